// SPDX-License-Identifier: BSD-3-Clause
// Scanned and generated surfaces in pieces of all kinds, and what ends an update: no rank
// waits for another that has left.
#include "AdviceWords.h"
#include "SurfaceInPieces.h"

#include "vtkCurvatureError.h"
#include "vtkDifferentialCoordinates.h"
#include "vtkHandleMotion.h"
#include "vtkLaplacianDeformation.h"
#include "vtkMarkHandle.h"
#include "vtkPoissonDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkSurfaceMorph.h"
#include "vtkVolumeChange.h"

#include "vtkCleanPolyData.h"
#include "vtkCompositeDataGeometryFilter.h"
#include "vtkGenerateGlobalIds.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPolyDataNormals.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"

namespace
{
using pieces::Kind;
using pieces::Rank;
using pieces::Size;
using shapes::Advice;

/// With both ends along the longest side as handles.
vtkSmartPointer<vtkPolyData> WithHandles(const shapes::Shape& shape)
{
  auto surface = vtktest::MakePolyData(shape);
  double box[6];
  surface->GetBounds(box);
  int axis = 0;
  for (int c = 1; c < 3; ++c)
  {
    axis = box[2 * c + 1] - box[2 * c] > box[2 * axis + 1] - box[2 * axis] ? c : axis;
  }
  const double low = box[2 * axis];
  const double length = box[2 * axis + 1] - low;
  vtktest::AddHandles(surface,
    [&](const Eigen::Vector3d& p) {
      return p[axis] < low + 0.2 * length ? 1 : p[axis] > low + 0.8 * length ? 2 : 0;
    });
  return surface;
}

struct Mesh
{
  std::string Name;
  vtkSmartPointer<vtkPolyData> Surface;
};

std::vector<Mesh> FourMeshes()
{
  return { { "eight", WithHandles(shapes::RealMesh("eight")) },
    { "elephant", WithHandles(shapes::RealMesh("elephant")) },
    { "torus", WithHandles(shapes::Torus(40, 20)) },
    { "bar", WithHandles(shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 })) } };
}

template <typename Filter>
vtkSmartPointer<Filter> Bending()
{
  auto filter = vtkSmartPointer<Filter>::New();
  vtkNew<vtkHandleMotion> motion;
  motion->SetAngle(40.0);
  motion->SetAxis(1.0, 0.3, 0.2);
  motion->SetTranslation(0.05, 0.0, 0.1);
  filter->SetHandleMotion(2, motion);
  return filter;
}

std::vector<vtkSmartPointer<vtkAlgorithm>> Deformations()
{
  return { Bending<vtkRotationInvariantDeformation>(), Bending<vtkShapePreservingDeformation>(),
    Bending<vtkPoissonDeformation>(), Bending<vtkLaplacianDeformation>() };
}

void UpdateBoth(vtkAlgorithm* filter, vtkPolyData* whole, vtkPolyData* piece,
  vtkSmartPointer<vtkPolyData>& wholeResult, vtkSmartPointer<vtkPolyData>& pieceResult)
{
  filter->SetInputDataObject(0, whole);
  filter->Update();
  wholeResult = vtktest::CopyOf(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0)));
  filter->SetInputDataObject(0, piece);
  pieces::UpdateTogether(filter);
  pieceResult = vtktest::CopyOf(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0)));
}

TEST(Pieces, DeformAsOneSurface)
{
  for (const Mesh& mesh : FourMeshes())
  {
    for (const auto& filter : Deformations())
    {
      const auto log = vtktest::Observe(filter);
      for (const Kind& kind : { Kind{ true, true }, Kind{ false, true }, Kind{ false, false } })
      {
        SCOPED_TRACE(mesh.Name + " " + filter->GetClassName());
        const auto piece = pieces::MyPieceOf(mesh.Surface, pieces::InBlocks, kind);
        vtkSmartPointer<vtkPolyData> whole;
        vtkSmartPointer<vtkPolyData> part;
        UpdateBoth(filter, mesh.Surface, piece, whole, part);
        ASSERT_EQ(part->GetNumberOfPoints(), piece->GetNumberOfPoints());
        EXPECT_LT(pieces::DifferenceToWhole(part, whole), 1e-8);
        vtktest::ExpectSameCells(part, piece);
        vtktest::ExpectArrays(part->GetPointData(), piece->GetPointData(), false);
        vtktest::ExpectArrays(part->GetCellData(), piece->GetCellData(), false);
      }
      EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
    }
  }
}

