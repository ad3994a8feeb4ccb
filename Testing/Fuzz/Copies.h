// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh.h"

namespace fuzz
{
/// Hangs another shape on a point of a triangle, each with a copy of the point. The
/// copies; empty where there is no triangle.
Ids HangOnPoint(Mesh& mesh, Random& random);

/// The array that joins copies of a point.
Array JoinedPoints(const Mesh& mesh, const Ids& copies);

/// The points that such an array joins.
Ids Copies(const Mesh& mesh);

/// Puts them all where the first one is.
void KeepTogether(const Mesh& joined, std::vector<Eigen::Vector3d>& points);

/// The points of edges that one polygon or triangle of a strip uses.
Ids BorderPoints(const Mesh& mesh);
}
