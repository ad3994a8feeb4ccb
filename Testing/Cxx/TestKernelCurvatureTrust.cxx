// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Differential/Curvature.h"

#include "TestShapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

// Each curvature is within 5 % of the closed formula, or said to be doubtful.

using namespace cartan;

namespace
{
struct Principal
{
  double Maximum;
  double Minimum;
};

/// A surface of `resolution` points around, jittered along itself.
struct Surface
{
  std::string Name;
  std::function<shapes::Shape(int resolution, double jitter, unsigned int seed)> Make;
  std::function<Principal(const Eigen::Vector3d& point)> Exact;
  /// The part of its points that may be doubtful with 80 points around.
  double LargestDoubt;
};

/// A surface of revolution about the z axis of this radius.
shapes::Shape Turned(int resolution, double jitter, unsigned int seed, double from, double to,
  const std::function<double(double z)>& radius)
{
  shapes::PatchOptions options;
  options.CountU = resolution;
  options.CountV = resolution / 2;
  options.PeriodicU = true;
  options.Jitter = jitter;
  options.Seed = seed;
  return shapes::Patch(options,
    [&](double u, double v)
    {
      const double z = from + (to - from) * v;
      return Eigen::Vector3d(radius(z) * std::cos(2 * Pi * u), radius(z) * std::sin(2 * Pi * u), z);
    });
}

Principal OfTorus(const Eigen::Vector3d& p, double major, double minor)
{
  const double cosine = (std::hypot(p[0], p[1]) - major) / minor;
  return { 1.0 / minor, cosine / (major + minor * cosine) };
}

Principal OfSaddle(const Eigen::Vector3d& p)
{
  const double w = 1.0 + p[0] * p[0] + p[1] * p[1];
  const double mean = (p[0] * p[0] - p[1] * p[1]) / (2.0 * std::pow(w, 1.5));
  const double spread = std::sqrt(mean * mean + 1.0 / (w * w));
  return { mean + spread, mean - spread };
}

const std::vector<Surface> Surfaces = {
  { "cylinder",
    [](int n, double jitter, unsigned int seed)
    { return shapes::OpenCylinder(n, n / 2, 1.0, 2.0, jitter, seed); },
    [](const Eigen::Vector3d&) {
      return Principal{ 1.0, 0.0 };
    },
    0.01 },
  { "cone",
    [](int n, double jitter, unsigned int seed)
    { return Turned(n, jitter, seed, 0.0, 1.6, [](double z) { return 1.0 - 0.5 * z; }); },
    [](const Eigen::Vector3d& p) {
      return Principal{ 2.0 / std::sqrt(5.0) / std::hypot(p[0], p[1]), 0.0 };
    },
    0.05 },
  { "sphere",
    [](int n, double jitter, unsigned int seed) {
      return Turned(n, jitter, seed, -0.95, 0.95, [](double z) { return std::sqrt(1.0 - z * z); });
    },
    [](const Eigen::Vector3d&) {
      return Principal{ 1.0, 1.0 };
    },
    0.0 },
  { "torus",
    [](int n, double jitter, unsigned int seed)
    { return shapes::Torus(n, n, 1.0, 0.5, jitter, seed); },
    [](const Eigen::Vector3d& p) { return OfTorus(p, 1.0, 0.5); }, 0.01 },
  { "catenoid",
    [](int n, double jitter, unsigned int seed)
    { return Turned(n, jitter, seed, -1.5, 1.5, [](double z) { return std::cosh(z); }); },
    [](const Eigen::Vector3d& p)
    {
      const double curvature = 1.0 / (p[0] * p[0] + p[1] * p[1]);
      return Principal{ curvature, -curvature };
    },
    0.1 },
  { "saddle",
    [](int n, double jitter, unsigned int seed)
    { return shapes::Saddle(n / 2, 2.0, jitter, seed); },
    OfSaddle, 0.15 },
};

/// Each triangle in four coplanar ones.
shapes::Shape SplitLinearly(const shapes::Shape& shape)
{
  std::vector<Eigen::Vector3d> positions;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    positions.emplace_back(shape.Positions.row(v).transpose());
  }
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b)
  {
    const auto [place, isNew] =
      middles.emplace(std::minmax(a, b), static_cast<int>(positions.size()));
    if (isNew)
    {
      positions.push_back(0.5 * (positions[a] + positions[b]));
    }
    return place->second;
  };
  std::vector<Eigen::Vector3i> faces;
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    const Eigen::Vector3i f = shape.Faces.row(t).transpose();
    const int ab = middle(f[0], f[1]);
    const int bc = middle(f[1], f[2]);
    const int ca = middle(f[2], f[0]);
    faces.emplace_back(f[0], ab, ca);
    faces.emplace_back(f[1], bc, ab);
    faces.emplace_back(f[2], ca, bc);
    faces.emplace_back(ab, bc, ca);
  }
  return { shapes::ToPoints(positions), shapes::ToTriangles(faces) };
}

Curvatures Fit(const shapes::Shape& shape)
{
  return FitCurvatures(TriangleMesh(shape.NumberOfVertices(), shape.Faces), shape.Positions);
}

