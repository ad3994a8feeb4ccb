// SPDX-License-Identifier: BSD-3-Clause
#include "CompressedFiles.h"
#include "RealMeshes.h"

#include "Kernel/Compression/ConnectivityCoder.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>

using cartan::CompressedSizes;
using cartan::CompressedSurface;
using cartan::Points;
using cartan::TraversalOrder;
using cartan::TriangleMesh;
using compressed::Bytes;
using shapes::Shape;

namespace
{
/// Two components, one with a boundary, and points in no triangle among the others.
Shape Mixed()
{
  Shape shape = shapes::Union(shapes::Noisy(shapes::Torus(24, 14), 0.03), shapes::Plane(8));
  std::mt19937 random(3);
  std::vector<int> numbers(static_cast<std::size_t>(shape.NumberOfVertices()) + 3);
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    numbers[i] = static_cast<int>(i);
  }
  std::shuffle(numbers.begin(), numbers.end(), random);
  Shape shuffled;
  shuffled.Positions = Points::Random(shape.NumberOfVertices() + 3, 3);
  shuffled.Faces = shape.Faces;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    shuffled.Positions.row(numbers[v]) = shape.Positions.row(v);
  }
  for (Eigen::Index i = 0; i < shape.Faces.size(); ++i)
  {
    shuffled.Faces.data()[i] = numbers[shape.Faces.data()[i]];
  }
  return shuffled;
}

/// Triangles with their smallest corner first, the orientation kept.
std::multiset<std::array<int, 3>> TurnedTriangles(const cartan::Triangles& faces)
{
  std::multiset<std::array<int, 3>> all;
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    std::array<int, 3> corners = { faces(t, 0), faces(t, 1), faces(t, 2) };
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    all.insert(corners);
  }
  return all;
}

cartan::Triangles Renamed(cartan::Triangles faces, const std::vector<int>& names)
{
  for (Eigen::Index i = 0; i < faces.size(); ++i)
  {
    faces.data()[i] = names[faces.data()[i]];
  }
  return faces;
}

CompressedSurface RoundTrip(const CompressedSurface& surface, CompressedSizes* sizes = nullptr)
{
  const Bytes file = cartan::Compress(surface, sizes);
  return cartan::Decompress(file.data(), file.size());
}

void ExpectSameCode(const cartan::HighPassCode& actual, const cartan::HighPassCode& expected)
{
  EXPECT_EQ(actual.Bits, expected.Bits);
  EXPECT_EQ(actual.Corner, expected.Corner);
  EXPECT_EQ(actual.Side, expected.Side);
  EXPECT_EQ(actual.Low, expected.Low);
  EXPECT_EQ(actual.Range, expected.Range);
  EXPECT_EQ(actual.Anchors, expected.Anchors);
  EXPECT_EQ(actual.AnchorPositions, expected.AnchorPositions);
  EXPECT_EQ(actual.Deltas, expected.Deltas);
}
}

TEST(TraversalOrder, IsTheSameSurface)
{
  const Shape shape = Mixed();
  const TriangleMesh mesh = shapes::MakeMesh(shape);
  const TraversalOrder order = cartan::OrderByTraversal(mesh);
  EXPECT_EQ(order.NumberOfUsed, shape.NumberOfVertices() - 3);
  EXPECT_EQ(std::set<int>(order.Vertices.begin(), order.Vertices.end()).size(),
    static_cast<std::size_t>(shape.NumberOfVertices()));
  EXPECT_LT(order.Faces.maxCoeff(), order.NumberOfUsed);
  EXPECT_EQ(TurnedTriangles(Renamed(order.Faces, order.Vertices)), TurnedTriangles(shape.Faces));
}

