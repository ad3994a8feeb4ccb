// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/HandleArrays.h"
#include "Bridge/SurfaceReader.h"
#include "Kernel/Deformation/HandleProblem.h"

#include <map>
#include <string>
#include <vector>

class vtkHandleMotion;

namespace cartan
{
/// The motions of one update, by handle id.
using MotionsById = std::map<int, vtkHandleMotion*>;

/// Throws Error(BadInput) for motions that move nothing or are not a map.
void RequireMeaningfulMotions(const MotionsById& motions, const Handles& handles);

/// The point arrays that move handles point by point, a row per point of
/// Handles::Points; empty where not used.
struct HandleArrays
{
  Field Positions;            ///< 3 columns, relative to the surface's origin
  Field RotationVectors;      ///< 3 columns
  Field Transforms;           ///< 9 columns, row by row
  std::vector<int> MovingIds; ///< handles that they move, in increasing order

  std::size_t GetBytes() const;
};

/// The names of these arrays; empty ones are not used.
struct HandleArrayNames
{
  std::string Positions;
  std::string RotationVectors;
  std::string Transforms;

  bool AreEmpty() const
  {
    return this->Positions.empty() && this->RotationVectors.empty() && this->Transforms.empty();
  }
};

/// Throws Error(BadInput) for arrays of the wrong size, values that are not
/// finite, and rotation vectors together with transforms.
HandleArrays ReadHandleArrays(vtkPolyData* input, const Surface& surface, const Handles& handles,
  const HandleArrayNames& names);

/// Weights >= 0 of the handles' points, 0 elsewhere: #V.
Eigen::VectorXd ReadSoftWeights(
  vtkPolyData* input, const std::string& name, const Handles& handles);

/// The targets of the `moving` handles, ids in increasing order: by motion where
/// there is one, else by the arrays.
HandleTargets MakeTargets(const Surface& surface, const std::vector<int>& moving,
  const MotionsById& motions, const Handles& handles, const HandleArrays& arrays);
}
