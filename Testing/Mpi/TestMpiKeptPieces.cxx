// SPDX-License-Identifier: BSD-3-Clause
// Filters that leave each piece of a surface where it is.
#include "../Distributed/CountedMessages.h"
#include "AdviceWords.h"
#include "SurfaceInPieces.h"

#include "vtkDifferentialCoordinates.h"
#include "vtkHandleMotion.h"
#include "vtkMarkHandle.h"
#include "vtkPoissonDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"

#include "vtkPolyDataNormals.h"
#include "vtkSphere.h"

namespace
{
using pieces::Kind;
using pieces::Rank;
using pieces::Size;
using shapes::Advice;

vtkSmartPointer<vtkPolyData> WithEnds(const shapes::Shape& shape, int axis)
{
  auto surface = vtktest::MakePolyData(shape);
  double box[6];
  surface->GetBounds(box);
  const double low = box[2 * axis];
  const double length = box[2 * axis + 1] - low;
  vtktest::AddHandles(surface,
    [&](const Eigen::Vector3d& p) {
      return p[axis] < low + 0.2 * length ? 1 : p[axis] > low + 0.8 * length ? 2 : 0;
    });
  return surface;
}

vtkSmartPointer<vtkPolyData> Beam()
{
  return WithEnds(shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 }), 2);
}

/// None has slivers.
std::map<std::string, vtkSmartPointer<vtkPolyData>> FourSurfaces()
{
  return { { "bar", Beam() },
    { "noisy ellipsoid",
      WithEnds(shapes::Noisy(shapes::Ellipsoid(3, { 3.0, 1.0, 2.0 }), 0.01), 0) },
    { "torus", WithEnds(shapes::Torus(40, 20), 0) },
    { "eight", WithEnds(shapes::RealMesh("eight"), 0) } };
}

/// One handle moves, the other is pinned.
template <typename Filter>
vtkSmartPointer<Filter> Mover()
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetRoundingCheckLimit(0);
  vtkNew<vtkHandleMotion> motion;
  motion->SetAngle(40.0);
  motion->SetAxis(1.0, 0.3, 0.2);
  motion->SetTranslation(0.05, 0.0, 0.1);
  filter->SetHandleMotion(2, motion);
  return filter;
}

std::map<std::string, vtkSmartPointer<vtkFrameDeformation>> FrameMethods()
{
  const auto raw = Mover<vtkRotationInvariantDeformation>();
  raw->SetFrameProjectionToNone();
  const auto table = Mover<vtkRotationInvariantDeformation>();
  table->TabulateTurnsOn();
  table->SetTurnTolerance(1e-6);
  const auto shape = Mover<vtkShapePreservingDeformation>();
  shape->SetVolumeCorrectionToNone();
  const auto shapeTable = Mover<vtkShapePreservingDeformation>();
  shapeTable->TabulateTurnsOn();
  shapeTable->SetTurnTolerance(1e-6);
  const auto uniform = Mover<vtkRotationInvariantDeformation>();
  uniform->SetLaplacianWeightsToUniform();
  uniform->SetPositionWeightsToCotangent();
  uniform->GenerateFrameChangeOn();
  uniform->GenerateRotationVectorOn();
  return { { "projected", Mover<vtkRotationInvariantDeformation>() }, { "raw", raw },
    { "table", table }, { "shape preserving", shape }, { "two systems", uniform },
    { "neutral offset", Mover<vtkShapePreservingDeformation>() },
    { "neutral offset, table", shapeTable }, { "Poisson", Mover<vtkPoissonDeformation>() } };
}

std::vector<Kind> AllKinds()
{
  return { { true, true }, { false, true }, { false, false }, { true, false } };
}

