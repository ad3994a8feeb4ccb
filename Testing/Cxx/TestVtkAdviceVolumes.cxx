// SPDX-License-Identifier: BSD-3-Clause
// What is advised where volumes are preserved or measured.
#include "Advice.h"
#include "PrepareShapes.h"

#include "vtkShapePreservingDeformation.h"
#include "vtkSurfaceMorph.h"
#include "vtkVolumeChange.h"

#include "vtkAppendPolyData.h"
#include "vtkPolyDataConnectivityFilter.h"
#include "vtkPolyDataNormals.h"
#include "vtkTable.h"
#include "vtkVariant.h"

using vtktest::Advice;
using vtktest::Advised;
using vtktest::MakePolyData;
using vtktest::SignedVolume;
using vtktest::Turn;

namespace
{
const shapes::Shape BarShape = shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 });

/// Bends and asks for the volume, by frames that scale and by a displacement.
struct Keeper : Advised<vtkShapePreservingDeformation>
{
  explicit Keeper(vtkPolyData* surface)
  {
    (*this)->SetHandleMotion(2, Turn(60.0));
    (*this)->CloseVolumeOn();
    this->Take(surface);
  }
  void Take(vtkPolyData* surface)
  {
    vtktest::MarkEnds(surface, 0.6, 3.4);
    (*this)->SetInputData(surface);
    this->Before = SignedVolume(surface);
  }
  void Keeps() { EXPECT_NEAR(SignedVolume(this->Works()), this->Before, 1e-9); }

  double Before = 0.0;
};

/// Flips the triangles of a surface as the message says.
vtkSmartPointer<vtkPolyData> Flipped(vtkPolyData* surface)
{
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(surface);
  normals->FlipNormalsOn();
  normals->SplittingOff();
  normals->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  normals->Update();
  return vtktest::CopyOf(normals->GetOutput());
}

vtkSmartPointer<vtkPolyData> Component(vtkPolyData* surface, int id)
{
  vtkNew<vtkPolyDataConnectivityFilter> extract;
  extract->SetInputData(surface);
  extract->SetExtractionModeToSpecifiedRegions();
  extract->AddSpecifiedRegion(id);
  extract->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  extract->Update();
  return vtktest::CopyOf(extract->GetOutput());
}

void CloseHoles(vtkPrepareSurface* prepare)
{
  prepare->SetMaximumHoleEdges(500);
}

/// What the morph has at the middle of two key frames.
struct Between : Advised<vtkSurfaceMorph>
{
  Between(vtkPolyData* first, vtkPolyData* last)
  {
    (*this)->AddInputData(first);
    (*this)->AddInputData(last);
    (*this)->SetParameter(0.5);
    (*this)->CloseVolumeOn();
  }
};
}

TEST(AdviceOnVolumes, StretchedTooMuchThereAreNoDigits)
{
  const auto bar = vtktest::MarkedBar();
  Advised<vtkShapePreservingDeformation> deform;
  deform->SetInputData(bar);
  deform->GenerateVolumeArraysOn();
  vtkNew<vtkHandleMotion> far;
  far->SetTranslation(1e8, -2e8, 3e8);
  deform->SetHandleMotion(2, far);
  const std::vector<std::string> parts = { "no digits for LocalVolume",
    Advice("Use smaller motions, or switch GenerateVolumeArrays off.") };
  deform.Warns(parts);
  deform->GenerateVolumeArraysOff();
  const auto stretched = deform.Works();
  deform->GenerateVolumeArraysOn();
  far->SetTranslation(10.0, -20.0, 30.0);
  const auto nearer = deform.Works();

  Advised<vtkVolumeChange> change;
  change->SetInputData(0, stretched);
  change->SetInputData(1, bar);
  change->ComputeLocalVolumeOn();
  change.Warns({ "no digits for LocalVolume",
    Advice("Compare surfaces that are stretched less, or switch ComputeLocalVolume off.") });
  change->ComputeLocalVolumeOff();
  change.Works();
  change->ComputeLocalVolumeOn();
  change->SetInputData(0, nearer);
  change.Works();
}

TEST(AdviceOnVolumes, AnOpenSurfaceIsClosedByPrepareSurface)
{
  const auto tube = MakePolyData(shapes::OpenCylinder(12, 12, 0.5, 4.0));
  Keeper keeper(tube);
  keeper.Warns({ "No volume is preserved in 1 open component (id 0)",
    Advice("close the surface (Prepare Surface, Maximum Hole Edges).") });
  keeper.Take(vtktest::Prepared(tube, CloseHoles));
  EXPECT_NEAR(keeper.Before, 4.0 * 0.25 * 6.0 * std::sin(shapes::Pi / 6.0), 1e-12);
  keeper.Keeps();
}

