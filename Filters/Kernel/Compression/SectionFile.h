// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cartan
{
/// A file of sections, each with a tag, its length and a checksum. All numbers are little
/// endian:
///
///     8 bytes   magic: a byte that is no text, "CSF", and line ends that a transfer as text
///               would change
///     u32       version of the format
///     u32       number of sections
///     for each  u32 tag, u32 CRC-32 of its bytes, u64 length
///     u32       CRC-32 of all before
///     the bytes of all sections, one after the other, to the end of the file
namespace sectionfile
{
constexpr std::uint32_t Version = 2;

struct Section
{
  std::uint32_t Tag = 0;
  std::vector<unsigned char> Bytes;
};

/// A section of a file in memory, which must outlive it.
struct SectionView
{
  std::uint32_t Tag = 0;
  const unsigned char* Bytes = nullptr;
  std::size_t Size = 0;
};

/// CRC-32 as in ISO 3309, PNG and zlib.
std::uint32_t Checksum(const unsigned char* bytes, std::size_t size);

/// Whether bytes begin as such a file does.
bool HasMagic(const unsigned char* bytes, std::size_t size);

std::vector<unsigned char> Write(const std::vector<Section>& sections);

/// Throws Error(BadInput) unless all lengths and checksums are right. Takes no memory but
/// for the views, which are fewer than the bytes.
std::vector<SectionView> Read(const unsigned char* bytes, std::size_t size);
}

/// Appends numbers to bytes.
class ByteWriter
{
public:
  static constexpr std::size_t MostElementsPerByte = 8;
  static constexpr std::size_t MostTrianglesPerByte = 32; // of regular surfaces

  void U8(std::uint8_t value) { this->Bytes.push_back(value); }
  void U32(std::uint32_t value) { this->Number(value, 4); }
  void U64(std::uint64_t value) { this->Number(value, 8); }
  void F64(double value);
  void Text(const std::string& text);
  void Append(const std::vector<unsigned char>& bytes);

  /// Appends the code of so many elements, and zeros where it has less than a byte for
  /// `mostPerByte` of them: a decoder need not believe in more.
  void AppendFor(const std::vector<unsigned char>& code, std::size_t elements,
    std::size_t mostPerByte = MostElementsPerByte);

  std::vector<unsigned char> Finish() { return std::move(this->Bytes); }

private:
  void Number(std::uint64_t value, int count);

  std::vector<unsigned char> Bytes;
};

/// Reads them back. Throws Error(BadInput) at the end.
class ByteReader
{
public:
  explicit ByteReader(const sectionfile::SectionView& section)
    : At(section.Bytes)
    , End(section.Bytes + section.Size)
  {
  }

  std::uint8_t U8() { return static_cast<std::uint8_t>(this->Number(1)); }
  std::uint32_t U32() { return static_cast<std::uint32_t>(this->Number(4)); }
  std::uint64_t U64() { return this->Number(8); }

  /// Any, and one that is finite, or an error.
  double AnyF64();
  double F64();
  std::string Text();

  /// What is left, and an error if that is too little for a code of so many elements.
  void RequireRestFor(std::uint64_t elements) const;
  const unsigned char* Rest() const { return this->At; }
  std::size_t RestSize() const { return static_cast<std::size_t>(this->End - this->At); }

private:
  std::uint64_t Number(int count);

  const unsigned char* At;
  const unsigned char* End;
};
}