TEST(KeptPieces, MoveAsOneSurface)
{
  for (const auto& [surfaceName, surface] : FourSurfaces())
  {
    for (const auto& [methodName, filter] : FrameMethods())
    {
      filter->SetInputData(surface);
      filter->Update();
      const auto whole = vtktest::CopyOf(filter->GetOutput());
      for (const Kind& kind : AllKinds())
      {
        SCOPED_TRACE(surfaceName + " " + methodName);
        const auto log = vtktest::Observe(filter);
        const auto piece = pieces::MyPieceOf(surface,
          kind.HasGhosts ? pieces::Distribution(pieces::InBlocks) : pieces::Scattered, kind);
        filter->SetInputData(piece);
        pieces::UpdateTogether(filter);
        vtktest::ExpectQuiet(*log); // it was not gathered
        vtkPolyData* part = filter->GetOutput();
        ASSERT_EQ(part->GetNumberOfPoints(), piece->GetNumberOfPoints());
        EXPECT_LT(pieces::DifferenceToWhole(part, whole), filter->GetTabulateTurns() ? 1e-7 : 1e-8);
        vtktest::ExpectSameCells(part, piece);
        vtktest::ExpectArrays(part->GetCellData(), piece->GetCellData(), false);
        if (filter->GetGenerateFrameChange())
        {
          EXPECT_LT(pieces::ArrayDifference(part, whole, "FrameChange"), 1e-7);
          EXPECT_LT(pieces::ArrayDifference(part, whole, "RotationVector"), 1e-7);
        }
      }
    }
  }
}
/// Updates, and tells how often this rank has called MPI meanwhile.
long long MessagesOfUpdate(vtkAlgorithm* filter)
{
  const long long before = CountedMessages();
  pieces::UpdateTogether(filter);
  return CountedMessages() - before;
}

/// Where the motions of a filter take a surface that is whole, without its table.
vtkSmartPointer<vtkPolyData> MovedWithoutTable(vtkFrameDeformation* filter, vtkPolyData* surface)
{
  auto alone = vtk::TakeSmartPointer(filter->NewInstance());
  auto* from = vtkRotationInvariantDeformation::SafeDownCast(filter);
  if (auto* to = vtkRotationInvariantDeformation::SafeDownCast(alone))
  {
    to->SetFrameProjection(from->GetFrameProjection());
  }
  alone->SetVolumeCorrection(filter->GetVolumeCorrection());
  alone->SetLaplacianWeights(filter->GetLaplacianWeights());
  for (const int id : { 1, 2 })
  {
    alone->SetHandleMotion(id, filter->GetHandleMotion(id));
  }
  alone->SetRoundingCheckLimit(0);
  alone->SetInputData(surface);
  alone->Update();
  return vtktest::CopyOf(alone->GetOutput());
}

TEST(KeptPieces, DragsSendNoMessage)
{
  const auto bar = Beam();
  const auto methods = FrameMethods();
  for (const char* name : { "raw", "table", "neutral offset, table" })
  {
    for (const pieces::Distribution& distribution :
      { pieces::Distribution(pieces::InBlocks), pieces::AllOn(Size() - 1) }) // some are empty
    {
      SCOPED_TRACE(name);
      const auto& filter = methods.at(name);
      const auto log = vtktest::Observe(filter);
      filter->SetInputData(pieces::MyPieceOf(bar, distribution));
      EXPECT_GT(MessagesOfUpdate(filter), 0);
      for (const double angle : { 50.0, -20.0, 80.0 })
      {
        filter->GetHandleMotion(2)->SetAngle(angle);
        filter->GetHandleMotion(2)->SetTranslation(0.01 * angle, 0.1, 0.0);
        EXPECT_EQ(MessagesOfUpdate(filter), 0);
        EXPECT_EQ(filter->GetTabulatedRange() > 0.0, filter->GetTabulateTurns());
        EXPECT_LT(pieces::DifferenceToWhole(filter->GetOutput(), MovedWithoutTable(filter, bar)),
          filter->GetTabulateTurns() ? 2e-6 : 1e-8);
      }
      vtktest::ExpectQuiet(*log);
    }
  }
}