TEST(Pieces, AreMeasuredAsOneSurface)
{
  for (const Mesh& mesh : FourMeshes())
  {
    SCOPED_TRACE(mesh.Name);
    const auto bend = Bending<vtkRotationInvariantDeformation>();
    bend->SetInputData(mesh.Surface);
    bend->Update();
    vtkPolyData* bent = bend->GetOutput();
    const auto piece = pieces::MyPieceOf(mesh.Surface, pieces::Scattered, { false, true });
    const auto bentPiece = pieces::MyPieceOf(bent, pieces::Scattered, { false, true });

    vtkNew<vtkVolumeChange> volume;
    vtktest::Observe(volume);
    volume->SetInputData(bent);
    volume->SetInputData(1, mesh.Surface);
    volume->Update();
    const double expected = volume->GetRelativeVolumeChange();
    const auto wholeVolume = vtktest::CopyOf(volume->GetOutput());
    volume->SetInputData(bentPiece);
    volume->SetInputData(1, piece);
    pieces::UpdateTogether(volume);
    if (Rank() == 0)
    {
      EXPECT_NEAR(volume->GetRelativeVolumeChange(), expected, 1e-8);
    }
    EXPECT_LT(pieces::ArrayDifference(volume->GetOutput(), wholeVolume, "AreaRatio"), 1e-8);

    vtkNew<vtkCurvatureError> curvature;
    vtktest::Observe(curvature);
    curvature->SetInputData(bent);
    curvature->SetInputData(1, mesh.Surface);
    curvature->Update();
    const auto wholeCurvature = vtktest::CopyOf(curvature->GetOutput());
    curvature->SetInputData(bentPiece);
    curvature->SetInputData(1, piece);
    pieces::UpdateTogether(curvature);
    EXPECT_LT(
      pieces::ArrayDifference(curvature->GetOutput(), wholeCurvature, "MeanCurvature"), 1e-8);

    vtkNew<vtkDifferentialCoordinates> coordinates;
    vtktest::Observe(coordinates);
    vtkSmartPointer<vtkPolyData> whole;
    vtkSmartPointer<vtkPolyData> part;
    UpdateBoth(coordinates, mesh.Surface, piece, whole, part);
    EXPECT_LT(pieces::ArrayDifference(part, whole, "DifferentialCoordinates"), 1e-8);
  }
}

TEST(Pieces, MayBeEmptyOrSmall)
{
  const auto bar = WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  // A few triangles on all ranks but the last; all on the last; all on the first.
  const std::vector<pieces::Distribution> distributions = { [](vtkIdType cell, vtkIdType)
    { return cell < Size() - 1 ? static_cast<int>(cell) : Size() - 1; },
    pieces::AllOn(Size() - 1), pieces::AllOn(0) };
  for (const pieces::Distribution& distribution : distributions)
  {
    for (const Kind& kind : { Kind{ true, true }, Kind{ false, false } })
    {
      const auto filter = Bending<vtkRotationInvariantDeformation>();
      const auto log = vtktest::Observe(filter);
      vtkSmartPointer<vtkPolyData> whole;
      vtkSmartPointer<vtkPolyData> part;
      UpdateBoth(filter, bar, pieces::MyPieceOf(bar, distribution, kind), whole, part);
      EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
      EXPECT_LT(pieces::DifferenceToWhole(part, whole), 1e-8);
      EXPECT_GE(pieces::SumOverRanks(part->GetNumberOfPoints()), bar->GetNumberOfPoints());
    }
  }
}

