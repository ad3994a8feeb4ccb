// SPDX-License-Identifier: BSD-3-Clause
// What the filters advise where surfaces are prepared, restored, compared, and
// rebuilt from their forms.
#include "Advice.h"
#include "PrepareShapes.h"
#include "TestSurfaces.h"

#include "vtkCurvatureError.h"
#include "vtkDiscreteForms.h"
#include "vtkFrameReconstruction.h"
#include "vtkRestoreSurface.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkVolumeChange.h"

#include "vtkTable.h"
#include "vtkTriangleFilter.h"
#include "vtkVariant.h"

#include <set>

using vtktest::Advice;
using vtktest::Advised;
using vtktest::MakePolyData;

namespace
{
vtkSmartPointer<vtkTable> FormsOf(vtkPolyData* surface)
{
  Advised<vtkDiscreteForms> forms;
  forms->SetInputData(surface);
  forms.Works();
  auto table = vtkSmartPointer<vtkTable>::New();
  table->DeepCopy(forms->GetFormsTable());
  return table;
}

/// How much the surface differs from the original, up to a rigid motion: the
/// largest change of the distance between two points.
double Difference(vtkPolyData* surface, vtkPolyData* original)
{
  const cartan::Points a = vtktest::PointsOf(surface);
  const cartan::Points b = vtktest::PointsOf(original);
  EXPECT_EQ(a.rows(), b.rows());
  double largest = 0.0;
  for (Eigen::Index v = 0; v < a.rows() && a.rows() == b.rows(); ++v)
  {
    for (Eigen::Index w = 0; w < v; ++w)
    {
      largest =
        std::max(largest, std::abs((a.row(v) - a.row(w)).norm() - (b.row(v) - b.row(w)).norm()));
    }
  }
  return largest;
}
}

TEST(AdviceOnPreparation, ASmallerToleranceLeavesTriangles)
{
  const auto sphere = MakePolyData(shapes::Soup(shapes::Icosphere(1)));
  Advised<vtkPrepareSurface> prepare;
  prepare->SetInputData(sphere);
  prepare->SetTolerance(10.0);
  prepare.Refuses({ "No triangle is left", Advice("Choose a smaller tolerance.") });
  prepare->SetTolerance(1e-3);
  EXPECT_EQ(prepare.Works()->GetNumberOfPoints(), 42);
}

TEST(AdviceOnPreparation, TheFilterThatCannotPrepareItsInputTakesAPreparedOne)
{
  const auto sphere = MakePolyData(shapes::Soup(shapes::Icosphere(1)));
  const std::string advice =
    Advice("turn it off, and connect the output of vtkPrepareSurface (Prepare Surface).");
  Advised<vtkDiscreteForms> forms;
  forms->SetInputData(sphere);
  forms->PrepareInputOn();
  forms.Refuses({ "PrepareInput is not possible in vtkDiscreteForms", advice });
  const auto prepared = vtktest::Prepared(sphere);
  forms->PrepareInputOff();
  forms->SetInputData(prepared);
  EXPECT_EQ(forms.Works()->GetNumberOfPoints(), 42);

  Advised<vtkFrameReconstruction> reconstruct;
  reconstruct->SetInputData(sphere);
  reconstruct->SetFormsData(forms->GetFormsTable());
  reconstruct->PrepareInputOn();
  reconstruct.Refuses({ "PrepareInput is not possible in vtkFrameReconstruction", advice });
  reconstruct->PrepareInputOff();
  reconstruct->SetInputData(prepared);
  EXPECT_LT(Difference(reconstruct.Works(), prepared), 1e-9);
}