TEST(ConnectivityCoder, KeepsSurfacesOfAnyTopology)
{
  // Of several genera, and with many borders, at which vertices of a triangle that is left
  // out touch: such a hole grows until the rest is a manifold.
  std::vector<Shape> all = { Mixed(), shapes::Icosphere(0), shapes::Torus(3, 3), shapes::Plane(1),
    shapes::RealMesh("double-torus-example"), shapes::RealMesh("bull") };
  std::mt19937 random(5);
  for (const int holes : { 3, 30, 300 })
  {
    const Shape shape = shapes::Torus(40, 30);
    std::vector<char> isLeftOut(static_cast<std::size_t>(shape.NumberOfVertices()), 0);
    for (int i = 0; i < holes; ++i)
    {
      isLeftOut[random() % isLeftOut.size()] = 1;
    }
    all.push_back(shape);
    all.back().Faces.resize(0, 3);
    for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
    {
      const auto corners = shape.Faces.row(t);
      if (!isLeftOut[corners[0]] && !isLeftOut[corners[1]] && !isLeftOut[corners[2]])
      {
        all.back().Faces.conservativeResize(all.back().Faces.rows() + 1, 3);
        all.back().Faces.bottomRows(1) = corners;
      }
    }
  }
  for (const Shape& shape : all)
  {
    cartan::MeshReport report;
    const TriangleMesh mesh =
      TriangleMesh::Build(shape.NumberOfVertices(), cartan::Triangles(shape.Faces), report);
    if (!report.IsManifold())
    {
      continue;
    }
    const TraversalOrder order = cartan::OrderByTraversal(mesh);
    EXPECT_EQ(TurnedTriangles(Renamed(order.Faces, order.Vertices)), TurnedTriangles(shape.Faces));
    const Bytes bytes =
      cartan::EncodeTriangles(TriangleMesh(shape.NumberOfVertices(), order.Faces));
    EXPECT_EQ(cartan::DecodeTriangles(bytes.data(), bytes.size(),
                static_cast<int>(shape.Faces.rows()), static_cast<std::size_t>(order.NumberOfUsed)),
      order.Faces);
    EXPECT_THROW(
      cartan::DecodeTriangles(bytes.data(), bytes.size(), static_cast<int>(shape.Faces.rows()),
        static_cast<std::size_t>(order.NumberOfUsed) - 1),
      cartan::Error);
  }
}

TEST(ConnectivityCoder, TakesNextToNothingOfRegularSurfaces)
{
  // All vertices have six triangles, as all but a few of a subdivided surface have.
  const Shape torus = shapes::Torus(100, 80);
  const TriangleMesh mesh = shapes::MakeMesh(torus);
  const TriangleMesh ordered(torus.NumberOfVertices(), cartan::OrderByTraversal(mesh).Faces);
  EXPECT_LT(8 * cartan::EncodeTriangles(ordered).size(),
    static_cast<std::size_t>(torus.NumberOfVertices()) / 8);
}

TEST(ConnectivityCoder, RefusesDistancesThatOverflow)
{
  // A code of 48 triangles that joins an edge 1 - 2^31 edges back.
  const std::vector<unsigned char> bytes{ 0x5b, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };
  EXPECT_THROW(cartan::DecodeTriangles(bytes.data(), bytes.size(), 48, 24), cartan::Error);
}

TEST(ConnectivityCoder, RefusesAnotherOrder)
{
  const TriangleMesh mesh = shapes::MakeMesh(Mixed());
  EXPECT_THROW(cartan::EncodeTriangles(mesh), cartan::Error);
}

TEST(SectionFile, HasTheChecksumOfTheStandard)
{
  const std::string text = "123456789"; // CRC-32's check value
  EXPECT_EQ(
    cartan::sectionfile::Checksum(reinterpret_cast<const unsigned char*>(text.data()), text.size()),
    0xcbf43926u);
}

TEST(CompressedSurface, BringsAllBack)
{
  const Shape shape = Mixed();
  for (const bool keepsOrder : { true, false })
  {
    CompressedSurface surface =
      compressed::SurfaceOf(shape, { shape.Positions }, 7, 12, keepsOrder);
    surface.IsSinglePrecision = keepsOrder;
    const CompressedSurface read = RoundTrip(surface);
    EXPECT_EQ(read.IsSinglePrecision, keepsOrder);
    EXPECT_EQ(read.OldNumbers, surface.OldNumbers);
    EXPECT_EQ(
      TurnedTriangles(read.Mesh->GetTriangles()), TurnedTriangles(surface.Mesh->GetTriangles()));
    ASSERT_EQ(read.Steps.size(), 1u);
    ExpectSameCode(read.Steps[0].Code, surface.Steps[0].Code);
    EXPECT_EQ(read.Steps[0].FreePoints, surface.Steps[0].FreePoints);
    EXPECT_EQ(read.Steps[0].FreePoints.rows(), 3);
  }
}

