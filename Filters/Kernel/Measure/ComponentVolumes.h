// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Measure/SurfaceComponents.h"

#include <vector>

namespace cartan
{
struct ComponentVolume
{
  /// Positive when the triangles are oriented outward, negative inside out (or
  /// for the wall of a cavity). Computed about the component's own center, so
  /// that a surface far from the origin keeps its digits. Means nothing when
  /// the component is not closed.
  double Volume = 0.0;
  double Area = 0.0;
  bool IsClosed = true;

  /// Whether the component is closed and its volume is more than rounding.
  bool EnclosesVolume() const;
};

/// One entry per component of the mesh.
std::vector<ComponentVolume> MeasureComponents(const TriangleMesh& mesh, const Points& points);

/// The same of a surface that may be in pieces; collective then.
std::vector<ComponentVolume> MeasureComponents(
  const TriangleMesh& mesh, const Points& points, const SurfaceComponents& parts);

/// Whether the bounding box of a component that encloses volume is inside of another's: if not,
/// none encloses another. Of pieces collective.
bool MayEncloseEachOther(const TriangleMesh& mesh, const Points& points,
  const std::vector<ComponentVolume>& components, const SurfaceComponents& parts);

/// For each component the one that encloses volume directly around it; -1 where
/// there is none, and for those that enclose no volume themselves. A cavity has the body
/// around it, a body inside of a cavity has the cavity. Orientations do not matter.
/// Components that intersect each other have one answer of several.
///
/// The ray from the farthest vertex of a component in some direction meets another
/// component first, from inside or from outside; in the latter case both are
/// enclosed by the same one. The best of three directions decides. Takes no time
/// to speak of unless a component's bounding box is inside another's;
/// O(#T log #T) then.
std::vector<int> EnclosingComponents(
  const TriangleMesh& mesh, const Points& points, const std::vector<ComponentVolume>& components);

/// The mean of each component's vertices, weighted by `weights` (#V, their sum in
/// each component positive), or alike without: #components x 3.
Points ComponentCenters(
  const TriangleMesh& mesh, const Points& points, const Eigen::VectorXd& weights = {});
}