TEST(AdviceOnPreparation, RestoreSurfaceTakesWhatPrepareSurfaceHadAndGave)
{
  const auto soup = MakePolyData(shapes::Soup(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 })));
  vtktest::MarkEnds(soup, 0.6, 3.4);
  const auto prepared = vtktest::Prepared(soup);
  Advised<vtkRotationInvariantDeformation> deform;
  deform->SetInputData(prepared);
  deform->SetHandleMotion(2, vtktest::Turn(30.0));
  const auto bent = deform.Works(); // passes the arrays of its input

  Advised<vtkRestoreSurface> restore;
  restore->SetOriginalData(soup);
  restore->SetInputData(soup);
  restore.Refuses({ "no array OriginalPointIds",
    Advice("connect the output of Prepare Surface, or of a filter after it that passes its "
           "arrays.") });
  restore->SetInputData(prepared);
  EXPECT_EQ(vtktest::PointsOf(restore.Works()), vtktest::PointsOf(soup));
  restore->SetInputData(bent);
  vtktest::ExpectEnds(restore.Works(), soup, vtktest::Turn(30.0));

  const auto other = MakePolyData(shapes::Icosphere(1));
  restore->SetOriginalData(other);
  restore.Refuses({ "does not fit the original surface (", " values for ", " out of range",
    Advice("connect the surface that Prepare Surface had as its input.") });
  restore->SetOriginalData(soup);
  vtktest::ExpectEnds(restore.Works(), soup, vtktest::Turn(30.0));
}

TEST(AdviceOnPreparation, PartsThatWereCutStayApartOnThePreparedSurface)
{
  // Two boxes that share a corner, of which one is shifted.
  shapes::Shape boxes = shapes::Union(shapes::Box(), shapes::Box({ 1, 1, 1 }));
  int shared = 0;
  for (int v = 0; v < 8; ++v)
  {
    for (int w = 8; w < 16; ++w)
    {
      if (boxes.Positions.row(v) == boxes.Positions.row(w))
      {
        boxes.Faces = (boxes.Faces.array() == w).select(v, boxes.Faces);
        shared = v;
      }
    }
  }
  const auto original = MakePolyData(boxes);
  const auto shifted = vtktest::Prepared(original);
  const Eigen::RowVector3d by(2.0, 0.0, 0.0);
  std::set<vtkIdType> ofSecond;
  for (vtkIdType cell = 12; cell < 24; ++cell)
  {
    vtkNew<vtkIdList> ids;
    shifted->GetCellPoints(cell, ids);
    ofSecond.insert(ids->begin(), ids->end());
  }
  for (const vtkIdType v : ofSecond)
  {
    const Eigen::RowVector3d x = Eigen::RowVector3d(shifted->GetPoint(v)) + by;
    shifted->GetPoints()->SetPoint(v, x.data());
  }
  Advised<vtkRestoreSurface> restore;
  restore->SetOriginalData(original);
  restore->SetInputData(shifted);
  restore.Warns({ "1 point (id " + std::to_string(shared) + ")", "placed in their middle",
    Advice("To keep the parts apart, go on with the prepared surface.") });
  Advised<vtkVolumeChange> volume;
  volume->SetInputData(shifted);
  volume->SetReferenceData(vtktest::Prepared(original));
  volume.Works();
  EXPECT_NEAR(volume->GetRelativeVolumeChange(), 0.0, 1e-12);
  EXPECT_NEAR(volume->GetEdgeLengthRMS(), 0.0, 1e-12); // neither is torn
}

TEST(AdviceOnPreparation, MeasuresCompareASurfaceBeforeAndAfterItWasDeformed)
{
  const auto bar = vtktest::MarkedBar();
  Advised<vtkRotationInvariantDeformation> deform;
  deform->SetInputData(bar);
  deform->SetHandleMotion(2, vtktest::Turn(0.0));
  const auto after = deform.Works();
  const std::string advice =
    Advice("Give both the same points and cells in the same order, such as "
           "a surface before and after it was deformed.");
  Advised<vtkVolumeChange> volume;
  volume->SetInputData(after);
  volume->SetReferenceData(MakePolyData(shapes::Icosphere(1)));
  volume.Refuses({ "The input has 74 points, the reference 42.", advice });
  volume->SetReferenceData(bar);
  volume.Works();
  EXPECT_EQ(volume->GetRelativeVolumeChange(), 0.0);

  shapes::Shape reordered = shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 });
  reordered.Faces.row(5).swap(reordered.Faces.row(9));
  Advised<vtkCurvatureError> curvature;
  curvature->SetInputData(after);
  curvature->SetReferenceData(MakePolyData(reordered));
  curvature.Refuses({ "2 cells (ids 5, 9)", advice });
}