TEST(KeptPieces, ChangesAreSeenByAllRanks)
{
  const auto bar = Beam();
  const auto filter = FrameMethods().at("raw");
  const auto log = vtktest::Observe(filter);
  const auto expectLikeWhole = [&](vtkPolyData* surface)
  {
    pieces::UpdateTogether(filter);
    EXPECT_LT(
      pieces::DifferenceToWhole(filter->GetOutput(), MovedWithoutTable(filter, surface)), 1e-8);
  };
  filter->SetInputData(pieces::MyPieceOf(bar));
  expectLikeWhole(bar);
  // Another setting, and another set of moving handles.
  filter->SetLaplacianWeightsToUniform();
  expectLikeWhole(bar);
  vtkNew<vtkHandleMotion> second;
  second->SetTranslation(0.0, 0.2, 0.0);
  filter->SetHandleMotion(1, second);
  expectLikeWhole(bar);
  filter->SetHandleMotion(1, nullptr);
  expectLikeWhole(bar);
  // Other points, on the last rank alone; the others' inputs come again.
  const auto bent = vtktest::CopyOf(bar);
  vtkNew<vtkPoints> points;
  points->DeepCopy(bar->GetPoints());
  const vtkIdType last = points->GetNumberOfPoints() - 1;
  double place[3];
  points->GetPoint(last, place);
  points->SetPoint(last, place[0] + 0.05, place[1] - 0.03, place[2]);
  bent->SetPoints(points);
  filter->SetInputData(pieces::MyPieceOf(bent));
  expectLikeWhole(bent);
  filter->SetInputData(pieces::MyPieceOf(bar));
  expectLikeWhole(bar);
  vtktest::ExpectQuiet(*log);
}

TEST(KeptPieces, NormalsTurnAlong)
{
  const auto bar = vtktest::CopyOf(Beam());
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(bar);
  normals->SplittingOff();
  normals->ComputeCellNormalsOn();
  normals->Update();
  const auto filter = FrameMethods().at("raw");
  filter->SetInputData(normals->GetOutput());
  filter->Update();
  const auto whole = vtktest::CopyOf(filter->GetOutput());
  const auto piece = pieces::MyPieceOf(normals->GetOutput());
  filter->SetInputData(piece);
  pieces::UpdateTogether(filter);
  EXPECT_LT(pieces::ArrayDifference(filter->GetOutput(), whole, "Normals"), 1e-6);
  if (piece->GetNumberOfCells() > 0)
  {
    vtkDataArray* before = piece->GetCellData()->GetNormals();
    vtkDataArray* after = filter->GetOutput()->GetCellData()->GetNormals();
    ASSERT_TRUE(before && after);
    EXPECT_EQ(before->GetNumberOfTuples(), after->GetNumberOfTuples());
  }
}

TEST(KeptPieces, MayBeEmptyOrOneTriangle)
{
  const auto bar = Beam();
  const std::vector<pieces::Distribution> distributions = { [](vtkIdType cell, vtkIdType)
    { return cell < Size() - 1 ? static_cast<int>(cell) : Size() - 1; },
    [](vtkIdType cell, vtkIdType count)
    { return cell % (count / Size()) == 0 ? static_cast<int>(cell) % Size() : 0; },
    pieces::AllOn(Size() - 1), pieces::AllOn(0) };
  for (const pieces::Distribution& distribution : distributions)
  {
    for (const Kind& kind : AllKinds())
    {
      for (const auto& [name, filter] : FrameMethods())
      {
        SCOPED_TRACE(name);
        const auto log = vtktest::Observe(filter);
        filter->SetInputData(bar);
        filter->Update();
        const auto whole = vtktest::CopyOf(filter->GetOutput());
        filter->SetInputData(pieces::MyPieceOf(bar, distribution, kind));
        pieces::UpdateTogether(filter);
        vtktest::ExpectQuiet(*log);
        EXPECT_LT(pieces::DifferenceToWhole(filter->GetOutput(), whole),
          filter->GetTabulateTurns() ? 1e-7 : 1e-8);
      }
    }
  }
}

