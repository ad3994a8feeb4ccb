// SPDX-License-Identifier: BSD-3-Clause
#include "Settings.h"

#include "Parameters.h"
#include "SteeringSettings.h"

#include "vtkAsRigidAsPossibleDeformation.h"
#include "vtkBoundaryLoops.h"
#include "vtkCarryAlong.h"
#include "vtkCoatingTransfer.h"
#include "vtkCurvatureError.h"
#include "vtkCurveDeformation.h"
#include "vtkDifferentialCoordinates.h"
#include "vtkDifferentialReconstruction.h"
#include "vtkDiscreteForms.h"
#include "vtkExampleBasedDeformation.h"
#include "vtkFrameReconstruction.h"
#include "vtkHighPassQuantization.h"
#include "vtkLandmarkHandles.h"
#include "vtkLaplacianDeformation.h"
#include "vtkLaplacianSpectrum.h"
#include "vtkLeastSquaresMesh.h"
#include "vtkMarkHandle.h"
#include "vtkMeshMerge.h"
#include "vtkMultiresolutionDeformation.h"
#include "vtkPoissonDeformation.h"
#include "vtkPrepareSurface.h"
#include "vtkPyramidDeformation.h"
#include "vtkRestoreSurface.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkSimilarityDeformation.h"
#include "vtkSphere.h"
#include "vtkSurfaceMorph.h"
#include "vtkVolumeChange.h"
#include "vtkVolumetricDeformation.h"

#include <map>

