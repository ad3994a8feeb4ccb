// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/DoubledTriangles.h"

#include "Base/DisjointSets.h"
#include "Mesh/EdgeTable.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace cartan
{
namespace
{
using Key = std::array<int, 3>;

Key SortedVertices(const Triangles& triangles, int t)
{
  Key key = { triangles(t, 0), triangles(t, 1), triangles(t, 2) };
  std::sort(key.begin(), key.end());
  return key;
}

/// For each triangle the first of those on the same vertices, and how many they
/// are at that first one.
struct Groups
{
  std::vector<int> First;
  std::vector<int> Count;
};

Groups GroupTriangles(const Triangles& triangles)
{
  const auto size = static_cast<int>(triangles.rows());
  std::vector<Key> keys(size);
  for (int t = 0; t < size; ++t)
  {
    keys[t] = SortedVertices(triangles, t);
  }
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&keys](int a, int b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  Groups groups{ std::vector<int>(size), std::vector<int>(size, 0) };
  for (int i = 0; i < size; ++i)
  {
    const bool isNew = i == 0 || keys[order[i]] != keys[order[i - 1]];
    groups.First[order[i]] = isNew ? order[i] : groups.First[order[i - 1]];
    ++groups.Count[groups.First[order[i]]];
  }
  return groups;
}

/// The first triangles of pairs (or other even numbers) in parts that a surface
/// closes without: non-zero for those.
std::vector<char> FindWalls(int numberOfVertices, const Triangles& triangles, const Groups& groups)
{
  const EdgeTable edges(numberOfVertices, triangles);
  const auto size = static_cast<int>(triangles.rows());
  const auto isEven = [&groups](int t) { return groups.Count[groups.First[t]] % 2 == 0; };
  DisjointSets parts(size);
  std::vector<int> others(edges.NumberOfEdges(), 0);
  for (int edge = 0; edge < edges.NumberOfEdges(); ++edge)
  {
    int last = -1;
    for (const int* side = edges.Begin(edge); side != edges.End(edge); ++side)
    {
      const int first = groups.First[*side / 3];
      if (isEven(first))
      {
        parts.Join(first, last < 0 ? first : last);
        last = first;
      }
      else if (first == *side / 3)
      {
        ++others[edge];
      }
    }
  }
  std::vector<char> touches(size, 0); // by part: some edge has two other triangles
  std::vector<char> opens(size, 0);   // by part: some edge has one, or three and more
  for (int edge = 0; edge < edges.NumberOfEdges(); ++edge)
  {
    for (const int* side = edges.Begin(edge); side != edges.End(edge); ++side)
    {
      if (isEven(*side / 3) && others[edge] > 0)
      {
        (others[edge] == 2 ? touches : opens)[parts.Find(groups.First[*side / 3])] = 1;
      }
    }
  }
  std::vector<char> isWall(size, 0);
  for (int t = 0; t < size; ++t)
  {
    const int part = parts.Find(groups.First[t]);
    isWall[t] = isEven(t) && touches[part] && !opens[part];
  }
  return isWall;
}
}

std::vector<char> FindDoubledTriangles(int numberOfVertices, const Triangles& triangles)
{
  const Groups groups = GroupTriangles(triangles);
  std::vector<char> drop(triangles.rows(), 0);
  bool anyEven = false;
  for (std::size_t t = 0; t < drop.size(); ++t)
  {
    drop[t] = groups.First[t] != static_cast<int>(t);
    anyEven = anyEven || (groups.Count[t] > 0 && groups.Count[t] % 2 == 0);
  }
  if (anyEven)
  {
    const std::vector<char> isWall = FindWalls(numberOfVertices, triangles, groups);
    for (std::size_t t = 0; t < drop.size(); ++t)
    {
      drop[t] = drop[t] || isWall[t];
    }
  }
  return drop;
}
}
