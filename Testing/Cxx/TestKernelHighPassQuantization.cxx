// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Compression/HighPassQuantization.h"

#include "Kernel/Base/Error.h"
#include "Kernel/Compression/QualitySearch.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

using cartan::HighPassCode;
using cartan::HighPassCoder;
using cartan::Points;
using cartan::TriangleMesh;
using shapes::MakeMesh;
using shapes::Shape;

namespace
{
Shape UnitMesh(const std::string& name)
{
  Shape shape = shapes::RealMesh(name);
  shape.Positions /=
    (shape.Positions.colwise().maxCoeff() - shape.Positions.colwise().minCoeff()).norm();
  return shape;
}

double RootMeanSquare(const Eigen::VectorXd& values)
{
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

/// How rough rounding positions to so many bits of the bounding box is.
double RoughnessOfPositions(const Shape& shape, const TriangleMesh& mesh, int bits)
{
  const Eigen::RowVector3d corner = shape.Positions.colwise().minCoeff();
  const double step =
    (shape.Positions.colwise().maxCoeff() - corner).maxCoeff() / (std::ldexp(1.0, bits) - 1.0);
  Points rounded = shape.Positions;
  for (Eigen::Index v = 0; v < rounded.rows(); ++v)
  {
    rounded.row(v) = corner.array() + step * ((rounded.row(v) - corner).array() / step).round();
  }
  return RootMeanSquare(cartan::VisualError(mesh, shape.Positions, rounded, 0.0));
}

/// The bits of positions that are as rough.
double EqualBits(const Shape& shape, const TriangleMesh& mesh, double roughness)
{
  double before = RoughnessOfPositions(shape, mesh, 6);
  for (int bits = 7; bits < 16; ++bits)
  {
    const double after = RoughnessOfPositions(shape, mesh, bits);
    if (before >= roughness && after < roughness)
    {
      return bits - 1 + std::log(before / roughness) / std::log(before / after);
    }
    before = after;
  }
  return 0.0;
}
}

TEST(HighPassQuantization, TakesTheBitsAndLooksAsPublished)
{
  struct Case
  {
    const char* Mesh;
    double BitsPerVertex[4]; ///< of 5, 6, 7, 8 bits
    double EqualBits[2];     ///< of 5 and 7 bits
  };
  for (const Case& asked : { Case{ "elephant", { 11.1, 14.1, 17.0, 20.0 }, { 10.0, 12.0 } },
         Case{ "camel", { 8.0, 10.9, 13.8, 16.8 }, { 10.4, 12.4 } } })
  {
    const Shape shape = UnitMesh(asked.Mesh);
    const auto mesh = std::make_shared<TriangleMesh>(MakeMesh(shape));
    const HighPassCoder coder(mesh, shape.Positions, 20);
    for (int bits = 5; bits <= 8; ++bits)
    {
      const HighPassCode code = coder.Encode(shape.Positions, bits);
      const double size = code.BitsPerVertex(*mesh);
      shapes::ShowFigure(std::string(asked.Mesh) + " bits per vertex", size);
      EXPECT_LT(size, 1.01 * asked.BitsPerVertex[bits - 5]);
      if (bits % 2 == 1)
      {
        const double equal = EqualBits(shape, *mesh,
          RootMeanSquare(cartan::VisualError(*mesh, shape.Positions, coder.Decode(code), 0.0)));
        shapes::ShowFigure(std::string(asked.Mesh) + " equal bits", equal);
        EXPECT_GT(equal, asked.EqualBits[(bits - 5) / 2] - 0.1);
      }
    }
  }
}

TEST(HighPassQuantization, DecodesFromTheCodeAlone)
{
  const Shape shape = shapes::Union(shapes::Noisy(shapes::Torus(24, 14), 0.03), shapes::Plane(8));
  const auto mesh = std::make_shared<TriangleMesh>(MakeMesh(shape));
  const HighPassCoder coder(mesh, shape.Positions, 10);
  const HighPassCode code = coder.Encode(shape.Positions, 8);
  const HighPassCoder other(mesh, code.Anchors);
  EXPECT_EQ(other.Decode(code), coder.Decode(code));
}

TEST(HighPassQuantization, ConvergesWithTheNumberOfBits)
{
  const Shape shape = shapes::Union(shapes::Noisy(shapes::Torus(24, 14), 0.03), shapes::Plane(8));
  const auto mesh = std::make_shared<TriangleMesh>(MakeMesh(shape));
  const HighPassCoder coder(mesh, shape.Positions, 40);
  double before = 0.0;
  for (const int bits : { 4, 8, 12, 16 })
  {
    const Points decoded = coder.Decode(coder.Encode(shape.Positions, bits));
    const double error = (decoded - shape.Positions).rowwise().norm().maxCoeff();
    EXPECT_TRUE(bits == 4 || error < 0.2 * before) << bits << ": " << error;
    before = error;
  }
  EXPECT_LT(before, 1e-3);
}

TEST(HighPassQuantization, MovesWithTheUnitAndTheOrigin)
{
  Shape shape = shapes::Noisy(shapes::Icosphere(3), 0.05);
  const auto mesh = std::make_shared<TriangleMesh>(MakeMesh(shape));
  const HighPassCoder coder(mesh, shape.Positions, 12);
  const Points decoded = coder.Decode(coder.Encode(shape.Positions, 7));
  // Powers of two and whole numbers keep all digits.
  const Points moved =
    (1024.0 * shape.Positions).rowwise() + Eigen::RowVector3d(4096.0, -8192.0, 0.0);
  const Points decodedThere = coder.Decode(coder.Encode(moved, 7));
  EXPECT_LT(((decodedThere.rowwise() - Eigen::RowVector3d(4096.0, -8192.0, 0.0)) / 1024.0 - decoded)
              .cwiseAbs()
              .maxCoeff(),
    1e-9);
}

// The extremes of a symmetric surface are opposite, so that zero is on the bound of two cells.
TEST(HighPassQuantization, RoundingChoosesNoCell)
{
  const Shape shape = shapes::Icosphere(3);
  const auto mesh = std::make_shared<TriangleMesh>(MakeMesh(shape));
  const HighPassCoder coder(mesh, shape.Positions, 12);
  const auto code = coder.Encode(shape.Positions, 8);
  for (const double unit : { 1e-3, 0.7, 1e3 })
  {
    const auto there = coder.Encode(unit * shape.Positions, 8);
    EXPECT_TRUE(there.Deltas == code.Deltas) << unit;
    EXPECT_TRUE(there.AnchorPositions == code.AnchorPositions) << unit;
  }
}

TEST(VisualError, IsDistanceAndRoughnessWithASign)
{
  const Shape sphere = shapes::Icosphere(3);
  const TriangleMesh mesh = MakeMesh(sphere);
  // Moved as a whole: no roughness. Grown: outwards everywhere.
  const Points moved = sphere.Positions.rowwise() + Eigen::RowVector3d(0.1, 0.0, 0.0);
  EXPECT_LT(cartan::VisualError(mesh, sphere.Positions, moved, 0.0).cwiseAbs().maxCoeff(), 1e-14);
  const Eigen::VectorXd distance = cartan::VisualError(mesh, sphere.Positions, moved, 1.0);
  EXPECT_LT((distance.cwiseAbs().array() - 0.1).abs().maxCoeff(), 1e-14);
  const Points grown = 1.1 * sphere.Positions;
  EXPECT_GT(cartan::VisualError(mesh, sphere.Positions, grown, 0.15).minCoeff(), 0.0);
  EXPECT_LT(
    cartan::VisualError(mesh, sphere.Positions, Points(0.9 * sphere.Positions), 0.15).maxCoeff(),
    0.0);
  // A uniform mean of a grown sphere grows with it: S(v') = 1.1 S(v).
  const Eigen::VectorXd rough = cartan::VisualError(mesh, sphere.Positions, grown, 0.0);
  const Eigen::VectorXd twice =
    cartan::VisualError(mesh, sphere.Positions, Points(1.2 * sphere.Positions), 0.0);
  EXPECT_LT((twice - 2.0 * rough).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(QualitySearch, FindsTheFewestBitsAndAnchors)
{
  // An error that halves with each bit, and with each doubling of the anchors.
  const auto errorOf = [](cartan::HighPassQuality quality)
  { return std::ldexp(1.0, -quality.Bits) / quality.Anchors; };
  // 1 / 16 / 20 is the first below .004; half the anchors would do with .0062 alone.
  cartan::HighPassQuality found = cartan::FewestBitsAndAnchors(errorOf, 0.004, { 20, 1, 100 });
  EXPECT_EQ(found.Bits, 4);
  EXPECT_EQ(found.Anchors, 20);
  found = cartan::FewestBitsAndAnchors(errorOf, 0.0063, { 20, 1, 100 });
  EXPECT_EQ(found.Bits, 3);
  EXPECT_EQ(found.Anchors, 20);
  // Many points: anchors are cheaper than a bit, one bit less with twice of them.
  found = cartan::FewestBitsAndAnchors(errorOf, 0.004, { 20, 1, 100000 });
  EXPECT_EQ(found.Bits, 3);
  EXPECT_EQ(found.Anchors, 40);
  // Anchors that do not matter go, down to one for each component.
  const auto bitsAlone = [](cartan::HighPassQuality quality)
  { return std::ldexp(1.0, -quality.Bits); };
  found = cartan::FewestBitsAndAnchors(bitsAlone, 0.1, { 20, 2, 100 });
  EXPECT_EQ(found.Bits, 4);
  EXPECT_EQ(found.Anchors, 2);
  EXPECT_THROW(cartan::FewestBitsAndAnchors(bitsAlone, 1e-9, { 20, 2, 100 }), cartan::Error);
}
