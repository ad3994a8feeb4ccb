// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/SparseProduct.h"

#include "Base/Error.h"

#include <atomic>
#include <limits>
#include <vector>

namespace cartan
{
namespace
{
constexpr std::int64_t MostEntries = std::numeric_limits<SparseMatrix::StorageIndex>::max();

std::atomic<std::int64_t> entryLimit{ MostEntries };

/// The products of two entries that left * right sums up: no fewer than its
/// entries.
std::int64_t CountTerms(const SparseMatrix& left, const SparseMatrix& right)
{
  std::int64_t terms = 0;
  for (Eigen::Index k = 0; k < right.nonZeros(); ++k)
  {
    const int column = right.innerIndexPtr()[k];
    terms += left.outerIndexPtr()[column + 1] - left.outerIndexPtr()[column];
  }
  return terms;
}
}

std::int64_t GetEntryLimit()
{
  return entryLimit;
}

LowerEntryLimit::LowerEntryLimit(std::int64_t limit)
{
  entryLimit = limit;
}

LowerEntryLimit::~LowerEntryLimit()
{
  entryLimit = MostEntries;
}

void RequireIndexable(std::int64_t entries, const std::string& what)
{
  if (entries > GetEntryLimit())
  {
    throw Error(ErrorCode::TooLarge,
      what + " has " + std::to_string(entries) + " entries, more than the " +
        std::to_string(GetEntryLimit()) +
        " that its indices can count. Leave fewer points free, or decimate the surface.");
  }
}

std::int64_t CountProductEntries(const SparseMatrix& left, const SparseMatrix& right)
{
  std::int64_t entries = 0;
  std::vector<Eigen::Index> lastColumn(left.rows(), -1);
  for (Eigen::Index column = 0; column < right.outerSize(); ++column)
  {
    for (SparseMatrix::InnerIterator entry(right, column); entry; ++entry)
    {
      for (SparseMatrix::InnerIterator term(left, entry.index()); term; ++term)
      {
        entries += lastColumn[term.index()] != column ? 1 : 0;
        lastColumn[term.index()] = column;
      }
    }
  }
  return entries;
}

SparseMatrix CheckedProduct(
  const SparseMatrix& left, const SparseMatrix& right, const std::string& what)
{
  // The exact count takes as long as half of the product.
  if (CountTerms(left, right) > GetEntryLimit())
  {
    RequireIndexable(CountProductEntries(left, right), what);
  }
  return left * right;
}
}
