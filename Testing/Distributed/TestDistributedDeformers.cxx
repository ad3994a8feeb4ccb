// SPDX-License-Identifier: BSD-3-Clause
#include "AdviceWords.h"
#include "CountedMessages.h"
#include "Pieces.h"
#include "RealMeshes.h"

#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/PoissonDeformer.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"
#include "Kernel/Mesh/Geometry.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using cartan::DistributedMesh;
using cartan::HandleProblem;
using cartan::HandleTargets;
using pieces::Piece;
using shapes::Shape;

using MakeDeformer = std::function<std::unique_ptr<cartan::SurfaceDeformer>(HandleProblem)>;

template <typename Deformer, typename Configure>
MakeDeformer Maker(const Configure& configure)
{
  return [configure](HandleProblem problem)
  {
    auto deformer = std::make_unique<Deformer>(std::move(problem));
    configure(*deformer);
    return deformer;
  };
}

std::map<std::string, MakeDeformer> AllMethods()
{
  using cartan::FrameProjection;
  const auto project = [](FrameProjection projection)
  {
    return [projection](cartan::RotationInvariantDeformer& deformer)
    { deformer.SetFrameProjection(projection); };
  };
  return {
    { "raw", Maker<cartan::RotationInvariantDeformer>(project(FrameProjection::None)) },
    { "projected", Maker<cartan::RotationInvariantDeformer>(project(FrameProjection::Rotation)) },
    { "shape preserving",
      Maker<cartan::ShapePreservingDeformer>([](cartan::ShapePreservingDeformer&) {}) },
    { "Poisson",
      [](HandleProblem problem)
      {
        return std::make_unique<cartan::PoissonDeformer>(
          std::move(problem), cartan::Propagation::Harmonic);
      } },
  };
}

cartan::HandleMotion Motion(const Eigen::Vector3d& rotation, const Eigen::Vector3d& translation)
{
  cartan::HandleMotion motion;
  motion.RotationVector = rotation;
  motion.Linear = cartan::RotationFromVector(rotation);
  motion.Translation = translation;
  return motion;
}

/// Turns about one axis, in parts of the size of the shape.
HandleTargets Turns(const HandleProblem& whole, double angle)
{
  const double size = cartan::BoundingDiagonal(*whole.Rest);
  HandleTargets targets;
  for (std::size_t k = 0; k < whole.Moving.size(); ++k)
  {
    const double part = static_cast<double>(k + 1) / static_cast<double>(whole.Moving.size());
    targets.Motions.push_back(Motion(part * angle * Eigen::Vector3d(0.6, 0.0, 0.8),
      0.1 * size * Eigen::Vector3d(0.3, -part, 0.2)));
  }
  return targets;
}

/// The largest distance between the vertices of a piece and those of the whole, in parts of
/// the diagonal.
double Difference(const cartan::Points& ofPiece, const cartan::Points& ofWhole, const Piece& piece,
  const DistributedMesh& mesh)
{
  double largest = 0.0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const int vertex = piece.Vertices[static_cast<std::size_t>(mesh.Point(v))];
    largest = std::max(largest, (ofPiece.row(v) - ofWhole.row(vertex)).norm());
  }
  return largest / mesh.GetDiagonal();
}

cartan::DeformedSurface OnOneProcess(
  const HandleProblem& whole, const MakeDeformer& make, const HandleTargets& targets)
{
  cartan::DeformedSurface result;
  make(whole)->Deform(targets, true, result, {});
  return result;
}

/// Deforms in pieces.
void ExpectSame(const HandleProblem& whole, const Piece& piece, const MakeDeformer& make,
  const HandleTargets& targets, const cartan::DeformedSurface& expected)
{
  const auto mesh = std::make_shared<const DistributedMesh>(piece.Surface);
  cartan::DeformedSurface result;
  piece.Surface.Group->Together(
    [&] { make(pieces::PartOf(whole, piece, mesh))->Deform(targets, true, result, {}); });
  EXPECT_LE(Difference(result.Positions, expected.Positions, piece, *mesh), 1e-8);
  for (int v = 0; v < mesh->NumberOfVertices(); ++v)
  {
    const int vertex = piece.Vertices[static_cast<std::size_t>(mesh->Point(v))];
    EXPECT_LE((result.Transforms.row(v) - expected.Transforms.row(vertex)).norm(), 1e-7);
  }
}

