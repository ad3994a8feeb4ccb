// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <cstdint>
#include <string>

namespace cartan
{
/// The most entries that a matrix may have: what SparseMatrix can index, 2^31 - 1.
std::int64_t GetEntryLimit();

/// Lowers it while this lives: tests need not fill the memory of a machine.
class LowerEntryLimit
{
public:
  explicit LowerEntryLimit(std::int64_t limit);
  ~LowerEntryLimit();
  LowerEntryLimit(const LowerEntryLimit&) = delete;
  LowerEntryLimit& operator=(const LowerEntryLimit&) = delete;
};

/// Throws Error(TooLarge) for a matrix of more entries than GetEntryLimit, before
/// it is built. `what` begins the message: "The system
/// of the frames".
void RequireIndexable(std::int64_t entries, const std::string& what);

/// How many entries left * right has.
std::int64_t CountProductEntries(const SparseMatrix& left, const SparseMatrix& right);

/// left * right; RequireIndexable before it is built.
SparseMatrix CheckedProduct(
  const SparseMatrix& left, const SparseMatrix& right, const std::string& what);
}
