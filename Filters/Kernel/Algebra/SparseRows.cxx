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

/// The rows of NormalMatrix.
SparseRows<double> NormalRows(int size, int numberOfFree, const SparseRows<double>& residuals,
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
  return MakeRows<double>(size, context,
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

SparseMatrix NormalMatrix(int size, int numberOfFree, const SparseRows<double>& residuals,
  const SparseRows<Eigen::Vector3d>& gradients, const SparseRows<Eigen::Vector3d>& differences,
  const ExecutionContext& context)
{
  const SparseRows<double> rows =
    NormalRows(size, numberOfFree, residuals, gradients, differences, context);
  SparseMatrix matrix(size, size);
  matrix.resizeNonZeros(static_cast<Eigen::Index>(rows.Entries.size()));
  std::copy(rows.Offsets.begin(), rows.Offsets.end(), matrix.outerIndexPtr());
  for (std::size_t i = 0; i < rows.Entries.size(); ++i)
  {
    matrix.innerIndexPtr()[i] = rows.Entries[i].Column;
    matrix.valuePtr()[i] = rows.Entries[i].Coefficient;
  }
  return matrix;
}
}
