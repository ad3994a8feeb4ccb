// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Morph/DiscreteFormsMorph.h"
#include "Kernel/Morph/IsometricMorph.h"
#include "Kernel/Morph/RigidPlacement.h"
#include "Kernel/Morph/RingFrames.h"
#include "Kernel/Morph/TriangleGradientMorph.h"
#include "MorphShapes.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <filesystem>

using cartan::DiscreteFormsMorph;
using cartan::KeyFrames;
using cartan::Points;
using morphshapes::Keys;
using morphshapes::MeasureMorph;
using morphshapes::MorphFigures;
using shapes::Shape;
using shapes::ShowFigure;

namespace
{
using Solver = DiscreteFormsMorph::FrameSolver;
using Transitions = DiscreteFormsMorph::Transitions;

/// The mesh and the mesh bent along its longest side.
KeyFrames BentKeys(const Shape& shape, double degrees)
{
  const Eigen::RowVector3d size =
    shape.Positions.colwise().maxCoeff() - shape.Positions.colwise().minCoeff();
  int axis = 0;
  size.maxCoeff(&axis);
  return Keys(shape, { shape.Positions, morphshapes::BendAlong(shape, axis, degrees) });
}

MorphFigures AtTheMiddle(const KeyFrames& keys, cartan::SurfaceMorph& morph)
{
  return MeasureMorph(keys, morph.Evaluate(0.5, {}), 0.5);
}

/// The names of the scanned and modeled meshes, by alphabet.
std::vector<std::string> MeshNames()
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(CARTAN_MESH_DIR))
  {
    if (entry.path().extension() == ".off")
    {
      names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A bar along z, and the same with a point on each of some edges about its middle, at
/// `part` of the edge; in one of both triangles only (`both` false), a triangle
/// without area closes the gap.
struct Splits
{
  Shape Clean;
  Shape Split;
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> Edges;
};

Splits SplitBar(double part, bool both)
{
  Splits result;
  result.Clean = shapes::Bar(4, 4, 24, { 1, 1, 6 });
  const cartan::TriangleMesh mesh = shapes::MakeMesh(result.Clean);
  std::vector<std::pair<int, int>> edges;
  std::vector<char> isTaken(mesh.NumberOfTriangles(), 0);
  for (int d = 0; d < mesh.NumberOfDirectedEdges() && edges.size() < 6; ++d)
  {
    const int left = mesh.LeftTriangle(d);
    const int right = mesh.LeftTriangle(mesh.Twin(d));
    const double z = 0.5 *
      (result.Clean.Positions(mesh.Origin(d), 2) + result.Clean.Positions(mesh.Neighbor(d), 2));
    if (std::abs(z - 3.0) < 0.3 && !isTaken[left] && !isTaken[right])
    {
      isTaken[left] = isTaken[right] = 1;
      edges.emplace_back(mesh.Origin(d), mesh.Neighbor(d));
    }
  }
  result.Edges.resize(static_cast<Eigen::Index>(edges.size()), 2);
  std::vector<Eigen::Vector3i> faces;
  for (int f = 0; f < mesh.NumberOfTriangles(); ++f)
  {
    faces.emplace_back(result.Clean.Faces.row(f).transpose());
  }
  int point = result.Clean.NumberOfVertices();
  for (std::size_t e = 0; e < edges.size(); ++e, ++point)
  {
    const auto [from, to] = edges[e];
    result.Edges.row(static_cast<Eigen::Index>(e)) << from, to;
    bool isFirst = true;
    for (std::size_t f = 0, count = faces.size(); f < count; ++f)
    {
      for (int c = 0; c < 3; ++c)
      {
        const Eigen::Vector3i face = faces[f];
        const int a = face[c];
        const int b = face[(c + 1) % 3];
        if (std::minmax(a, b) == std::minmax(from, to) && (both || isFirst))
        {
          isFirst = false;
          faces[f] = { a, point, face[(c + 2) % 3] };
          faces.emplace_back(point, b, face[(c + 2) % 3]);
          if (!both)
          {
            faces.emplace_back(a, b, point);
          }
          break;
        }
      }
    }
  }
  result.Split.Faces = shapes::ToTriangles(faces);
  result.Split.Positions.resize(point, 3);
  for (int v = 0; v < point; ++v)
  {
    const int onEdge = v - result.Clean.NumberOfVertices();
    result.Split.Positions.row(v) = onEdge < 0
      ? Eigen::RowVector3d(result.Clean.Positions.row(v))
      : Eigen::RowVector3d((1 - part) * result.Clean.Positions.row(result.Edges(onEdge, 0)) +
          part * result.Clean.Positions.row(result.Edges(onEdge, 1)));
  }
  return result;
}

/// The bent clean bar with the points on the edges of the bend.
Points BentSplits(const Splits& splits, double part, const Points& bent)
{
  Points positions(splits.Split.NumberOfVertices(), 3);
  positions.topRows(bent.rows()) = bent;
  for (Eigen::Index e = 0; e < splits.Edges.rows(); ++e)
  {
    positions.row(bent.rows() + e) =
      (1 - part) * bent.row(splits.Edges(e, 0)) + part * bent.row(splits.Edges(e, 1));
  }
  return positions;
}

/// Where `positions` are, without a rigid motion, from `reference`: the largest
/// distance of the points of the latter.
double ShapeDistance(const Points& reference, const Points& positions)
{
  const Points shared = positions.topRows(reference.rows());
  return (shapes::BestRigidMotion(shared, reference)(shared) - reference)
    .rowwise()
    .norm()
    .maxCoeff();
}
}

TEST(MorphOfCoarseMeshes, KeepsLengthsOfMechanicalParts)
{
  // Thin triangles, edges nearly along the normals, ring after ring of both.
  for (const std::string name : { "pipe", "joint", "mpi_triang", "anchor", "P", "beam", "boeing" })
  {
    const KeyFrames keys = BentKeys(shapes::RealMesh(name), 40);
    const double size = cartan::BoundingDiagonal(keys.Positions[0]);
    for (const Transitions transitions : { Transitions::Rotations, Transitions::Forms })
    {
      DiscreteFormsMorph morph(keys, transitions);
      const MorphFigures figures = AtTheMiddle(keys, morph);
      ShowFigure(name + ", edge rms", figures.EdgeRms);
      ShowFigure(name + ", edge max", figures.EdgeMax);
      EXPECT_LT(figures.EdgeRms, 0.002) << name;
      EXPECT_LT(figures.EdgeMax, 0.02) << name;
      EXPECT_EQ(morph.GetWarning(), "") << name;
      for (const int k : { 0, 1 })
      {
        Points positions = morph.Evaluate(k, {});
        cartan::RigidPlacement(keys, Eigen::VectorXd::Ones(positions.rows())).Place(k, positions);
        EXPECT_LT((positions - keys.Positions[k]).rowwise().norm().maxCoeff(), 1e-9 * size) << name;
      }
    }
  }
}

TEST(MorphOfCoarseMeshes, KeepsLengthsOfAllRealMeshesAsTheIsometricMorphDoes)
{
  int count = 0;
  MorphFigures worst;
  for (const std::string& name : MeshNames())
  {
    const Shape shape = shapes::RealMesh(name);
    KeyFrames keys;
    try
    {
      if (shape.NumberOfVertices() > 7000)
      {
        continue;
      }
      keys = BentKeys(shape, 40);
    }
    catch (const cartan::Error&)
    {
      continue; // no oriented manifold
    }
    ++count;
    DiscreteFormsMorph morph(keys);
    const MorphFigures figures = AtTheMiddle(keys, morph);
    cartan::IsometricMorph isometric(keys);
    const MorphFigures byHinges = AtTheMiddle(keys, isometric);
    EXPECT_LT(figures.EdgeRms, 3.0 * byHinges.EdgeRms + 5e-4) << name;
    EXPECT_LT(figures.EdgeMax, 3.0 * byHinges.EdgeMax + 3e-3) << name;
    EXPECT_EQ(morph.GetWarning(), "") << name;
    worst.EdgeRms = std::max(worst.EdgeRms, figures.EdgeRms);
    worst.EdgeMax = std::max(worst.EdgeMax, figures.EdgeMax);
  }
  ShowFigure("meshes", count);
  ShowFigure("edge rms, at worst", worst.EdgeRms);
  ShowFigure("edge max, at worst", worst.EdgeMax);
  EXPECT_GT(count, 100);
  EXPECT_LT(worst.EdgeRms, 0.005);
  EXPECT_LT(worst.EdgeMax, 0.03);
}

TEST(MorphOfCoarseMeshes, WarnsOfLengthsThatAreOff)
{
  // So far that the inner side turns inside out.
  const KeyFrames keys = BentKeys(shapes::RealMesh("dragknob"), 150);
  DiscreteFormsMorph morph(keys);
  const MorphFigures figures = AtTheMiddle(keys, morph);
  for (const std::string part : { "25 %", "from point", "Isometric", "key frame in between" })
  {
    EXPECT_NE(morph.GetWarning().find(part), std::string::npos) << morph.GetWarning();
  }
  EXPECT_NE(
    morph.GetWarning().find("by " + std::to_string(std::lround(100 * figures.EdgeMax)) + " %"),
    std::string::npos)
    << figures.EdgeMax << ": " << morph.GetWarning();
  morph.Evaluate(1.0, {});
  EXPECT_EQ(morph.GetWarning(), "");

  cartan::IsometricMorph isometric(keys);
  const MorphFigures byHinges = AtTheMiddle(keys, isometric);
  EXPECT_LT(byHinges.EdgeRms, 0.6 * figures.EdgeRms);
  EXPECT_LT(byHinges.EdgeMax, 0.6 * figures.EdgeMax);
}

TEST(MorphOfCoarseMeshes, TheIsometricMorphWarnsOfLengthsToo)
{
  const Shape tube = shapes::OpenCylinder(8, 12, 1.0, 6.0);
  const KeyFrames keys = Keys(tube, { tube.Positions, morphshapes::Bend(tube, 400.0, 0.0, 6.0) });
  cartan::IsometricMorph morph(keys);
  const MorphFigures figures = MeasureMorph(keys, morph.Evaluate(0.7, {}), 0.7);
  EXPECT_GT(figures.EdgeMax, 0.25);
  const std::string figure = "by " + std::to_string(std::lround(100 * figures.EdgeMax)) + " %";
  for (const std::string& part : { std::string("by more than 25 %"), figure })
  {
    EXPECT_NE(morph.GetWarning().find(part), std::string::npos) << morph.GetWarning();
  }
  morph.Evaluate(1.0, {});
  EXPECT_EQ(morph.GetWarning(), "");
}

TEST(MorphOfCoarseMeshes, KeepsLengthsWithAKeyFrameInBetween)
{
  const Shape shape = shapes::RealMesh("anchor");
  const KeyFrames keys = BentKeys(shape, 300);
  DiscreteFormsMorph morph(keys);
  const MorphFigures figures = AtTheMiddle(keys, morph);
  EXPECT_NE(morph.GetWarning(), "");
  const Points half = BentKeys(shape, 150).Positions[1];
  DiscreteFormsMorph withThree(Keys(shape, { keys.Positions[0], half, keys.Positions[1] }));
  const KeyFrames first = Keys(shape, { keys.Positions[0], half });
  const KeyFrames second = Keys(shape, { half, keys.Positions[1] });
  for (const auto& [between, t] : { std::pair(first, 0.25), std::pair(second, 0.75) })
  {
    const MorphFigures shorter = MeasureMorph(between, withThree.Evaluate(t, {}), 0.5);
    EXPECT_LT(shorter.EdgeRms, 0.5 * figures.EdgeRms) << t;
    EXPECT_LT(shorter.EdgeMax, 0.5 * figures.EdgeMax) << t;
    EXPECT_EQ(withThree.GetWarning(), "") << t;
  }
}

TEST(MorphOfCoarseMeshes, ShortEdgesAndTrianglesWithoutAreaDoNotSpoilTheRest)
{
  const auto makers = std::vector<
    std::pair<std::string, std::function<std::unique_ptr<cartan::SurfaceMorph>(const KeyFrames&)>>>{
    { "rotations",
      [](const KeyFrames& keys) { return std::make_unique<DiscreteFormsMorph>(keys); } },
    { "forms",
      [](const KeyFrames& keys)
      { return std::make_unique<DiscreteFormsMorph>(keys, Transitions::Forms); } },
    { "direct",
      [](const KeyFrames& keys) {
        return std::make_unique<DiscreteFormsMorph>(keys, Transitions::Rotations, Solver::Direct);
      } },
    { "isometric",
      [](const KeyFrames& keys) { return std::make_unique<cartan::IsometricMorph>(keys); } },
    { "gradient",
      [](const KeyFrames& keys) { return std::make_unique<cartan::TriangleGradientMorph>(keys); } },
  };
  for (const auto& [part, both] :
    { std::pair(0.5, false), std::pair(1e-2, true), std::pair(1e-4, true), std::pair(1e-6, true),
      std::pair(1e-8, true), std::pair(1e-10, true), std::pair(1e-13, true) })
  {
    const Splits splits = SplitBar(part, both);
    const Points bent = morphshapes::Bend(splits.Clean, 90, 1, 5);
    const KeyFrames clean = Keys(splits.Clean, { splits.Clean.Positions, bent });
    const KeyFrames split =
      Keys(splits.Split, { splits.Split.Positions, BentSplits(splits, part, bent) });
    for (const auto& [name, make] : makers)
    {
      const Points expected = make(clean)->Evaluate(0.5, {});
      const Points positions = make(split)->Evaluate(0.5, {});
      ASSERT_TRUE(positions.allFinite()) << name << ", " << part;
      EXPECT_LT(ShapeDistance(expected, positions), 0.01) << name << ", " << part;
    }
  }
}

TEST(RingFrames, FollowTheRingsAndNothingElse)
{
  const Shape torus = shapes::Torus(24, 12, 2.0, 0.7, 0.2);
  Points squashed = torus.Positions;
  squashed.col(2) *= 1.5;
  const cartan::TriangleMesh mesh = shapes::MakeMesh(torus);
  const std::vector<cartan::Matrices> frames =
    cartan::RingFrames(mesh, { torus.Positions, squashed });
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(3, 10.0);
  const std::vector<cartan::Matrices> moved =
    cartan::RingFrames(mesh, { torus.Positions, motion(squashed) });
  const std::vector<cartan::Matrices> reversed =
    cartan::RingFrames(mesh, { squashed, torus.Positions });
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const Eigen::Matrix3d second = cartan::MatrixAt(frames[1], v);
    EXPECT_LT((second.transpose() * second - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_GT(second.determinant(), 0.0);
    EXPECT_LT((cartan::MatrixAt(moved[0], v) - cartan::MatrixAt(frames[0], v)).norm(), 1e-9);
    EXPECT_LT((cartan::MatrixAt(moved[1], v) - motion.Rotation * second).norm(), 1e-9);
    EXPECT_LT((cartan::MatrixAt(reversed[0], v) - second).norm(), 1e-9);
    EXPECT_LT((cartan::MatrixAt(reversed[1], v) - cartan::MatrixAt(frames[0], v)).norm(), 1e-9);
  }
}

TEST(DiscreteFormsMorph, ProgressNeverRunsBack)
{
  const Shape bar = shapes::Bar(4, 4, 24, { 1, 1, 6 });
  const KeyFrames keys = Keys(bar, { bar.Positions, morphshapes::Twist(bar, 180, 1, 5) });
  for (const Solver solver :
    { Solver::RotationAveraging, Solver::ConjugateGradients, Solver::Direct })
  {
    double last = 0.0;
    const cartan::ExecutionContext context({},
      [&](double fraction)
      {
        EXPECT_GE(fraction, last);
        last = fraction;
        return true;
      });
    DiscreteFormsMorph morph(keys, Transitions::Rotations, solver, context);
    EXPECT_EQ(last, 1.0);
    last = 0.0;
    morph.Evaluate(0.5, context);
    EXPECT_EQ(last, 1.0);
  }
}