void ExpectSame(const HandleProblem& whole, const Piece& piece, const MakeDeformer& make,
  const HandleTargets& targets)
{
  ExpectSame(whole, piece, make, targets, OnOneProcess(whole, make, targets));
}

std::map<std::string, Shape> AllShapes()
{
  return { { "bar", shapes::Bar(12, 4, 4, { 3.0, 1.0, 1.0 }) },
    { "noisy ellipsoid", shapes::Noisy(shapes::Ellipsoid(3, { 3.0, 1.0, 2.0 }), 0.01) },
    { "torus", shapes::Torus(30, 14) }, { "camel", shapes::RealMesh("camel") } };
}

TEST(DistributedDeformers, PiecesMoveLikeTheWhole)
{
  const auto group = pieces::World();
  for (const auto& [shapeName, shape] : AllShapes())
  {
    const HandleProblem whole =
      pieces::WholeProblem(shape, shapes::EndsAlong(shape, 0, 0.15), { 2 });
    const HandleTargets targets = Turns(whole, 1.1);
    for (const auto& [methodName, make] : AllMethods())
    {
      const cartan::DeformedSurface expected = OnOneProcess(whole, make, targets);
      for (const auto& [cutName, cut] : pieces::AllCuts())
      {
        if (shapeName == "camel" && cutName == "scattered")
        {
          continue; // it takes long, as most messages are short
        }
        SCOPED_TRACE(shapeName + ", " + cutName + ", " + methodName);
        const Piece piece = pieces::CutOut(shape, cut(shape, group->GetSize()), group);
        ExpectSame(whole, piece, make, targets, expected);
      }
    }
  }
}

TEST(DistributedDeformers, HandlesThatAreAllMovingGiveTheSame)
{
  const auto group = pieces::World();
  const Shape shape = shapes::Torus(30, 14);
  const HandleProblem whole =
    pieces::WholeProblem(shape, shapes::EndsAlong(shape, 0, 0.2), { 1, 2 });
  for (const auto& [cutName, cut] : pieces::AllCuts())
  {
    const Piece piece = pieces::CutOut(shape, cut(shape, group->GetSize()), group);
    for (const auto& [methodName, make] : AllMethods())
    {
      SCOPED_TRACE(cutName + ", " + methodName);
      ExpectSame(whole, piece, make, Turns(whole, 0.8));
      // All alike: rigid.
      HandleTargets alike = Turns(whole, 0.8);
      alike.Motions[1] = alike.Motions[0];
      ExpectSame(whole, piece, make, alike);
    }
  }
}

TEST(DistributedDeformers, SettingsOfTheProblemGiveTheSame)
{
  const auto group = pieces::World();
  const Shape shape = shapes::Noisy(shapes::Ellipsoid(3, { 3.0, 1.0, 2.0 }), 0.01);
  const Piece piece = pieces::CutOut(shape, pieces::Scattered(shape, group->GetSize()), group);
  const HandleProblem plain = pieces::WholeProblem(shape, shapes::EndsAlong(shape, 0, 0.15), { 2 });
  std::map<std::string, HandleProblem> problems;
  for (const cartan::LaplacianWeights weights :
    { cartan::LaplacianWeights::Uniform, cartan::LaplacianWeights::MeanValue })
  {
    HandleProblem& problem = problems["weights " + std::to_string(static_cast<int>(weights))];
    problem = plain;
    problem.Weights = weights;
  }
  problems["free places"] = plain;
  problems["free places"].ConstrainPositions = false;
  problems["many handles"] = plain;
  problems["many handles"].StoredHandles = 1;
  HandleProblem& soft = problems["soft"] = plain;
  soft.SoftWeights = Eigen::VectorXd::Zero(shape.NumberOfVertices());
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    soft.SoftWeights[v] = soft.Handle[v] == 1 ? std::numeric_limits<double>::infinity()
      : soft.Handle[v] == 2                   ? 0.5 + 0.1 * (v % 7)
                                              : 0.0;
  }
  for (const auto& [name, problem] : problems)
  {
    for (const auto& [methodName, make] : AllMethods())
    {
      SCOPED_TRACE(name + ", " + methodName);
      ExpectSame(problem, piece, make, Turns(problem, 0.8));
    }
  }
}

