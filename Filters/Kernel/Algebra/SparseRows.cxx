// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/SparseRows.h"

#include "Algebra/SparseProduct.h"

namespace cartan
{
namespace
{
double Product(double a, double b)
{
  return a * b;
}
double Product(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return a.dot(b);
}

/// Adds row `column` of left^T right to `sum`; `leftColumns` is left by columns.
template <typename Value>
void AddProductRow(const SparseRows<Value>& leftColumns, const SparseRows<Value>& right, int column,
  RowSum<double>& sum)
{
  for (const auto* left = leftColumns.Begin(column); left != leftColumns.End(column); ++left)
  {
    for (const auto* entry = right.Begin(left->Column); entry != right.End(left->Column); ++entry)
    {
      sum.Add(entry->Column, Product(left->Coefficient, entry->Coefficient));
    }
  }
}

/// How many products of two entries AddProductRow sums up for all rows.
template <typename Value>
std::int64_t CountTerms(const SparseRows<Value>& left, const SparseRows<Value>& right)
{
  std::int64_t terms = 0;
  for (int row = 0; row < left.Count(); ++row)
  {
    terms += (left.End(row) - left.Begin(row)) * (right.End(row) - right.Begin(row));
  }
  return terms;
}

/// A matrix of `size` rows that makeRange makes as AppendRows wants them.
SparseMatrix MatrixOfRows(int size, const ExecutionContext& context,
  const std::function<void(int, int, SparseRows<double>&)>& makeRange)
{
  SparseMatrix matrix(size, size);
  Eigen::Index entries = 0;
  for (const auto& [first, last] : RowBlocks(size))
  {
    SparseRows<double> rows;
    AppendRows(first, last, context, makeRange, rows);
    const std::size_t total = static_cast<std::size_t>(entries) + rows.Entries.size();
    matrix.data().reserve(static_cast<Eigen::Index>(ExpectedEntries(total, last, size)) - entries);
    matrix.data().resize(static_cast<Eigen::Index>(total));
    for (int row = first; row < last; ++row)
    {
      for (const auto* entry = rows.Begin(row - first); entry != rows.End(row - first); ++entry)
      {
        matrix.innerIndexPtr()[entries] = entry->Column;
        matrix.valuePtr()[entries] = entry->Coefficient;
        ++entries;
      }
      matrix.outerIndexPtr()[row + 1] = static_cast<int>(entries);
    }
  }
  return matrix;
}
}

std::vector<std::pair<int, int>> RowBlocks(int count)
{
  constexpr int blocks = 8;
  std::vector<std::pair<int, int>> ends;
  for (int block = 0; block < blocks; ++block)
  {
    const auto end = [count](int number)
    { return static_cast<int>(static_cast<std::int64_t>(count) * number / blocks); };
    if (end(block) < end(block + 1))
    {
      ends.emplace_back(end(block), end(block + 1));
    }
  }
  return ends;
}

std::size_t ExpectedEntries(std::size_t entries, int made, int count)
{
  // A twentieth more than so far on the average.
  const double expected = 1.05 * static_cast<double>(entries) / made * count;
  return made < count ? std::max(entries, static_cast<std::size_t>(expected)) : entries;
}

SparseMatrix NormalMatrix(int size, int numberOfFree, const SparseRows<double>& residuals,
  const SparseRows<Eigen::Vector3d>& gradients, const SparseRows<Eigen::Vector3d>& differences,
  const ExecutionContext& context)
{
  const SparseRows<double> residualColumns = residuals.Transposed(size);
  const SparseRows<Eigen::Vector3d> gradientColumns = gradients.Transposed(size);
  const auto isRead = [numberOfFree](int row, int column)
  { return row < numberOfFree || column < numberOfFree; };
  const auto addRow = [&](int row, RowSum<double>& sum)
  {
    sum.Clear();
    AddProductRow(residualColumns, residuals, row, sum);
    AddProductRow(gradientColumns, differences, row, sum);
  };
  // The exact count takes as long as the product.
  if (CountTerms(residuals, residuals) + CountTerms(gradients, differences) > GetEntryLimit())
  {
    std::int64_t entries = 0;
    RowSum<double> sum(size);
    for (int row = 0; row < size; ++row)
    {
      addRow(row, sum);
      entries += std::count_if(sum.Columns().begin(), sum.Columns().end(),
        [&](int column) { return isRead(row, column); });
    }
    RequireIndexable(entries, "The normal system");
  }
  return MatrixOfRows(size, context,
    [&](int begin, int end, SparseRows<double>& part)
    {
      RowSum<double> sum(size);
      for (int row = begin; row < end; ++row)
      {
        addRow(row, sum);
        std::sort(sum.Columns().begin(), sum.Columns().end());
        for (const int column : sum.Columns())
        {
          if (isRead(row, column))
          {
            part.Add(column, sum.At(column));
          }
        }
        part.FinishRow();
      }
    });
}
}
