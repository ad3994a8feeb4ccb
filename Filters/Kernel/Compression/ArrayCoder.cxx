// SPDX-License-Identifier: BSD-3-Clause
#include "Compression/ArrayCoder.h"

#include "Base/Error.h"
#include "Compression/RangeCoder.h"
#include "Compression/SectionFile.h"

#include <cstring>

namespace cartan
{
namespace
{
/// A number of `size` bytes as a whole one, and back, on machines of any byte order.
std::uint64_t Load(const unsigned char* at, int size)
{
  std::uint8_t one8 = 0;
  std::uint16_t one16 = 0;
  std::uint32_t one32 = 0;
  std::uint64_t one64 = 0;
  switch (size)
  {
    case 1:
      std::memcpy(&one8, at, 1);
      return one8;
    case 2:
      std::memcpy(&one16, at, 2);
      return one16;
    case 4:
      std::memcpy(&one32, at, 4);
      return one32;
    default:
      std::memcpy(&one64, at, 8);
      return one64;
  }
}

void Store(std::uint64_t value, int size, unsigned char* at)
{
  const auto one8 = static_cast<std::uint8_t>(value);
  const auto one16 = static_cast<std::uint16_t>(value);
  const auto one32 = static_cast<std::uint32_t>(value);
  switch (size)
  {
    case 1:
      std::memcpy(at, &one8, 1);
      break;
    case 2:
      std::memcpy(at, &one16, 2);
      break;
    case 4:
      std::memcpy(at, &one32, 4);
      break;
    default:
      std::memcpy(at, &value, 8);
  }
}

/// Differences modulo 2^bits, small ones of either sign as small numbers: 0, -1, 1, -2, ...
std::uint64_t Fold(std::uint64_t difference, int bits)
{
  const std::uint64_t mask = ~std::uint64_t{ 0 } >> (64 - bits);
  const bool isNegative = (difference >> (bits - 1) & 1) != 0;
  return (isNegative ? ~(difference << 1) : difference << 1) & mask;
}

std::uint64_t Unfold(std::uint64_t folded, int bits)
{
  const std::uint64_t mask = ~std::uint64_t{ 0 } >> (64 - bits);
  return (folded & 1 ? ~(folded >> 1) : folded >> 1) & mask;
}

/// A byte by its place in the number and by whether a byte before it was not zero.
template <typename Coder>
void CodeValues(Coder& coder, CodedArray& array)
{
  const int size = SizeOf(array.Type);
  const auto components = static_cast<std::size_t>(array.Components);
  std::vector<ByteModel> models(2 * static_cast<std::size_t>(size));
  std::vector<std::uint64_t> before(components, 0);
  const std::size_t count = array.Bytes.size() / static_cast<std::size_t>(size);
  for (std::size_t i = 0; i < count; ++i)
  {
    unsigned char* at = array.Bytes.data() + i * static_cast<std::size_t>(size);
    std::uint64_t& last = before[i % components];
    const std::uint64_t folded = Fold(Load(at, size) - last, 8 * size);
    std::uint64_t coded = 0;
    for (int place = size - 1; place >= 0; --place)
    {
      const std::size_t isLater = coded != 0 ? 1 : 0;
      ByteModel& model = models[2 * static_cast<std::size_t>(place) + isLater];
      coded = coded << 8 | model.Code(coder, static_cast<unsigned char>(folded >> (8 * place)));
    }
    last += Unfold(coded, 8 * size);
    Store(last, size, at);
  }
}
}

int SizeOf(ScalarType type)
{
  switch (type)
  {
    case ScalarType::Int8:
    case ScalarType::UInt8:
      return 1;
    case ScalarType::Int16:
    case ScalarType::UInt16:
      return 2;
    case ScalarType::Float32:
    case ScalarType::Int32:
    case ScalarType::UInt32:
      return 4;
    case ScalarType::Float64:
    case ScalarType::Int64:
    case ScalarType::UInt64:
      return 8;
  }
  return 0;
}

void WriteArray(const CodedArray& array, ByteWriter& writer)
{
  writer.Text(array.Name);
  writer.U8(static_cast<std::uint8_t>(array.Type));
  writer.U32(static_cast<std::uint32_t>(array.Components));
  CodedArray copy = array;
  RangeEncoder coder;
  CodeValues(coder, copy);
  writer.AppendFor(
    coder.Finish(), array.Bytes.size() / static_cast<std::size_t>(SizeOf(array.Type)));
}

CodedArray ReadArray(ByteReader& reader, int numberOfTuples)
{
  CodedArray array;
  array.Name = reader.Text();
  array.Type = static_cast<ScalarType>(reader.U8());
  const std::uint32_t components = reader.U32();
  const int size = SizeOf(array.Type);
  const std::uint64_t values =
    std::uint64_t{ components } * static_cast<std::uint64_t>(numberOfTuples);
  if (size == 0 || components == 0)
  {
    throw Error(ErrorCode::BadInput, "a point array has an unknown type");
  }
  reader.RequireRestFor(values);
  array.Components = static_cast<int>(components);
  array.Bytes.resize(static_cast<std::size_t>(values) * static_cast<std::size_t>(size));
  RangeDecoder coder(reader.Rest(), reader.RestSize());
  CodeValues(coder, array);
  return array;
}
}