TEST(Pieces, OfNothingGiveNothing)
{
  vtkNew<vtkPolyData> nothing;
  const auto filter = Bending<vtkRotationInvariantDeformation>();
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(nothing);
  pieces::UpdateTogether(filter);
  vtktest::ExpectQuiet(*log);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(Pieces, KeepNormalsThatAreSplit)
{
  // Points on creases are doubled in each piece: their normals tell which belong together.
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 })));
  normals->SplittingOn();
  normals->Update();
  const auto bar = vtktest::CopyOf(normals->GetOutput());
  vtkNew<vtkDifferentialCoordinates> coordinates;
  vtktest::Observe(coordinates);
  vtkSmartPointer<vtkPolyData> whole;
  vtkSmartPointer<vtkPolyData> part;
  UpdateBoth(
    coordinates, bar, pieces::MyPieceOf(bar, pieces::Scattered, { false, false }), whole, part);
  EXPECT_LT(pieces::ArrayDifference(part, whole, "DifferentialCoordinates"), 1e-8);
}

TEST(Pieces, SayOnceThatTheyAreGathered)
{
  const auto bar = WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  const auto filter = Bending<vtkLaplacianDeformation>();
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(pieces::MyPieceOf(bar));
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Warnings, { "distributed over", "gathered on the first" });
  filter->GetHandleMotion(2)->SetAngle(50.0);
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Warnings, { "gathered" }); // still one
}

TEST(Pieces, HaveALimit)
{
  const auto bar = WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  const auto filter = Bending<vtkLaplacianDeformation>();
  const auto log = vtktest::Observe(filter);
  filter->SetGatherLimit(100);
  filter->SetInputData(pieces::MyPieceOf(bar));
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(
    log->Errors, { "more than GatherLimit (100)", Advice("allows on one rank: raise it") });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  log->Clear();
  filter->SetGatherLimit(100000);
  pieces::UpdateTogether(filter);
  EXPECT_TRUE(log->Errors.empty());
  EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 0);
}

/// All ranks end with one message, and go on with a good surface.
void ExpectRefused(vtkPolyData* piece, const std::vector<std::string>& parts)
{
  const auto filter = Bending<vtkRotationInvariantDeformation>();
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(piece);
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Errors, parts);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_NE(filter->GetErrorCode(), 0u);
  log->Clear();
  filter->SetInputData(pieces::MyPieceOf(WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }))));
  pieces::UpdateTogether(filter);
  EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
  EXPECT_GT(pieces::SumOverRanks(filter->GetOutput()->GetNumberOfPoints()), 0.0);
}

TEST(Pieces, WithDefectsBetweenRanksAreRefused)
{
  const shapes::Shape plane = shapes::Plane(6);
  const auto from = [&plane](const std::vector<Eigen::Vector3i>& faces)
  {
    shapes::Shape shape = plane;
    shape.Faces = shapes::ToTriangles(faces);
    return vtktest::MakePolyData(shape);
  };
  const pieces::Distribution oneEach = [](vtkIdType cell, vtkIdType)
  { return static_cast<int>(cell) % Size(); };
  for (const Kind& kind : { Kind{ true, false }, Kind{ true, true } })
  {
    ExpectRefused(
      pieces::MyPieceOf(from({ { 0, 1, 8 }, { 1, 0, 9 }, { 0, 1, 10 } }), oneEach, kind),
      { "1 edge", "more than two triangles" });
    ExpectRefused(pieces::MyPieceOf(from({ { 0, 1, 8 }, { 1, 8, 9 } }), oneEach, kind),
      { "1 edge", "opposite orientation" });
  }
}

