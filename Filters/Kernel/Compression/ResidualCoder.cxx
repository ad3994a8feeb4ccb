// SPDX-License-Identifier: BSD-3-Clause
#include "Compression/ResidualCoder.h"

#include "Base/Error.h"

#include <cstdlib>

namespace cartan
{
namespace
{
/// 2^(k / 2.5) in sixteenths, rounded up: classes of sizes that grow by a third.
constexpr std::array<int, 23> ClassLimits = { 22, 28, 37, 49, 64, 85, 112, 148, 194, 256, 338, 446,
  589, 777, 1024, 1352, 1784, 2353, 3105, 4096, 5405, 7132, 9411 };
constexpr int NumberOfClasses = static_cast<int>(ClassLimits.size()) + 1;
constexpr int LargestLean = 6; // classes to each side of the sign's context
constexpr int LargestValue = 65535;

/// What is known of the number at an axis of a vertex before it is coded.
struct Context
{
  std::int64_t Sizes = 0;     ///< weighted sum of the sizes around
  std::int64_t Weight = 0;    ///< of it
  std::int64_t Sum = 0;       ///< of the neighbors' numbers
  std::int64_t Neighbors = 0; ///< how many

  /// What the neighbors' mean says of the number: three tenths of it, rounded.
  std::int32_t Prediction() const
  {
    if (this->Neighbors == 0)
    {
      return 0;
    }
    const std::int64_t tenths = 3 * this->Sum;
    const std::int64_t half = 5 * this->Neighbors;
    return static_cast<std::int32_t>(
      (tenths < 0 ? tenths - half : tenths + half) / (10 * this->Neighbors));
  }

  /// The class of the mean size m around, by 1 + 2 m.
  int SizeClass() const
  {
    const std::int64_t size =
      this->Weight > 0 ? 16 + 32 * this->Sizes / this->Weight : ClassLimits[NumberOfClasses / 2];
    int number = 0;
    while (number < NumberOfClasses - 1 && size >= ClassLimits[number])
    {
      ++number;
    }
    return number;
  }

  /// How much the neighbors agree on a sign: the mean over the mean size, in quarters.
  int Lean() const
  {
    if (this->Neighbors == 0)
    {
      return 0;
    }
    const std::int64_t lean = 4 * this->Sum * this->Weight / (this->Neighbors * (this->Sizes + 1));
    return static_cast<int>(std::clamp<std::int64_t>(lean, -LargestLean, LargestLean));
  }
};

/// The neighbors' number of the same axis counts twice, the vertex's own numbers of the axes
/// before as much as a neighbor.
Context ContextOf(const TriangleMesh& mesh, const Residuals& values, int v, int axis)
{
  Context context;
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const int neighbor = mesh.Neighbor(d);
    if (neighbor < v)
    {
      const auto row = values.row(neighbor);
      context.Sizes += std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]) + std::abs(row[axis]);
      context.Weight += 4;
      context.Sum += row[axis];
      ++context.Neighbors;
    }
  }
  for (int before = 0; before < axis; ++before)
  {
    context.Sizes += 2 * std::abs(values(v, before));
  }
  context.Weight += axis > 0 ? 4 : 0;
  return context;
}

template <typename Coder>
void CodeAll(Coder& coder, const TriangleMesh& mesh, Residuals& values)
{
  std::vector<LengthModel> lengths(NumberOfClasses);
  std::vector<BitModel> signs(2 * LargestLean + 1);
  IntegerCoder<Coder> integers(coder);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int axis = 0; mesh.IsUsed(v) && axis < 3; ++axis)
    {
      const Context context = ContextOf(mesh, values, v, axis);
      const std::int32_t prediction = context.Prediction();
      const std::int32_t coded = integers.Code(lengths[context.SizeClass()],
        signs[context.Lean() + LargestLean], values(v, axis) - prediction);
      if (std::abs(static_cast<std::int64_t>(coded) + prediction) > LargestValue)
      {
        throw Error(ErrorCode::BadInput, "a differential coordinate is out of range");
      }
      values(v, axis) = coded + prediction;
    }
  }
}
}

void CodeResiduals(RangeEncoder& coder, const TriangleMesh& mesh, Residuals& values)
{
  CodeAll(coder, mesh, values);
}

void CodeResiduals(RangeDecoder& coder, const TriangleMesh& mesh, Residuals& values)
{
  CodeAll(coder, mesh, values);
}
}
