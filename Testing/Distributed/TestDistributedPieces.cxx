// SPDX-License-Identifier: BSD-3-Clause
#include "AdviceWords.h"
#include "Pieces.h"

#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Differential/Laplacian.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{
using cartan::DistributedMesh;
using cartan::Error;
using cartan::ErrorCode;
using cartan::Field;
using pieces::Piece;
using shapes::Shape;

/// The text that all ranks throw alike; empty where none does.
std::string SharedText(const cartan::Ranks& group, const std::function<void()>& work)
{
  std::string text;
  try
  {
    group.Together(work);
  }
  catch (const Error& error)
  {
    EXPECT_TRUE(cartan::Ranks::IsShared(error));
    text = error.what();
  }
  // As numbers: whether all are the same.
  std::vector<std::int64_t> letters(text.begin(), text.end());
  const std::vector<std::int64_t> all = group.Gather(letters);
  EXPECT_EQ(all.size(), letters.size() * static_cast<std::size_t>(group.GetSize()));
  for (std::size_t i = 0; i < all.size() && !letters.empty(); ++i)
  {
    EXPECT_EQ(all[i], letters[i % letters.size()]);
  }
  return text;
}

std::string TextOfMesh(const Shape& shape, const pieces::Cut& cut)
{
  const auto group = pieces::World();
  const Piece piece = pieces::CutOut(shape, cut(shape, group->GetSize()), group);
  return SharedText(*group, [&piece] { DistributedMesh mesh(piece.Surface); });
}

TEST(DistributedPieces, AnErrorOfOneRankIsThrownByAll)
{
  const auto group = pieces::World();
  const int last = group->GetSize() - 1;
  const std::string text = SharedText(*group,
    [&]
    {
      if (group->GetRank() == last)
      {
        throw Error(ErrorCode::BadInput, "No good.");
      }
      // The others are here already, and wait.
      group->Any(false);
      group->Gather({ 1, 2 });
    });
  EXPECT_EQ(text, "No good.");
  // And go on together.
  EXPECT_TRUE(group->Any(group->GetRank() == last));
  EXPECT_EQ(SharedText(*group, [] {}), "");
}

TEST(DistributedPieces, TheLowestRankSpeaks)
{
  const auto group = pieces::World();
  const std::string text = SharedText(*group,
    [&] { throw Error(ErrorCode::BadInput, "Rank " + std::to_string(group->GetRank()) + "."); });
  const int others = group->GetSize() - 1;
  EXPECT_EQ(text,
    others == 0     ? "Rank 0."
      : others == 1 ? "Rank 0. (And 1 rank has another problem.)"
                    : "Rank 0. (And " + std::to_string(others) + " ranks have another problem.)");
}

TEST(DistributedPieces, ListsGoWhereTheyBelong)
{
  const auto group = pieces::World();
  const int size = group->GetSize();
  std::vector<std::vector<std::int64_t>> lists(static_cast<std::size_t>(size));
  for (int to = 0; to < size; ++to)
  {
    lists[static_cast<std::size_t>(to)].assign(
      static_cast<std::size_t>(to), 100 * group->GetRank() + to);
  }
  const auto taken = group->Exchange(lists);
  for (int from = 0; from < size; ++from)
  {
    EXPECT_EQ(taken[static_cast<std::size_t>(from)],
      std::vector<std::int64_t>(
        static_cast<std::size_t>(group->GetRank()), 100 * from + group->GetRank()));
  }
  EXPECT_EQ(group->SumBefore(group->GetRank() + 1),
    std::int64_t{ group->GetRank() } * (group->GetRank() + 1) / 2);
}

TEST(DistributedPieces, GhostsGetWhatTheirOwnersHave)
{
  const auto group = pieces::World();
  const Shape shape = shapes::Icosphere(2);
  for (const auto& [name, cut] : pieces::AllCuts())
  {
    SCOPED_TRACE(name);
    const Piece piece = pieces::CutOut(shape, cut(shape, group->GetSize()), group);
    const DistributedMesh mesh(piece.Surface);
    EXPECT_EQ(mesh.GetTotalNumberOfPoints(), shape.NumberOfVertices());
    EXPECT_EQ(mesh.NumberOfPoints(), static_cast<int>(piece.Vertices.size()));
    Field values = Field::Constant(mesh.NumberOfVertices(), 2, -1.0);
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      if (mesh.IsOwned(v))
      {
        const double id = static_cast<double>(mesh.GetName(v));
        values.row(v) << id, std::sqrt(id);
      }
    }
    mesh.UpdateGhosts(values);
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      const double id = 3.0 * piece.Vertices[static_cast<std::size_t>(mesh.Point(v))] + 1.0;
      EXPECT_EQ(values(v, 0), id);
      EXPECT_EQ(values(v, 1), std::sqrt(id));
    }
  }
}

