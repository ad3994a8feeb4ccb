// SPDX-License-Identifier: BSD-3-Clause
#include "Compression/RangeCoder.h"

#include "Base/Error.h"

namespace cartan
{
namespace
{
/// Where [low, high] is split: the lower part is that of a 1.
std::uint32_t Middle(std::uint32_t low, std::uint32_t high, std::uint32_t probability)
{
  return low + static_cast<std::uint32_t>((std::uint64_t{ high - low } * probability) >> 16);
}

/// Whether all numbers of [low, high] have the same highest byte, which is then known.
bool SharesHighestByte(std::uint32_t low, std::uint32_t high)
{
  return ((low ^ high) & 0xff000000) == 0;
}

constexpr std::uint32_t Half = 1 << 15;
}

bool RangeEncoder::Code(BitModel& model, bool bit)
{
  this->Split(model.GetProbability(), bit);
  model.Update(bit);
  return bit;
}

std::uint32_t RangeEncoder::CodeRaw(std::uint32_t value, int count)
{
  for (int bit = count - 1; bit >= 0; --bit)
  {
    this->Split(Half, (value >> bit & 1) != 0);
  }
  return value;
}

void RangeEncoder::Split(std::uint32_t probability, bool bit)
{
  const std::uint32_t middle = Middle(this->Low, this->High, probability);
  (bit ? this->High : this->Low) = bit ? middle : middle + 1;
  while (SharesHighestByte(this->Low, this->High))
  {
    this->Bytes.push_back(static_cast<unsigned char>(this->High >> 24));
    this->Low <<= 8;
    this->High = this->High << 8 | 255;
  }
}

std::vector<unsigned char> RangeEncoder::Finish()
{
  for (int shift = 24; shift >= 0; shift -= 8)
  {
    this->Bytes.push_back(static_cast<unsigned char>(this->Low >> shift));
  }
  return std::move(this->Bytes);
}

RangeDecoder::RangeDecoder(const unsigned char* bytes, std::size_t size)
  : At(bytes)
  , End(bytes + size)
{
  for (int i = 0; i < 4; ++i)
  {
    this->Value = this->Value << 8 | this->Next();
  }
}

bool RangeDecoder::Code(BitModel& model, bool)
{
  const bool bit = this->Split(model.GetProbability());
  model.Update(bit);
  return bit;
}

std::uint32_t RangeDecoder::CodeRaw(std::uint32_t, int count)
{
  std::uint32_t value = 0;
  for (int bit = 0; bit < count; ++bit)
  {
    value = value << 1 | (this->Split(Half) ? 1 : 0);
  }
  return value;
}

bool RangeDecoder::Split(std::uint32_t probability)
{
  const std::uint32_t middle = Middle(this->Low, this->High, probability);
  const bool bit = this->Value <= middle;
  (bit ? this->High : this->Low) = bit ? middle : middle + 1;
  while (SharesHighestByte(this->Low, this->High))
  {
    this->Low <<= 8;
    this->High = this->High << 8 | 255;
    this->Value = this->Value << 8 | this->Next();
  }
  return bit;
}

unsigned char RangeDecoder::Next()
{
  if (this->At == this->End)
  {
    throw Error(ErrorCode::BadInput, "the coded numbers end too early");
  }
  return *this->At++;
}
}
