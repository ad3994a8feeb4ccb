// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "History.h"

#include "vtkAsRigidAsPossibleDeformation.h"
#include "vtkCurveDeformation.h"
#include "vtkExampleBasedDeformation.h"
#include "vtkHandleMotion.h"
#include "vtkLaplacianDeformation.h"
#include "vtkMultiresolutionDeformation.h"
#include "vtkPoissonDeformation.h"
#include "vtkPyramidDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkSimilarityDeformation.h"
#include "vtkVolumetricDeformation.h"

#include "Kernel/Algebra/SymmetricSolver.h"

namespace history
{
inline vtkSmartPointer<vtkHandleMotion> MotionOf(int id, int value)
{
  auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  motion->SetAngle(20.0 * value);
  motion->SetAxis(1.0, 0.1 * id, 0.0);
  motion->SetTranslation(0.1 * id, 0.0, 0.0);
  return motion;
}

/// None, one or two motions; in three ways: all by id, one of them as the active
/// one, and that of handle 2 as a row of the table.
inline Choice MotionChoice()
{
  return Of<vtkSurfaceDeformation>(18,
    [](vtkSurfaceDeformation* filter, int value)
    {
      const int motions = value % 6;
      filter->RemoveAllHandleMotions();
      filter->SetNumberOfMotionRows(0);
      for (int id = 1; id <= 2; ++id)
      {
        if (motions % (id + 1) > 0 || motions == 0)
        {
          filter->SetHandleMotion(id, MotionOf(id, motions));
        }
      }
      if (value / 6 == 1)
      {
        filter->SetActiveHandle(1 + value % 2);
        filter->SetActiveMotion(MotionOf(3, motions));
      }
      if (value / 6 == 2)
      {
        filter->RemoveHandleMotion(2);
        filter->SetMotionRow(
          0, 2.0, 1.0, 1.1, 1.0, 10.0 * motions, 0.0, 0.0, 1.0, 0.0, 0.0, 3.0, 0.0, 0.2, 0.0);
      }
    });
}

template <typename Filter>
std::vector<Choice> DeformationChoices(std::vector<Choice> own = {})
{
  using Base = vtkSurfaceDeformation;
  std::vector<Choice> choices = { InputChoice(), MotionChoice(),
    Enumeration<Base>(3, &Base::SetLaplacianWeights),
    Enumeration<Base>(cartan::HasCholmod() ? 3 : 2, &Base::SetSolver),
    Name<Base>(&Base::SetHandleArrayName, { "Handle", "Other", "Handle", "Weight" }),
    Name<Base>(&Base::SetTargetPositionArrayName, { "", "Target" }),
    Of<Base>(6, // most often neither: not all methods accept them, none accepts both
      [](Base* filter, int value)
      {
        filter->SetRotationVectorArrayName(value == 1 || value == 3 ? "Turn" : "");
        filter->SetTransformArrayName(value == 2 || value == 3 ? "Transform" : "");
      }),
    Name<Base>(&Base::SetConstraintWeightArrayName, { "", "Weight" }),
    Switch<Base>(&Base::SetScaleConstraintWeights),
    Of<Base>(2, [](Base* filter, int value) { filter->SetRoundingCheckLimit(value ? 0 : 5000); }),
    Of<Base>(2, [](Base* filter, int value) { filter->SetConstrainHandlePositions(value == 0); }),
    Switch<Base>(&Base::SetGenerateFrameChange), Switch<Base>(&Base::SetGenerateRotationVector) };
  choices.insert(choices.end(), own.begin(), own.end());
  return choices;
}

template <typename Filter>
std::vector<Choice> FrameChoices(std::vector<Choice> own = {})
{
  using Base = vtkFrameDeformation;
  own.push_back(Enumeration<Base>(3, &Base::SetVolumeCorrection));
  own.push_back(Switch<Base>(&Base::SetCloseVolume));
  own.push_back(Enumeration<Base>(4, &Base::SetPositionWeights));
  own.push_back(Switch<Base>(&Base::SetGenerateVolumeArrays));
  own.push_back(Switch<Base>(&Base::SetGenerateShapeDistance));
  return DeformationChoices<Filter>(std::move(own));
}

inline Subject AsRigidAsPossible()
{
  using Filter = vtkAsRigidAsPossibleDeformation;
  return Make<Filter>("AsRigidAsPossible",
    DeformationChoices<Filter>({ Enumeration<Filter>(3, &Filter::SetEnergy),
      // PREVIOUS_RESULT depends on the way by its definition.
      Of<Filter>(3, [](Filter* f, int value) { f->SetInitialGuess(value ? value + 1 : 0); }),
      Of<Filter>(2, [](Filter* f, int value) { f->SetMaximumIterations(1 + 3 * value); }),
      Number<Filter>(&Filter::SetBending, { 0.1, 0.0, 1.0 }),
      Number<Filter>(&Filter::SetTolerance, { 0.0, 0.5 }),
      Switch<Filter>(&Filter::SetGenerateRigidityEnergy) }));
}

inline Subject Pyramid()
{
  using Filter = vtkPyramidDeformation;
  return Make<Filter>("Pyramid",
    DeformationChoices<Filter>({ // PREVIOUS_RESULT depends on the way by its definition.
      Of<Filter>(3, [](Filter* f, int value) { f->SetInitialGuess(value ? value + 1 : 0); }),
      Of<Filter>(2, [](Filter* f, int value) { f->SetMaximumIterations(1 + 3 * value); }),
      Number<Filter>(&Filter::SetTolerance, { 0.0, 0.5 }),
      Switch<Filter>(&Filter::SetGeneratePyramidEnergy) }));
}

inline Subject Similarity()
{
  using Filter = vtkSimilarityDeformation;
  return Make<Filter>("Similarity",
    DeformationChoices<Filter>(
      { Of<Filter>(2, [](Filter* f, int value) { f->SetCoherenceRings(1 + value); }),
        Enumeration<Filter>(3, &Filter::SetReconstruction),
        Enumeration<Filter>(2, &Filter::SetRefits),
        Switch<Filter>(&Filter::SetConstrainHandleTransforms),
        Switch<Filter>(&Filter::SetScaleFeatures),
        Switch<Filter>(&Filter::SetGenerateScaleFactor) }));
}

inline Subject Volumetric()
{
  using Filter = vtkVolumetricDeformation;
  return Make<Filter>("Volumetric",
    DeformationChoices<Filter>({ Number<Filter>(&Filter::SetLatticeSpacing, { 0.0, 0.6, 0.3 }),
      Of<Filter>(2, [](Filter* f, int value) { f->SetOuterLayer(value == 0); }),
      Of<Filter>(2, [](Filter* f, int value) { f->SetVolumeRounds(3 - value); }) }));
}

/// A line that a curve along a bar can follow.
inline vtkSmartPointer<vtkPolyData> TargetLine(double height)
{
  auto line = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(3);
  lines->InsertCellPoint(points->InsertNextPoint(0.5, 0.5, 0.5));
  lines->InsertCellPoint(points->InsertNextPoint(0.5 + height, 0.5, 1.5));
  lines->InsertCellPoint(points->InsertNextPoint(0.5, 0.5, 3.5));
  line->SetPoints(points);
  line->SetLines(lines);
  return line;
}

inline Subject Curve()
{
  using Filter = vtkCurveDeformation;
  return Make<Filter>("Curve",
    { InputChoice(),
      Of<Filter>(3,
        [](Filter* f, int value) { f->SetTargetData(value ? TargetLine(0.3 * value) : nullptr); }),
      Of<Filter>(3,
        [](Filter* f, int value)
        {
          f->SetPointId(0, 10 + value);
          f->SetPointId(1, 60);
        }),
      Enumeration<Filter>(5, &Filter::SetSource), Enumeration<Filter>(5, &Filter::SetMethod),
      Number<Filter>(&Filter::SetFeatureAngle, { 30.0, 120.0 }),
      Of<Filter>(2, [](Filter* f, int value) { f->SetViewDirection(1.0, 0.3 * value, 0.2); }),
      Number<Filter>(&Filter::SetFidelity, { 1.0, 0.3 }),
      Number<Filter>(&Filter::SetReach, { 0.0, 1.0 }),
      Number<Filter>(&Filter::SetRidgeHeight, { 0.0, 0.1 }),
      Number<Filter>(&Filter::SetRidgeWidth, { 0.0, 0.7 }), Switch<Filter>(&Filter::SetSharpRidge),
      Switch<Filter>(&Filter::SetReverseTarget), Switch<Filter>(&Filter::SetCurveRotations),
      Switch<Filter>(&Filter::SetClosedCurve), Number<Filter>(&Filter::SetRidgeScale, { 1.0, 1.5 }),
      Number<Filter>(&Filter::SetRidgeTurn, { 0.0, 30.0 }),
      Name<Filter>(&Filter::SetHandleArrayName, { "Handle", "None", "Weight" }) });
}

/// WarmStart depends on the way by its definition.
inline Subject ExampleBased()
{
  using Filter = vtkExampleBasedDeformation;
  const Choice examples = { 6,
    [](vtkAlgorithm* filter, int value, Surfaces& surfaces)
    {
      auto* deformation = static_cast<Filter*>(filter);
      deformation->RemoveAllExamples();
      // Those of the most frequent connectivity, and one of another.
      const int first[] = { 0, 2, 3, 3, 2, 1 };
      deformation->AddExampleData(surfaces[first[value]]);
      if (value > 3)
      {
        deformation->AddExampleData(surfaces[2]);
      }
    } };
  return Make<Filter>("ExampleBased",
    DeformationChoices<Filter>({ examples,
      Of<Filter>(2, [](Filter* f, int value) { f->SetMaximumIterations(20 - 10 * value); }),
      Number<Filter>(&Filter::SetRigidness, { 0.0, 0.4 }),
      Enumeration<Filter>(8, &Filter::SetRigidMethod), Switch<Filter>(&Filter::SetExamplesOverTime),
      Number<Filter>(&Filter::SetTolerance, { 1e-6, 1e-2 }) }));
}

inline std::vector<Subject> DeformationSubjects()
{
  using RotationInvariant = vtkRotationInvariantDeformation;
  using ShapePreserving = vtkShapePreservingDeformation;
  using Laplacian = vtkLaplacianDeformation;
  using Multiresolution = vtkMultiresolutionDeformation;
  return {
    Make<RotationInvariant>("RotationInvariant",
      FrameChoices<RotationInvariant>(
        { Enumeration<RotationInvariant>(3, &RotationInvariant::SetFrameProjection) })),
    Make<ShapePreserving>("ShapePreserving",
      FrameChoices<ShapePreserving>(
        { Of<ShapePreserving>(
            3, [](ShapePreserving* f, int value) { f->SetMaximumIterations(1 + value); }),
          Number<ShapePreserving>(&ShapePreserving::SetTolerance, { 1e-6, 0.5 }) })),
    Make<vtkPoissonDeformation>("Poisson",
      FrameChoices<vtkPoissonDeformation>(
        { Enumeration<vtkPoissonDeformation>(2, &vtkPoissonDeformation::SetPropagation) })),
    Similarity(),
    Make<Laplacian>("Laplacian",
      DeformationChoices<Laplacian>({ Enumeration<Laplacian>(3, &Laplacian::SetRotations),
        Of<Laplacian>(2, [](Laplacian* f, int value) { f->SetRounds(2 + value); }) })),
    Make<Multiresolution>("Multiresolution",
      DeformationChoices<Multiresolution>({ Of<Multiresolution>(
        3, [](Multiresolution* f, int value) { f->SetSmoothness(1 + value); }) })),
    AsRigidAsPossible(),
    Pyramid(),
    Volumetric(),
    Curve(),
    ExampleBased(),
  };
}
}