TEST(AdviceOnPreparation, FormsAreThoseOfTriangles)
{
  const surfaces::Surface quads = surfaces::QuadGrid(3, 0.4);
  Advised<vtkFrameReconstruction> reconstruct;
  reconstruct->SetInputData(quads);
  reconstruct->SetFormsData(FormsOf(quads));
  reconstruct.Refuses({ "9 cells (ids 0, 1, 2, 3, 4, ...)", "not triangles",
    Advice("triangulate the surface (Triangulate) before its forms are computed.") });
  vtkNew<vtkTriangleFilter> triangulate;
  triangulate->SetInputData(quads);
  triangulate->Update();
  reconstruct->SetInputData(triangulate->GetOutput());
  reconstruct->SetFormsData(FormsOf(triangulate->GetOutput()));
  EXPECT_LT(Difference(reconstruct.Works(), quads), 1e-9);
}

TEST(AdviceOnPreparation, TheTableOfDiscreteFormsIsGivenAsItCame)
{
  const auto sphere = MakePolyData(shapes::Noisy(shapes::Icosphere(1), 0.05));
  const auto table = FormsOf(sphere);
  Advised<vtkFrameReconstruction> reconstruct;
  reconstruct->SetInputData(sphere);
  vtkNew<vtkTable> none;
  reconstruct->SetFormsData(none);
  reconstruct.Refuses({ "no numeric column \"Vertex\"",
    Advice("of one component: give the table of vtkDiscreteForms (Discrete Forms).") });
  auto shorter = vtkSmartPointer<vtkTable>::New();
  shorter->DeepCopy(table);
  vtkDataArray::SafeDownCast(shorter->GetColumnByName("Height"))->SetNumberOfTuples(7);
  reconstruct->SetFormsData(shorter);
  reconstruct.Refuses({ "\"Height\" of the forms table has 7 values for 240 rows",
    Advice("rows: give the table of vtkDiscreteForms (Discrete Forms) as it came.") });
  reconstruct->SetFormsData(FormsOf(MakePolyData(shapes::Plane(2))));
  reconstruct.Refuses({ "has 32 rows, but the connectivity has 240", "different surfaces" });
  reconstruct->SetFormsData(table);
  EXPECT_LT(Difference(reconstruct.Works(), sphere), 1e-9);
}

TEST(AdviceOnPreparation, SeedsAreOnTheSurface)
{
  shapes::Shape shape = shapes::Noisy(shapes::Icosphere(1), 0.05);
  shape.Positions.conservativeResize(43, 3);
  shape.Positions.row(42).setZero();
  const auto sphere = MakePolyData(shape);
  Advised<vtkFrameReconstruction> reconstruct;
  reconstruct->SetInputData(sphere);
  reconstruct->SetFormsData(FormsOf(sphere));
  reconstruct->SetSeedPoint(42);
  reconstruct->SetSeedPosition(3.0, 2.0, 1.0);
  reconstruct.Refuses(
    { "seed point 42", Advice("choose a point of the surface, or -1 for its first one.") });
  for (const auto& [seed, point] : { std::pair(17, 17), std::pair(-1, 0) })
  {
    reconstruct->SetSeedPoint(seed);
    const auto result = reconstruct.Works();
    EXPECT_EQ(Eigen::Vector3d(result->GetPoint(point)), Eigen::Vector3d(3.0, 2.0, 1.0));
  }
}

TEST(AdviceOnPreparation, AConstraintInEachComponentKeepsThemApart)
{
  const shapes::Shape part = shapes::Noisy(shapes::Icosphere(1), 0.05);
  const auto both = MakePolyData(shapes::Union(part, shapes::Moved(part, { 5, 0, 0 })));
  Advised<vtkDiscreteForms> forms;
  forms->SetInputData(both);
  const auto framed = forms.Works(); // with the frames that constraints take
  Advised<vtkFrameReconstruction> reconstruct;
  reconstruct->SetInputData(framed);
  reconstruct->SetFormsData(forms->GetFormsTable());
  reconstruct.Warns(
    { "1 further component (id 1)", Advice("Hold a point of each with a constraint array.") });
  vtktest::AddArray(
    framed, "Held", 1, [](vtkIdType v, double* value) { *value = v == 0 || v == 42; });
  reconstruct->SetConstraintArrayName("Held");
  const cartan::Points result = vtktest::PointsOf(reconstruct.Works());
  EXPECT_LT((result - vtktest::PointsOf(both)).cwiseAbs().maxCoeff(), 1e-9);
}