TEST(CompressedSurface, KeepsEveryBitOfArrays)
{
  const Shape shape = Mixed();
  CompressedSurface surface = compressed::SurfaceOf(shape, { shape.Positions }, 6, 4);
  std::mt19937 random(11);
  for (int type = 1; type <= 10; ++type)
  {
    cartan::CodedArray array;
    array.Name = "array " + std::to_string(type);
    array.Type = static_cast<cartan::ScalarType>(type);
    array.Components = 1 + type % 3;
    array.Bytes.resize(static_cast<std::size_t>(
      shape.NumberOfVertices() * array.Components * cartan::SizeOf(array.Type)));
    for (unsigned char& byte : array.Bytes)
    {
      byte = static_cast<unsigned char>(random());
    }
    surface.Steps[0].Arrays.push_back(array);
  }
  CompressedSizes sizes;
  const CompressedSurface read = RoundTrip(surface, &sizes);
  ASSERT_EQ(read.Steps[0].Arrays.size(), 10u);
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < 10; ++i)
  {
    const cartan::CodedArray& actual = read.Steps[0].Arrays[i];
    const cartan::CodedArray& expected = surface.Steps[0].Arrays[i];
    EXPECT_EQ(actual.Name, expected.Name);
    EXPECT_EQ(actual.Type, expected.Type);
    EXPECT_EQ(actual.Components, expected.Components);
    EXPECT_EQ(actual.Bytes, expected.Bytes);
    bytes += expected.Bytes.size();
  }
  // Noise cannot be compressed; an array of the same number takes next to nothing.
  EXPECT_GT(sizes.Arrays, bytes);
  for (cartan::CodedArray& array : surface.Steps[0].Arrays)
  {
    std::fill(array.Bytes.begin(), array.Bytes.end(), 7);
  }
  cartan::Compress(surface, &sizes);
  EXPECT_LT(sizes.Arrays, bytes / 20);
}

TEST(CompressedSurface, CodesTimeStepsAsDifferences)
{
  const Shape shape = shapes::Noisy(shapes::Icosphere(4), 0.03);
  // Almost at rest, then upside down, which no difference helps.
  Points moved = shape.Positions;
  moved.col(0) += 0.01 * shape.Positions.col(1).array().sin().matrix();
  const std::vector<Points> steps = { shape.Positions, moved, Points(-1.0 * moved) };
  const CompressedSurface surface = compressed::SurfaceOf(shape, steps, 8, 10);
  CompressedSizes all;
  const CompressedSurface read = RoundTrip(surface, &all);
  ASSERT_EQ(read.Steps.size(), 3u);
  std::vector<std::size_t> alone;
  for (std::size_t i = 0; i < 3; ++i)
  {
    EXPECT_EQ(read.Steps[i].Time, 0.5 * static_cast<double>(i));
    ExpectSameCode(read.Steps[i].Code, surface.Steps[i].Code);
    CompressedSurface one = surface;
    one.Steps = { surface.Steps[i] };
    CompressedSizes sizes;
    cartan::Compress(one, &sizes);
    alone.push_back(sizes.Geometry);
  }
  EXPECT_LT(all.Geometry, alone[0] + alone[1] / 2 + alone[2]);
  const Bytes file = cartan::Compress(surface);
  EXPECT_EQ(cartan::ReadTimes(file.data(), file.size()), (std::vector<double>{ 0.0, 0.5, 1.0 }));
}

TEST(CompressedSurface, TakesThePublishedBits)
{
  struct Case
  {
    const char* Mesh;
    double Bits[4]; ///< per vertex, with 5, 6, 7, 8 of a coordinate: geometry with anchors
  };
  for (const Case& asked :
    { Case{ "elephant", { 11.1, 14.1, 17.0, 20.0 } }, Case{ "camel", { 8.0, 10.9, 13.8, 16.8 } } })
  {
    const Shape shape = shapes::RealMesh(asked.Mesh);
    for (int bits = 5; bits <= 8; ++bits)
    {
      CompressedSizes sizes;
      cartan::Compress(compressed::SurfaceOf(shape, { shape.Positions }, bits, 20), &sizes);
      const double perBit = 8.0 / shape.NumberOfVertices();
      const double geometry = perBit * static_cast<double>(sizes.Geometry);
      shapes::ShowFigure(
        std::string(asked.Mesh) + " " + std::to_string(bits) + " bits, geometry", geometry);
      EXPECT_LT(geometry, 1.03 * asked.Bits[bits - 5]);
      if (bits == 5)
      {
        shapes::ShowFigure(std::string(asked.Mesh) + " connectivity",
          perBit * static_cast<double>(sizes.Connectivity));
        shapes::ShowFigure(std::string(asked.Mesh) + " order of points",
          perBit * static_cast<double>(sizes.PointOrder));
        EXPECT_LT(perBit * static_cast<double>(sizes.Connectivity), 2.5);
      }
    }
  }
}
