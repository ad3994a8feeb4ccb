// SPDX-License-Identifier: BSD-3-Clause
#include "Compression/SectionFile.h"

#include "Base/Error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace cartan
{
namespace
{
constexpr std::array<unsigned char, 8> Magic = { 0x89, 'C', 'S', 'F', '\r', '\n', 0x1a, '\n' };
constexpr std::size_t HeadSize = Magic.size() + 8;
constexpr std::size_t EntrySize = 16;

[[noreturn]] void Refuse(const std::string& what)
{
  throw Error(ErrorCode::BadInput, what);
}

/// The polynomial of CRC-32, bits reversed, divided into every byte.
std::array<std::uint32_t, 256> MakeChecksumTable()
{
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte)
  {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit)
    {
      rest = rest & 1 ? 0xedb88320 ^ rest >> 1 : rest >> 1;
    }
    table[byte] = rest;
  }
  return table;
}
}

std::uint32_t sectionfile::Checksum(const unsigned char* bytes, std::size_t size)
{
  static const std::array<std::uint32_t, 256> table = MakeChecksumTable();
  std::uint32_t rest = 0xffffffff;
  for (std::size_t i = 0; i < size; ++i)
  {
    rest = table[(rest ^ bytes[i]) & 255] ^ rest >> 8;
  }
  return ~rest;
}

bool sectionfile::HasMagic(const unsigned char* bytes, std::size_t size)
{
  return size >= Magic.size() && std::equal(Magic.begin(), Magic.end(), bytes);
}

std::vector<unsigned char> sectionfile::Write(const std::vector<Section>& sections)
{
  ByteWriter head;
  head.Append({ Magic.begin(), Magic.end() });
  head.U32(Version);
  head.U32(static_cast<std::uint32_t>(sections.size()));
  for (const Section& section : sections)
  {
    head.U32(section.Tag);
    head.U32(Checksum(section.Bytes.data(), section.Bytes.size()));
    head.U64(section.Bytes.size());
  }
  std::vector<unsigned char> bytes = head.Finish();
  ByteWriter file;
  file.Append(bytes);
  file.U32(Checksum(bytes.data(), bytes.size()));
  for (const Section& section : sections)
  {
    file.Append(section.Bytes);
  }
  return file.Finish();
}

std::vector<sectionfile::SectionView> sectionfile::Read(
  const unsigned char* bytes, std::size_t size)
{
  if (!HasMagic(bytes, size))
  {
    Refuse("it is not a compressed surface");
  }
  if (size < HeadSize)
  {
    Refuse("the header is cut off");
  }
  ByteReader head({ 0, bytes + Magic.size(), size - Magic.size() });
  const std::uint32_t version = head.U32();
  const std::uint64_t count = head.U32();
  if (version != Version)
  {
    Refuse("its format has version " + std::to_string(version) + ", and version " +
      std::to_string(Version) + " can be read");
  }
  if (count > (size - HeadSize) / EntrySize)
  {
    Refuse("the header is cut off");
  }
  const std::size_t headSize = HeadSize + static_cast<std::size_t>(count) * EntrySize;
  std::vector<SectionView> sections(static_cast<std::size_t>(count));
  std::vector<std::uint32_t> sums;
  std::size_t at = headSize + 4;
  for (SectionView& section : sections)
  {
    section.Tag = head.U32();
    sums.push_back(head.U32());
    const std::uint64_t length = head.U64();
    if (at > size || length > size - at)
    {
      Refuse("it is cut off, or its header is damaged");
    }
    section.Bytes = bytes + at;
    section.Size = static_cast<std::size_t>(length);
    at += section.Size;
  }
  if (at != size || head.U32() != Checksum(bytes, headSize))
  {
    Refuse("its header is damaged, or bytes follow its end");
  }
  for (std::size_t i = 0; i < sections.size(); ++i)
  {
    if (Checksum(sections[i].Bytes, sections[i].Size) != sums[i])
    {
      Refuse("the checksum of section " + std::to_string(i) + " is wrong");
    }
  }
  return sections;
}

void ByteWriter::Number(std::uint64_t value, int count)
{
  for (int i = 0; i < count; ++i)
  {
    this->U8(static_cast<std::uint8_t>(value >> (8 * i)));
  }
}

void ByteWriter::F64(double value)
{
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  this->U64(bits);
}

void ByteWriter::Text(const std::string& text)
{
  this->U32(static_cast<std::uint32_t>(text.size()));
  this->Bytes.insert(this->Bytes.end(), text.begin(), text.end());
}

void ByteWriter::Append(const std::vector<unsigned char>& bytes)
{
  this->Bytes.insert(this->Bytes.end(), bytes.begin(), bytes.end());
}

void ByteWriter::AppendFor(
  const std::vector<unsigned char>& code, std::size_t elements, std::size_t mostPerByte)
{
  this->Append(code);
  const std::size_t least = (elements + mostPerByte - 1) / mostPerByte;
  this->Bytes.insert(this->Bytes.end(), least > code.size() ? least - code.size() : 0, 0);
}

void ByteReader::RequireRestFor(std::uint64_t elements) const
{
  if (elements / ByteWriter::MostElementsPerByte > this->RestSize())
  {
    Refuse("a section is too short for what it is said to have");
  }
}

std::uint64_t ByteReader::Number(int count)
{
  if (this->RestSize() < static_cast<std::size_t>(count))
  {
    Refuse("a section ends too early");
  }
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i)
  {
    value |= std::uint64_t{ *this->At++ } << (8 * i);
  }
  return value;
}

double ByteReader::AnyF64()
{
  const std::uint64_t bits = this->U64();
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

double ByteReader::F64()
{
  const double value = this->AnyF64();
  if (!std::isfinite(value))
  {
    Refuse("a number is not finite");
  }
  return value;
}

std::string ByteReader::Text()
{
  const std::uint32_t length = this->U32();
  if (length > this->RestSize())
  {
    Refuse("a section ends too early");
  }
  const unsigned char* begin = this->At;
  this->At += length;
  return { begin, begin + length };
}
}
