// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>

namespace cartan
{
/// Puts the closest rotation (see ProjectOnRotations) in the place of each of `count` matrices of
/// nine numbers, as rows of Matrices have them: several at once, in a fifth of the time that one
/// by one takes, and to the last bit the same wherever a matrix is among the others.
void ProjectAllOnRotations(double* matrices, int count);

/// Calls `write(i, R)` with the rotation closest to a matrix, for each i of a range for which
/// `read(i, A)` writes a matrix and returns true.
template <typename Read, typename Write>
void ForClosestRotations(int begin, int end, const Read& read, const Write& write)
{
  // As many as the processor's first cache holds beside what they are made from.
  constexpr int block = 64;
  double matrices[9 * block];
  int indices[block];
  const auto at = [&matrices](int k) { return Eigen::Map<Eigen::Matrix3d>(matrices + 9 * k); };
  for (int first = begin; first < end; first += block)
  {
    int count = 0;
    for (int i = first; i < std::min(first + block, end); ++i)
    {
      if (read(i, at(count)))
      {
        indices[count++] = i;
      }
    }
    ProjectAllOnRotations(matrices, count);
    for (int k = 0; k < count; ++k)
    {
      write(indices[k], at(k));
    }
  }
}
}
