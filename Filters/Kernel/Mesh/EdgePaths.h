// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// Which directed edges a path may take, both directions alike: #D; empty: all.
using EdgeMask = std::vector<char>;

/// Edges whose triangles' normals are more than `angle` (radians) apart, and borders.
EdgeMask FeatureEdges(const TriangleMesh& mesh, const Points& points, double angle);

/// Edges between a triangle that faces along `direction` and one that does not, and
/// borders: what a viewer along it sees as outline, and what is hidden of it.
EdgeMask SilhouetteEdges(
  const TriangleMesh& mesh, const Points& points, const Eigen::Vector3d& direction);

/// The shortest path along allowed edges, both ends included (Dijkstra 1959); of equally
/// short ones always the same. Empty where there is none.
std::vector<int> ShortestEdgePath(
  const TriangleMesh& mesh, const Points& points, int from, int to, const EdgeMask& allowed = {});

/// The vertex at an allowed edge that is nearest to `vertex` in its component; -1 where
/// there is none.
int NearestOnEdges(
  const TriangleMesh& mesh, const Points& points, int vertex, const EdgeMask& allowed);

/// Throws Error(BadInput) that there is no path between two picks.
[[noreturn]] void RefusePath(int from, int to);

/// Throws Error(BadInput) where a path through picks passes a vertex twice.
void RequireSimplePath(const std::vector<int>& path, bool isClosed);

/// The path from each of `picks` (two or more) to the next, along allowed edges; picks
/// beside these stand for the nearest vertex on them. With `isClosed` it goes on from the last
/// to the first, which is not repeated. Throws Error(BadInput) where there is no path, or it
/// passes a vertex twice.
std::vector<int> PathThrough(const TriangleMesh& mesh, const Points& points,
  const std::vector<int>& picks, const EdgeMask& allowed = {}, bool isClosed = false);

/// The shortest ring of allowed edges through the vertex on them that is nearest to `pick`, from
/// there on; the outline of a part, or its border. Throws Error(BadInput) where there is none.
std::vector<int> RingThrough(
  const TriangleMesh& mesh, const Points& points, int pick, const EdgeMask& allowed);

/// Puts vertices that form one line of edges in the order of that line, from the end that
/// is named first on; with `isClosed` those of a ring, from the one that is named first on
/// towards that of its neighbors which is. Throws Error(BadInput) where they do not: fewer
/// than two, several lines, branches, or a ring instead of a line.
std::vector<int> ChainVertices(
  const TriangleMesh& mesh, const std::vector<int>& vertices, bool isClosed = false);
}
