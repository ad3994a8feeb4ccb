// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Base/Types.h"

#include <memory>
#include <vector>

/// CGAL's Surface_mesh_deformation with the tag ORIGINAL_ARAP and the solver it
/// chooses by default. Handle k of `handles` is held; that of the largest id
/// moves, the others are static.
class PeerDeformation
{
public:
  PeerDeformation(const cartan::Points& points, const cartan::Triangles& triangles,
    const std::vector<int>& handles);
  ~PeerDeformation();

  /// Seconds that preprocess() took.
  double GetPreprocessTime() const;

  /// The moving handle goes to x -> linear x + translation.
  void MoveHandle(const Eigen::Matrix3d& linear, const Eigen::Vector3d& translation);

  /// One iteration: a local fit of rotations and a global solve.
  void Iterate();

  /// The vertices where they are now: #V x 3.
  cartan::Points GetPositions() const;

private:
  class Internals;
  std::unique_ptr<Internals> State;
};
