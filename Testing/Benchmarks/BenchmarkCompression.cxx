// SPDX-License-Identifier: BSD-3-Clause
//
// Files of compressed surfaces against Draco's, whole and without the order of points, which
// Draco does not keep: for seven scanned meshes, our bytes with 5 and 7 bits and 20 anchors, and
// with 7 bits and 100, and the bytes that Draco takes for the same normals (root mean square of the
// angle between triangles, by area) and for the same visual error (Karni and Gotsman, alpha .15,
// root mean square). Draco's best: Edgebreaker, the smallest file of speeds 0 to 3, between whole
// numbers of bits by the logarithm of the error. Then the time to decode a file of 104K points
// against a factorization and a solve of the same system. All losses are printed.
#include "BenchmarkTools.h"
#include "CompressedFiles.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <cstdio>
#include <exception>

using cartan::Points;
using cartan::TriangleMesh;

namespace
{
struct Quality
{
  double Normals = 0.0; ///< degrees
  double Visual = 0.0;  ///< of the diagonal
};

Quality QualityOf(const TriangleMesh& mesh, const Points& points, const Points& decoded)
{
  const auto normalOf = [](const Points& at, const auto& corners)
  {
    const Eigen::Vector3d a = at.row(corners[1]) - at.row(corners[0]);
    const Eigen::Vector3d b = at.row(corners[2]) - at.row(corners[0]);
    return Eigen::Vector3d(a.cross(b));
  };
  double sum = 0.0;
  double area = 0.0;
  for (Eigen::Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Eigen::RowVector3i corners = mesh.GetTriangles().row(t);
    const Eigen::Vector3d before = normalOf(points, corners);
    const Eigen::Vector3d after = normalOf(decoded, corners);
    const double angle = std::atan2(before.cross(after).norm(), before.dot(after));
    sum += before.norm() * angle * angle;
    area += before.norm();
  }
  const double diagonal = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  const Eigen::VectorXd errors = cartan::VisualError(mesh, points, decoded, 0.15);
  return { std::sqrt(sum / area) * 180.0 / M_PI,
    errors.norm() / std::sqrt(static_cast<double>(errors.size())) / diagonal };
}

/// For Draco, with or without the numbers of points.
std::unique_ptr<draco::Mesh> DracoMesh(const shapes::Shape& shape, bool hasNumbers)
{
  auto mesh = std::make_unique<draco::Mesh>();
  const auto count = static_cast<std::uint32_t>(shape.NumberOfVertices());
  mesh->set_num_points(count);
  draco::GeometryAttribute positions;
  positions.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  const int at = mesh->AddAttribute(positions, true, count);
  draco::GeometryAttribute numbers;
  numbers.Init(draco::GeometryAttribute::GENERIC, nullptr, 1, draco::DT_UINT32, false, 4, 0);
  const int number = hasNumbers ? mesh->AddAttribute(numbers, true, count) : -1;
  for (std::uint32_t v = 0; v < count; ++v)
  {
    const Eigen::Matrix<float, 1, 3> point = shape.Positions.row(v).cast<float>();
    mesh->attribute(at)->SetAttributeValue(draco::AttributeValueIndex(v), point.data());
    if (hasNumbers)
    {
      mesh->attribute(number)->SetAttributeValue(draco::AttributeValueIndex(v), &v);
    }
  }
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    draco::Mesh::Face face;
    for (int c = 0; c < 3; ++c)
    {
      face[c] = draco::PointIndex(static_cast<std::uint32_t>(shape.Faces(t, c)));
    }
    mesh->AddFace(face);
  }
  return mesh;
}

void Encode(const draco::Mesh& mesh, int bits, int speed, draco::EncoderBuffer& buffer)
{
  draco::Encoder encoder;
  encoder.SetSpeedOptions(speed, speed);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
  if (!encoder.EncodeMeshToBuffer(mesh, &buffer).ok())
  {
    throw std::runtime_error("Draco cannot encode");
  }
}

std::size_t DracoSize(const shapes::Shape& shape, int bits)
{
  const auto mesh = DracoMesh(shape, false);
  std::size_t least = ~std::size_t{ 0 };
  for (int speed = 0; speed <= 3; ++speed)
  {
    draco::EncoderBuffer buffer;
    Encode(*mesh, bits, speed, buffer);
    least = std::min(least, buffer.size());
  }
  return least;
}

Points DracoDecoded(const shapes::Shape& shape, int bits)
{
  draco::EncoderBuffer buffer;
  Encode(*DracoMesh(shape, true), bits, 0, buffer);
  draco::DecoderBuffer input;
  input.Init(buffer.data(), buffer.size());
  draco::Decoder decoder;
  const auto mesh = decoder.DecodeMeshFromBuffer(&input).value();
  const auto* positions = mesh->GetNamedAttribute(draco::GeometryAttribute::POSITION);
  const auto* numbers = mesh->GetNamedAttribute(draco::GeometryAttribute::GENERIC);
  Points decoded = shape.Positions;
  for (std::uint32_t i = 0; i < mesh->num_points(); ++i)
  {
    std::uint32_t v = 0;
    Eigen::Matrix<float, 1, 3> point;
    numbers->GetMappedValue(draco::PointIndex(i), &v);
    positions->GetMappedValue(draco::PointIndex(i), point.data());
    decoded.row(v) = point.cast<double>();
  }
  return decoded;
}

