// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Base/CountingSort.h"
#include "Kernel/Base/FloodFill.h"
#include "Kernel/Base/IdSet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <set>
#include <utility>
#include <vector>

using namespace cartan;

TEST(CountingSort, IsAStableSortByGroup)
{
  std::mt19937 random(1);
  for (const int groups : { 1, 7, 100 })
  {
    std::vector<std::pair<int, int>> items;
    for (int i = 0; i < 60; ++i)
    {
      items.emplace_back(random() % groups, i);
    }
    std::vector<std::size_t> offsets;
    std::vector<int> sorted;
    CountingSort(
      groups,
      [&items](const auto& visit)
      {
        for (const auto& [group, item] : items)
        {
          visit(group, item);
        }
      },
      offsets, sorted);
    std::stable_sort(
      items.begin(), items.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    ASSERT_EQ(sorted.size(), items.size());
    ASSERT_EQ(offsets.size(), groups + 1u);
    for (int group = 0; group < groups; ++group)
    {
      for (std::size_t i = offsets[group]; i < offsets[group + 1]; ++i)
      {
        EXPECT_EQ(items[i], std::make_pair(group, sorted[i]));
      }
    }
  }
}

TEST(CountingSort, SortsNothingIntoNoGroups)
{
  std::vector<int> offsets = { 3 };
  std::vector<int> sorted = { 4 };
  CountingSort(
    0, [](const auto&) {}, offsets, sorted);
  EXPECT_EQ(offsets, std::vector<int>({ 0 }));
  EXPECT_TRUE(sorted.empty());
}

TEST(FloodFill, VisitsAGridOnceInTheOrderOfDistance)
{
  // Squares of a board, next to each other in rows and columns, with a wall that
  // leaves the last column out: the distance is |x - x0| + |y - y0| to the nearer seed.
  constexpr int size = 12;
  const std::vector<int> seeds = { 2 + size * 3, 8 + size * 9 };
  const auto distance = [&seeds](int i)
  {
    int least = 2 * size;
    for (const int seed : seeds)
    {
      least = std::min(least, std::abs(i % size - seed % size) + std::abs(i / size - seed / size));
    }
    return least;
  };
  std::vector<char> isVisited(size * size, 0);
  const std::vector<int> visited = FloodFill(
    seeds, [&](int i) { return i % size < size - 1 && !std::exchange(isVisited[i], 1); },
    [](int i, const auto& reach)
    {
      for (const int step : { -1, 1 })
      {
        if (i % size + step >= 0 && i % size + step < size)
        {
          reach(i + step);
        }
        if (i / size + step >= 0 && i / size + step < size)
        {
          reach(i + size * step);
        }
      }
    });
  EXPECT_EQ(visited.size(), static_cast<std::size_t>(size * (size - 1)));
  EXPECT_TRUE(std::is_sorted(
    visited.begin(), visited.end(), [&](int a, int b) { return distance(a) < distance(b); }));
  for (int i = 0; i < size * size; ++i)
  {
    EXPECT_EQ(isVisited[i], i % size < size - 1) << i;
  }
}

// Small and large sets in turn, of ids that share their last digits too.
TEST(IdSet, ContainsWhatWasInsertedSinceItWasCleared)
{
  std::mt19937 random(2);
  IdSet found;
  for (const int count : { 0, 5, 90, 3000, 20, 200000, 7 })
  {
    found.Clear();
    std::set<int> expected;
    for (int i = 0; i < count; ++i)
    {
      const int id = i % 2 ? i << 12 & 0x7fffffff : static_cast<int>(random() >> 1);
      found.Insert(id);
      found.Insert(id);
      expected.insert(id);
    }
    for (int i = 0; i < 10000; ++i)
    {
      const int id = i % 2 ? i << 12 & 0x7fffffff : static_cast<int>(random() >> 1);
      ASSERT_EQ(found.Contains(id), expected.count(id) > 0) << id;
    }
    for (const int id : expected)
    {
      ASSERT_TRUE(found.Contains(id));
    }
  }
}