TEST(DistributedPieces, RowsOfTheLaplacianAreThoseOfTheWhole)
{
  const auto group = pieces::World();
  const Shape shape = shapes::Noisy(shapes::Torus(20, 9), 0.02);
  const cartan::TriangleMesh whole(shape.NumberOfVertices(), shape.Faces);
  for (const auto weights : { cartan::LaplacianWeights::Uniform,
         cartan::LaplacianWeights::Cotangent, cartan::LaplacianWeights::MeanValue })
  {
    const cartan::SparseMatrix expected =
      cartan::Laplacian(whole, cartan::EdgeWeights(whole, shape.Positions, weights));
    const Piece piece = pieces::CutOut(shape, pieces::Scattered(shape, group->GetSize()), group);
    const DistributedMesh mesh(piece.Surface);
    const cartan::SparseMatrix rows = cartan::Laplacian(
      *mesh.GetMesh(), cartan::EdgeWeights(*mesh.GetMesh(), *mesh.GetPositions(), weights));
    const auto vertexOf = [&](int v) { return piece.Vertices[std::size_t(mesh.Point(v))]; };
    for (int column = 0; column < mesh.NumberOfVertices(); ++column)
    {
      for (cartan::SparseMatrix::InnerIterator entry(rows, column); entry; ++entry)
      {
        if (mesh.IsOwned(static_cast<int>(entry.row())))
        {
          EXPECT_NEAR(entry.value(),
            expected.coeff(vertexOf(static_cast<int>(entry.row())), vertexOf(column)), 1e-12);
        }
      }
    }
  }
}

TEST(DistributedPieces, DefectsOfTheWholeAreNamedByGlobalIds)
{
  // A third triangle at the edge of the vertices 5 and 6, wherever these are.
  Shape wing = shapes::Icosphere(2);
  const Shape sphere = wing;
  const Eigen::Vector3i first = wing.Faces.row(0);
  wing.Positions.conservativeResize(wing.Positions.rows() + 1, 3);
  wing.Positions.bottomRows<1>() << 3.0, 3.0, 3.0;
  wing.Faces.conservativeResize(wing.Faces.rows() + 1, 3);
  wing.Faces.bottomRows<1>() << first[0], first[1], wing.NumberOfVertices() - 1;
  Shape turned = sphere;
  std::swap(turned.Faces(0, 0), turned.Faces(0, 1));
  Shape lost = sphere;
  lost.Positions(17, 1) = std::numeric_limits<double>::quiet_NaN();
  // Two spheres that touch in a point.
  Shape touching = shapes::Union(sphere, sphere);
  touching.Positions.bottomRows(sphere.Positions.rows()).col(0).array() += 2.0;
  const int count = sphere.NumberOfVertices();
  touching.Faces =
    touching.Faces.unaryExpr([count](int v) { return v == count + 9 ? 9 : v; }).eval();
  const std::string smaller = std::to_string(3 * std::min(first[0], first[1]) + 1);
  for (const auto& [name, cut] : pieces::AllCuts())
  {
    SCOPED_TRACE(name);
    EXPECT_EQ(TextOfMesh(sphere, cut), "");
    EXPECT_NE(TextOfMesh(wing, cut).find("1 edge (id " + smaller + ") with more than two"),
      std::string::npos);
    EXPECT_NE(TextOfMesh(turned, cut).find("3 edges (ids "), std::string::npos);
    EXPECT_NE(TextOfMesh(turned, cut).find("opposite orientation"), std::string::npos);
    EXPECT_NE(TextOfMesh(lost, cut).find("1 point (id 52) with a NaN"), std::string::npos);
    EXPECT_NE(
      TextOfMesh(touching, cut).find("1 point (id 28) where several fans"), std::string::npos);
  }
}

