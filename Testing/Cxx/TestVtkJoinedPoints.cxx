// SPDX-License-Identifier: BSD-3-Clause
#include "Advice.h"
#include "PrepareShapes.h"

#include "vtkAsRigidAsPossibleDeformation.h"
#include "vtkDiscreteForms.h"
#include "vtkFrameReconstruction.h"
#include "vtkLaplacianDeformation.h"
#include "vtkMarkHandle.h"
#include "vtkMultiresolutionDeformation.h"
#include "vtkPoissonDeformation.h"
#include "vtkRestoreSurface.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkSimilarityDeformation.h"
#include "vtkSurfaceMorph.h"

#include "vtkCellArray.h"
#include "vtkIdTypeArray.h"
#include "vtkTable.h"

/// Copies that Prepare Surface makes of a point are held together when the surface is
/// deformed.
namespace
{
using vtktest::Advice;
using vtktest::Advised;
using vtktest::PointsOf;

/// A bar along z from -2 to 2, and a block that hangs on one of its points or, upright,
/// on edges: triangles over shared points, no manifold. The block's points come last.
vtkSmartPointer<vtkPolyData> BarWithBlock(bool isUpright)
{
  const shapes::Shape bar =
    shapes::Moved(shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 }, true), { 0.0, 0.0, -2.0 });
  shapes::Shape block = shapes::Bar(2, 2, 3, { 0.5, 0.4, 1.0 }, true);
  const Eigen::RowVector3d at(0.5, 1.0 / 6.0, 0.0);
  block.Positions.rowwise() += at - block.Positions.row(0);
  block.Positions.col(0) += 0.3 * (block.Positions.col(1).array() - at[1]).matrix();
  block.Positions.col(0) += (isUpright ? 0.0 : 0.4) * block.Positions.col(2);
  shapes::Shape both = shapes::Union(bar, block);
  for (int corner = 0; corner < both.Faces.size(); ++corner)
  {
    int& v = both.Faces.data()[corner];
    for (int w = 0; w < bar.NumberOfVertices(); ++w)
    {
      if ((both.Positions.row(v) - both.Positions.row(w)).norm() < 1e-9)
      {
        v = w;
      }
    }
  }
  const auto surface = vtktest::MakePolyData(both);
  vtktest::AddHandles(
    surface, [](const Eigen::Vector3d& x) { return x[2] < -1.5 ? 1
                                              : x[2] > 1.5     ? 2
                                                               : 0; });
  return surface;
}

/// The point of the bar that the block hangs on.
vtkIdType JointOf(vtkPolyData* surface)
{
  return surface->FindPoint(0.5, 1.0 / 6.0, 0.0);
}

void BendEnd(vtkSurfaceDeformation* deform)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(0.2, 1.0, 0.0);
  motion->SetAngle(30.0);
  motion->SetTranslation(0.3, 0.1, -0.2);
  deform->SetHandleMotion(2, motion);
}

std::vector<vtkSmartPointer<vtkSurfaceDeformation>> Methods()
{
  return { vtkSmartPointer<vtkRotationInvariantDeformation>::New(),
    vtkSmartPointer<vtkShapePreservingDeformation>::New(),
    vtkSmartPointer<vtkSimilarityDeformation>::New(),
    vtkSmartPointer<vtkLaplacianDeformation>::New(), vtkSmartPointer<vtkPoissonDeformation>::New(),
    vtkSmartPointer<vtkMultiresolutionDeformation>::New(),
    vtkSmartPointer<vtkAsRigidAsPossibleDeformation>::New() };
}

/// The points that have copies, in increasing order.
std::vector<vtkIdType> CopiesIn(vtkPolyData* prepared)
{
  vtkDataArray* joined = prepared->GetPointData()->GetArray("JoinedPoints");
  std::vector<vtkIdType> copies;
  for (vtkIdType v = 0; v < prepared->GetNumberOfPoints(); ++v)
  {
    if (joined->GetTuple1(v) >= 0.0)
    {
      copies.push_back(v);
    }
  }
  return copies;
}

/// How far the farthest point of the block is from the joint, of what it was.
double Reach(vtkPolyData* result, vtkPolyData* rest, vtkIdType joint, vtkIdType far)
{
  const auto length = [&](vtkPolyData* surface)
  {
    return (Eigen::Vector3d(surface->GetPoint(far)) - Eigen::Vector3d(surface->GetPoint(joint)))
      .norm();
  };
  return length(result) / length(rest);
}

