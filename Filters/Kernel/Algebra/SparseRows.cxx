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
}

SparseMatrix NormalMatrix(int size, int numberOfFree, const SparseRows<double>& residuals,
  const SparseRows<Eigen::Vector3d>& gradients, const SparseRows<Eigen::Vector3d>& differences,
  const ExecutionContext& context)
{
  const SparseRows<double> residualColumns = residuals.Transposed(size);
  const SparseRows<Eigen::Vector3d> gradientColumns = gradients.Transposed(size);
  const SparseRows<double> rows = MakeRows<double>(size, context,
    [&](int begin, int end, SparseRows<double>& part)
    {
      RowSum<double> sum(size);
      for (int row = begin; row < end; ++row)
      {
        sum.Clear();
        AddProductRow(residualColumns, residuals, row, sum);
        AddProductRow(gradientColumns, differences, row, sum);
        std::sort(sum.Columns().begin(), sum.Columns().end());
        for (const int column : sum.Columns())
        {
          if (row < numberOfFree || column < numberOfFree)
          {
            part.Add(column, sum.At(column));
          }
        }
        part.FinishRow();
      }
    });
  RequireIndexable(static_cast<std::int64_t>(rows.Entries.size()), "The normal system");
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
