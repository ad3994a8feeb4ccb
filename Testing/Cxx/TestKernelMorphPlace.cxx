// SPDX-License-Identifier: BSD-3-Clause
// Morphs whose parts are at different parameters, and blends of several key frames.
#include "MorphShapes.h"

#include "Kernel/Measure/ComponentVolumes.h"
#include "Kernel/Morph/DiscreteFormsMorph.h"
#include "Kernel/Morph/IsometricMorph.h"
#include "Kernel/Morph/LinearMorph.h"
#include "Kernel/Morph/PyramidCoordinatesMorph.h"
#include "Kernel/Morph/RigidPlacement.h"
#include "Kernel/Morph/TriangleGradientMorph.h"

#include <gtest/gtest.h>

using cartan::KeyFrames;
using cartan::MorphPlace;
using cartan::Points;
using morphshapes::Bend;
using morphshapes::Keys;
using morphshapes::Twist;
using shapes::Shape;

namespace
{
using MakeMorph = std::function<std::unique_ptr<cartan::SurfaceMorph>(const KeyFrames&)>;

const std::vector<std::pair<std::string, MakeMorph>>& Methods()
{
  static const std::vector<std::pair<std::string, MakeMorph>> methods = {
    { "forms",
      [](const KeyFrames& keys) { return std::make_unique<cartan::DiscreteFormsMorph>(keys); } },
    { "isometric",
      [](const KeyFrames& keys) { return std::make_unique<cartan::IsometricMorph>(keys); } },
    { "gradient",
      [](const KeyFrames& keys) { return std::make_unique<cartan::TriangleGradientMorph>(keys); } },
    { "pyramid",
      [](const KeyFrames& keys)
      { return std::make_unique<cartan::PyramidCoordinatesMorph>(keys); } },
    { "linear", [](const KeyFrames& keys) { return std::make_unique<cartan::LinearMorph>(keys); } }
  };
  return methods;
}

/// A bar along z from 0 to 6.
Shape LongBar()
{
  Shape bar = shapes::Bar(2, 2, 12, { 1.0, 1.0, 6.0 });
  bar.Positions.rowwise() -= bar.Positions.colwise().minCoeff().eval();
  return bar;
}

/// Evaluated and placed.
Points At(
  const std::string& name, const MakeMorph& make, const KeyFrames& keys, const MorphPlace& place)
{
  Points positions = make(keys)->Evaluate(place, {});
  if (name != "linear")
  {
    cartan::RigidPlacement(keys, cartan::AreaWeights(keys)).Place(place, positions);
  }
  return positions;
}

double Difference(const Points& a, const Points& b)
{
  return (a - b).rowwise().norm().maxCoeff();
}

double Volume(const KeyFrames& keys, const Points& positions)
{
  return cartan::MeasureComponents(*keys.Mesh, positions)[0].Volume;
}
}

TEST(MorphPlace, OneParameterForAllIsAMorph)
{
  const Shape bar = LongBar();
  const KeyFrames keys =
    Keys(bar, { bar.Positions, Bend(bar, 80.0, 2.0, 4.0), Twist(bar, 100.0, 1.0, 5.0) });
  for (const auto& [name, make] : Methods())
  {
    for (const double t : { 0.3, 0.8 })
    {
      const Eigen::VectorXd all = Eigen::VectorXd::Constant(bar.NumberOfVertices(), t);
      EXPECT_LT(
        Difference(At(name, make, keys, MorphPlace::Local(all, t)), At(name, make, keys, t)), 1e-9)
        << name << t;
    }
  }
}

TEST(MorphPlace, TwoWeightsAreAParameter)
{
  const Shape bar = LongBar();
  const KeyFrames keys = Keys(bar, { bar.Positions, Bend(bar, 80.0, 2.0, 4.0) });
  for (const auto& [name, make] : Methods())
  {
    const MorphPlace blend = MorphPlace::Blend(Eigen::Vector2d(0.3, 0.7), keys.Parameters);
    EXPECT_LT(Difference(At(name, make, keys, blend), At(name, make, keys, 0.7)), 1e-8) << name;
  }
}

