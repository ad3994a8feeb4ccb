// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cartan
{
class ByteReader;
class ByteWriter;

/// The number types of point arrays; their numbers are part of the format.
enum class ScalarType : std::uint8_t
{
  Float32 = 1,
  Float64,
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  UInt64
};

/// How many bytes a number has; 0 for what is no type.
int SizeOf(ScalarType type);

/// An array that keeps every bit.
struct CodedArray
{
  std::string Name;
  ScalarType Type = ScalarType::Float64;
  int Components = 1;
  std::vector<unsigned char> Bytes; ///< #V Components numbers in the order of this machine
};

/// Writes an array so that every bit of it comes back: numbers as whole ones, each as its
/// difference from the one before in its component.
void WriteArray(const CodedArray& array, ByteWriter& writer);

/// Reads an array of `numberOfTuples`. Throws Error(BadInput) when the bytes are none.
CodedArray ReadArray(ByteReader& reader, int numberOfTuples);
}
