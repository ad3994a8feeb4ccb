// SPDX-License-Identifier: BSD-3-Clause
#include "AdviceWords.h"
#include "HandleShapes.h"
#include "RealMeshes.h"
#include "VtkTestHelpers.h"

#include "vtkHandleMotion.h"
#include "vtkLaplacianDeformation.h"
#include "vtkRotationInvariantDeformation.h"

#include <string>
#include <utility>

// Estimated rotations are found in rounds, which need not converge. Whoever is not
// warned must have what more rounds would give.

namespace
{
/// A real mesh whose upper end along its longest side turns about a short one.
struct BentMesh
{
  BentMesh(const std::string& name, double degrees)
  {
    const shapes::Shape shape = shapes::RealMesh(name);
    const Eigen::RowVector3d low = shape.Positions.colwise().minCoeff();
    const Eigen::RowVector3d extent = shape.Positions.colwise().maxCoeff() - low;
    this->Size = extent.norm();
    int axis = 0;
    extent.maxCoeff(&axis);
    this->Surface = vtktest::MakePolyData(shape);
    vtktest::AddHandles(this->Surface, shapes::EndsAlong(shape, axis, 0.15));
    Eigen::RowVector3d center = low + 0.5 * extent;
    center[axis] = low[axis] + 0.92 * extent[axis];
    const Eigen::Vector3d turnAxis = Eigen::Vector3d::Unit((axis + 1) % 3);
    this->Turn->SetAxis(turnAxis[0], turnAxis[1], turnAxis[2]);
    this->Turn->SetCenter(center[0], center[1], center[2]);
    this->Turn->SetAngle(degrees);
  }

  /// The filter's warnings, in one text.
  std::string Run(vtkSurfaceDeformation* filter) const
  {
    auto log = vtktest::Observe(filter);
    filter->SetInputData(this->Surface);
    filter->SetHandleMotion(2, this->Turn);
    filter->Update();
    EXPECT_TRUE(log->Errors.empty());
    std::string text;
    for (const std::string& warning : log->Warnings)
    {
      text += warning;
    }
    return text;
  }

  double Size;
  vtkSmartPointer<vtkPolyData> Surface;
  vtkNew<vtkHandleMotion> Turn;
};

bool IsUnsettled(const std::string& warnings)
{
  return warnings.find("The estimated rotations do not settle") != std::string::npos;
}

/// The rounds' result and warnings.
std::pair<cartan::Points, std::string> AfterRounds(const BentMesh& mesh, int rounds)
{
  vtkNew<vtkLaplacianDeformation> filter;
  filter->SetRotationsToEstimated();
  filter->SetRounds(rounds);
  const std::string warnings = mesh.Run(filter);
  return { vtktest::PointsOf(filter->GetOutput()), warnings };
}

TEST(LaplacianRounds, WithoutAWarningMoreRoundsChangeLittle)
{
  int warned = 0;
  for (const char* name : { "boeing", "triceratops", "hand", "eight" })
  {
    for (const double degrees : { 40.0, 120.0 })
    {
      const BentMesh mesh(name, degrees);
      const auto [points, warnings] = AfterRounds(mesh, 5);
      if (IsUnsettled(warnings))
      {
        ++warned;
        continue;
      }
      const cartan::Points more = AfterRounds(mesh, 20).first;
      EXPECT_LT((more - points).rowwise().norm().maxCoeff(), 0.15 * mesh.Size)
        << name << " " << degrees;
    }
  }
  EXPECT_GE(warned, 2);
  EXPECT_LE(warned, 4);
}

TEST(LaplacianRounds, EachAdviceOfTheWarningWorks)
{
  const BentMesh mesh("boeing", 40.0);
  const auto [points, warnings] = AfterRounds(mesh, 5);
  ASSERT_TRUE(IsUnsettled(warnings)) << warnings;
  EXPECT_NE(warnings.find(shapes::Advice(
              "Rotation Invariant Deformation and Rotations None solve without rounds; merge "
              "pieces that belong together (Prepare Surface).")),
    std::string::npos)
    << warnings;
  const auto size = [](const cartan::Points& p)
  { return (p.colwise().maxCoeff() - p.colwise().minCoeff()).norm(); };
  EXPECT_GT(size(points), 2.0 * mesh.Size);

  vtkNew<vtkRotationInvariantDeformation> rotationInvariant;
  EXPECT_FALSE(IsUnsettled(mesh.Run(rotationInvariant)));
  EXPECT_LT(size(vtktest::PointsOf(rotationInvariant->GetOutput())), 1.3 * mesh.Size);

  vtkNew<vtkLaplacianDeformation> without;
  without->SetRotationsToNone();
  EXPECT_FALSE(IsUnsettled(mesh.Run(without)));
  EXPECT_LT(size(vtktest::PointsOf(without->GetOutput())), 1.5 * mesh.Size);

  vtkNew<vtkLaplacianDeformation> prepared;
  prepared->SetRotationsToEstimated();
  prepared->PrepareInputOn();
  EXPECT_FALSE(IsUnsettled(mesh.Run(prepared)));
  EXPECT_LT(size(vtktest::PointsOf(prepared->GetOutput())), 1.3 * mesh.Size);
}

TEST(LaplacianRounds, TheWarningIsOfTheLastMotion)
{
  const BentMesh mesh("boeing", 40.0);
  vtkNew<vtkLaplacianDeformation> filter;
  filter->SetRotationsToEstimated();
  EXPECT_TRUE(IsUnsettled(mesh.Run(filter)));
  mesh.Turn->SetAngle(0.0);
  EXPECT_FALSE(IsUnsettled(mesh.Run(filter)));
}
}