// Where both key frames have the same shape, the parameter makes no difference. Forms, lengths
// and angles do not tell the end above z = 5 from itself at rest; coordinates do. Triangles'
// rotations are relative to the mean, so DeformationGradient has no such part.
TEST(MorphPlace, PartsArriveAtDifferentTimes)
{
  const Shape bar = LongBar();
  const KeyFrames keys = Keys(bar, { bar.Positions, Bend(bar, 90.0, 2.0, 4.0) });
  for (const auto& [name, make] : Methods())
  {
    if (name == "gradient")
    {
      continue;
    }
    Eigen::VectorXd parameters(bar.NumberOfVertices());
    for (int v = 0; v < bar.NumberOfVertices(); ++v)
    {
      const double z = bar.Positions(v, 2);
      const bool isRest = z < 1.2 || (z > 4.8 && name != "linear");
      parameters[v] = isRest ? 0.0 : 1.0;
    }
    const Points result = At(name, make, keys, MorphPlace::Local(parameters, parameters.mean()));
    // Up to the place of the whole: all distances are those of the last key frame.
    for (int v = 0; v < bar.NumberOfVertices(); v += 7)
    {
      for (int w = 0; w < v; w += 5)
      {
        EXPECT_NEAR((result.row(v) - result.row(w)).norm(),
          (keys.Positions[1].row(v) - keys.Positions[1].row(w)).norm(), 1e-6)
          << name << v << " " << w;
      }
    }
  }
}

// Bends about one axis add up, wherever they are along the bar, and keep the volume.
TEST(MorphPlace, BlendsAddBendsWithoutShrinking)
{
  const Shape bar = LongBar();
  const KeyFrames keys =
    Keys(bar, { bar.Positions, Bend(bar, 90.0, 1.0, 3.0), Bend(bar, -120.0, 3.0, 5.0) });
  const MorphPlace place = MorphPlace::Blend(Eigen::Vector3d(0.2, 0.4, 0.4), keys.Parameters);
  for (const auto& [name, make] : Methods())
  {
    const Points result = At(name, make, keys, place);
    // The ends are at 36 - 48 degrees to each other: the angle of the edges along the bar.
    const auto along = [&](double z) -> Eigen::RowVector3d
    {
      int low = 0;
      int high = 0;
      for (int v = 0; v < bar.NumberOfVertices(); ++v)
      {
        if (bar.Positions(v, 0) == 0.0 && bar.Positions(v, 1) == 0.0)
        {
          low = std::abs(bar.Positions(v, 2) - z) < 1e-9 ? v : low;
          high = std::abs(bar.Positions(v, 2) - z - 0.5) < 1e-9 ? v : high;
        }
      }
      return (result.row(high) - result.row(low)).normalized();
    };
    const double angle = std::acos(along(0.0).dot(along(5.5))) * 180.0 / shapes::Pi;
    const double lost = 1.0 - Volume(keys, result) / Volume(keys, bar.Positions);
    if (name == "linear")
    {
      EXPECT_GT(lost, 0.1);
    }
    else
    {
      EXPECT_NEAR(angle, 12.0, 2.0) << name;
      EXPECT_LT(std::abs(lost), 0.05) << name;
    }
  }
}

TEST(MorphPlace, AUnitWeightIsAKeyFrameAndOrderDoesNotMatter)
{
  const Shape bar = LongBar();
  const Points bent = Bend(bar, 90.0, 1.0, 3.0);
  const Points twisted = Twist(bar, 70.0, 1.0, 5.0);
  const KeyFrames keys = Keys(bar, { bar.Positions, bent, twisted });
  const KeyFrames swapped = Keys(bar, { bar.Positions, twisted, bent });
  for (const auto& [name, make] : Methods())
  {
    const auto blend = [&, m = make, n = name](const KeyFrames& of, double a, double b, double c)
    { return At(n, m, of, MorphPlace::Blend(Eigen::Vector3d(a, b, c), of.Parameters)); };
    EXPECT_LT(Difference(blend(keys, 0.0, 1.0, 0.0), bent), 1e-6) << name;
    EXPECT_LT(Difference(blend(keys, 0.0, 0.0, 1.0), twisted), 1e-6) << name;
    // The frames of one-rings follow from one key frame to the next.
    EXPECT_LT(Difference(blend(keys, 0.5, 0.2, 0.3), blend(swapped, 0.5, 0.3, 0.2)),
      name == "forms" ? 2e-3 : 1e-6)
      << name;
  }
}