TEST(JoinedPoints, HoldLimbsOnPointsAndEdgesWithEveryMethod)
{
  for (const bool isUpright : { false, true })
  {
    const auto surface = BarWithBlock(isUpright);
    const vtkIdType joint = JointOf(surface);
    const vtkIdType far = surface->GetNumberOfPoints() - 1;
    for (const auto& deform : Methods())
    {
      SCOPED_TRACE(deform->GetClassName());
      const auto log = vtktest::Observe(deform);
      deform->SetInputData(surface);
      deform->PrepareInputOn();
      BendEnd(deform);
      deform->Update();
      EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
      if (vtkMultiresolutionDeformation::SafeDownCast(deform))
      {
        vtktest::ExpectMessage(log->Warnings, { "limbs without handles" });
      }
      else
      {
        EXPECT_TRUE(log->Warnings.empty()) << log->Warnings[0];
      }
      vtkPolyData* result = deform->GetOutput();
      ASSERT_EQ(result->GetNumberOfPoints(), surface->GetNumberOfPoints());
      EXPECT_FALSE(result->GetPointData()->HasArray("JoinedPoints"));
      EXPECT_GT(
        (Eigen::Vector3d(result->GetPoint(joint)) - Eigen::Vector3d(surface->GetPoint(joint)))
          .norm(),
        0.05);
      EXPECT_NEAR(Reach(result, surface, joint, far), 1.0, 0.1);
    }
  }
}

TEST(JoinedPoints, AreOneUnknownToTheBit)
{
  for (const bool isUpright : { false, true })
  {
    const auto surface = BarWithBlock(isUpright);
    const auto prepared = vtktest::Prepared(surface);
    auto* joined = vtkIdTypeArray::SafeDownCast(prepared->GetPointData()->GetArray("JoinedPoints"));
    auto* copyOf = vtkIdTypeArray::SafeDownCast(prepared->GetPointData()->GetArray("CopyOf"));
    ASSERT_TRUE(joined && copyOf);
    Advised<vtkShapePreservingDeformation> deform;
    deform->SetInputData(prepared);
    BendEnd(deform.Get());
    const auto result = deform.Works();
    int copies = 0;
    for (vtkIdType v = 0; v < prepared->GetNumberOfPoints(); ++v)
    {
      const vtkIdType first = copyOf->GetValue(v);
      EXPECT_TRUE(joined->GetValue(v) == -1 || joined->GetValue(v) == first);
      EXPECT_TRUE(first == v || joined->GetValue(v) == first);
      copies += first != v;
      EXPECT_EQ(Eigen::Vector3d(result->GetPoint(v)), Eigen::Vector3d(result->GetPoint(first)));
    }
    EXPECT_EQ(copies, isUpright ? 4 : 1);

    // Preparing again changes nothing, and what it gives bends alike.
    const auto again = vtktest::Prepared(prepared);
    EXPECT_TRUE(vtktest::SameArray(again->GetPointData()->GetArray("JoinedPoints"), joined));

    // Other values mean another surface, and without them the block stays.
    const vtkIdType far = prepared->GetNumberOfPoints() - 1;
    prepared->GetPointData()->RemoveArray("JoinedPoints");
    prepared->Modified();
    const auto apart = deform.Works();
    EXPECT_EQ(Eigen::Vector3d(apart->GetPoint(far)), Eigen::Vector3d(prepared->GetPoint(far)));
    EXPECT_NE(Eigen::Vector3d(result->GetPoint(far)), Eigen::Vector3d(prepared->GetPoint(far)));
    const auto off =
      vtktest::Prepared(surface, [](vtkPrepareSurface* prepare) { prepare->JoinCopiesOff(); });
    EXPECT_FALSE(off->GetPointData()->HasArray("JoinedPoints"));
  }
}

/// A seam of two rows of points is one row for a deformation.
TEST(JoinedPoints, CloseSeamsThatAreMarkedByHand)
{
  const shapes::Shape whole = shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }, true);
  const auto handle = [](const Eigen::Vector3d& x) { return x[2] < 0.3 ? 1 : x[2] > 3.7 ? 2 : 0; };
  const auto soup = vtktest::MakePolyData(shapes::Soup(whole));
  vtktest::AddHandles(soup, handle);
  vtktest::AddArray(soup, "JoinedPoints", 1,
    [&whole](vtkIdType corner, double* value) { *value = whole.Faces.data()[corner]; });
  const auto surface = vtktest::MakePolyData(whole);
  vtktest::AddHandles(surface, handle);
  vtkNew<vtkRotationInvariantDeformation> ofSoup;
  Advised<vtkRotationInvariantDeformation> ofWhole;
  ofSoup->SetInputData(soup);
  ofWhole->SetInputData(surface);
  BendEnd(ofSoup);
  BendEnd(ofWhole.Get());
  ofSoup->Update();
  const cartan::Points expected = PointsOf(ofWhole.Works());
  const cartan::Points found = PointsOf(ofSoup->GetOutput());
  ASSERT_EQ(found.rows(), whole.Faces.size());
  for (int corner = 0; corner < whole.Faces.size(); ++corner)
  {
    ASSERT_LT((found.row(corner) - expected.row(whole.Faces.data()[corner])).norm(), 1e-9);
  }
}

