// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Spectral/SpectralWatermark.h"

#include "Kernel/Base/Error.h"
#include "Kernel/Mesh/GraphPatches.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <random>

using cartan::Points;
using cartan::SpectralWatermark;
using cartan::WatermarkReading;
using shapes::MakeMesh;
using shapes::Shape;

namespace
{
std::vector<char> RandomBits(int count, unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<char> bits(count);
  for (char& bit : bits)
  {
    bit = static_cast<char>(random() >> 31U);
  }
  return bits;
}

int Errors(const std::vector<char>& bits, const std::vector<char>& read)
{
  int errors = 0;
  for (std::size_t i = 0; i < bits.size(); ++i)
  {
    errors += bits[i] != read[i] ? 1 : 0;
  }
  return errors;
}

Shape UnitMesh(const std::string& name)
{
  Shape shape = shapes::RealMesh(name);
  shape.Positions /=
    (shape.Positions.colwise().maxCoeff() - shape.Positions.colwise().minCoeff()).norm();
  return shape;
}

Points Noise(Eigen::Index count, double deviation, unsigned seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, deviation);
  Points noise(count, 3);
  std::generate(noise.data(), noise.data() + noise.size(), [&] { return normal(random); });
  return noise;
}

Points Quantized(const Points& points, int bits)
{
  const Eigen::RowVector3d low = points.colwise().minCoeff();
  const double step = (points.colwise().maxCoeff() - low).maxCoeff() / ((1 << bits) - 1);
  return (((points.rowwise() - low) / step).array().round() * step).matrix().rowwise() + low;
}

/// One patch where patches cannot be made.
int PatchSize(int size)
{
  return cartan::HasMetis() ? size : 0;
}
}

TEST(SpectralWatermark, SurvivesNoiseAndQuantization)
{
  const std::vector<char> bits = RandomBits(64, 1);
  for (const char* name : { "elephant", "camel" })
  {
    const Shape shape = UnitMesh(name);
    const Points& points = shape.Positions;
    SpectralWatermark::Settings settings;
    settings.PatchSize = PatchSize(1000);
    const SpectralWatermark watermark(MakeMesh(shape), settings);
    const Points signal = watermark.Signal(bits, "key", 0.001);
    const double change = std::sqrt(signal.squaredNorm() / static_cast<double>(points.rows()));
    shapes::ShowFigure(std::string(name) + " change", change);
    EXPECT_LT(change, 4.6e-4);
    EXPECT_GT(change, 3e-4);
    const Points marked = points + signal;
    const std::pair<const char*, Points> suspects[] = { { "none", marked },
      { "noise", marked + Noise(points.rows(), 0.001 / std::sqrt(3.0), 2) },
      { "8 bits", Quantized(marked, 8) } };
    for (const auto& [attack, suspect] : suspects)
    {
      const WatermarkReading reading = watermark.Read(suspect - points, 64, "key");
      const double least = reading.Scores.cwiseAbs().minCoeff();
      shapes::ShowFigure(std::string(name) + " " + attack + ", least score", least);
      EXPECT_EQ(Errors(bits, reading.Bits), 0) << name << " " << attack;
      EXPECT_LT(cartan::ChanceOfScores(reading.Scores), 1e-12);
    }
  }
}

TEST(SpectralWatermark, SurvivesTheLossOfAThirdOfTheSurface)
{
  // Each bit is all over the surface.
  const Shape camel = UnitMesh("camel");
  SpectralWatermark::Settings settings;
  settings.PatchSize = PatchSize(1000);
  const SpectralWatermark watermark(MakeMesh(camel), settings);
  const std::vector<char> bits = RandomBits(64, 3);
  Points difference = watermark.Signal(bits, "key", 0.001);
  difference.topRows(difference.rows() / 3).setZero();
  const WatermarkReading reading = watermark.Read(difference, 64, "key");
  EXPECT_EQ(Errors(bits, reading.Bits), 0);
}

TEST(SpectralWatermark, IsSilentWithoutTheKey)
{
  const Shape shape = UnitMesh("elephant");
  SpectralWatermark::Settings settings;
  settings.PatchSize = PatchSize(1000);
  const SpectralWatermark watermark(MakeMesh(shape), settings);
  const std::vector<char> bits = RandomBits(64, 1);
  const Points signal = watermark.Signal(bits, "key", 0.001);
  // Scores of other keys have mean 0 and variance 1: their sum over 40 keys of 64 bits has
  // the standard deviation 50, and that of their squares sqrt(2 * 2560) or less.
  double sum = 0.0;
  double squares = 0.0;
  double matches = 0.0;
  for (int key = 0; key < 40; ++key)
  {
    const WatermarkReading reading = watermark.Read(signal, 64, std::to_string(key));
    sum += reading.Scores.sum();
    squares += reading.Scores.squaredNorm();
    matches += 64 - Errors(bits, reading.Bits);
    EXPECT_GT(cartan::ChanceOfScores(reading.Scores), 1e-4) << key;
  }
  EXPECT_LT(std::abs(sum), 4.0 * 51.0);
  EXPECT_NEAR(squares, 2560.0, 4.0 * 72.0);
  EXPECT_NEAR(matches, 1280.0, 4.0 * 26.0);
}

