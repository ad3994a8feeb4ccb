// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Base/Types.h"

/// By how much a surface is folded where two were joined: angles between the normals on
/// both sides, in degrees.
struct PeerSeam
{
  double Mean = 0.0;
  double Maximum = 0.0;
  double FairedMean = 0.0;
  double FairedMaximum = 0.0;
  int NumberOfEdges = 0;
};

/// CGAL's way to join two surfaces that overlap: their holes are closed, the union of both bodies
/// is made by corefinement, and the curve where they meet is faired with `rings` rings around
/// it. Points #V x 3, triangles #T x 3. Throws std::runtime_error where the union is no manifold
/// or fairing fails.
PeerSeam MergeByPeer(const cartan::Points& target, const cartan::Triangles& targetTriangles,
  const cartan::Points& source, const cartan::Triangles& sourceTriangles, int rings);