TEST(KeptPieces, BadMotionsGiveOneMessage)
{
  const auto filter = FrameMethods().at("raw");
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(pieces::MyPieceOf(Beam()));
  pieces::UpdateTogether(filter);
  vtktest::ExpectQuiet(*log);
  vtkNew<vtkHandleMotion> motion;
  filter->SetHandleMotion(7, motion);
  pieces::UpdateTogether(filter); // a drag
  pieces::ExpectOneMessage(log->Errors, { "Handle 7 has a motion", "Handles with points: 1, 2" });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  log->Clear();
  filter->SetHandleMotion(7, nullptr);
  pieces::UpdateTogether(filter);
  vtktest::ExpectQuiet(*log);
  EXPECT_GT(pieces::SumOverRanks(filter->GetOutput()->GetNumberOfPoints()), 0.0);
}

TEST(KeptPieces, AWrongArrayOfOneRankIsToldOnce)
{
  const auto filter = Mover<vtkRotationInvariantDeformation>();
  const auto log = vtktest::Observe(filter);
  const auto piece = pieces::MyPieceOf(Beam());
  if (Rank() == Size() - 1)
  {
    piece->GetPointData()->GetArray("Handle")->SetTuple1(0, -1.0);
  }
  filter->SetInputData(piece);
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Errors,
    { "On rank " + std::to_string(Size() - 1) + ": ", "1 value (id 0)", "whole numbers" });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(KeptPieces, SliversAreGathered)
{
  // A vertex of a cap lies almost on the opposite edge.
  shapes::Shape shape = shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 });
  const Eigen::Vector3i face = shape.Faces.row(shape.Faces.rows() / 2);
  shape.Positions.row(face[0]) = 0.52 * shape.Positions.row(face[1]) +
    0.48 * shape.Positions.row(face[2]) + 0.01 * shape.Positions.row(face[0]);
  const auto bar = WithEnds(shape, 2);
  const auto filter = FrameMethods().at("raw");
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(bar);
  filter->Update();
  const auto whole = vtktest::CopyOf(filter->GetOutput());
  filter->SetInputData(pieces::MyPieceOf(bar));
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(
    log->Warnings, { "cannot stay in pieces", "are slivers", "gathered on the first" });
  EXPECT_LT(pieces::DifferenceToWhole(filter->GetOutput(), whole), 1e-8);
  log->Clear();
  filter->SetGatherLimit(10);
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Warnings,
    { "in pieces", "slivers", Advice("raise GatherLimit if the first rank has the memory.") });
  EXPECT_TRUE(log->Errors.empty());
  EXPECT_GT(pieces::SumOverRanks(filter->GetOutput()->GetNumberOfPoints()), 0.0);
}

TEST(KeptPieces, VolumesOfMoreThanTheLimitAreRefused)
{
  const auto filter = FrameMethods().at("neutral offset");
  const auto log = vtktest::Observe(filter);
  filter->SetGatherLimit(10);
  filter->SetInputData(pieces::MyPieceOf(Beam()));
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Errors,
    { "more than GatherLimit (10)",
      Advice("set VolumeCorrection to None, or raise the limit if all ranks have the memory.") });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  log->Clear();
  filter->SetVolumeCorrectionToNone();
  pieces::UpdateTogether(filter);
  vtktest::ExpectQuiet(*log);
  EXPECT_GT(pieces::SumOverRanks(filter->GetOutput()->GetNumberOfPoints()), 0.0);
}

TEST(KeptPieces, FreePointsAreThoseOfTheWhole)
{
  const auto bar = Beam();
  for (const auto& [name, filter] : FrameMethods())
  {
    filter->SetInputData(bar);
    filter->Update();
    const int free = filter->GetNumberOfFreePoints();
    filter->SetInputData(pieces::MyPieceOf(bar));
    pieces::UpdateTogether(filter);
    EXPECT_EQ(filter->GetNumberOfFreePoints(), free) << name;
  }
}

/// All ranks end with one message or none, and go on afterwards.
void ExpectToGoOn(vtkSurfaceDeformation* filter)
{
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(pieces::MyPieceOf(Beam()));
  pieces::UpdateTogether(filter);
  vtktest::ExpectQuiet(*log);
  EXPECT_GT(pieces::SumOverRanks(filter->GetOutput()->GetNumberOfPoints()), 0.0);
}

