// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Morph/DiscreteFormsMorph.h"
#include "Kernel/Morph/IsometricMorph.h"
#include "Kernel/Morph/MorphVolume.h"
#include "Kernel/Morph/PyramidCoordinatesMorph.h"
#include "Kernel/Morph/RigidPlacement.h"
#include "Kernel/Morph/TriangleGradientMorph.h"
#include "MorphShapes.h"

#include <gtest/gtest.h>

/// A morph is of a surface: the order of vertices, triangles and corners says nothing.
namespace
{
using cartan::DiscreteFormsMorph;
using cartan::IsometricMorph;
using cartan::IsometricMorphOptions;
using cartan::KeyFrames;
using cartan::Points;
using shapes::Shape;

/// Four key frames, so that the slopes at those inside matter.
KeyFrames BentEllipsoids(const Shape& shape)
{
  KeyFrames keys = morphshapes::Keys(shape,
    { shape.Positions, morphshapes::BendAlong(shape, 2, 40.0),
      morphshapes::BendAlong(shape, 0, 70.0), 1.2 * morphshapes::BendAlong(shape, 2, -30.0) });
  return keys;
}

/// The same backwards.
KeyFrames Reversed(const KeyFrames& keys)
{
  const int last = keys.Mesh->NumberOfVertices() - 1;
  const cartan::Triangles& old = keys.Mesh->GetTriangles();
  cartan::Triangles triangles(old.rows(), 3);
  for (Eigen::Index t = 0; t < old.rows(); ++t)
  {
    const Eigen::Index from = old.rows() - 1 - t;
    triangles.row(t) << last - old(from, 2), last - old(from, 0), last - old(from, 1);
  }
  KeyFrames reversed = keys;
  reversed.Mesh = std::make_shared<const cartan::TriangleMesh>(last + 1, triangles);
  for (Points& positions : reversed.Positions)
  {
    positions = positions.colwise().reverse().eval();
  }
  return reversed;
}

std::unique_ptr<cartan::SurfaceMorph> Isometric(
  const KeyFrames& keys, IsometricMorphOptions::Method method)
{
  IsometricMorphOptions options;
  options.Type = method;
  options.LengthPolish = 2;
  return std::make_unique<IsometricMorph>(keys, options);
}

using Make = std::function<std::unique_ptr<cartan::SurfaceMorph>(const KeyFrames&)>;

std::vector<std::pair<std::string, Make>> Methods()
{
  using Transitions = DiscreteFormsMorph::Transitions;
  using Solver = DiscreteFormsMorph::FrameSolver;
  const auto forms = [](Transitions transitions) -> Make
  {
    return [transitions](const KeyFrames& keys)
    { return std::make_unique<DiscreteFormsMorph>(keys, transitions, Solver::RotationAveraging); };
  };
  const auto isometric = [](IsometricMorphOptions::Method method) -> Make
  { return [method](const KeyFrames& keys) { return Isometric(keys, method); }; };
  return { { "Rotations", forms(Transitions::Rotations) }, { "Forms", forms(Transitions::Forms) },
    { "Gradient",
      [](const KeyFrames& keys) { return std::make_unique<cartan::TriangleGradientMorph>(keys); } },
    { "Pyramid",
      [](const KeyFrames& keys)
      { return std::make_unique<cartan::PyramidCoordinatesMorph>(keys); } },
    { "Isometric", isometric(IsometricMorphOptions::Method::Automatic) },
    { "TreeStitched", isometric(IsometricMorphOptions::Method::TreeStitched) } };
}

Points At(double t, const KeyFrames& keys, const Make& make)
{
  Points positions = make(keys)->Evaluate(t, {});
  cartan::RigidPlacement(keys, cartan::AreaWeights(keys)).Place(t, positions);
  EXPECT_EQ(cartan::MorphVolume(keys).Close(t, positions), "");
  return positions;
}

TEST(MorphOrder, DoesNotMatter)
{
  // Without symmetries, which would leave equal choices.
  const KeyFrames keys =
    BentEllipsoids(shapes::Noisy(shapes::Ellipsoid(2, { 0.5, 0.7, 1.5 }), 0.02));
  const KeyFrames reversed = Reversed(keys);
  for (const auto& [name, make] : Methods())
  {
    for (const double part : { 0.2, 0.6 })
    {
      const double t = part * keys.Parameters.back();
      const Points difference =
        At(t, keys, make) - At(t, reversed, make).colwise().reverse().eval();
      // Frames are averaged, and lengths polished, until nobody sees a difference.
      EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-5) << name << " at " << t;
    }
  }
}
}
