// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Case.h"

#include "vtkTable.h"

namespace fuzz
{
/// Numbers of an output that are not the input's.
struct Field
{
  enum Place
  {
    OfPoints,
    OfCells,
    OfSurface,
    OfTable
  };
  std::string Name;
  Place Where = OfPoints;
  Kind Type = Kind::Scalar;
  double Power = 0.0;
  Eigen::MatrixXd Values;   ///< a row per point, cell or row
  bool IsArbitrary = false; ///< others are as right, such as a basis of a space
};

struct Outcome
{
  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;
  vtkSmartPointer<vtkPolyData> Surface; ///< output 0
  vtkSmartPointer<vtkTable> Table;      ///< output 1; none: nullptr
  std::vector<Field> Fields;            ///< the points first
  bool IsInputChanged = false;

  bool IsQuiet() const { return this->Errors.empty() && this->Warnings.empty(); }
  const Field* Find(const std::string& name, Field::Place where) const;
};

/// Runs the filter of a case. With `before`, the same filter does that case first.
Outcome Run(const Case& of, const Case* before = nullptr);

/// Same arrays and cells to the last bit; what differs, or nothing.
std::string DescribeDifference(vtkPolyData* a, vtkPolyData* b);
}