TEST(KeptPieces, AnAbortOfOneRankStopsAll)
{
  for (const int rank : { 0, Size() - 1 })
  {
    for (const int report : { 1, 3, 6 })
    {
      const auto filter = Mover<vtkRotationInvariantDeformation>();
      const auto log = vtktest::Observe(filter);
      vtkNew<vtktest::ProgressLog> progress;
      progress->AbortAt = Rank() == rank ? report : 0;
      filter->AddObserver(vtkCommand::ProgressEvent, progress);
      filter->SetInputData(pieces::MyPieceOf(Beam()));
      pieces::UpdateTogether(filter);
      EXPECT_TRUE(log->Errors.empty());
      EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
      progress->AbortAt = 0;
      filter->SetAbortExecute(0);
      ExpectToGoOn(filter);
    }
  }
}

TEST(KeptPieces, AreMarkedAsOneSurface)
{
  for (const auto& [name, surface] : FourSurfaces())
  {
    double center[3];
    surface->GetPoint(surface->GetNumberOfPoints() / 3, center);
    vtkNew<vtkSphere> ball;
    ball->SetCenter(center);
    ball->SetRadius(0.1 * surface->GetLength());
    for (const int rings : { 0, 1, 6 })
    {
      SCOPED_TRACE(name + ", rings: " + std::to_string(rings));
      vtkNew<vtkMarkHandle> mark;
      const auto log = vtktest::Observe(mark);
      mark->SetRegion(ball);
      mark->SetGrowRings(rings);
      mark->SetHandleId(3);
      mark->SetInputData(surface);
      mark->Update();
      const auto whole = vtktest::CopyOf(vtkPolyData::SafeDownCast(mark->GetOutputDataObject(0)));
      for (const Kind& kind : AllKinds())
      {
        mark->SetInputData(pieces::MyPieceOf(surface, pieces::Scattered, kind));
        pieces::UpdateTogether(mark);
        vtktest::ExpectQuiet(*log);
        EXPECT_EQ(pieces::ArrayDifference(
                    vtkPolyData::SafeDownCast(mark->GetOutputDataObject(0)), whole, "Handle"),
          0.0);
      }
    }
  }
}

TEST(KeptPieces, ARegionWithoutPointsIsToldOnce)
{
  vtkNew<vtkSphere> ball;
  ball->SetCenter(100.0, 0.0, 0.0);
  vtkNew<vtkMarkHandle> mark;
  const auto log = vtktest::Observe(mark);
  mark->SetRegion(ball);
  mark->SetGrowRings(2);
  mark->SetInputData(pieces::MyPieceOf(Beam()));
  pieces::UpdateTogether(mark);
  pieces::ExpectOneMessage(log->Warnings, { "No point is marked", "has no points" });
}

TEST(KeptPieces, HaveDifferentialCoordinatesOfTheWhole)
{
  for (const auto& [name, surface] : FourSurfaces())
  {
    for (const int weights : { vtkDifferentialFilter::UNIFORM, vtkDifferentialFilter::COTANGENT,
           vtkDifferentialFilter::MEAN_VALUE })
    {
      SCOPED_TRACE(name);
      vtkNew<vtkDifferentialCoordinates> coordinates;
      const auto log = vtktest::Observe(coordinates);
      coordinates->SetLaplacianWeights(weights);
      coordinates->SetInputData(surface);
      coordinates->Update();
      const auto whole = vtktest::CopyOf(coordinates->GetOutput());
      for (const Kind& kind : AllKinds())
      {
        coordinates->SetInputData(pieces::MyPieceOf(surface, pieces::InBlocks, kind));
        pieces::UpdateTogether(coordinates);
        vtktest::ExpectQuiet(*log);
        for (const char* array : { "DifferentialCoordinates", "DifferentialCoordinatesAreDefined" })
        {
          EXPECT_LT(pieces::ArrayDifference(coordinates->GetOutput(), whole, array), 1e-8);
        }
      }
    }
  }
}
}
