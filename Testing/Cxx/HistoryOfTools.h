// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "History.h"

#include "vtkBoundaryLoops.h"
#include "vtkCarryAlong.h"
#include "vtkCoatingTransfer.h"
#include "vtkCurvatureError.h"
#include "vtkDifferentialCoordinates.h"
#include "vtkDifferentialReconstruction.h"
#include "vtkDiscreteForms.h"
#include "vtkFrameReconstruction.h"
#include "vtkHandleMotion.h"
#include "vtkHighPassQuantization.h"
#include "vtkLandmarkHandles.h"
#include "vtkLaplacianSpectrum.h"
#include "vtkLeastSquaresMesh.h"
#include "vtkMarkHandle.h"
#include "vtkMeshMerge.h"
#include "vtkPrepareSurface.h"
#include "vtkRestoreSurface.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkSpectralWatermark.h"
#include "vtkSurfaceMorph.h"
#include "vtkVolumeChange.h"

#include "vtkAppendPolyData.h"
#include "vtkBox.h"
#include "vtkClipPolyData.h"
#include "vtkIdTypeArray.h"
#include "vtkMaskPoints.h"
#include "vtkPlane.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"

namespace history
{
/// A filter upstream of a subject, whose own complaints are not the law's matter.
template <typename Filter>
vtkSmartPointer<Filter> Upstream()
{
  auto filter = vtkSmartPointer<Filter>::New();
  vtktest::Observe(filter);
  return filter;
}

template <typename Filter>
Subject Comparison(const std::string& name, const Choice& own)
{
  return Make<Filter>(name, { InputChoice(0), InputChoice(1), own });
}

/// Two to four key frames of one connectivity, some in single precision, or the
/// time steps of one input.
inline Choice KeyFrames()
{
  const std::vector<std::vector<int>> keys = { { 0, 2 }, { 2, 0 }, { 0, 2, 3 }, { 3, 0, 2, 0 },
    { 4, 4 }, { 0, 3, 2 } };
  return { static_cast<int>(keys.size()),
    [keys](vtkAlgorithm* filter, int value, Surfaces& surfaces)
    {
      filter->RemoveAllInputConnections(0);
      vtkNew<TimeSteps> source;
      for (const int key : keys[value])
      {
        source->Steps.push_back(surfaces[key]);
      }
      if (value == 5)
      {
        filter->AddInputConnection(0, source->GetOutputPort());
        return;
      }
      for (const auto& step : source->Steps)
      {
        filter->AddInputDataObject(0, step);
      }
    } };
}

inline Subject Morph()
{
  using Filter = vtkSurfaceMorph;
  return Make<Filter>("SurfaceMorph",
    { KeyFrames(), Number<Filter>(&Filter::SetParameter, { 0.0, 0.25, 0.4, 0.75, 1.0, 1.1 }),
      Enumeration<Filter>(5, &Filter::SetMethod), Enumeration<Filter>(2, &Filter::SetPlacement),
      Switch<Filter>(&Filter::SetCloseVolume), Enumeration<Filter>(3, &Filter::SetStitching),
      Enumeration<Filter>(3, &Filter::SetFrameSolver),
      Enumeration<Filter>(2, &Filter::SetTransitionInterpolation),
      Enumeration<Filter>(2, &Filter::SetLengthPolish), Switch<Filter>(&Filter::SetFollowTime),
      Of<Filter>(2, [](Filter* f, int value) { f->SetStepsBetweenKeyFrames(1 + 2 * value); }),
      Name<Filter>(&Filter::SetParameterArrayName, { "", "Part" }),
      Of<Filter>(3,
        [](Filter* f, int value)
        {
          f->SetNumberOfWeights(0);
          for (int k = 0; k < value + 1 && value > 0; ++k)
          {
            f->SetWeight(k, 1.0 / (value + 1));
          }
        }),
      Name<Filter>(&Filter::SetHandleArrayName, { "Handle", "Other" }) });
}

/// Every `stride`-th point.
inline vtkSmartPointer<vtkSelection> SelectEvery(int stride)
{
  vtkNew<vtkIdTypeArray> ids;
  for (vtkIdType v = 0; v < 60; v += stride)
  {
    ids->InsertNextValue(v);
  }
  vtkNew<vtkSelectionNode> node;
  node->SetFieldType(vtkSelectionNode::POINT);
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetSelectionList(ids);
  auto selection = vtkSmartPointer<vtkSelection>::New();
  selection->AddNode(node);
  return selection;
}

inline Subject Mark()
{
  using Filter = vtkMarkHandle;
  return Make<Filter>("MarkHandle",
    { InputChoice(),
      Of<Filter>(3,
        [](Filter* filter, int value)
        {
          vtkNew<vtkBox> box;
          box->SetBounds(-9.0, 9.0, -9.0, 9.0, 1.0 + value, 2.0 + value);
          filter->SetRegion(box);
        }),
      Of<Filter>(3,
        [](Filter* filter, int value)
        { filter->SetSelectionData(value ? SelectEvery(value + 2).Get() : nullptr); }),
      Enumeration<Filter>(4, &Filter::SetRegionSource), Switch<Filter>(&Filter::SetInsideOut),
      Switch<Filter>(&Filter::SetOverwrite), Enumeration<Filter>(3, &Filter::SetHandleId),
      Enumeration<Filter>(3, &Filter::SetGrowRings),
      Number<Filter>(&Filter::SetGrowDistance, { 0.0, 1.0 }),
      Name<Filter>(&Filter::SetHandleArrayName, { "Handle", "Other", "Target" }) });
}

inline Subject Reconstruction()
{
  using Filter = vtkFrameReconstruction;
  // Filters, because the surfaces may be edited. Output 0 has frames for constraints.
  const auto formsOf = [](const std::vector<int>& which, int port)
  {
    return Choice{ static_cast<int>(which.size()),
      [which, port](vtkAlgorithm* filter, int value, Surfaces& surfaces)
      {
        const auto forms = Upstream<vtkDiscreteForms>();
        forms->SetInputData(surfaces[which[value]]);
        filter->SetInputConnection(port, forms->GetOutputPort(port));
      } };
  };
  return Make<Filter>("FrameReconstruction",
    { formsOf({ 0, 2, 3, 4 }, 0), formsOf({ 0, 2, 3, 1 }, 1),
      Of<Filter>(3, [](Filter* f, int value) { f->SetSeedPoint(value - 1); }),
      Of<Filter>(2, [](Filter* f, int value) { f->SetSeedPosition(value, 2.0 * value, 0.0); }),
      Of<Filter>(2,
        [](Filter* f, int value)
        {
          value ? f->SetSeedFrame(0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
                : f->SetSeedFrame(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        }),
      Name<Filter>(&Filter::SetConstraintArrayName, { "", "Handle" }),
      Enumeration<Filter>(2, &Filter::SetTransitionMethod),
      Switch<Filter>(&Filter::SetProjectFrames) });
}

/// The surfaces, two of them in one place, and one that is cut open.
inline Choice DirtyInput()
{
  return { NumberOfSurfaces + 2,
    [](vtkAlgorithm* filter, int value, Surfaces& surfaces)
    {
      if (value < NumberOfSurfaces)
      {
        filter->SetInputDataObject(0, surfaces[value]);
      }
      else if (value == NumberOfSurfaces)
      {
        vtkNew<vtkAppendPolyData> both;
        both->AddInputData(surfaces[0]);
        both->AddInputData(surfaces[2]);
        filter->SetInputConnection(0, both->GetOutputPort());
      }
      else
      {
        vtkNew<vtkPlane> plane;
        plane->SetOrigin(0.0, 0.0, 2.2);
        plane->SetNormal(0.0, 0.1, 1.0);
        vtkNew<vtkClipPolyData> open;
        open->SetInputData(surfaces[0]);
        open->SetClipFunction(plane);
        filter->SetInputConnection(0, open->GetOutputPort());
      }
    } };
}

inline Subject Prepare()
{
  using Filter = vtkPrepareSurface;
  return Make<Filter>("PrepareSurface",
    { DirtyInput(), Switch<Filter>(&Filter::SetMergePoints),
      Switch<Filter>(&Filter::SetMergeInnerPoints),
      Number<Filter>(&Filter::SetTolerance, { 0.0, 1e-6, 0.02 }),
      Switch<Filter>(&Filter::SetToleranceIsAbsolute),
      Switch<Filter>(&Filter::SetAverageMergedArrays),
      Switch<Filter>(&Filter::SetDropDoubledTriangles),
      Switch<Filter>(&Filter::SetOrientConsistently), Switch<Filter>(&Filter::SetCutNonManifold),
      Switch<Filter>(&Filter::SetJoinCopies), Switch<Filter>(&Filter::SetOrientOutwards),
      Switch<Filter>(&Filter::SetAlternateNested),
      Number<Filter>(&Filter::SetMinimumComponentArea, { 0.0, 0.3 }),
      Of<Filter>(2, [](Filter* f, int value) { f->SetMaximumHoleEdges(100 * value); }),
      Number<Filter>(&Filter::SetMaximumHoleLength, { 0.0, 1.0 }),
      Switch<Filter>(&Filter::SetFlipEdges),
      Number<Filter>(&Filter::SetFlipAngle, { 10.0, 90.0 }) });
}

/// A surface that was prepared and bent, and the one that it was.
inline Subject Restore()
{
  return Make<vtkRestoreSurface>("RestoreSurface",
    { { 2 * NumberOfSurfaces,
        [](vtkAlgorithm* filter, int value, Surfaces& surfaces)
        {
          const auto prepare = Upstream<vtkPrepareSurface>();
          prepare->SetInputData(surfaces[value % NumberOfSurfaces]);
          prepare->SetMinimumComponentArea(0.1);
          const auto bend = Upstream<vtkRotationInvariantDeformation>();
          vtkNew<vtkHandleMotion> motion;
          motion->SetAngle(value < NumberOfSurfaces ? 30.0 : 60.0);
          bend->SetHandleMotion(2, motion);
          bend->SetInputConnection(prepare->GetOutputPort());
          filter->SetInputConnection(0, bend->GetOutputPort());
        } },
      InputChoice(1) });
}

inline Subject Coordinates()
{
  using Filter = vtkDifferentialCoordinates;
  return Make<Filter>("DifferentialCoordinates",
    { InputChoice(), Enumeration<Filter>(3, &Filter::SetLaplacianWeights),
      Enumeration<Filter>(3, &Filter::SetNormalization),
      Name<Filter>(
        &Filter::SetDifferentialCoordinatesArrayName, { "DifferentialCoordinates", "Delta" }) });
}

/// Coordinates of a few surfaces and kinds, with handles; some do not fit the settings.
inline Subject ReconstructionFromCoordinates()
{
  using Filter = vtkDifferentialReconstruction;
  const Choice input{ 2 * NumberOfSurfaces,
    [](vtkAlgorithm* filter, int value, Surfaces& surfaces)
    {
      const auto coordinates = Upstream<vtkDifferentialCoordinates>();
      coordinates->SetInputData(surfaces[value % NumberOfSurfaces]);
      coordinates->SetLaplacianWeights(value < NumberOfSurfaces ? 1 : 0);
      filter->SetInputConnection(0, coordinates->GetOutputPort());
    } };
  return Make<Filter>("DifferentialReconstruction",
    { input, Enumeration<Filter>(3, &Filter::SetLaplacianWeights),
      Enumeration<Filter>(3, &Filter::SetNormalization),
      Enumeration<Filter>(3, &Filter::SetAnchorMode),
      Number<Filter>(&Filter::SetConstraintWeight, { 1.0, 0.1, 10.0 }),
      Name<Filter>(&Filter::SetConstraintWeightArrayName, { "", "Weight" }),
      Name<Filter>(&Filter::SetAnchorPositionArrayName, { "", "Target" }),
      Name<Filter>(&Filter::SetHandleArrayName, { "Handle", "Other" }) });
}

inline Subject Spectrum()
{
  using Filter = vtkLaplacianSpectrum;
  return Make<Filter>("LaplacianSpectrum",
    { InputChoice(), Enumeration<Filter>(2, &Filter::SetOperator),
      Of<Filter>(3, [](Filter* f, int value) { f->SetNumberOfModes(5 + 300 * (value / 2)); }),
      Enumeration<Filter>(4, &Filter::SetApproximation),
      Of<Filter>(3, [](Filter* f, int value) { f->SetApproximationModes(2 * value); }),
      Of<Filter>(2, [](Filter* f, int value) { f->SetFirstMode(value); }),
      Switch<Filter>(&Filter::SetPlayModes), Switch<Filter>(&Filter::SetGenerateModes),
      Name<Filter>(&Filter::SetCoefficientArrayName, { "", "Target" }),
      Of<Filter>(2, [](Filter* f, int value) { f->SetModeMemoryLimit(value ? 1 : 4000); }) });
}

inline Subject Approximation()
{
  using Filter = vtkLeastSquaresMesh;
  return Make<Filter>("LeastSquaresMesh",
    { InputChoice(), Enumeration<Filter>(3, &Filter::SetAnchorSelection),
      Of<Filter>(3, [](Filter* f, int value) { f->SetNumberOfAnchors(1 + 20 * value); }),
      Name<Filter>(&Filter::SetHandleArrayName, { "Handle", "Other" }),
      Switch<Filter>(&Filter::SetPlayAnchors), Switch<Filter>(&Filter::SetGenerateBasisFunctions),
      Of<Filter>(2, [](Filter* f, int value) { f->SetBasisMemoryLimit(value ? 1 : 4000); }) });
}

inline Subject Quantization()
{
  using Filter = vtkHighPassQuantization;
  return Make<Filter>("HighPassQuantization",
    { InputChoice(), Of<Filter>(3, [](Filter* f, int value) { f->SetBits(3 + 3 * value); }),
      Of<Filter>(3, [](Filter* f, int value) { f->SetNumberOfAnchors(1 + 9 * value); }),
      Number<Filter>(&Filter::SetMaximumError, { 0.0, 1e-3, 1e-9 }),
      Number<Filter>(&Filter::SetVisualErrorAlpha, { 0.15, 1.0 }) });
}

inline Subject Watermark()
{
  using Filter = vtkSpectralWatermark;
  return Make<Filter>("SpectralWatermark",
    { InputChoice(0), InputChoice(1), Enumeration<Filter>(2, &Filter::SetMode),
      Name<Filter>(&Filter::SetMessage, { "10", "", "0110" }),
      Enumeration<Filter>(2, &Filter::SetMessageFormat),
      Name<Filter>(&Filter::SetKey, { "", "key" }),
      Of<Filter>(2, [](Filter* f, int value) { f->SetNumberOfBits(2 + 30 * value); }),
      Number<Filter>(&Filter::SetStrength, { 0.001, 0.01 }),
      Of<Filter>(2, [](Filter* f, int value) { f->SetPatchSize(20 * value); }),
      Number<Filter>(&Filter::SetModeFraction, { 0.07, 0.3 }), Switch<Filter>(&Filter::SetAlign) });
}

/// The lower (port 0) or upper half of a surface, which is open where it is cut.
inline Choice Half(int port)
{
  return { 2 * NumberOfSurfaces,
    [port](vtkAlgorithm* filter, int value, Surfaces& surfaces)
    {
      vtkNew<vtkPlane> plane;
      plane->SetNormal(0.0, 0.0, port ? 1.0 : -1.0);
      plane->SetOrigin(0.0, 0.0, value < NumberOfSurfaces ? 1.7 : 2.1);
      const auto clip = Upstream<vtkClipPolyData>();
      clip->SetClipFunction(plane);
      clip->SetInputData(surfaces[value % NumberOfSurfaces]);
      filter->SetInputConnection(port, clip->GetOutputPort());
    } };
}

inline Subject Merge()
{
  using Filter = vtkMeshMerge;
  return Make<Filter>("MeshMerge",
    { Half(0), Half(1), Enumeration<Filter>(2, &Filter::SetConfiguration),
      Number<Filter>(&Filter::SetBendWidth, { 0.0, 0.5 }),
      Of<Filter>(3,
        [](Filter* f, int value)
        {
          f->SetTransitionWidth(0.3 * value / (value + 1.0));
          f->SetSourceTransitionWidth(value == 2 ? 0.1 : 0.0);
        }),
      Of<Filter>(3, [](Filter* f, int value) { f->SetSeamFairing(value); }),
      Enumeration<Filter>(2, &Filter::SetFairingMethod),
      Of<Filter>(3,
        [](Filter* f, int value)
        {
          f->RemoveAllHandleMotions();
          f->SetNumberOfMotionRows(0);
          if (value == 1)
          {
            vtkNew<vtkHandleMotion> motion;
            motion->SetTranslation(0.1, 0.0, 0.2);
            f->SetHandleMotion(1, motion);
          }
          else if (value == 2)
          {
            f->SetMotionRow(0, 2, 1, 1, 1, 20, 0, 0, 1, 0, 0, 0, 0, 0.1, 0);
          }
        }),
      Name<Filter>(&Filter::SetFeatureArrayName, { "Feature", "Handle" }),
      Name<Filter>(&Filter::SetHandleArrayName, { "Handle", "None" }),
      Name<Filter>(&Filter::SetBoundaryKeyArrayName, { "BoundaryKey", "Handle" }) });
}

inline Subject Coating()
{
  using Filter = vtkCoatingTransfer;
  return Make<Filter>("CoatingTransfer",
    { InputChoice(0), InputChoice(1),
      Of<Filter>(3, [](Filter* f, int value) { f->SetCorrespondence(value == 1 ? 2 : value); }),
      Enumeration<Filter>(3, &Filter::SetAlignment),
      Enumeration<Filter>(2, &Filter::SetRepresentation),
      Number<Filter>(&Filter::SetSmoothing, { 5.0, 1.0 }),
      Number<Filter>(&Filter::SetStrength, { 1.0, -0.5 }), Switch<Filter>(&Filter::SetScaleDetails),
      Name<Filter>(&Filter::SetRegionArrayName, { "", "Handle" }),
      Number<Filter>(&Filter::SetFadeWidth, { 0.0, 0.5 }),
      Switch<Filter>(&Filter::SetTransferArrays) });
}

/// Some points of a surface as landmarks. They have no names to match.
inline Choice LandmarksOn(int port)
{
  return { 2 * NumberOfSurfaces,
    [port](vtkAlgorithm* filter, int value, Surfaces& surfaces)
    {
      const auto some = Upstream<vtkMaskPoints>();
      some->SetInputData(surfaces[value % NumberOfSurfaces]);
      some->SetOnRatio(value < NumberOfSurfaces ? 9 : 13);
      some->SetMaximumNumberOfPoints(5);
      filter->SetInputConnection(port, some->GetOutputPort());
    } };
}

inline Subject Landmarks()
{
  using Filter = vtkLandmarkHandles;
  return Make<Filter>("LandmarkHandles",
    { InputChoice(), LandmarksOn(1), LandmarksOn(2),
      Number<Filter>(&Filter::SetTolerance, { 0.0, 1.0, 2.0 }),
      Number<Filter>(&Filter::SetAccuracy, { 0.0, 0.01 }),
      Name<Filter>(&Filter::SetAccuracyArrayName, { "", "Weight" }),
      Name<Filter>(&Filter::SetHandleArrayName, { "Handle", "Other" }) });
}

inline std::vector<Subject> ToolSubjects()
{
  return { Comparison<vtkCurvatureError>(
             "CurvatureError", Switch<vtkCurvatureError>(&vtkCurvatureError::SetComputeDirections)),
    Make<vtkVolumeChange>("VolumeChange",
      { InputChoice(0), InputChoice(1),
        Switch<vtkVolumeChange>(&vtkVolumeChange::SetComputeLocalVolume),
        Switch<vtkVolumeChange>(&vtkVolumeChange::SetComputeStretches),
        Enumeration<vtkVolumeChange>(5, &vtkVolumeChange::SetStrainMeasure),
        Switch<vtkVolumeChange>(&vtkVolumeChange::SetComputeRates) }),
    Make<vtkDiscreteForms>("DiscreteForms", { InputChoice() }), Reconstruction(), Mark(), Morph(),
    Prepare(), Restore(), Coordinates(), ReconstructionFromCoordinates(), Spectrum(),
    Approximation(), Quantization(), Make<vtkBoundaryLoops>("BoundaryLoops", { Half(0) }), Merge(),
    Watermark(), Coating(), Landmarks(),
    Make<vtkCarryAlong>("CarryAlong",
      { InputChoice(0), InputChoice(1), InputChoice(2),
        Switch<vtkCarryAlong>(&vtkCarryAlong::SetTurnVectors) }) };
}
}
