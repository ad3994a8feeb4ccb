// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/FilterRun.h"
#include "Bridge/HandleMotions.h"

namespace cartan
{
/// What a deformation deforms.
struct DeformationInput
{
  std::shared_ptr<const Surface> TheSurface;
  std::shared_ptr<const PieceSurface> Piece; ///< nothing where the surface is whole
};

DeformationInput ReadDeformationInput(FilterRun& run);

/// The handles in the point array `name`, kept under `key`.
std::shared_ptr<const Handles> KeepHandles(
  FilterRun& run, const DeformationInput& input, const std::string& name, const ContentKey& key);

/// Throws, so that pieces are gathered, where one process would take slivers out of the mesh or
/// hold points together; warns of slivers instead where the whole has more than `limit` points.
/// Collective.
void RequirePiecesServe(FilterRun& run, const PieceSurface& piece, vtkIdType limit);

/// The handles that arrays or motions move, in increasing order.
std::vector<int> MovingHandles(const HandleArrays& arrays, const MotionsById& motions);
}