TEST(Pieces, WithNanOnOneRankAreRefusedByGlobalId)
{
  const auto bar = WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  const vtkIdType last = bar->GetNumberOfPoints() - 1;
  bar->GetPoints()->SetPoint(last, std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  bar->Modified();
  ExpectRefused(pieces::MyPieceOf(bar, pieces::InBlocks, { true, false }),
    { "1 point (id " + std::to_string(last) + ")", "NaN or infinite", "are their global ids" });
}

TEST(Pieces, WithGlobalIdsOfEachRankAreRefused)
{
  const auto bar = WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  const auto piece = pieces::MyPieceOf(bar, pieces::InBlocks, { true, false });
  auto* ids = vtkIdTypeArray::SafeDownCast(piece->GetPointData()->GetGlobalIds());
  for (vtkIdType v = 0; v < ids->GetNumberOfTuples(); ++v)
  {
    ids->SetValue(v, v);
  }
  ExpectRefused(
    piece, { "in different places", Advice("make the ids anew (Generate Global Ids)") });

  vtkNew<vtkGenerateGlobalIds> generate;
  generate->SetInputData(piece);
  const auto filter = Bending<vtkRotationInvariantDeformation>();
  const auto log = vtktest::Observe(filter);
  filter->SetInputConnection(generate->GetOutputPort());
  pieces::UpdateTogether(filter);
  EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
  const auto whole = Bending<vtkRotationInvariantDeformation>();
  whole->SetInputData(bar);
  whole->Update();
  EXPECT_LT(pieces::DifferenceToWhole(filter->GetOutput(), whole->GetOutput()), 1e-8);
}

TEST(Pieces, WithCopiesThatNothingTellsApartAreRefused)
{
  // Each triangle has its own points; no array says which are one.
  const shapes::Shape bar = shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 });
  shapes::Shape soup;
  soup.Positions.resize(3 * bar.Faces.rows(), 3);
  soup.Faces.resize(bar.Faces.rows(), 3);
  for (Eigen::Index t = 0; t < bar.Faces.rows(); ++t)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      const Eigen::Index v = 3 * t + corner;
      soup.Positions.row(v) = bar.Positions.row(bar.Faces(t, corner));
      soup.Faces(t, corner) = static_cast<int>(v);
    }
  }
  const auto piece = pieces::MyPieceOf(WithHandles(soup), pieces::InBlocks, { false, false });
  piece->GetPointData()->RemoveArray("Id");
  ExpectRefused(piece, { "it is open which belong together", Advice("merge them (Clean)") });

  vtkNew<vtkCleanPolyData> clean; // of each piece
  clean->SetInputData(piece);
  clean->ToleranceIsAbsoluteOn();
  clean->SetAbsoluteTolerance(0.0);
  const auto filter = Bending<vtkRotationInvariantDeformation>();
  const auto log = vtktest::Observe(filter);
  filter->SetInputConnection(clean->GetOutputPort());
  pieces::UpdateTogether(filter);
  EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
  EXPECT_GT(pieces::SumOverRanks(filter->GetOutput()->GetNumberOfPoints()), bar.NumberOfVertices());
}

