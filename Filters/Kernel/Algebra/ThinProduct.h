// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Base/Types.h"

#include <algorithm>

namespace cartan
{
/// Calls `action(first, count)` for parts of [0, size) that have `part` elements each, but
/// the last one, whatever the number of threads is.
template <typename Action>
void ForParts(
  Eigen::Index size, Eigen::Index part, const ExecutionContext& context, const Action& action)
{
  context.For(static_cast<int>((size + part - 1) / part),
    [&](int begin, int end)
    {
      for (Eigen::Index first = begin * part; first < std::min(end * part, size); first += part)
      {
        action(first, std::min(part, size - first));
      }
    });
}

/// Products of a large dense matrix `a` with a few columns go through panels of so many rows
/// and columns, which a cache holds for all of them: `a`, which no cache holds, passes by
/// once. Eigen's product of matrices would copy it first.
namespace panel
{
constexpr Eigen::Index Rows = 512;
constexpr Eigen::Index Columns = 8;
}

/// a^T b. #a's columns x #b's columns; the result does not depend on the number of threads.
inline Eigen::MatrixXd ThinTransposedProduct(const Eigen::Ref<const Eigen::MatrixXd>& a,
  const Eigen::Ref<const Eigen::MatrixXd>& b, const ExecutionContext& context = {})
{
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  ForParts(a.cols(), panel::Columns, context,
    [&](Eigen::Index first, Eigen::Index count)
    {
      for (Eigen::Index row = 0; row < a.rows(); row += panel::Rows)
      {
        const Eigen::Index rows = std::min(panel::Rows, a.rows() - row);
        const auto part = a.block(row, first, rows, count);
        for (Eigen::Index j = 0; j < b.cols(); ++j)
        {
          product.col(j).segment(first, count).noalias() +=
            part.transpose() * b.col(j).segment(row, rows);
        }
      }
    });
  return product;
}

/// b -= a c.
inline void SubtractThinProduct(const Eigen::Ref<const Eigen::MatrixXd>& a,
  const Eigen::Ref<const Eigen::MatrixXd>& c, Eigen::Ref<Eigen::MatrixXd> b,
  const ExecutionContext& context = {})
{
  ForParts(a.rows(), panel::Rows, context,
    [&](Eigen::Index row, Eigen::Index rows)
    {
      for (Eigen::Index first = 0; first < a.cols(); first += panel::Columns)
      {
        const Eigen::Index count = std::min(panel::Columns, a.cols() - first);
        const auto part = a.block(row, first, rows, count);
        for (Eigen::Index j = 0; j < b.cols(); ++j)
        {
          b.col(j).segment(row, rows).noalias() -= part * c.col(j).segment(first, count);
        }
      }
    });
}
}
