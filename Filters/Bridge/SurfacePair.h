// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/ContentKey.h"
#include "Bridge/SurfaceReader.h"
#include "Kernel/Algebra/DistributedRows.h"

namespace cartan
{
/// Two surfaces of the same connectivity.
struct SurfacePair
{
  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Connectivity> Cells; ///< with the current surface's cell ids
  std::shared_ptr<const Points> Reference;   ///< #V x 3, about the reference's own center
  std::shared_ptr<const Points> Current;     ///< #V x 3, about the current surface's own center
  CoincidentBorders Borders;                 ///< of the reference
  ContentKey ReferenceKey;                   ///< of the reference as it is used here
  std::shared_ptr<const DistributedRows> Pieces = nullptr; ///< of a surface in pieces
};
}
