// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Compression/RangeCoder.h"

#include "Kernel/Base/Error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using cartan::BitModel;
using cartan::ByteModel;
using cartan::IntegerCoder;
using cartan::LengthModel;
using cartan::RangeDecoder;
using cartan::RangeEncoder;

TEST(RangeCoder, TakesTheEntropy)
{
  // Shannon: no code of independent decisions takes less; a model that learns, little more.
  for (const double share : { 0.5, 0.1, 0.01 })
  {
    constexpr int Count = 100000;
    std::mt19937 random(7);
    std::bernoulli_distribution draw(share);
    std::vector<char> bits(Count);
    RangeEncoder encoder;
    BitModel model;
    int ones = 0;
    for (char& bit : bits)
    {
      bit = draw(random) ? 1 : 0;
      ones += bit;
      encoder.Code(model, bit != 0);
    }
    const std::vector<unsigned char> bytes = encoder.Finish();
    const double p = static_cast<double>(ones) / Count;
    const double entropy = -Count * (p * std::log2(p) + (1.0 - p) * std::log2(1.0 - p));
    EXPECT_GT(8.0 * static_cast<double>(bytes.size()), entropy) << share;
    EXPECT_LT(8.0 * static_cast<double>(bytes.size()), 1.02 * entropy + 64.0) << share;

    RangeDecoder decoder(bytes.data(), bytes.size());
    BitModel same;
    for (const char bit : bits)
    {
      ASSERT_EQ(decoder.Code(same), bit != 0);
    }
  }
}

TEST(RangeCoder, BringsNumbersOfEverySizeBack)
{
  std::vector<std::int32_t> numbers = { 0, 1, -1, 7, 8, 9, -1000,
    std::numeric_limits<std::int32_t>::max(), -std::numeric_limits<std::int32_t>::max() };
  for (int bit = 0; bit < 31; ++bit)
  {
    numbers.insert(numbers.end(), { 1 << bit, -(1 << bit), (1 << bit) - 1 });
  }
  RangeEncoder encoder;
  IntegerCoder<RangeEncoder> integers(encoder);
  LengthModel length;
  BitModel sign;
  ByteModel byte;
  for (const std::int32_t number : numbers)
  {
    EXPECT_EQ(integers.Code(length, sign, number), number);
    EXPECT_EQ(
      encoder.CodeRaw(static_cast<std::uint32_t>(number), 32), static_cast<std::uint32_t>(number));
    const auto low = static_cast<unsigned char>(number);
    EXPECT_EQ(byte.Code(encoder, low), low);
  }
  const std::vector<unsigned char> bytes = encoder.Finish();
  RangeDecoder decoder(bytes.data(), bytes.size());
  IntegerCoder<RangeDecoder> integersThere(decoder);
  LengthModel lengthThere;
  BitModel signThere;
  ByteModel byteThere;
  for (const std::int32_t number : numbers)
  {
    ASSERT_EQ(integersThere.Code(lengthThere, signThere), number);
    ASSERT_EQ(decoder.CodeRaw(0, 32), static_cast<std::uint32_t>(number));
    ASSERT_EQ(byteThere.Code(decoder), static_cast<unsigned char>(number));
  }
}

TEST(RangeCoder, RefusesToDecodeMoreThanThereIs)
{
  RangeEncoder encoder;
  encoder.CodeRaw(12345, 20);
  const std::vector<unsigned char> bytes = encoder.Finish();
  RangeDecoder decoder(bytes.data(), bytes.size());
  EXPECT_EQ(decoder.CodeRaw(0, 20), 12345u);
  EXPECT_THROW(
    for (int i = 0; i < 3; ++i) { decoder.CodeRaw(0, 32); }, cartan::Error);
  EXPECT_THROW(RangeDecoder(bytes.data(), 3), cartan::Error);
}