TEST(DistributedPieces, GhostsWithoutAnOwnerAreRefused)
{
  const auto group = pieces::World();
  if (group->GetSize() < 2)
  {
    GTEST_SKIP() << "ghosts need two ranks";
  }
  const Shape shape = shapes::Icosphere(1);
  Piece piece = pieces::CutOut(shape, pieces::Slices(shape, group->GetSize()), group);
  const Piece made = piece;
  if (group->GetRank() == 1)
  {
    for (std::size_t i = 0; i < piece.Surface.Owners.size(); ++i)
    {
      if (piece.Surface.Owners[i] == 0)
      {
        piece.Surface.GlobalIds[i] = 1000;
        break;
      }
    }
  }
  const std::string text = SharedText(*group, [&piece] { DistributedMesh mesh(piece.Surface); });
  EXPECT_NE(text.find("1 ghost point (id 1000) of which the owner has no such"), std::string::npos)
    << text;
  EXPECT_NE(text.find(shapes::Advice("Remove the surface's global ids and ghost cells; they are "
                                     "made where they are missing.")),
    std::string::npos);
  EXPECT_EQ(SharedText(*group, [&made] { DistributedMesh mesh(made.Surface); }), "");
}

/// The problem of a bar with both ends held.
struct Bent
{
  explicit Bent(
    const pieces::Cut& cut, const Shape& shape = shapes::Bar(12, 4, 4, { 3.0, 1.0, 1.0 }))
    : Group(pieces::World())
    , Whole(pieces::WholeProblem(shape, shapes::EndsAlong(shape, 0, 0.15), { 2 }))
    , Part(pieces::CutOut(shape, cut(shape, Group->GetSize()), Group))
    , Mesh(std::make_shared<const DistributedMesh>(Part.Surface))
  {
    cartan::HandleMotion motion;
    motion.Translation << 0.0, 0.3, 0.0;
    this->Targets.Motions.push_back(motion);
  }
  std::shared_ptr<const cartan::Ranks> Group;
  cartan::HandleProblem Whole;
  Piece Part;
  std::shared_ptr<const DistributedMesh> Mesh;
  cartan::HandleTargets Targets;
};

TEST(DistributedPieces, PartsThatNothingHoldsAreNamedByGlobalIds)
{
  const Bent bent(pieces::Slices);
  cartan::HandleProblem whole = bent.Whole;
  // The moving handle is unknown, and nothing else holds the surface.
  whole.ConstrainPositions = false;
  for (int& handle : whole.Handle)
  {
    handle = handle == 2 ? 2 : 0;
  }
  const std::string text = SharedText(*bent.Group,
    [&] { cartan::RotationInvariantDeformer(pieces::PartOf(whole, bent.Part, bent.Mesh)); });
  EXPECT_NE(text.find("The system is singular"), std::string::npos) << text;
}

TEST(DistributedPieces, AnAbortOnOneRankStopsAll)
{
  for (const auto& [name, cut] : pieces::AllCuts())
  {
    for (int stopping = 0; stopping < pieces::World()->GetSize(); ++stopping)
    {
      SCOPED_TRACE(name + ", rank " + std::to_string(stopping));
      const Bent bent(cut);
      bool isSolving = false;
      const cartan::ExecutionContext context(
        nullptr, [&](double) { return !isSolving || bent.Group->GetRank() != stopping; });
      cartan::DeformedSurface result;
      std::unique_ptr<cartan::RotationInvariantDeformer> deformer;
      bent.Group->Together(
        [&]
        {
          deformer = std::make_unique<cartan::RotationInvariantDeformer>(
            pieces::PartOf(bent.Whole, bent.Part, bent.Mesh));
        });
      deformer->SetFrameProjection(cartan::FrameProjection::Rotation);
      isSolving = true;
      const auto deform = [&] { deformer->Deform(bent.Targets, false, result, context); };
      EXPECT_EQ(SharedText(*bent.Group, deform), "Stopped on request.");
      // Nothing is left behind.
      isSolving = false;
      EXPECT_EQ(SharedText(*bent.Group, deform), "");
    }
  }
}
}