TEST(DistributedDeformers, PartsThatNoHandleReachesStay)
{
  const auto group = pieces::World();
  Shape far = shapes::Icosphere(2);
  far.Positions.col(1).array() += 10.0;
  const Shape shape = shapes::Union(shapes::Bar(12, 4, 4, { 3.0, 1.0, 1.0 }), far);
  const auto ends = shapes::EndsAlong(shapes::Bar(12, 4, 4, { 3.0, 1.0, 1.0 }), 0, 0.15);
  const HandleProblem whole = pieces::WholeProblem(
    shape, [&ends](const Eigen::Vector3d& x) { return x[1] < 5.0 ? ends(x) : 0; }, { 2 });
  const Piece piece = pieces::CutOut(shape, pieces::Scattered(shape, group->GetSize()), group);
  const auto mesh = std::make_shared<const DistributedMesh>(piece.Surface);
  cartan::RotationInvariantDeformer deformer(pieces::PartOf(whole, piece, mesh));
  cartan::DeformedSurface result;
  group->Together([&] { deformer.Deform(Turns(whole, 0.8), false, result, {}); });
  int still = 0;
  for (int v = 0; v < mesh->NumberOfVertices(); ++v)
  {
    const int vertex = piece.Vertices[static_cast<std::size_t>(mesh->Point(v))];
    if (shape.Positions(vertex, 1) > 5.0)
    {
      EXPECT_EQ(result.Positions.row(v), whole.Rest->row(vertex));
      ++still;
    }
  }
  Eigen::VectorXd total = Eigen::VectorXd::Constant(1, still);
  group->Sum(total);
  EXPECT_GE(total[0], far.NumberOfVertices());
}

TEST(DistributedDeformers, RawMotionsSendNoMessageAfterTheFirst)
{
  const auto group = pieces::World();
  const Shape shape = shapes::Torus(30, 14);
  const HandleProblem whole =
    pieces::WholeProblem(shape, shapes::EndsAlong(shape, 0, 0.15), { 1, 2 });
  const Piece piece = pieces::CutOut(shape, pieces::Slices(shape, group->GetSize()), group);
  const auto mesh = std::make_shared<const DistributedMesh>(piece.Surface);
  cartan::RotationInvariantDeformer deformer(pieces::PartOf(whole, piece, mesh));
  cartan::RotationInvariantDeformer alone(whole);
  deformer.SetFrameProjection(cartan::FrameProjection::None);
  alone.SetFrameProjection(cartan::FrameProjection::None);
  cartan::DeformedSurface result;
  deformer.Deform(Turns(whole, 0.3), false, result, {});
  const long long before = CountedMessages();
  EXPECT_GT(before, 0);
  const std::int64_t own = group->GetNumberOfMessages();
  for (const double angle : { 0.2, 0.9, -0.4 })
  {
    deformer.Deform(Turns(whole, angle), false, result, {});
    EXPECT_EQ(CountedMessages(), before);
    EXPECT_EQ(group->GetNumberOfMessages(), own);
    cartan::DeformedSurface expected;
    alone.Deform(Turns(whole, angle), false, expected, {});
    EXPECT_LE(Difference(result.Positions, expected.Positions, piece, *mesh), 1e-8);
  }
}

TEST(DistributedDeformers, DifferentAxesAreNotRefined)
{
  const auto group = pieces::World();
  const Shape shape = shapes::Torus(30, 14);
  const HandleProblem whole =
    pieces::WholeProblem(shape, shapes::EndsAlong(shape, 0, 0.15), { 1, 2 });
  const Piece piece = pieces::CutOut(shape, pieces::Slices(shape, group->GetSize()), group);
  const auto mesh = std::make_shared<const DistributedMesh>(piece.Surface);
  HandleTargets targets = Turns(whole, 0.5);
  // Relative to the first handle, one axis remains; three handles would be needed for more.
  HandleProblem pinned = whole;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    pinned.Handle[v] = pinned.Handle[v] == 0 && shape.Positions(v, 1) > 2.0 ? 3 : pinned.Handle[v];
  }
  targets.Motions[1] = Motion({ 0.0, 0.5, 0.0 }, { 0.1, 0.0, 0.0 });
  cartan::ShapePreservingDeformer deformer(pieces::PartOf(pinned, piece, mesh));
  deformer.SetIteration(5, 1e-6);
  cartan::DeformedSurface result;
  try
  {
    group->Together([&] { deformer.Deform(targets, false, result, {}); });
    FAIL() << "no error";
  }
  catch (const cartan::Error& error)
  {
    EXPECT_NE(std::string(error.what())
                .find(shapes::Advice("set MaximumIterations to 1, or gather the surface.")),
      std::string::npos);
  }
  deformer.SetIteration(1, 1e-6);
  group->Together([&] { deformer.Deform(targets, false, result, {}); });
  EXPECT_FALSE(deformer.HasSharedAxis());
  cartan::DeformedSurface expected;
  cartan::ShapePreservingDeformer(pinned).Deform(targets, false, expected, {});
  EXPECT_LE(Difference(result.Positions, expected.Positions, piece, *mesh), 1e-8);
}

