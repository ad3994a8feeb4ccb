// SPDX-License-Identifier: BSD-3-Clause
// A morph of key frames that stay in pieces.
#include "SurfaceInPieces.h"

#include "vtkSurfaceMorph.h"

#include <map>

namespace
{
using pieces::Kind;
using pieces::Rank;
using pieces::Size;

/// Three poses of a surface, with an array that changes.
std::vector<vtkSmartPointer<vtkPolyData>> PosesOf(const shapes::Shape& shape)
{
  std::vector<vtkSmartPointer<vtkPolyData>> poses;
  for (int k = 0; k < 3; ++k)
  {
    shapes::Shape pose = shape;
    for (Eigen::Index v = 0; v < pose.Positions.rows(); ++v)
    {
      const Eigen::RowVector3d p = pose.Positions.row(v);
      pose.Positions.row(v) +=
        k * Eigen::RowVector3d(0.3 * p[2] * p[2] + 5.0, 0.2 * p[0], 0.1 * std::sin(p[1]));
    }
    poses.push_back(vtktest::MakePolyData(pose));
    vtkNew<vtkDoubleArray> heat;
    heat->SetName("Heat");
    for (vtkIdType v = 0; v < poses[k]->GetNumberOfPoints(); ++v)
    {
      heat->InsertNextValue(std::cos(0.1 * static_cast<double>(v) + k));
    }
    poses[k]->GetPointData()->AddArray(heat);
  }
  return poses;
}

std::map<std::string, shapes::Shape> PosedShapes()
{
  return { { "bar", shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 }) },
    { "noisy ellipsoid", shapes::Noisy(shapes::Ellipsoid(3, { 3.0, 1.0, 2.0 }), 0.01) },
    { "torus", shapes::Torus(40, 20) }, { "eight", shapes::RealMesh("eight") } };
}

template <typename Choose>
void SetKeyFrames(vtkSurfaceMorph* filter, const std::vector<vtkSmartPointer<vtkPolyData>>& poses,
  const Choose& choose)
{
  filter->RemoveAllInputConnections(0);
  for (const auto& pose : poses)
  {
    filter->AddInputDataObject(0, choose(pose));
  }
}

TEST(KeptMorph, IsThatOfOneSurface)
{
  const std::vector<pieces::Distribution> distributions = { pieces::InBlocks, pieces::Scattered,
    pieces::AllOn(Size() - 1), pieces::AllOn(0) };
  for (const auto& [name, shape] : PosedShapes())
  {
    const auto poses = PosesOf(shape);
    for (const double parameter : { 0.0, 0.3, 0.5, 0.8 })
    {
      SCOPED_TRACE(name + " at " + std::to_string(parameter));
      vtkNew<vtkSurfaceMorph> filter;
      filter->SetMethodToLinear();
      filter->FollowTimeOff();
      filter->SetParameter(parameter);
      SetKeyFrames(filter, poses, [](vtkPolyData* pose) { return pose; });
      filter->Update();
      const auto whole = vtktest::CopyOf(filter->GetOutput());
      for (const pieces::Distribution& distribution : distributions)
      {
        for (const Kind& kind : { Kind{ true, true }, Kind{ false, false }, Kind{ true, false } })
        {
          const auto log = vtktest::Observe(filter);
          const auto piece = pieces::MyPieceOf(poses[0], distribution, kind);
          SetKeyFrames(filter, poses,
            [&](vtkPolyData* pose) { return pieces::MyPieceOf(pose, distribution, kind); });
          pieces::UpdateTogether(filter);
          vtktest::ExpectQuiet(*log); // it was not gathered
          vtkPolyData* part = filter->GetOutput();
          ASSERT_EQ(part->GetNumberOfPoints(), piece->GetNumberOfPoints());
          EXPECT_LT(pieces::DifferenceToWhole(part, whole), 1e-8);
          EXPECT_LT(pieces::ArrayDifference(part, whole, "Heat"), 1e-8);
          vtktest::ExpectSameCells(part, piece);
          EXPECT_EQ(filter->GetNumberOfKeyFrames(), 3);
          EXPECT_EQ(part->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), parameter);
        }
      }
    }
  }
}

TEST(KeptMorph, OtherMethodsAreGathered)
{
  const auto poses = PosesOf(PosedShapes().at("bar"));
  vtkNew<vtkSurfaceMorph> filter;
  filter->SetMethodToDiscreteForms();
  filter->FollowTimeOff();
  filter->SetParameter(0.25);
  const auto log = vtktest::Observe(filter);
  SetKeyFrames(filter, poses, [](vtkPolyData* pose) { return pose; });
  filter->Update();
  const auto whole = vtktest::CopyOf(filter->GetOutput());
  SetKeyFrames(filter, poses, [](vtkPolyData* pose) { return pieces::MyPieceOf(pose); });
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Warnings, { "gathered on the first" });
  EXPECT_LT(pieces::DifferenceToWhole(filter->GetOutput(), whole), 1e-8);
}

TEST(KeptMorph, BadKeyFramesAreToldOnce)
{
  auto poses = PosesOf(PosedShapes().at("bar"));
  vtkNew<vtkSurfaceMorph> filter;
  filter->SetMethodToLinear();
  filter->FollowTimeOff();
  filter->SetParameter(0.25);
  const auto log = vtktest::Observe(filter);
  const vtkIdType last = poses[1]->GetNumberOfPoints() - 1;
  poses[1]->GetPoints()->SetPoint(last, std::nan(""), 0.0, 0.0);
  SetKeyFrames(filter, poses, [](vtkPolyData* pose) { return pieces::MyPieceOf(pose); });
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Errors,
    { "key frame 1", "1 point (id " + std::to_string(last) + ")", "NaN", "global ids" });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  log->Clear();
  poses = PosesOf(PosedShapes().at("bar"));
  SetKeyFrames(filter, poses,
    [&](vtkPolyData* pose)
    {
      return pieces::MyPieceOf(pose,
        pose == poses[2] ? pieces::Distribution(pieces::Scattered)
                         : pieces::Distribution(pieces::InBlocks));
    });
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Errors, { "On rank", "key frame 2", "same points and cells" });
  log->Clear();
  SetKeyFrames(filter, poses, [](vtkPolyData* pose) { return pieces::MyPieceOf(pose); });
  pieces::UpdateTogether(filter);
  vtktest::ExpectQuiet(*log);
  EXPECT_GT(pieces::SumOverRanks(filter->GetOutput()->GetNumberOfPoints()), 0.0);
}
}
