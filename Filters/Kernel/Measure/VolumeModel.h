// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Base/ExecutionContext.h"
#include "Mesh/RayTree.h"
#include "Mesh/TriangleMesh.h"

#include <functional>
#include <string>
#include <vector>

/// Local depth, local volume and what follows from them; Lipman et al., Volume
/// and Shape Preservation via Moving Frame Manipulation, 2007, section 4.
namespace cartan
{
/// Follows a ray from a point in a unit direction. Called from several threads.
using RayCaster = std::function<RayHit(const Eigen::Vector3d&, const Eigen::Vector3d&)>;

/// What the preservation of volume needs to know of a surface at rest.
struct VolumeModel
{
  /// How thick the body is under each vertex, along the inward normal; 0 in
  /// components that enclose nothing: #V, in length units.
  Eigen::VectorXd LocalDepth;
  /// Which vertices' depths rays have found. The others are filled in
  /// harmonically and count as of unknown depth.
  std::vector<char> IsMeasured;
  /// From the middle of the body to the vertex; zero in components that enclose
  /// nothing: #V x 3.
  Points Offsets;
  /// Per component: whether it takes part, and its volume, negative for the wall
  /// of a cavity. Those take part that enclose volume, but for outermost ones that
  /// are oriented inside out and what is inside of those.
  std::vector<char> EnclosesVolume;
  std::vector<double> Volumes;
  /// The components' numbers in messages; empty: as in the mesh.
  std::vector<long long> Names;
  /// Why some components do not take part; empty if all do.
  std::string Warning;

  bool IsEmpty() const { return this->LocalDepth.size() == 0; }

  std::size_t GetBytes() const
  {
    return TotalBytes(this->LocalDepth, this->IsMeasured, this->Offsets, this->EnclosesVolume,
      this->Volumes, this->Names);
  }
};

/// Measures the depth by a cone of rays (half angle 15 degrees) around the
/// inward normal, one towards each neighbor, the mean of those that leave the
/// body, and places the middle of the body c = p - L / 2 N, smoothed by one
/// implicit step (M + tau L) c' = M c, tau = .02 median(depth)^2 of the component.
/// IsEmpty() if no component encloses volume.
VolumeModel MeasureVolumeModel(const TriangleMesh& mesh, const Points& points,
  const RayCaster& castRay, const ExecutionContext& context = {},
  std::vector<long long> names = {});

/// h of Eq. 13 at each vertex, with the curvatures from CurvaturesFromNormals: #V.
Eigen::VectorXd ColumnHeights(const TriangleMesh& mesh, const Points& points,
  const Eigen::VectorXd& localDepth, const ExecutionContext& context = {});

/// How deep the column of body under a vertex is taken: min(depth / 2, r1 / 2,
/// r2 / 2) with the positive radii of curvature r = 1 / k (section 4.2 with
/// alpha = beta = 1/2).
double ColumnDepth(double localDepth, double k1, double k2);

/// Eq. 13 in closed form, without its cases: the volume per area of the column
/// of body of depth phi under a surface with principal curvatures k1, k2,
/// h = phi - (k1 + k2) phi^2 / 2 + k1 k2 phi^3 / 3.
double ColumnHeight(double phi, double k1, double k2);
}