struct Sample
{
  double Bytes;
  Quality Reached;
};

/// The bytes at an error, between samples; NaN outside of them.
double BytesAt(const std::vector<Sample>& samples, double Quality::*which, double error)
{
  for (std::size_t i = 1; i < samples.size(); ++i)
  {
    const double coarse = samples[i - 1].Reached.*which;
    const double fine = samples[i].Reached.*which;
    if (coarse >= error && error >= fine)
    {
      const double part = std::log(coarse / error) / std::log(coarse / fine);
      return samples[i - 1].Bytes + part * (samples[i].Bytes - samples[i - 1].Bytes);
    }
  }
  return std::nan("");
}

struct Rate
{
  int Bits;
  int Anchors;
  int Normals = 0; ///< how often ours is smaller at equal normals
  int Visual = 0;  ///< and at equal visual error
};

void Compare(const std::string& name, std::vector<Rate>& rates)
{
  const benchmarks::Mesh read = benchmarks::ReadMesh(name);
  const shapes::Shape shape{ read.Points, read.Triangles };
  const TriangleMesh mesh(shape.NumberOfVertices(), shape.Faces);
  std::vector<Sample> draco;
  for (int bits = 6; bits <= 16; ++bits)
  {
    draco.push_back({ static_cast<double>(DracoSize(shape, bits)),
      QualityOf(mesh, shape.Positions, DracoDecoded(shape, bits)) });
  }
  for (Rate& rate : rates)
  {
    const cartan::CompressedSurface surface =
      compressed::SurfaceOf(shape, { shape.Positions }, rate.Bits, rate.Anchors, false);
    const auto bytes = static_cast<double>(cartan::Compress(surface).size());
    const cartan::TraversalOrder order = cartan::OrderByTraversal(mesh);
    const Points decoded = cartan::HighPassCoder(surface.Mesh, surface.Steps[0].Code.Anchors)
                             .Decode(surface.Steps[0].Code);
    const Quality reached = QualityOf(*surface.Mesh, order.Reordered(shape.Positions), decoded);
    const double normals = BytesAt(draco, &Quality::Normals, reached.Normals);
    const double visual = BytesAt(draco, &Quality::Visual, reached.Visual);
    rate.Normals += bytes < normals ? 1 : 0;
    rate.Visual += bytes < visual ? 1 : 0;
    std::printf("%-14s %6d %5d %7d %8.0f %8.3f %9.2e %10.0f %5.2f %10.0f %5.2f\n", name.c_str(),
      shape.NumberOfVertices(), rate.Bits, rate.Anchors, bytes, reached.Normals, reached.Visual,
      normals, bytes / normals, visual, bytes / visual);
    std::fflush(stdout);
  }
}

/// Decoding against one factorization and one solve of the same system, the best of three.
void CompareTimes()
{
  const benchmarks::Mesh fine = benchmarks::Subdivide(benchmarks::ReadMesh("armadillo"));
  const shapes::Shape shape{ fine.Points, fine.Triangles };
  const cartan::CompressedSurface surface =
    compressed::SurfaceOf(shape, { shape.Positions }, 7, 20, false);
  const compressed::Bytes file = cartan::Compress(surface);
  double whole = 1e300;
  double system = 1e300;
  for (int round = 0; round < 3; ++round)
  {
    double begin = benchmarks::ProcessorTime();
    const cartan::CompressedSurface read = cartan::Decompress(file.data(), file.size());
    cartan::HighPassCoder(read.Mesh, read.Steps[0].Code.Anchors).Decode(read.Steps[0].Code);
    whole = std::min(whole, benchmarks::ProcessorTime() - begin);
    begin = benchmarks::ProcessorTime();
    cartan::HighPassCoder(surface.Mesh, surface.Steps[0].Code.Anchors)
      .Decode(surface.Steps[0].Code);
    system = std::min(system, benchmarks::ProcessorTime() - begin);
  }
  std::printf("\n%d points, %.1f bits per point\n", shape.NumberOfVertices(),
    8.0 * static_cast<double>(file.size()) / shape.NumberOfVertices());
  benchmarks::PrintRow("factorize and solve", "", system, "s");
  benchmarks::PrintRow("decode a file", "", whole, "s");
  benchmarks::PrintRow(
    "decode over factorize and solve", "at most 1.5", whole / system, "", whole <= 1.5 * system);
}
}

int main()
{
  try
  {
    std::printf("%-14s %6s %5s %7s %8s %8s %9s %10s %5s %10s %5s\n", "mesh", "points", "bits",
      "anchors", "bytes", "normals", "visual", "Draco(n)", "ratio", "Draco(v)", "ratio");
    std::vector<Rate> rates = { { 5, 20 }, { 7, 20 }, { 7, 100 } };
    for (const char* name :
      { "elephant", "camel", "armadillo", "bunny00", "lion-head", "dino", "bull" })
    {
      Compare(name, rates);
    }
    for (const Rate& rate : rates)
    {
      const std::string of = ", " + std::to_string(rate.Bits) + " bits, " +
        std::to_string(rate.Anchors) + " anchors, of 7 meshes";
      benchmarks::PrintRow(
        "smaller in normals" + of, "at least 5", rate.Normals, "", rate.Normals >= 5);
      benchmarks::PrintRow("smaller in visual error" + of, "", rate.Visual, "");
    }
    CompareTimes();
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