int Count(const Curvatures& curvatures, CurvatureState state)
{
  return static_cast<int>(std::count(curvatures.States.begin(), curvatures.States.end(), state));
}
}

class CurvatureTrust : public testing::TestWithParam<Surface>
{
};

TEST_P(CurvatureTrust, EachPointIsRightOrDoubtful)
{
  const Surface& surface = GetParam();
  for (const double jitter : { 0.0, 0.1, 0.2, 0.3 })
  {
    for (unsigned int seed = 1; seed <= (jitter > 0.0 ? 3 : 1); ++seed)
    {
      for (const int resolution : { 8, 12, 20, 40, 80 })
      {
        const shapes::Shape shape = surface.Make(resolution, jitter, seed);
        const Curvatures curvatures = Fit(shape);
        double largest = 0.0;
        for (int v = 0; v < shape.NumberOfVertices(); ++v)
        {
          const Principal exact = surface.Exact(shape.Positions.row(v).transpose());
          const double error = std::max(std::abs(curvatures.Maximum[v] - exact.Maximum),
                                 std::abs(curvatures.Minimum[v] - exact.Minimum)) /
            std::max(std::abs(exact.Maximum), std::abs(exact.Minimum));
          if (curvatures.States[v] == CurvatureState::Determined)
          {
            largest = std::max(largest, error);
          }
        }
        EXPECT_LT(largest, 0.05) << resolution << " " << jitter << " " << seed;
        const double doubtful = 1.0 -
          Count(curvatures, CurvatureState::Determined) /
            static_cast<double>(shape.NumberOfVertices());
        EXPECT_TRUE(resolution < 80 || doubtful <= surface.LargestDoubt) << doubtful;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, CurvatureTrust, testing::ValuesIn(Surfaces),
  [](const testing::TestParamInfo<Surface>& chosen) { return chosen.param.Name; });

TEST(CurvatureOfSplitTriangles, IsDoubtfulAtEachPointForThatReason)
{
  for (const shapes::Shape& smooth : { shapes::Torus(50, 50, 1.0, 0.5), shapes::Icosphere(3),
         shapes::OpenCylinder(24, 8), shapes::OpenCylinder(40, 20, 1.0, 2.0, 0.2) })
  {
    EXPECT_EQ(Count(Fit(smooth), CurvatureState::Split), 0);
    const shapes::Shape split = SplitLinearly(smooth);
    // In single precision, too.
    for (const shapes::Shape& stored :
      { split, shapes::Shape{ split.Positions.cast<float>().cast<double>(), split.Faces } })
    {
      EXPECT_EQ(Count(Fit(stored), CurvatureState::Split), stored.NumberOfVertices());
    }
  }
}

TEST(CurvatureOfSplitTriangles, IsZeroInsideThem)
{
  // After three times, each triangle of the icosahedron has points of which no
  // neighbor's neighbor is on an edge.
  shapes::Shape shape = shapes::Icosphere(0);
  for (int i = 0; i < 4; ++i)
  {
    shape = SplitLinearly(shape);
  }
  const Curvatures curvatures = Fit(shape);
  EXPECT_GT(Count(curvatures, CurvatureState::Determined), 20 * 20);
  EXPECT_EQ(
    Count(curvatures, CurvatureState::Determined) + Count(curvatures, CurvatureState::Split),
    shape.NumberOfVertices());
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    if (curvatures.States[v] == CurvatureState::Determined)
    {
      EXPECT_LT(std::abs(curvatures.Maximum[v]), 1e-9);
      EXPECT_LT(std::abs(curvatures.Minimum[v]), 1e-9);
    }
  }
}

TEST(CurvatureOfWaves, IsRightOrDoubtfulToSevenPercentOfThatNearby)
{
  // z = sin(3 x) / 5, of curvatures 1.8 sin(3 x) / (1 + z'^2)^3/2, which are 0 on lines.
  const auto exact = [](double x)
  {
    const double slope = 0.6 * std::cos(3.0 * x);
    return 1.8 * std::sin(3.0 * x) / std::pow(1.0 + slope * slope, 1.5);
  };
  for (unsigned int seed = 1; seed <= 3; ++seed)
  {
    for (const int resolution : { 20, 40, 80 })
    {
      const shapes::Shape shape = shapes::Graph(
        resolution, 2.0, [](double x, double) { return 0.2 * std::sin(3.0 * x); }, 0.2, seed);
      const Curvatures curvatures = Fit(shape);
      const double edge = 2.0 / resolution;
      for (int v = 0; v < shape.NumberOfVertices(); ++v)
      {
        const double x = shape.Positions(v, 0);
        const double nearby = std::max(
          { std::abs(exact(x)), std::abs(exact(x - 2.0 * edge)), std::abs(exact(x + 2.0 * edge)) });
        if (curvatures.States[v] == CurvatureState::Determined)
        {
          EXPECT_NEAR(curvatures.Maximum[v], std::max(exact(x), 0.0), 0.07 * nearby);
          EXPECT_NEAR(curvatures.Minimum[v], std::min(exact(x), 0.0), 0.07 * nearby);
        }
      }
      EXPECT_GT(Count(curvatures, CurvatureState::Determined),
        resolution == 80 ? 0.9 * shape.NumberOfVertices() : 0.0);
    }
  }
}
