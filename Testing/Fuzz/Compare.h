// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run.h"

namespace fuzz
{
/// How the second of two cases differs from the first, and how near their results
/// must be.
struct Relation
{
  Motion Map;                   ///< of everything
  std::vector<vtkIdType> Order; ///< point i has become point Order[i]; empty: itself
  double Tolerance = 1e-4;      ///< part of the size, or of a field's largest value
  double PointTolerance = 0.0;  ///< length that the points may differ by in any case
  bool IsOfPointsOnly = false;  ///< other fields depend on the triangles
};

/// Where the second result is not what the first one becomes under the relation.
struct Difference
{
  std::string Field; ///< empty where they agree
  double Size = 0.0; ///< part of the size, or of the field's largest value
  long long Row = 0;

  bool IsNone() const { return this->Field.empty(); }
  std::string Describe() const;
};

/// The first field that differs by more than the tolerance, where it does so most.
Difference Compare(
  const Outcome& first, const Outcome& second, const Relation& relation, double size);

/// The largest difference of one field, whatever the tolerance.
Difference CompareField(
  const Field& first, const Field& second, const Relation& relation, double size);

/// What must hold for every result: inputs as they were, one error with empty outputs
/// or none with complete and finite ones. Empty if it does.
std::string DescribeUnsound(const Case& of, const Outcome& outcome);
}
