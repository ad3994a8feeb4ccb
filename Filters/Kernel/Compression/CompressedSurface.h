// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Compression/ArrayCoder.h"
#include "Compression/HighPassQuantization.h"

namespace cartan
{
/// What a time step has of its own.
struct CodedStep
{
  double Time = 0.0;
  HighPassCode Code;
  /// Vertices in no triangle, which come last: as they are.
  Points FreePoints = Points(0, 3);
  std::vector<CodedArray> Arrays;
};

/// A compressed surface, the contents of a file `.csf`: one connectivity and one or more
/// time steps. Triangles and vertices are in TraversalOrder.
struct CompressedSurface
{
  std::shared_ptr<const TriangleMesh> Mesh; ///< used vertices come first
  bool IsSinglePrecision = false;
  /// The number that each vertex had before: a permutation, or empty where the order is lost.
  std::vector<int> OldNumbers;
  std::vector<CodedStep> Steps; ///< with one and the same set of anchors and number of bits
};

/// How many bytes the parts of a file take; counts, times, lengths and checksums in the total
/// alone.
struct CompressedSizes
{
  std::size_t Total = 0;
  std::size_t Connectivity = 0;
  std::size_t PointOrder = 0;
  std::size_t Geometry = 0; ///< differential coordinates, anchors and free points of all steps
  std::size_t Arrays = 0;
};

/// The bytes of a file, see SectionFile. Differential coordinates of a step that has the
/// scale of the one before are coded as differences from it if that takes less. Throws
/// Error(BadInput) when triangles and vertices are not in TraversalOrder.
std::vector<unsigned char> Compress(
  const CompressedSurface& surface, CompressedSizes* sizes = nullptr);

/// The times of a file, without decoding it. Throws Error(BadInput) as Decompress.
std::vector<double> ReadTimes(const unsigned char* bytes, std::size_t size);

/// Decodes bytes that may come from anyone. Throws Error(BadInput) with the rest of a
/// sentence, "the header is cut off", unless all is right: the triangles are an oriented
/// manifold on the used vertices, each component has an anchor, all numbers are in their
/// ranges. Takes memory in proportion to `size`: a byte stands for at most 32 triangles, or 8
/// vertices or values.
CompressedSurface Decompress(const unsigned char* bytes, std::size_t size);
}
