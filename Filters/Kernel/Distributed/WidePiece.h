// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"
#include "Mesh/VerticesLookedAt.h"

namespace cartan
{
/// Collective. Adds triangles and ghosts of other ranks to a piece until all triangles are there
/// around each vertex that owned ones in triangles look at. `mesh` is that of the piece as it
/// comes; the result that of the piece as it is then.
std::shared_ptr<const DistributedMesh> WidenPiece(
  SurfacePiece& piece, std::shared_ptr<const DistributedMesh> mesh, const VerticesLookedAt& reach);
}
