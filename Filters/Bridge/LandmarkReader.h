// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Base/ExecutionContext.h"
#include "Kernel/Mesh/TriangleMesh.h"

#include <string>
#include <vector>

class vtkDataObject;

namespace cartan
{
/// Named positions.
struct LandmarkSet
{
  Points Positions;               ///< #L x 3, as they are
  std::vector<std::string> Names; ///< empty, or one for each
  Eigen::VectorXd Accuracies;     ///< empty, or one for each, length units, >= 0

  Eigen::Index Size() const { return this->Positions.rows(); }

  /// "landmark 3 (nose)"
  std::string Describe(Eigen::Index k) const;

  /// "2 landmarks (3 (nose), 7)": at most five of them.
  std::string Describe(const std::vector<Eigen::Index>& landmarks) const;
};

/// The points of a vtkPointSet, or the rows of a vtkTable with three columns of
/// coordinates: x, y, z; r, a, s; l, p, s; or Points:0, Points:1, Points:2 as ParaView
/// writes them, in letters of either case. Names are the string array "label", "name" or
/// "landmark", else the first string array; accuracies are the numeric array
/// `accuracyArray` unless that is empty. `role` names the set in messages. Throws
/// Error(BadInput) for no landmarks, other tables, values that are not finite, and
/// accuracies that are negative.
LandmarkSet ReadLandmarks(
  vtkDataObject* input, const std::string& role, const std::string& accuracyArray = {});

/// `set` with its landmarks in the order of `names`. Throws Error(BadInput) unless it has
/// each of these names once and no others.
LandmarkSet InOrderOf(const LandmarkSet& named, const LandmarkSet& set);

/// The nearest vertex of a triangle, for each landmark.
struct NearestVertices
{
  std::vector<int> Vertices;
  Eigen::VectorXd Distances;
};
NearestVertices FindNearestVertices(
  const TriangleMesh& mesh, const Points& points, const Points& queries);
}
