// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Entropy coding of binary decisions (Martin, Range Encoding: an Algorithm for Removing
/// Redundancy from a Digitized Message, 1979) with probabilities that are learned from the
/// decisions before. Encoder and decoder have the same function Code(), so that what is
/// coded is written down once, as a template of the coder, and cannot differ. All numbers
/// are whole ones: every machine decodes the same.
namespace cartan
{
/// How likely a decision is 1: the share of ones, in parts of 2^16, so far. The older ones
/// fade when there are many.
class BitModel
{
public:
  std::uint32_t GetProbability() const { return this->Probability; }

  void Update(bool bit)
  {
    const std::int32_t target = bit ? 65536 : 0;
    const std::int32_t moved = static_cast<std::int32_t>(this->Probability) +
      (target - static_cast<std::int32_t>(this->Probability)) * 2 / (2 * this->Count + 3);
    // No decision is ever free or impossible.
    this->Probability = static_cast<std::uint16_t>(std::clamp(moved, 32, 65536 - 32));
    this->Count = static_cast<std::uint16_t>(std::min<int>(this->Count + 1, Memory));
  }

private:
  static constexpr int Memory = 250; // decisions

  std::uint16_t Probability = 1 << 15;
  std::uint16_t Count = 0;
};

class RangeEncoder
{
public:
  /// Returns `bit`.
  bool Code(BitModel& model, bool bit);

  /// The lowest `count` <= 32 bits of `value`, which may be anything. Returns `value`.
  std::uint32_t CodeRaw(std::uint32_t value, int count);

  /// The bytes of all that was coded.
  std::vector<unsigned char> Finish();

private:
  void Split(std::uint32_t probability, bool bit);

  std::uint32_t Low = 0;
  std::uint32_t High = 0xffffffff;
  std::vector<unsigned char> Bytes;
};

/// Reads `size` bytes that must outlive it. Throws Error(BadInput) when there is more to
/// decode than they have.
class RangeDecoder
{
public:
  RangeDecoder(const unsigned char* bytes, std::size_t size);

  /// The next decision; the second argument is not looked at.
  bool Code(BitModel& model, bool = false);
  std::uint32_t CodeRaw(std::uint32_t, int count);

private:
  bool Split(std::uint32_t probability);
  unsigned char Next();

  const unsigned char* At;
  const unsigned char* End;
  std::uint32_t Low = 0;
  std::uint32_t High = 0xffffffff;
  std::uint32_t Value = 0;
};

/// A byte, bit by bit from the highest, each with those before as its context.
class ByteModel
{
public:
  template <typename Coder>
  unsigned char Code(Coder& coder, unsigned char byte = 0)
  {
    unsigned node = 1;
    for (int bit = 7; bit >= 0; --bit)
    {
      node = 2 * node + (coder.Code(this->Nodes[node], (byte >> bit & 1) != 0) ? 1 : 0);
    }
    return static_cast<unsigned char>(node);
  }

private:
  std::array<BitModel, 256> Nodes;
};

/// How many bits the size of a number has, one decision for each more.
class LengthModel
{
public:
  static constexpr int Most = 31;

  template <typename Coder>
  int Code(Coder& coder, std::uint32_t size)
  {
    int length = 0;
    while (length < Most && coder.Code(this->Longer[length], size >> length != 0))
    {
      ++length;
    }
    return length;
  }

private:
  std::array<BitModel, Most> Longer;
};

/// Signed whole numbers of less than 2^31: the length and the sign by models that the caller
/// chooses, then the bits below the highest, of which the first few are learned for each
/// length.
template <typename Coder>
class IntegerCoder
{
public:
  explicit IntegerCoder(Coder& coder)
    : TheCoder(coder)
  {
  }

  std::int32_t Code(LengthModel& lengths, BitModel& sign, std::int32_t value = 0)
  {
    const auto size = static_cast<std::uint32_t>(value < 0 ? -value : value);
    const int length = lengths.Code(this->TheCoder, size);
    if (length == 0)
    {
      return 0;
    }
    const bool isNegative = this->TheCoder.Code(sign, value < 0);
    std::uint32_t prefix = 1;
    int rest = length - 1;
    for (; rest > 0 && prefix < Learned; --rest)
    {
      const bool bit =
        this->TheCoder.Code(this->Mantissas[length][prefix], (size >> (rest - 1) & 1) != 0);
      prefix = 2 * prefix + (bit ? 1 : 0);
    }
    const std::uint32_t mask = (std::uint32_t{ 1 } << rest) - 1;
    const auto coded =
      static_cast<std::int32_t>(prefix << rest | this->TheCoder.CodeRaw(size & mask, rest));
    return isNegative ? -coded : coded;
  }

private:
  static constexpr std::uint32_t Learned = 8;

  Coder& TheCoder;
  std::array<std::array<BitModel, Learned>, LengthModel::Most + 1> Mantissas;
};
}