TEST(JoinedPoints, AdviceOnHandlesThatDisagree)
{
  const auto surface = BarWithBlock(false);
  const auto mark = [](vtkPolyData* prepared, bool isAlike)
  {
    vtkDataArray* handles = prepared->GetPointData()->GetArray("Handle");
    vtkDataArray* copyOf = prepared->GetPointData()->GetArray("CopyOf");
    for (vtkIdType v = 0; v < prepared->GetNumberOfPoints(); ++v)
    {
      const auto first = static_cast<vtkIdType>(copyOf->GetTuple1(v));
      if (first != v)
      {
        handles->SetTuple1(v, 2);
        handles->SetTuple1(first, isAlike ? 2 : 1);
      }
    }
    handles->Modified();
  };
  const std::string advice = Advice("mark all copies of a point (equal CopyOf) with one handle, or "
                                    "turn JoinCopies of Prepare Surface off.");
  const auto prepared = vtktest::Prepared(surface);
  mark(prepared, false);
  Advised<vtkRotationInvariantDeformation> deform;
  deform->SetInputData(prepared);
  BendEnd(deform.Get());
  deform.Refuses({ "Several handles have 2 points", advice });
  mark(prepared, true);
  deform.Works();
  const auto off =
    vtktest::Prepared(surface, [](vtkPrepareSurface* prepare) { prepare->JoinCopiesOff(); });
  mark(off, false);
  deform->SetInputData(off);
  deform.Works();
}

TEST(JoinedPoints, RegionsGrowFromCopyToCopy)
{
  const auto prepared = vtktest::Prepared(BarWithBlock(false));
  const auto copies = CopiesIn(prepared);
  ASSERT_EQ(copies.size(), 2u);
  const auto countMarked = [&](int rings, double distance)
  {
    vtkNew<vtkMarkHandle> mark;
    mark->SetInputData(prepared);
    mark->SetHandleArrayName("Region");
    mark->SetPointId(0, copies[0]);
    mark->SetRegionSourceToSelection();
    mark->SetGrowRings(rings);
    mark->SetGrowDistance(distance);
    mark->Update();
    int onBlock = 0;
    vtkDataArray* region = mark->GetOutput()->GetPointData()->GetArray("Region");
    for (vtkIdType v = 0; v < prepared->GetNumberOfPoints(); ++v)
    {
      onBlock += region->GetTuple1(v) != 0.0 && prepared->GetPoint(v)[0] > 0.5 + 1e-9;
    }
    return onBlock;
  };
  EXPECT_EQ(countMarked(0, 0.0), 0);
  EXPECT_GE(countMarked(1, 0.0), 3);
  EXPECT_GE(countMarked(0, 0.6), 3);
  EXPECT_GT(countMarked(100, 0.0), countMarked(1, 0.0));

  prepared->GetPointData()->RemoveArray("JoinedPoints");
  EXPECT_EQ(countMarked(100, 10.0), 0);
}

TEST(JoinedPoints, AdviceWhereMorphsPartCopies)
{
  const auto first = vtktest::Prepared(BarWithBlock(false));
  Advised<vtkRotationInvariantDeformation> deform;
  deform->SetInputData(first);
  BendEnd(deform.Get());
  const auto last = deform.Works();
  Advised<vtkSurfaceMorph> morph;
  morph->AddInputData(first);
  morph->AddInputData(last);
  morph->SetParameter(0.5);
  morph.Warns({ "1 point", "JoinedPoints",
    Advice("choose Method Linear, which keeps them together, or one of the deformations.") });
  morph->SetMethodToLinear();
  const auto result = morph.Works();
  const auto copies = CopiesIn(first);
  EXPECT_LT(
    (Eigen::Vector3d(result->GetPoint(copies[0])) - Eigen::Vector3d(result->GetPoint(copies[1])))
      .norm(),
    1e-12);
}

TEST(JoinedPoints, AdviceWhereReconstructionsPartCopies)
{
  const auto prepared = vtktest::Prepared(BarWithBlock(false));
  vtkNew<vtkDiscreteForms> forms;
  forms->SetInputData(prepared);
  forms->Update();
  // All lengths grow, so that points that are held elsewhere do not keep copies together.
  const auto table = forms->GetFormsTable();
  for (const char* name : { "Length", "Height" })
  {
    auto* column = vtkDataArray::SafeDownCast(table->GetColumnByName(name));
    for (vtkIdType row = 0; row < column->GetNumberOfTuples(); ++row)
    {
      column->SetTuple1(row, 1.3 * column->GetTuple1(row));
    }
  }
  const auto surface = vtktest::CopyOf(forms->GetOutput());
  const auto copies = CopiesIn(surface);
  const auto hold = [&](vtkIdType ofBar, vtkIdType ofBlock)
  {
    vtktest::AddArray(surface, "Held", 1,
      [=](vtkIdType v, double* value) { *value = v == ofBar || v == ofBlock ? 1.0 : 0.0; });
    surface->Modified();
  };
  Advised<vtkFrameReconstruction> reconstruction;
  reconstruction->SetInputData(0, surface);
  reconstruction->SetInputData(1, table);
  reconstruction->SetConstraintArrayName("Held");
  hold(0, surface->GetNumberOfPoints() - 1);
  reconstruction.Warns({ "1 point", "JoinedPoints",
    Advice("hold one copy of each in every part with a constraint array.") });
  hold(copies[0], copies[1]);
  reconstruction.Works();
}
}
