// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TestShapes.h"

#include "Kernel/Base/Error.h"
#include "Kernel/Compression/CompressedSurface.h"
#include "Kernel/Compression/ConnectivityCoder.h"
#include "Kernel/Compression/SectionFile.h"

#include <cmath>
#include <cstring>

/// What the tests of compressed surfaces and the fuzzer share.
namespace compressed
{
using Bytes = std::vector<unsigned char>;

/// A shape as a file has it, one step for each of `steps`, with the arrays of the first.
inline cartan::CompressedSurface SurfaceOf(const shapes::Shape& shape,
  const std::vector<cartan::Points>& steps, int bits, int anchors, bool keepsOrder = true)
{
  const cartan::TriangleMesh mesh(shape.NumberOfVertices(), shape.Faces);
  cartan::TraversalOrder order = cartan::OrderByTraversal(mesh);
  cartan::CompressedSurface surface;
  surface.Mesh = std::make_shared<cartan::TriangleMesh>(mesh.NumberOfVertices(), order.Faces);
  const cartan::HighPassCoder coder(surface.Mesh, order.Reordered(steps[0]), anchors);
  cartan::HighPassScale scale = coder.ScaleOf(order.Reordered(steps[0]));
  for (const cartan::Points& points : steps)
  {
    scale = scale.Joined(coder.ScaleOf(order.Reordered(points)));
  }
  for (const cartan::Points& points : steps)
  {
    cartan::CodedStep step;
    step.Time = 0.5 * static_cast<double>(surface.Steps.size());
    const cartan::Points reordered = order.Reordered(points);
    step.Code = coder.Encode(reordered, bits, scale);
    step.FreePoints = reordered.bottomRows(mesh.NumberOfVertices() - order.NumberOfUsed);
    surface.Steps.push_back(std::move(step));
  }
  if (keepsOrder)
  {
    surface.OldNumbers = order.Vertices;
  }
  return surface;
}

inline std::uint64_t NumberAt(const Bytes& bytes, std::size_t at, int count)
{
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i)
  {
    value |= std::uint64_t{ bytes[at + i] } << (8 * i);
  }
  return value;
}

inline void SetNumber(Bytes& bytes, std::size_t at, int count, std::uint64_t value)
{
  for (int i = 0; i < count; ++i)
  {
    bytes[at + i] = static_cast<unsigned char>(value >> (8 * i));
  }
}

constexpr std::size_t CountAt = 12;   ///< where a file has its number of sections
constexpr std::size_t TableAt = 16;   ///< where their table begins, 16 bytes for each
constexpr std::size_t LengthAt = 8;   ///< of an entry
constexpr std::size_t ChecksumAt = 4; ///< of an entry

/// Where the bytes of section `i` are.
inline std::size_t SectionAt(const Bytes& file, std::size_t i)
{
  std::size_t at = TableAt + 16 * NumberAt(file, CountAt, 4) + 4;
  for (std::size_t before = 0; before < i; ++before)
  {
    at += NumberAt(file, TableAt + 16 * before + LengthAt, 8);
  }
  return at;
}

/// Gives a changed file the checksums that it should have, as far as its lengths make sense.
inline void Reseal(Bytes& file)
{
  if (file.size() < TableAt + 4)
  {
    return;
  }
  const std::uint64_t count = NumberAt(file, CountAt, 4);
  if (count > (file.size() - TableAt - 4) / 16)
  {
    return;
  }
  const std::size_t head = TableAt + 16 * count;
  std::size_t at = head + 4;
  for (std::uint64_t i = 0; i < count; ++i)
  {
    const std::size_t entry = TableAt + 16 * i;
    const std::uint64_t length = NumberAt(file, entry + LengthAt, 8);
    if (length > file.size() - at)
    {
      return;
    }
    SetNumber(file, entry + ChecksumAt, 4,
      cartan::sectionfile::Checksum(file.data() + at, static_cast<std::size_t>(length)));
    at += static_cast<std::size_t>(length);
  }
  SetNumber(file, head, 4, cartan::sectionfile::Checksum(file.data(), head));
}

/// Decodes all steps; the error's text, or nothing.
inline std::string ProblemOf(const Bytes& file)
{
  try
  {
    const cartan::CompressedSurface surface = cartan::Decompress(file.data(), file.size());
    for (const cartan::CodedStep& step : surface.Steps)
    {
      cartan::HighPassCoder(surface.Mesh, step.Code.Anchors).Decode(step.Code);
    }
  }
  catch (const cartan::Error& error)
  {
    return error.what();
  }
  return "";
}
}