TEST(AdviceOnVolumes, WhatIsInsideOutIsFlipped)
{
  const auto inverted = MakePolyData(shapes::Inverted(BarShape));
  Keeper keeper(inverted);
  keeper.Warns({ "No volume is preserved in 1 component (id 0) that are oriented inside out",
    Advice("flip the triangles (Surface Normals with Flip Normals on and Splitting off).") });
  keeper.Take(Flipped(inverted));
  EXPECT_NEAR(keeper.Before, 4.0, 1e-12);
  keeper.Keeps();
}

TEST(AdviceOnVolumes, OfSeveralComponentsThoseThatAreNamedAreFlipped)
{
  const auto both = MakePolyData(
    shapes::Union(BarShape, shapes::Inverted(shapes::Moved(BarShape, { 3.0, 0.0, 0.0 }))));
  Keeper keeper(both);
  const std::string message = keeper.Warns({ "1 component (id 1) that are oriented inside out",
    Advice("flip the triangles of these components alone (Surface Normals with Flip Normals on "
           "and Splitting off).") });
  const std::vector<vtkIdType> ids = vtktest::IdsAfter(message, "1 component (id ");
  ASSERT_EQ(ids.size(), 1u);
  vtkNew<vtkAppendPolyData> append;
  for (int component = 0; component < 2; ++component)
  {
    const auto part = Component(both, component);
    append->AddInputData(component == ids[0] ? Flipped(part) : part);
  }
  append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  append->Update();
  keeper.Take(append->GetOutput());
  EXPECT_NEAR(keeper.Before, 8.0, 1e-12);
  keeper.Keeps();
}

TEST(AdviceOnVolumes, TheWallOfACavityAlternates)
{
  shapes::Shape cavity = shapes::Bar(2, 2, 8, { 0.5, 0.5, 2.0 });
  cavity.Positions.col(2).array() += 1.0;
  const auto hollow = MakePolyData(shapes::Union(BarShape, cavity));
  Advised<vtkVolumeChange> volume;
  const auto cell = [&](vtkIdType row, const char* column)
  { return volume->GetChangeTable()->GetValueByName(row, column); };
  const auto measure = [&](vtkPolyData* surface)
  {
    volume->SetInputData(surface);
    volume->SetReferenceData(surface);
    volume.Works();
    return cell(0, "Current").ToDouble();
  };
  EXPECT_NEAR(measure(hollow), 4.5, 1e-12);
  const vtkIdType last = volume->GetChangeTable()->GetNumberOfRows() - 1;
  EXPECT_EQ(cell(last, "Quantity").ToString(), "Volume of component 1");
  const std::string advice =
    Advice("A cavity's wall is oriented the other way (Prepare Surface, Alternate Nested)");
  EXPECT_NE(cell(last, "Note").ToString().find("inside component 0"), std::string::npos);
  EXPECT_NE(cell(last, "Note").ToString().find(advice), std::string::npos);
  const auto prepared =
    vtktest::Prepared(hollow, [](vtkPrepareSurface* prepare) { prepare->AlternateNestedOn(); });
  EXPECT_NEAR(measure(prepared), 3.5, 1e-12);
  EXPECT_EQ(cell(last, "Note").ToString().find(advice), std::string::npos);
}

TEST(AdviceOnVolumes, HolesAreFilledBeforeTheSurfaceIsDeformed)
{
  const auto deformed = [](vtkPolyData* surface)
  {
    vtktest::MarkEnds(surface, 0.6, 3.4);
    Advised<vtkShapePreservingDeformation> deform;
    deform->SetInputData(surface);
    deform->SetHandleMotion(2, Turn(90.0));
    deform->SetVolumeCorrectionToNone();
    return deform.Works();
  };
  const auto tube = MakePolyData(shapes::OpenCylinder(12, 12, 0.5, 4.0));
  Between open(tube, deformed(tube));
  open.Warns({ "The volume of 1 open component (id 0) is not adjusted",
    Advice("fill the holes before the surface is deformed to the key frames (Prepare Surface, "
           "Maximum Hole Edges).") });
  const auto closed = vtktest::Prepared(tube, CloseHoles);
  const auto bent = deformed(closed);
  Between between(closed, bent);
  EXPECT_NEAR(
    SignedVolume(between.Works()), 0.5 * (SignedVolume(closed) + SignedVolume(bent)), 1e-9);
}

TEST(AdviceOnVolumes, AKeyFrameThatIsTurnedInsideOutIsNamedWithoutAdvice)
{
  const auto bar = MakePolyData(BarShape);
  const auto mirrored = MakePolyData(
    { BarShape.Positions * Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal(), BarShape.Faces });
  Between between(bar, mirrored);
  between->SetMethodToLinear();
  between.Warns({ "The volume of 1 component (id 0) is not adjusted",
    "encloses nothing or is turned inside out" });
}
