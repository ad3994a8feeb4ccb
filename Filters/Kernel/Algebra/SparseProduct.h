// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <cstdint>
#include <string>

namespace cartan
{
/// Throws Error(TooLarge) for a matrix with more entries than SparseMatrix can
/// index, 2^31 - 1: before it is built. `what` begins the message: "The system
/// of the frames".
void RequireIndexable(std::int64_t entries, const std::string& what);

/// How many entries left * right has.
std::int64_t CountProductEntries(const SparseMatrix& left, const SparseMatrix& right);

/// left * right; RequireIndexable before it is built.
SparseMatrix CheckedProduct(
  const SparseMatrix& left, const SparseMatrix& right, const std::string& what);
}