namespace fuzz
{
namespace
{
Parameters DeformationParameters()
{
  using Class = vtkSurfaceDeformation;
  return {
    Make("LaplacianWeights", &Class::SetLaplacianWeights, Integer(0, 2)),
    Make("Solver", &Class::SetSolver, Integer(0, 2)),
    Make("ConstrainHandlePositions", &Class::SetConstrainHandlePositions, Flag()),
    Make("ScaleConstraintWeights", &Class::SetScaleConstraintWeights, Flag()),
    Make("GenerateFrameChange", &Class::SetGenerateFrameChange, Flag()),
    Make("GenerateRotationVector", &Class::SetGenerateRotationVector, Flag()),
  };
}

Parameters FrameParameters()
{
  using Class = vtkFrameDeformation;
  Parameters parameters = DeformationParameters();
  const Parameters own = {
    Make("VolumeCorrection", &Class::SetVolumeCorrection, Integer(0, 2)),
    Make("CloseVolume", &Class::SetCloseVolume, Flag()),
    Make("PositionWeights", &Class::SetPositionWeights, Integer(0, 3)),
    Make("GenerateVolumeArrays", &Class::SetGenerateVolumeArrays, Flag()),
    Make("GenerateShapeDistance", &Class::SetGenerateShapeDistance, Flag()),
    Make("TabulateTurns", &Class::SetTabulateTurns, Flag()),
  };
  parameters.insert(parameters.end(), own.begin(), own.end());
  return parameters;
}

Parameters RigidParameters()
{
  using Class = vtkAsRigidAsPossibleDeformation;
  return With(DeformationParameters(),
    { Make("Energy", &Class::SetEnergy, Integer(0, 2)),
      Make("Bending", &Class::SetBending, Real(0.0, 0.3)),
      Make("InitialGuess", &Class::SetInitialGuess, Integer(0, 3)),
      Make("MaximumIterations", &Class::SetMaximumIterations, Integer(0, 12)),
      Make("Tolerance", &Class::SetTolerance, Real(0.0, 1e-3)),
      Make("GenerateRigidityEnergy", &Class::SetGenerateRigidityEnergy, Flag()) });
}

Parameters PyramidParameters()
{
  using Class = vtkPyramidDeformation;
  return With(DeformationParameters(),
    { Make("InitialGuess", &Class::SetInitialGuess, Integer(0, 3)),
      Make("MaximumIterations", &Class::SetMaximumIterations, Integer(0, 40)),
      Make("Tolerance", &Class::SetTolerance, Real(0.0, 1e-3)),
      Make("GeneratePyramidEnergy", &Class::SetGeneratePyramidEnergy, Flag()) });
}

Parameters SimilarityParameters()
{
  using Class = vtkSimilarityDeformation;
  return With(DeformationParameters(),
    { Make("ScaleFeatures", &Class::SetScaleFeatures, Flag()),
      Make("CoherenceRings", &Class::SetCoherenceRings, Integer(1, 2)),
      Make("ConstrainHandleTransforms", &Class::SetConstrainHandleTransforms, Flag()),
      Make("Reconstruction", &Class::SetReconstruction, Integer(0, 2)),
      Make("Refits", &Class::SetRefits, Integer(0, 4)),
      Make("GenerateScaleFactor", &Class::SetGenerateScaleFactor, Flag()) });
}

Parameters PrepareParameters()
{
  using Class = vtkPrepareSurface;
  return { Make("MergePoints", &Class::SetMergePoints, Flag()),
    Make("MergeInnerPoints", &Class::SetMergeInnerPoints, Flag()),
    // Relative: without a unit.
    Make("Tolerance", &Class::SetTolerance, Logarithmic(1e-9, 1e-1)),
    Make("AverageMergedArrays", &Class::SetAverageMergedArrays, Flag()),
    Make("DropDoubledTriangles", &Class::SetDropDoubledTriangles, Flag()),
    Make("OrientConsistently", &Class::SetOrientConsistently, Flag()),
    Make("CutNonManifold", &Class::SetCutNonManifold, Flag()),
    Make("OrientOutwards", &Class::SetOrientOutwards, Flag()),
    Make("AlternateNested", &Class::SetAlternateNested, Flag()),
    Make("MinimumComponentArea", &Class::SetMinimumComponentArea, Real(0.0, 0.5)),
    Make("MaximumHoleEdges", &Class::SetMaximumHoleEdges, Integer(0, 40)),
    Make("MaximumHoleLength", &Class::SetMaximumHoleLength, Length(1e-2, 10.0), Kind::Scalar, 1),
    Make("FlipEdges", &Class::SetFlipEdges, Flag()),
    Make("FlipAngle", &Class::SetFlipAngle, Real(0.0, 180.0)),
    Make("JoinCopies", &Class::SetJoinCopies, Flag()) };
}

Parameters MorphParameters()
{
  using Class = vtkSurfaceMorph;
  return { Make("Method", &Class::SetMethod, Integer(0, 3)),
    Make("Parameter", &Class::SetParameter, Real(0.0, 1.0)),
    Make("Placement", &Class::SetPlacement, Integer(0, 1)),
    Make("CloseVolume", &Class::SetCloseVolume, Flag()),
    Make("TransitionInterpolation", &Class::SetTransitionInterpolation, Integer(0, 1)),
    Make("FrameSolver", &Class::SetFrameSolver, Integer(0, 2)),
    Make("Stitching", &Class::SetStitching, Integer(0, 2)),
    Make("LengthPolish", &Class::SetLengthPolish, Integer(0, 3)) };
}

vtkSphere* RegionOf(vtkAlgorithm* filter)
{
  auto* mark = vtkMarkHandle::SafeDownCast(filter);
  if (!mark->GetRegion())
  {
    mark->SetRegion(vtkSmartPointer<vtkSphere>::New());
  }
  return vtkSphere::SafeDownCast(mark->GetRegion());
}

/// Center and radius of a sphere.
Parameters RegionParameters()
{
  Setting center;
  center.Name = "RegionCenter";
  center.Type = Kind::Point;
  center.Apply = [](vtkAlgorithm* filter, const std::vector<double>& v)
  { RegionOf(filter)->SetCenter(v[0], v[1], v[2]); };
  const Draw onePoint = [](Random& random, const Mesh& mesh) -> std::vector<double>
  {
    const Eigen::Vector3d point = random.Pick(mesh.Points);
    const bool isFinite = point.allFinite();
    return { isFinite ? point.x() : 0.0, isFinite ? point.y() : 0.0, isFinite ? point.z() : 0.0 };
  };
  Setting radius;
  radius.Name = "RegionRadius";
  radius.Power = 1;
  radius.Apply = [](vtkAlgorithm* filter, const std::vector<double>& v)
  { RegionOf(filter)->SetRadius(v[0]); };
  return { { center, onePoint }, { radius, Length(1e-2, 1.0) } };
}

Parameters MarkParameters()
{
  using Class = vtkMarkHandle;
  return With(RegionParameters(),
    { Make("HandleId", &Class::SetHandleId, Integer(0, 5)),
      Make("RegionSource", &Class::SetRegionSource, Integer(0, 3)),
      Make("InsideOut", &Class::SetInsideOut, Flag()),
      Make("GrowRings", &Class::SetGrowRings, Integer(0, 4)),
      Make("GrowDistance", &Class::SetGrowDistance, Length(1e-3, 2.0), Kind::Scalar, 1),
      Make("Overwrite", &Class::SetOverwrite, Flag()) });
}

Parameters DifferentialParameters()
{
  using Class = vtkDifferentialFilter;
  return { Make("LaplacianWeights", &Class::SetLaplacianWeights, Integer(0, 2)),
    Make("Normalization", &Class::SetNormalization, Integer(0, 2)) };
}

Parameters ReconstructionParameters()
{
  using Class = vtkDifferentialReconstruction;
  return With(DifferentialParameters(),
    { Make("AnchorMode", &Class::SetAnchorMode, Integer(0, 2)),
      Make("ConstraintWeight", &Class::SetConstraintWeight, Logarithmic(1e-2, 1e3)) });
}

Parameters SpectrumParameters()
{
  using Class = vtkLaplacianSpectrum;
  return { Make("Operator", &Class::SetOperator, Integer(0, 1)),
    Make("NumberOfModes", &Class::SetNumberOfModes, Integer(1, 40)),
    Make("Approximation", &Class::SetApproximation, Integer(0, 3)),
    Make("ApproximationModes", &Class::SetApproximationModes, Integer(0, 40)),
    Make("FirstMode", &Class::SetFirstMode, Integer(0, 10)),
    Make("GenerateModes", &Class::SetGenerateModes, Flag()) };
}

Parameters LeastSquaresParameters()
{
  using Class = vtkLeastSquaresMesh;
  return { Make("AnchorSelection", &Class::SetAnchorSelection, Integer(0, 2)),
    Make("NumberOfAnchors", &Class::SetNumberOfAnchors, Integer(1, 40)),
    Make("GenerateBasisFunctions", &Class::SetGenerateBasisFunctions, Flag()) };
}

Parameters QuantizationParameters()
{
  using Class = vtkHighPassQuantization;
  return { Make("Bits", &Class::SetBits, Integer(1, 16)),
    Make("NumberOfAnchors", &Class::SetNumberOfAnchors, Integer(1, 40)),
    Make("MaximumError", &Class::SetMaximumError, Logarithmic(1e-6, 1e-1)),
    Make("VisualErrorAlpha", &Class::SetVisualErrorAlpha, Real(0.0, 1.0)) };
}

Parameters MergeParameters()
{
  using Class = vtkMeshMerge;
  return { Make("Configuration", &Class::SetConfiguration, Integer(0, 1)),
    Make("BendWidth", &Class::SetBendWidth, Length(1e-2, 2.0), Kind::Scalar, 1),
    Make("SeamFairing", &Class::SetSeamFairing, Integer(0, 4)),
    Make("FairingMethod", &Class::SetFairingMethod, Integer(0, 1)) };
}

Parameters CoatingParameters()
{
  using Class = vtkCoatingTransfer;
  return { Make("Correspondence", &Class::SetCorrespondence, Integer(0, 3)),
    Make("Alignment", &Class::SetAlignment, Integer(0, 2)),
    Make("Smoothing", &Class::SetSmoothing, Real(0.0, 20.0)),
    Make("Strength", &Class::SetStrength, Real(-2.0, 2.0)),
    Make("ScaleDetails", &Class::SetScaleDetails, Flag()),
    Make("FadeWidth", &Class::SetFadeWidth, Length(1e-2, 1.0), Kind::Scalar, 1),
    Make("TransferArrays", &Class::SetTransferArrays, Flag()) };
}

/// Filters, each with what makes it and what can be set.
struct Entry
{
  std::function<vtkSmartPointer<vtkAlgorithm>()> New;
  Parameters Own;
};

template <typename Class>
Entry MakeEntry(Parameters own)
{
  return { [] { return vtkSmartPointer<Class>::New(); }, std::move(own) };
}

const std::map<std::string, Entry>& Entries()
{
  using Frames = vtkShapePreservingDeformation;
  using Forms = vtkFrameReconstruction;
  static const std::map<std::string, Entry> entries = {
    { "AsRigidAsPossibleDeformation",
      MakeEntry<vtkAsRigidAsPossibleDeformation>(RigidParameters()) },
    { "BoundaryLoops", MakeEntry<vtkBoundaryLoops>({}) },
    { "CarryAlong", MakeEntry<vtkCarryAlong>(CarryParameters()) },
    { "CoatingTransfer", MakeEntry<vtkCoatingTransfer>(CoatingParameters()) },
    { "CurvatureError",
      MakeEntry<vtkCurvatureError>(
        { Make("ComputeDirections", &vtkCurvatureError::SetComputeDirections, Flag()) }) },
    { "CurveDeformation", MakeEntry<vtkCurveDeformation>(CurveParameters()) },
    { "DifferentialCoordinates", MakeEntry<vtkDifferentialCoordinates>(DifferentialParameters()) },
    { "DifferentialReconstruction",
      MakeEntry<vtkDifferentialReconstruction>(ReconstructionParameters()) },
    { "DiscreteForms", MakeEntry<vtkDiscreteForms>({}) },
    { "ExampleBasedDeformation",
      MakeEntry<vtkExampleBasedDeformation>(With(DeformationParameters(), ExampleParameters())) },
    { "FrameReconstruction",
      MakeEntry<Forms>({ Make("SeedPoint", &Forms::SetSeedPoint, Integer(0, 40)),
        Make("TransitionMethod", &Forms::SetTransitionMethod, Integer(0, 1)),
        Make("ProjectFrames", &Forms::SetProjectFrames, Flag()) }) },
    { "HighPassQuantization", MakeEntry<vtkHighPassQuantization>(QuantizationParameters()) },
    { "LandmarkHandles", MakeEntry<vtkLandmarkHandles>(LandmarkParameters()) },
    { "LaplacianDeformation",
      MakeEntry<vtkLaplacianDeformation>(With(DeformationParameters(),
        { Make("Rotations", &vtkLaplacianDeformation::SetRotations, Integer(0, 2)),
          Make("Rounds", &vtkLaplacianDeformation::SetRounds, Integer(1, 8)) })) },
    { "LaplacianSpectrum", MakeEntry<vtkLaplacianSpectrum>(SpectrumParameters()) },
    { "LeastSquaresMesh", MakeEntry<vtkLeastSquaresMesh>(LeastSquaresParameters()) },
    { "MarkHandle", MakeEntry<vtkMarkHandle>(MarkParameters()) },
    { "MeshMerge", MakeEntry<vtkMeshMerge>(MergeParameters()) },
    { "MultiresolutionDeformation",
      MakeEntry<vtkMultiresolutionDeformation>(With(DeformationParameters(),
        { Make("Smoothness", &vtkMultiresolutionDeformation::SetSmoothness, Integer(1, 3)) })) },
    { "PoissonDeformation",
      MakeEntry<vtkPoissonDeformation>(With(FrameParameters(),
        { Make("Propagation", &vtkPoissonDeformation::SetPropagation, Integer(0, 1)) })) },
    { "PrepareSurface", MakeEntry<vtkPrepareSurface>(PrepareParameters()) },
    { "PyramidDeformation", MakeEntry<vtkPyramidDeformation>(PyramidParameters()) },
    { "RestoreSurface", MakeEntry<vtkRestoreSurface>({}) },
    { "RotationInvariantDeformation",
      MakeEntry<vtkRotationInvariantDeformation>(With(FrameParameters(),
        { Make("FrameProjection", &vtkRotationInvariantDeformation::SetFrameProjection,
          Integer(0, 2)) })) },
    { "ShapePreservingDeformation",
      MakeEntry<Frames>(With(FrameParameters(),
        { Make("MaximumIterations", &Frames::SetMaximumIterations, Integer(1, 20)),
          Make("Tolerance", &Frames::SetTolerance, Real(0.0, 1e-3)) })) },
    { "SimilarityDeformation", MakeEntry<vtkSimilarityDeformation>(SimilarityParameters()) },
    { "SurfaceMorph", MakeEntry<vtkSurfaceMorph>(MorphParameters()) },
    { "VolumetricDeformation",
      MakeEntry<vtkVolumetricDeformation>(With(DeformationParameters(), VolumetricParameters())) },
    { "VolumeChange",
      MakeEntry<vtkVolumeChange>(
        { Make("ComputeLocalVolume", &vtkVolumeChange::SetComputeLocalVolume, Flag()) }) },
  };
  return entries;
}
}

const std::vector<std::string>& Filters()
{
  static const std::vector<std::string> names = []
  {
    std::vector<std::string> all;
    for (const auto& entry : Entries())
    {
      all.push_back(entry.first);
    }
    return all;
  }();
  return names;
}

std::vector<Setting> RandomSettings(const std::string& filter, const Mesh& mesh, Random& random)
{
  std::vector<Setting> settings;
  // Some cases are all defaults, in others much is set.
  const double part = random.Chance(0.2) ? 0.0 : random.Real(0.1, 0.7);
  for (const Parameter& parameter : Entries().at(filter).Own)
  {
    // A region has both, center and radius.
    const bool isOfRegion =
      parameter.Call.Name == "RegionCenter" || parameter.Call.Name == "RegionRadius";
    if (isOfRegion || random.Chance(part))
    {
      settings.push_back(parameter.Call);
      settings.back().Values = parameter.Values(random, mesh);
    }
  }
  return settings;
}

vtkSmartPointer<vtkAlgorithm> NewFilter(const Case& of)
{
  vtkSmartPointer<vtkAlgorithm> filter = Entries().at(of.Filter).New();
  for (const Setting& setting : of.Settings)
  {
    setting.Apply(filter, setting.Values);
  }
  return filter;
}
}