TEST(Pieces, WithOtherInputsOnEachRankAreRefused)
{
  const auto bar = WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  vtkNew<vtkSurfaceMorph> morph;
  const auto log = vtktest::Observe(morph);
  for (int key = 0; key < 2 + Rank() % 2; ++key)
  {
    morph->AddInputDataObject(0, pieces::MyPieceOf(bar));
  }
  pieces::UpdateTogether(morph);
  pieces::ExpectOneMessage(
    log->Errors, { "different numbers of inputs", Advice("connect the same ones on each") });
  log->Clear();
  if (Rank() % 2 == 0)
  {
    morph->AddInputDataObject(0, pieces::MyPieceOf(bar));
  }
  morph->Modified(); // all ranks update again, or none
  pieces::UpdateTogether(morph);
  EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
  EXPECT_GT(morph->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(Pieces, RefuseSelectionsOfOneRank)
{
  const auto bar = WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  vtkNew<vtkIdTypeArray> ids;
  ids->InsertNextValue(3);
  vtkNew<vtkSelectionNode> node;
  node->SetFieldType(vtkSelectionNode::POINT);
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetSelectionList(ids);
  node->GetProperties()->Set(vtkSelectionNode::PROCESS_ID(), Size() - 1);
  vtkNew<vtkSelection> selection;
  selection->AddNode(node);
  vtkNew<vtkMarkHandle> mark;
  const auto log = vtktest::Observe(mark);
  mark->SetHandleArrayName("Picked");
  mark->SetInputData(pieces::MyPieceOf(bar));
  mark->SetSelectionData(selection);
  pieces::UpdateTogether(mark);
  pieces::ExpectOneMessage(log->Errors,
    { "names points of the pieces", Advice("mark by a region function or by PointIds instead.") });
  log->Clear();
  mark->SetSelectionData(nullptr);
  mark->SetPointId(0, 3); // of the whole
  pieces::UpdateTogether(mark);
  EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
  auto* marked = vtkPolyData::SafeDownCast(mark->GetOutputDataObject(0));
  vtkDataArray* id = marked->GetPointData()->GetArray("Id");
  for (vtkIdType v = 0; v < marked->GetNumberOfPoints(); ++v)
  {
    EXPECT_EQ(marked->GetPointData()->GetArray("Picked")->GetTuple1(v), id->GetTuple1(v) == 3.0);
  }
}

TEST(Pieces, StopTogether)
{
  const auto filter = Bending<vtkRotationInvariantDeformation>();
  const auto log = vtktest::Observe(filter);
  vtkNew<vtktest::ProgressLog> progress;
  progress->AbortAt = Rank() == Size() - 1 ? 1 : 0;
  filter->AddObserver(vtkCommand::ProgressEvent, progress);
  filter->SetInputData(pieces::MyPieceOf(WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }))));
  pieces::UpdateTogether(filter);
  EXPECT_TRUE(log->Errors.empty());
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  progress->AbortAt = 0;
  filter->SetAbortExecute(0);
  filter->Modified();
  pieces::UpdateTogether(filter);
  EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(Pieces, InBlocksOfSeveralRanksAreRefused)
{
  const auto bar = WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  for (const int used : { 1, Size() })
  {
    // Rank r has r blocks more than the first, or none at all.
    vtkNew<vtkMultiBlockDataSet> blocks;
    blocks->SetNumberOfBlocks(static_cast<unsigned>(Size()) + 1);
    for (int block = 0; block <= Rank() && Rank() < used; ++block)
    {
      blocks->SetBlock(static_cast<unsigned>(block), vtktest::CopyOf(bar));
    }
    const auto filter = Bending<vtkRotationInvariantDeformation>();
    const auto log = vtktest::Observe(filter);
    filter->SetInputDataObject(0, blocks);
    pieces::UpdateTogether(filter);
    if (used == 1)
    {
      EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
      continue;
    }
    pieces::ExpectOneMessage(log->Errors,
      { "Composite surfaces are on",
        Advice("make one surface of them (Merge Blocks, then Extract Surface) first.") });
    log->Clear();
    vtkNew<vtkMultiBlockDataSet> pieceOfEach;
    pieceOfEach->SetBlock(static_cast<unsigned>(Rank()), pieces::MyPieceOf(bar));
    vtkNew<vtkCompositeDataGeometryFilter> extract; // does what these two do
    extract->SetInputData(pieceOfEach);
    filter->SetInputConnection(extract->GetOutputPort());
    pieces::UpdateTogether(filter);
    EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
    EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 0);
  }
}

TEST(Pieces, ResultsOfAWholeUpdateAreUntouched)
{
  // An update of one rank alone asks nobody.
  if (Rank() != 0)
  {
    return;
  }
  const auto bar = WithHandles(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  const auto filter = Bending<vtkRotationInvariantDeformation>();
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(bar);
  filter->Update();
  vtktest::ExpectQuiet(*log);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), bar->GetNumberOfPoints());
}
}
