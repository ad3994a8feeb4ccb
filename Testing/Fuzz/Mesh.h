// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Random.h"

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fuzz
{
/// x -> Scale * Rotation * x + Translation.
struct Motion
{
  double Scale = 1.0;
  Eigen::Matrix3d Rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d Translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const
  {
    return this->Scale * (this->Rotation * x) + this->Translation;
  }
};

/// What a motion does to a value.
enum class Kind
{
  Scalar,   ///< times Scale^power
  Point,    ///< 3 components
  Vector,   ///< 3 components: turns, times Scale^power
  Transform ///< 9 components, a 3 x 3 matrix row by row
};

struct Array
{
  std::string Name;
  Kind Type = Kind::Scalar;
  double Power = 0.0; ///< of the length unit
  bool IsInteger = false;
  Eigen::MatrixXd Values; ///< a row per point
};

/// The values of `array` after a motion of everything.
Eigen::MatrixXd Moved(const Eigen::MatrixXd& values, Kind type, double power, const Motion& motion);

using Ids = std::vector<vtkIdType>;

/// A surface before it becomes a vtkPolyData, with double precision.
struct Mesh
{
  std::vector<Eigen::Vector3d> Points;
  std::vector<Ids> Verts;
  std::vector<Ids> Lines;
  std::vector<Ids> Polys;
  std::vector<Ids> Strips;
  std::vector<Array> Arrays; ///< of points
  bool IsFloat = false;      ///< of points

  vtkIdType NumberOfPoints() const { return static_cast<vtkIdType>(this->Points.size()); }
  vtkIdType AddPoint(const Eigen::Vector3d& point)
  {
    this->Points.push_back(point);
    return this->NumberOfPoints() - 1;
  }
  const Array* Find(const std::string& name) const;
};

/// The diagonal of the bounding box of the finite points; 1 without extent.
double Size(const std::vector<Eigen::Vector3d>& points);

/// Adds points and cells of another one. Arrays are left alone.
void Append(Mesh& mesh, const Mesh& other);

/// What single precision holds.
void RoundToFloat(std::vector<Eigen::Vector3d>& points);

void Move(Mesh& mesh, const Motion& motion);

/// Point i becomes point order[i], and cells come in another order.
void Permute(Mesh& mesh, const std::vector<vtkIdType>& order, Random& random);

/// With a point array PointId, which says which point it was before a
/// permutation, and a cell array CellId.
vtkSmartPointer<vtkPolyData> ToPolyData(const Mesh& mesh);

/// The component of each point over polygons and strips, and over copies that are joined.
std::vector<vtkIdType> Components(const Mesh& mesh);
}
