// SPDX-License-Identifier: BSD-3-Clause
#include "SteeringSettings.h"

#include "vtkCarryAlong.h"
#include "vtkCurveDeformation.h"
#include "vtkExampleBasedDeformation.h"
#include "vtkLandmarkHandles.h"
#include "vtkVolumetricDeformation.h"

namespace fuzz
{
Parameters CarryParameters()
{
  return { Make("TurnVectors", &vtkCarryAlong::SetTurnVectors, Flag()) };
}

Parameters CurveParameters()
{
  using Class = vtkCurveDeformation;
  return { Make("Method", &Class::SetMethod, Integer(0, 4)),
    Make("CurveRotations", &Class::SetCurveRotations, Flag()),
    Make("Fidelity", &Class::SetFidelity, Real(0.5, 1.0)),
    Make("Reach", &Class::SetReach, Length(1e-1, 2.0), Kind::Scalar, 1),
    Make("RidgeHeight", &Class::SetRidgeHeight, Length(1e-3, 1e-1), Kind::Scalar, 1),
    Make("RidgeWidth", &Class::SetRidgeWidth, Length(1e-2, 1.0), Kind::Scalar, 1),
    Make("RidgeScale", &Class::SetRidgeScale, Real(0.0, 3.0)),
    Make("RidgeTurn", &Class::SetRidgeTurn, Real(-90.0, 90.0)),
    Make("SharpRidge", &Class::SetSharpRidge, Flag()) };
}

Parameters ExampleParameters()
{
  using Class = vtkExampleBasedDeformation;
  return { Make("WarmStart", &Class::SetWarmStart, Flag()),
    Make("Rigidness", &Class::SetRigidness, Real(0.0, 1.0)),
    Make("RigidMethod", &Class::SetRigidMethod, Integer(0, 7)),
    Make("MaximumIterations", &Class::SetMaximumIterations, Integer(0, 20)) };
}

Parameters LandmarkParameters()
{
  using Class = vtkLandmarkHandles;
  return { Make("Tolerance", &Class::SetTolerance, Length(1e-1, 10.0), Kind::Scalar, 1),
    Make("Accuracy", &Class::SetAccuracy, Length(1e-4, 1e-1), Kind::Scalar, 1) };
}

Parameters VolumetricParameters()
{
  using Class = vtkVolumetricDeformation;
  return { Make("LatticeSpacing", &Class::SetLatticeSpacing, Length(0.05, 0.5), Kind::Scalar, 1),
    Make("OuterLayer", &Class::SetOuterLayer, Flag()),
    Make("VolumeRounds", &Class::SetVolumeRounds, Integer(0, 6)) };
}
}
