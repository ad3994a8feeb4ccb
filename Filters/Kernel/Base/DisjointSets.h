// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>
#include <vector>

namespace cartan
{
/// The numbers 0 ... count - 1 in sets that grow together, each set known by one
/// of its members.
class DisjointSets
{
public:
  explicit DisjointSets(int count)
    : Parent(count)
  {
    std::iota(this->Parent.begin(), this->Parent.end(), 0);
  }

  /// The member that stands for the set of i. Halves the paths it goes.
  int Find(int i)
  {
    while (this->Parent[i] != i)
    {
      i = this->Parent[i] = this->Parent[this->Parent[i]];
    }
    return i;
  }

  /// Makes one set of those of i and j; returns whether they were two.
  bool Join(int i, int j)
  {
    const int a = this->Find(i);
    const int b = this->Find(j);
    this->Parent[a] = b;
    return a != b;
  }

private:
  std::vector<int> Parent;
};
}
