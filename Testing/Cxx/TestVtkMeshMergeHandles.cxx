// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshMerge.h"

#include "Advice.h"
#include "MergeShapes.h"

#include "vtkBoundaryLoops.h"

namespace
{
using vtktest::Advice;
using vtktest::ExpectMessage;
using vtktest::ExpectQuiet;
using vtktest::MakePolyData;
using vtktest::PointsOf;

constexpr int Around = 24;

/// A tube with waves from z = `from` to `from` + 3, a key on the loop that is sewn.
vtkSmartPointer<vtkPolyData> Tube(double from)
{
  shapes::Shape tube = shapes::OpenCylinder(Around, 20, 1.0, 3.0);
  for (int v = 0; v < tube.NumberOfVertices(); ++v)
  {
    tube.Positions.row(v).head<2>() *= 1.0 + 0.05 * std::sin(4.0 * tube.Positions(v, 2));
  }
  tube.Positions.col(2).array() += from;
  auto surface = MakePolyData(tube);
  vtktest::AddArray(surface, "BoundaryKey", 1,
    [&](vtkIdType v, double* key)
    { *key = v == (from > 0.0 ? 0 : surface->GetNumberOfPoints() - Around); });
  return surface;
}

class MeshMergeHandles : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Target = Tube(0.0);
    this->Source = Tube(3.5);
    this->Filter->SetInputData(this->Target);
    this->Filter->SetSourceData(this->Source);
    this->Log = vtktest::Observe(this->Filter);
  }

  /// The points where the source's came, as they are in the output.
  std::map<vtkIdType, Eigen::RowVector3d> SourcePoints()
  {
    this->Log->Clear();
    this->Filter->Update();
    ExpectQuiet(*this->Log);
    vtkPolyData* output = this->Filter->GetOutput();
    const cartan::Points points = PointsOf(output);
    std::map<vtkIdType, Eigen::RowVector3d> found;
    for (vtkIdType v = 0; v < output->GetNumberOfPoints(); ++v)
    {
      if (output->GetPointData()->GetArray("MergeOrigin")->GetTuple1(v) == 1.0)
      {
        found[static_cast<vtkIdType>(
          output->GetPointData()->GetArray("OriginalPointIds")->GetTuple1(v))] = points.row(v);
      }
    }
    return found;
  }

  void ExpectError(const std::vector<std::string>& parts)
  {
    this->Log->Clear();
    this->Filter->Update();
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
    ExpectMessage(this->Log->Errors, parts);
  }

  void MarkEnd(const char* name, double from, double to)
  {
    vtktest::AddArray(this->Source, name, 1,
      [&](vtkIdType v, double* mark)
      { *mark = this->Source->GetPoint(v)[2] >= from && this->Source->GetPoint(v)[2] <= to; });
  }

  vtkSmartPointer<vtkPolyData> Target;
  vtkSmartPointer<vtkPolyData> Source;
  vtkNew<vtkMeshMerge> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST_F(MeshMergeHandles, DragTheSourceWhileItStaysSewn)
{
  this->MarkEnd("Handle", 6.0, 7.0);
  this->Filter->SetConfigurationToDependent();
  vtkNew<vtkHandleMotion> motion;
  motion->SetTranslation(0.4, 0.1, -0.6);
  this->Filter->SetHandleMotion(1, motion);
  this->SourcePoints();
  const int factorizations = this->Filter->GetNumberOfFactorizations();
  motion->SetAxis(0.0, 1.0, 0.0);
  motion->SetCenter(0.0, 0.0, 6.5);
  motion->SetAngle(20.0);
  const auto points = this->SourcePoints();
  EXPECT_EQ(this->Filter->GetNumberOfFactorizations(), factorizations);
  int count = 0;
  for (const auto& [id, point] : points)
  {
    if (this->Source->GetPointData()->GetArray("Handle")->GetTuple1(id) == 1.0)
    {
      double rest[3];
      this->Source->GetPoint(id, rest);
      EXPECT_LT((point.transpose() - vtktest::MovedBy(motion, rest)).norm(), 1e-12);
      ++count;
    }
  }
  EXPECT_GT(count, 2 * Around);
  vtkNew<vtkBoundaryLoops> boundary;
  boundary->SetInputData(this->Filter->GetOutput());
  boundary->Update();
  EXPECT_EQ(boundary->GetNumberOfLoops(), 2);

  // A row of the table means the same.
  this->Filter->RemoveAllHandleMotions();
  this->Filter->SetMotionRow(0, 1, 1, 1, 1, 20, 0, 1, 0, 0, 0, 6.5, 0.4, 0.1, -0.6);
  for (const auto& [id, point] : this->SourcePoints())
  {
    EXPECT_LT((point - points.at(id)).norm(), 1e-12);
  }
  this->Filter->SetNumberOfMotionRows(0);

  // One that moves nothing pins.
  motion->SetTranslation(0.0, 0.0, 0.0);
  motion->SetAngle(0.0);
  this->Filter->SetHandleMotion(1, motion);
  const auto pinned = this->SourcePoints();
  this->Filter->RemoveAllHandleMotions();
  for (const auto& [id, point] : this->SourcePoints())
  {
    EXPECT_LT((point - pinned.at(id)).norm(), 1e-9);
  }
}

