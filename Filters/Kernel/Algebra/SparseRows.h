// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Base/CountingSort.h"
#include "Base/ExecutionContext.h"
#include "Base/Types.h"

#include <algorithm>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace cartan
{
/// Rows of a sparse matrix whose entries are of type Value.
template <typename Value>
struct SparseRows
{
  struct Entry
  {
    int Column;
    Value Coefficient;
  };
  std::vector<std::size_t> Offsets = { 0 };
  std::vector<Entry> Entries;

  int Count() const { return static_cast<int>(this->Offsets.size()) - 1; }
  const Entry* Begin(int row) const { return this->Entries.data() + this->Offsets[row]; }
  const Entry* End(int row) const { return this->Entries.data() + this->Offsets[row + 1]; }
  void Add(int column, const Value& value) { this->Entries.push_back({ column, value }); }
  void FinishRow() { this->Offsets.push_back(this->Entries.size()); }

  /// The same matrix by columns: row and column change places.
  SparseRows Transposed(int numberOfColumns) const
  {
    SparseRows transposed;
    CountingSort(
      numberOfColumns,
      [this](const auto& visit)
      {
        for (int row = 0; row < this->Count(); ++row)
        {
          for (const Entry* entry = this->Begin(row); entry != this->End(row); ++entry)
          {
            visit(entry->Column, Entry{ row, entry->Coefficient });
          }
        }
      },
      transposed.Offsets, transposed.Entries);
    return transposed;
  }
};

template <typename Value>
std::size_t BytesOf(const SparseRows<Value>& rows)
{
  return TotalBytes(rows.Offsets, rows.Entries);
}

/// Rows from `first` to `last` - 1 behind those of `rows`; makeRange(begin, end, part)
/// appends those from begin to end - 1 to `part`, in any order of the ranges and from any
/// thread.
template <typename Value>
void AppendRows(int first, int last, const ExecutionContext& context,
  const std::function<void(int begin, int end, SparseRows<Value>& part)>& makeRange,
  SparseRows<Value>& rows)
{
  std::vector<std::pair<int, SparseRows<Value>>> parts;
  std::mutex mutex;
  context.For(last - first,
    [&](int begin, int end)
    {
      SparseRows<Value> part;
      makeRange(first + begin, first + end, part);
      const std::lock_guard<std::mutex> lock(mutex);
      parts.emplace_back(begin, std::move(part));
    });
  std::sort(
    parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& [begin, part] : parts)
  {
    const std::size_t entries = rows.Entries.size();
    for (int row = 0; row < part.Count(); ++row)
    {
      rows.Offsets.push_back(entries + part.Offsets[row + 1]);
    }
    rows.Entries.insert(rows.Entries.end(), part.Entries.begin(), part.Entries.end());
    part = {};
  }
}

/// The first and one past the last row of each of a few blocks of `count` rows: what is made
/// block by block takes little more memory than what is made of it.
std::vector<std::pair<int, int>> RowBlocks(int count);

/// So many entries as `made` rows of `count` let expect for all, and a few more.
std::size_t ExpectedEntries(std::size_t entries, int made, int count);

/// `count` rows by AppendRows.
template <typename Value>
SparseRows<Value> MakeRows(int count, const ExecutionContext& context,
  const std::function<void(int begin, int end, SparseRows<Value>& part)>& makeRange)
{
  SparseRows<Value> rows;
  for (const auto& [first, last] : RowBlocks(count))
  {
    AppendRows(first, last, context, makeRange, rows);
    rows.Entries.reserve(ExpectedEntries(rows.Entries.size(), last, count));
  }
  return rows;
}

/// A row in the making: sums by column.
template <typename Value>
class RowSum
{
public:
  explicit RowSum(int numberOfColumns)
    : Values(numberOfColumns)
    , LastRow(numberOfColumns, 0)
  {
  }

  void Clear()
  {
    this->Touched.clear();
    ++this->Row;
  }

  void Add(int column, const Value& value)
  {
    if (this->LastRow[column] == this->Row)
    {
      this->Values[column] += value;
      return;
    }
    this->LastRow[column] = this->Row;
    this->Values[column] = value;
    this->Touched.push_back(column);
  }

  /// The columns that were added to, in the order of that.
  std::vector<int>& Columns() { return this->Touched; }
  const Value& At(int column) const { return this->Values[column]; }

private:
  std::vector<Value> Values;
  std::vector<int> LastRow;
  std::vector<int> Touched;
  int Row = 0; // counts from 1: LastRow starts with 0
};

/// residuals^T residuals + gradients^T differences, symmetric, of `size`
/// columns. Entries between columns that are both beyond `numberOfFree` are
/// left out: no solve reads them. Throws Error(TooLarge) where the matrix has more
/// entries than it can index.
SparseMatrix NormalMatrix(int size, int numberOfFree, const SparseRows<double>& residuals,
  const SparseRows<Eigen::Vector3d>& gradients, const SparseRows<Eigen::Vector3d>& differences,
  const ExecutionContext& context);
}
