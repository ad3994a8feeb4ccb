// SPDX-License-Identifier: BSD-3-Clause
#include "Compression/IndexCoder.h"

#include "Base/Error.h"
#include "Compression/RangeCoder.h"

#ifdef CARTAN_HAVE_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace cartan
{
#ifdef CARTAN_HAVE_MESHOPTIMIZER
namespace
{
/// A code of meshoptimizer has a byte of version, a byte for each triangle, up to 5 for each
/// corner, and a table of 16.
constexpr std::size_t VersionBytes = 1;
constexpr std::size_t TableBytes = 16;
constexpr std::size_t MostBytesPerTriangle = 16;

/// The bytes of triangles after the byte before, the others by themselves.
template <typename Coder>
void CodeBytes(Coder& coder, std::size_t numberOfTriangles, std::vector<unsigned char>& bytes)
{
  std::vector<ByteModel> afterByte(256);
  ByteModel other;
  for (std::size_t i = 0; i < bytes.size(); ++i)
  {
    const bool isTriangle = i >= VersionBytes && i < VersionBytes + numberOfTriangles;
    ByteModel& model = isTriangle ? afterByte[bytes[i - 1]] : other;
    bytes[i] = model.Code(coder, bytes[i]);
  }
}
}

std::vector<unsigned char> EncodeTriangles(const Triangles& triangles, int numberOfVertices)
{
  const auto indices = static_cast<std::size_t>(triangles.size());
  const std::vector<unsigned int> corners(triangles.data(), triangles.data() + indices);
  std::vector<unsigned char> bytes(
    meshopt_encodeIndexBufferBound(indices, static_cast<std::size_t>(numberOfVertices)));
  meshopt_encodeIndexVersion(1);
  bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), corners.data(), indices));
  RangeEncoder coder;
  coder.CodeRaw(static_cast<std::uint32_t>(bytes.size()), 32);
  CodeBytes(coder, indices / 3, bytes);
  return coder.Finish();
}

Triangles DecodeTriangles(const unsigned char* bytes, std::size_t size, int numberOfTriangles)
{
  const auto count = static_cast<std::size_t>(numberOfTriangles);
  RangeDecoder coder(bytes, size);
  const std::size_t length = coder.CodeRaw(0, 32);
  if (length < VersionBytes + count + TableBytes ||
    length > VersionBytes + MostBytesPerTriangle * count + TableBytes)
  {
    throw Error(ErrorCode::BadInput, "the connectivity has a wrong length");
  }
  std::vector<unsigned char> code(length);
  CodeBytes(coder, count, code);
  std::vector<unsigned int> corners(3 * count);
  if (meshopt_decodeIndexBuffer(
        corners.data(), corners.size(), sizeof(unsigned int), code.data(), code.size()) != 0)
  {
    throw Error(ErrorCode::BadInput, "the connectivity cannot be decoded");
  }
  Triangles triangles(numberOfTriangles, 3);
  std::copy(corners.begin(), corners.end(), triangles.data());
  return triangles;
}
#else
namespace
{
[[noreturn]] void Refuse()
{
  throw Error(ErrorCode::BadInput,
    "meshoptimizer, which codes the connectivity of compressed surfaces, is not part of this "
    "build: it needs CARTAN_USE_MESHOPTIMIZER.");
}
}

std::vector<unsigned char> EncodeTriangles(const Triangles&, int)
{
  Refuse();
}

Triangles DecodeTriangles(const unsigned char*, std::size_t, int)
{
  Refuse();
}
#endif
}
