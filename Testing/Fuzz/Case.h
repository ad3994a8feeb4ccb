// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh.h"

#include "vtkAlgorithm.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace fuzz
{
/// One call of a filter's setter.
struct Setting
{
  std::string Name; ///< without Set
  std::vector<double> Values;
  std::string Text; ///< of setters that take one, instead of Values
  Kind Type = Kind::Scalar;
  double Power = 0.0;   ///< of the length unit
  bool IsOfIds = false; ///< of points of the surface
  std::function<void(vtkAlgorithm*, const std::vector<double>&)> Apply;
};

/// The motion of a handle: about an axis, or any affine map.
struct HandleMotion
{
  int Id = 1;
  bool IsMatrix = false;
  Eigen::Vector3d Axis = Eigen::Vector3d::UnitZ();
  double Angle = 0.0; ///< in degrees
  double Scale = 1.0;
  Eigen::Vector3d Center = Eigen::Vector3d::Zero();
  Eigen::Vector3d Translation = Eigen::Vector3d::Zero();
  Eigen::Matrix4d Matrix = Eigen::Matrix4d::Identity();
};

/// A filter with its inputs and settings: all that a result depends on.
struct Case
{
  std::uint64_t Seed = 0;
  std::string Filter; ///< the class without vtk
  Mesh Surface;
  /// The points of further surfaces of the same cells: key frames of a morph, the
  /// reference of a comparison, the moved points of what is restored, what is sewn on, a
  /// detailed source and its base.
  std::vector<std::vector<Eigen::Vector3d>> Others;
  /// Points of no surface, joined by a line: landmarks, where they go, a drawn curve.
  std::vector<std::vector<Eigen::Vector3d>> Clouds;
  std::vector<Ids> CloudKeys;  ///< of the clouds' points: points of the surface, -1 for none
  std::vector<Ids> CloudNames; ///< of the clouds' points; both empty, or one for each cloud
  std::vector<Ids> Tetrahedra; ///< of the points of the surface, for filters that take them
  std::vector<Setting> Settings;
  std::vector<HandleMotion> Motions;

  bool IsDeformation() const;
  /// Whether the output's points are others than the input's.
  bool NumbersAnew() const;
  /// The first value of a setting, or `otherwise` if it is not set.
  double Get(const std::string& setting, double otherwise) const;
};

/// Everything moves together: surfaces, lengths and places in settings, motions.
void Move(Case& changed, const Motion& motion);

/// All filters, by the class without vtk.
const std::vector<std::string>& Filters();

/// The case of a seed. With `filter` the filter is given and the rest as random.
Case MakeCase(std::uint64_t seed, const std::string& filter = {});
}