TEST(DistributedDeformers, WhatPiecesAreNotServedIsRefused)
{
  const auto group = pieces::World();
  const Shape shape = shapes::Torus(30, 14);
  const HandleProblem whole = pieces::WholeProblem(shape, shapes::EndsAlong(shape, 0, 0.15), { 2 });
  const Piece piece = pieces::CutOut(shape, pieces::Slices(shape, group->GetSize()), group);
  const auto mesh = std::make_shared<const DistributedMesh>(piece.Surface);
  const HandleProblem part = pieces::PartOf(whole, piece, mesh);
  const auto textOf = [&](cartan::SurfaceDeformer& deformer, const HandleTargets& targets)
  {
    std::string text;
    cartan::DeformedSurface result;
    try
    {
      group->Together([&] { deformer.Deform(targets, false, result, {}); });
    }
    catch (const cartan::Error& error)
    {
      text = error.what();
    }
    return text;
  };
  const HandleTargets targets = Turns(whole, 0.5);
  const std::string gather = shapes::Advice("gather the surface on one process.");
  cartan::ShapePreservingDeformer deformer(part);
  EXPECT_EQ(textOf(deformer, targets), "");
  deformer.SetVolumeModel(std::make_shared<const cartan::VolumeModel>());
  EXPECT_EQ(textOf(deformer, targets), "");
  deformer.SetVolumeCorrection(cartan::VolumeCorrection::FrameScaling);
  EXPECT_NE(textOf(deformer, targets).find(gather), std::string::npos);
  deformer.SetVolumeCorrection(cartan::VolumeCorrection::None);
  HandleTargets arrays = targets;
  for (int v = 0; v < mesh->NumberOfVertices(); ++v)
  {
    arrays.Vertices.push_back(v);
  }
  arrays.Positions = *part.Rest;
  EXPECT_NE(textOf(deformer, arrays)
              .find(shapes::Advice("give each handle a motion instead of arrays of targets, or "
                                   "gather the surface on one process.")),
    std::string::npos);
  cartan::PoissonDeformer geodesic(part, cartan::Propagation::Geodesic);
  EXPECT_NE(textOf(geodesic, targets).find(gather), std::string::npos);
}

/// A handle turns about one axis: each method that tabulates it.
template <typename Deformer>
void ExpectSilentTable()
{
  const auto group = pieces::World();
  const Shape shape = shapes::Noisy(shapes::Ellipsoid(3, { 3.0, 1.0, 2.0 }), 0.01);
  const HandleProblem whole = pieces::WholeProblem(shape, shapes::EndsAlong(shape, 0, 0.15), { 2 });
  const Piece piece = pieces::CutOut(shape, pieces::Slices(shape, group->GetSize()), group);
  const auto mesh = std::make_shared<const DistributedMesh>(piece.Surface);
  Deformer deformer(pieces::PartOf(whole, piece, mesh));
  Deformer alone(whole);
  const double tolerance = 1e-5;
  deformer.SetTurnTable({ 2.0, tolerance * mesh->GetDiagonal() });
  cartan::DeformedSurface result;
  // The table is made for the second motion with its ratio.
  deformer.Deform(Turns(whole, 0.3), false, result, {});
  deformer.Deform(Turns(whole, 0.4), false, result, {});
  const long long before = CountedMessages();
  for (const double angle : { 0.2, 1.7, -0.9 })
  {
    deformer.Deform(Turns(whole, angle), false, result, {});
    EXPECT_NE(deformer.GetUsedTable(), nullptr);
    EXPECT_EQ(CountedMessages(), before);
    cartan::DeformedSurface expected;
    alone.Deform(Turns(whole, angle), false, expected, {});
    EXPECT_LE(Difference(result.Positions, expected.Positions, piece, *mesh), tolerance);
  }
}

TEST(DistributedDeformers, MotionsByTheTableSendNoMessage)
{
  ExpectSilentTable<cartan::RotationInvariantDeformer>();
  ExpectSilentTable<cartan::ShapePreservingDeformer>();
}
}