TEST(SpectralWatermark, ChangesLowFrequenciesOnly)
{
  // The signal is orthogonal to constants on each patch, and smooth: its Laplacian is small
  // against that of noise of the same size, which has the mean square d (d + 1).
  const Shape shape = UnitMesh("camel");
  const cartan::TriangleMesh mesh = MakeMesh(shape);
  SpectralWatermark::Settings settings;
  settings.PatchSize = PatchSize(1000);
  const SpectralWatermark watermark(mesh, settings);
  const Points signal = watermark.Signal(RandomBits(64, 1), "key", 0.001);
  Points sums = Points::Zero(watermark.NumberOfPatches(), 3);
  double inner = 0.0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const int patch = watermark.GetPatchOfVertex()[v];
    sums.row(patch) += signal.row(v);
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int other = mesh.Neighbor(d);
      inner += watermark.GetPatchOfVertex()[other] == patch
        ? (signal.row(other) - signal.row(v)).squaredNorm()
        : 0.0;
    }
  }
  EXPECT_LT(sums.cwiseAbs().maxCoeff(), 1e-12);
  // Twice the Dirichlet energy: 2 lambda at most for each unit of the squared norm.
  EXPECT_LT(inner, 2.0 * 1.0 * signal.squaredNorm());
}

TEST(SpectralWatermark, TakesTheWholeSurfaceOrSeveralComponents)
{
  Shape shape = shapes::Union(shapes::Noisy(shapes::Icosphere(3), 0.02), shapes::Plane(20));
  shape.Positions.conservativeResize(shape.NumberOfVertices() + 1, 3);
  shape.Positions.bottomRows<1>().setConstant(7.0);
  const std::vector<char> bits = RandomBits(16, 5);
  for (const int size : { 0, PatchSize(150) })
  {
    SpectralWatermark::Settings settings;
    settings.PatchSize = size;
    const SpectralWatermark watermark(MakeMesh(shape), settings);
    EXPECT_EQ(watermark.NumberOfPatches() > 1, size > 0);
    const Points signal = watermark.Signal(bits, "another key", 0.5);
    EXPECT_TRUE(signal.bottomRows<1>().isZero(0.0));
    EXPECT_EQ(Errors(bits, watermark.Read(signal, 16, "another key").Bits), 0);
    // Every coefficient of a place has the amplitude.
    EXPECT_NEAR(signal.norm(), 0.5 * std::sqrt(watermark.NumberOfPlaces()), 1e-9);
  }
}

TEST(SpectralWatermark, KnowsChance)
{
  EXPECT_NEAR(cartan::ChanceOfMatches(64, 64), std::exp2(-64), 1e-28);
  EXPECT_NEAR(cartan::ChanceOfMatches(0, 64), 1.0, 1e-12);
  EXPECT_NEAR(cartan::ChanceOfMatches(2, 3), 0.5, 1e-12);
  EXPECT_NEAR(cartan::WatermarkConfidence(0.0), 0.5, 1e-15);
  EXPECT_NEAR(cartan::WatermarkConfidence(-1.959964), 0.975, 1e-6);
  // The tail of a sum of two squares is exp(-t / 2), which the bound exceeds.
  const Eigen::Vector2d scores(3.0, 4.0);
  EXPECT_GT(cartan::ChanceOfScores(scores), std::exp(-12.5));
  EXPECT_LT(cartan::ChanceOfScores(scores), 1e-3);
  EXPECT_EQ(cartan::ChanceOfScores(Eigen::Vector2d(0.5, 0.5)), 1.0);
}

TEST(SpectralWatermark, RefusesWhatDoesNotFit)
{
  const Shape shape = shapes::Icosphere(3);
  SpectralWatermark::Settings settings;
  settings.PatchSize = 0;
  const SpectralWatermark watermark(MakeMesh(shape), settings);
  EXPECT_EQ(watermark.NumberOfPlaces(), 3 * 44);
  EXPECT_THROW(watermark.Signal(RandomBits(133, 1), "key", 1.0), cartan::Error);
  EXPECT_THROW(watermark.Signal({}, "key", 1.0), cartan::Error);
  settings.MaximumBytes = 100000;
  EXPECT_THROW(SpectralWatermark(MakeMesh(shape), settings), cartan::Error);
}