TEST_F(MeshMergeHandles, MotionsNeedAPlaceThatCounts)
{
  this->MarkEnd("Handle", 6.0, 7.0);
  vtkNew<vtkHandleMotion> motion;
  motion->SetTranslation(0.0, 0.0, 0.1);
  this->Filter->SetHandleMotion(1, motion);
  this->ExpectError(
    { "the source's place does not count", Advice("choose DEPENDENT, or remove the motions.") });
  this->Filter->SetConfigurationToDependent();
  EXPECT_FALSE(this->SourcePoints().empty());
  this->Filter->SetConfigurationToIndependent();
  this->Filter->RemoveAllHandleMotions();
  EXPECT_FALSE(this->SourcePoints().empty());
  this->Filter->SetHandleMotion(2, motion);
  this->Filter->SetConfigurationToDependent();
  this->ExpectError({ "Handle 2 has a motion" });
}

TEST_F(MeshMergeHandles, FeaturesMoveAsOneSimilarity)
{
  // The target's loop is wider than the source's, so that the source is stretched.
  for (vtkIdType v = 0; v < this->Target->GetNumberOfPoints(); ++v)
  {
    double p[3];
    this->Target->GetPoint(v, p);
    this->Target->GetPoints()->SetPoint(v, 1.3 * p[0], 0.9 * p[1], p[2]);
  }
  const auto spread = [&](const std::map<vtkIdType, Eigen::RowVector3d>& points)
  {
    // Ratios of distances before and after are one number.
    double least = 1e300;
    double most = 0.0;
    vtkIdType first = -1;
    for (const auto& [id, point] : points)
    {
      const double z = this->Source->GetPoint(id)[2];
      if (z < 4.5 || z > 5.0)
      {
        continue;
      }
      first = first < 0 ? id : first;
      if (id != first)
      {
        const double rest = (Eigen::Vector3d(this->Source->GetPoint(id)) -
          Eigen::Vector3d(this->Source->GetPoint(first)))
                              .norm();
        const double ratio = (point - points.at(first)).norm() / rest;
        least = std::min(least, ratio);
        most = std::max(most, ratio);
      }
    }
    return most / least - 1.0;
  };
  for (const bool isDependent : { false, true })
  {
    this->Filter->SetConfiguration(isDependent);
    this->MarkEnd("Handle", 6.3, 7.0);
    this->Source->GetPointData()->RemoveArray("Feature");
    EXPECT_GT(spread(this->SourcePoints()), 0.01);
    this->MarkEnd("Feature", 4.5, 5.0);
    EXPECT_LT(spread(this->SourcePoints()), 1e-10);
  }
  this->MarkEnd("Feature", 4.5, 6.5);
  this->ExpectError({ "of the source are held and in a feature",
    Advice("which finds its own place: unmark them as one of both.") });
  this->MarkEnd("Feature", 4.5, 6.2);
  EXPECT_FALSE(this->SourcePoints().empty());
}

TEST_F(MeshMergeHandles, FeaturesNeedThreePoints)
{
  const auto mark = [&](int count)
  {
    vtktest::AddArray(this->Source, "Feature", 1,
      [=](vtkIdType v, double* id) { *id = v >= 5 * Around && v < 5 * Around + count ? 4 : 0; });
  };
  mark(2);
  this->ExpectError({ "feature 4", Advice("so nothing says how it turns: mark more points.") });
  mark(5);
  EXPECT_FALSE(this->SourcePoints().empty());
}
