// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/HandleMotions.h"

#include "Bridge/PointArrays.h"
#include "Kernel/Algebra/Rotation.h"
#include "vtkHandleMotion.h"

#include "vtkDataArray.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace cartan
{
namespace
{
std::string ListIds(const std::vector<int>& ids)
{
  std::string text;
  for (const int id : ids)
  {
    text += (text.empty() ? "" : ", ") + std::to_string(id);
  }
  return text;
}

Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> TransformAt(
  const HandleArrays& arrays, Eigen::Index row)
{
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
    arrays.Transforms.row(row).data());
}

/// Whether the arrays leave a handle's point as it is.
bool IsAtRest(const HandleArrays& arrays, Eigen::Index row, const Eigen::RowVector3d& rest)
{
  return (arrays.Positions.rows() == 0 || arrays.Positions.row(row) == rest) &&
    (arrays.RotationVectors.rows() == 0 || arrays.RotationVectors.row(row).isZero(0.0)) &&
    (arrays.Transforms.rows() == 0 || TransformAt(arrays, row).isIdentity(0.0));
}

HandleMotion ToKernel(vtkHandleMotion* motion, const Eigen::Vector3d& origin)
{
  vtkNew<vtkMatrix4x4> transform;
  motion->GetTransformRelativeTo(origin.data(), transform);
  HandleMotion result;
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      result.Linear(row, column) = transform->GetElement(row, column);
    }
    result.Translation[row] = transform->GetElement(row, 3);
  }
  motion->GetRotationVector(result.RotationVector.data());
  result.CountsTurns = motion->GetMode() == vtkHandleMotion::AXIS_ANGLE;
  return result;
}

/// The target in a row of `targets` by a row of the arrays.
void SetTarget(
  const HandleArrays& arrays, Eigen::Index from, Eigen::Index row, HandleTargets& targets)
{
  auto transform = MatrixAt(targets.Transforms, row);
  if (arrays.Positions.rows())
  {
    targets.Positions.row(row) = arrays.Positions.row(from);
  }
  if (arrays.RotationVectors.rows())
  {
    targets.RotationVectors.row(row) = arrays.RotationVectors.row(from);
    transform = RotationFromVector(arrays.RotationVectors.row(from).transpose());
  }
  if (arrays.Transforms.rows())
  {
    transform = TransformAt(arrays, from);
    targets.RotationVectors.row(row) =
      VectorFromRotation(ProjectOnRotations(transform)).transpose();
  }
}

/// The target in a row of `targets` by its handle's motion.
void SetTarget(const HandleMotion& motion, Eigen::Index row, HandleTargets& targets)
{
  targets.Positions.row(row) =
    (motion.Linear * targets.Positions.row(row).transpose() + motion.Translation).transpose();
  targets.RotationVectors.row(row) = motion.RotationVector.transpose();
  MatrixAt(targets.Transforms, row) = motion.Linear;
}

/// Gives the points of moving handles a row each, which leaves them where they are.
void AddRows(const Surface& surface, const std::vector<int>& moving, const Handles& handles,
  HandleTargets& targets)
{
  for (std::size_t h = 0; h < handles.Ids.size(); ++h)
  {
    if (std::binary_search(moving.begin(), moving.end(), handles.Ids[h]))
    {
      targets.Vertices.insert(targets.Vertices.end(), handles.Points.begin() + handles.Offsets[h],
        handles.Points.begin() + handles.Offsets[h + 1]);
    }
  }
  std::sort(targets.Vertices.begin(), targets.Vertices.end());
  const auto numberOfRows = static_cast<Eigen::Index>(targets.Vertices.size());
  targets.Positions = (*surface.Positions)(targets.Vertices, Eigen::all);
  targets.RotationVectors = Points::Zero(numberOfRows, 3);
  targets.Transforms = Identities(numberOfRows);
}
}

void RequireMeaningfulMotions(const MotionsById& motions, const Handles& handles)
{
  for (const auto& [id, motion] : motions)
  {
    if (!handles.Has(id))
    {
      throw Error(ErrorCode::BadInput,
        "Handle " + std::to_string(id) +
          " has a motion, but no point in a triangle belongs to it. " +
          (handles.Ids.empty() ? std::string("No point belongs to any handle")
                               : "Handles with points: " + ListIds(handles.Ids)) +
          ". Mark points for it or remove the motion.");
    }
    const std::string problem = motion->GetProblem();
    if (!problem.empty())
    {
      throw Error(
        ErrorCode::BadInput, "The motion of handle " + std::to_string(id) + ": " + problem);
    }
  }
}

std::size_t HandleArrays::GetBytes() const
{
  return sizeof(double) *
    static_cast<std::size_t>(
      this->Positions.size() + this->RotationVectors.size() + this->Transforms.size());
}

HandleArrays ReadHandleArrays(
  vtkPolyData* input, const Surface& surface, const Handles& handles, const HandleArrayNames& names)
{
  HandleArrays arrays;
  const auto read = [&](const std::string& name, int components)
  {
    return name.empty() ? Field()
                        : ReadPointArray(input, name, components, handles.Points, "handle point");
  };
  arrays.Positions = read(names.Positions, 3);
  arrays.RotationVectors = read(names.RotationVectors, 3);
  arrays.Transforms = read(names.Transforms, 9);
  if (!names.RotationVectors.empty() && !names.Transforms.empty())
  {
    throw Error(ErrorCode::BadInput,
      "Both a rotation vector array and a transform array are set: choose one.");
  }
  if (arrays.Positions.rows())
  {
    arrays.Positions.rowwise() -= surface.Origin.transpose();
  }
  for (std::size_t h = 0; h < handles.Ids.size(); ++h)
  {
    bool isAtRest = true;
    for (int i = handles.Offsets[h]; i < handles.Offsets[h + 1] && isAtRest; ++i)
    {
      isAtRest = IsAtRest(arrays, i, surface.Positions->row(handles.Points[i]));
    }
    if (!isAtRest)
    {
      arrays.MovingIds.push_back(handles.Ids[h]);
    }
  }
  return arrays;
}

Eigen::VectorXd ReadSoftWeights(vtkPolyData* input, const std::string& name, const Handles& handles)
{
  vtkDataArray* array = RequirePointArray(input, name, 1);
  Eigen::VectorXd weights =
    Eigen::VectorXd::Zero(static_cast<Eigen::Index>(handles.OfVertex.size()));
  IdSample bad;
  for (const int v : handles.Points)
  {
    if (v >= array->GetNumberOfTuples())
    {
      continue; // a point of another rank
    }
    weights[v] = array->GetTuple1(v);
    if (!(weights[v] >= 0.0))
    {
      bad.Add(v);
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The point array \"" + name + "\" has " + bad.Describe("handle point", "handle points") +
        " with a weight that is negative or NaN: 0 leaves a point free, infinity fixes it.");
  }
  return weights;
}

HandleTargets MakeTargets(const Surface& surface, const std::vector<int>& moving,
  const MotionsById& motions, const Handles& handles, const HandleArrays& arrays)
{
  HandleTargets targets;
  bool isPerVertex = false;
  for (const int id : moving)
  {
    const auto motion = motions.find(id);
    isPerVertex = isPerVertex || motion == motions.end();
    targets.Motions.push_back(
      motion == motions.end() ? HandleMotion() : ToKernel(motion->second, surface.Origin));
    if (motion == motions.end())
    {
      targets.Motions.back().CountsTurns = arrays.Transforms.rows() == 0;
    }
  }
  if (!isPerVertex)
  {
    return targets;
  }
  AddRows(surface, moving, handles, targets);
  for (std::size_t h = 0; h < handles.Ids.size(); ++h)
  {
    const int id = handles.Ids[h];
    const auto place = std::lower_bound(moving.begin(), moving.end(), id);
    if (place == moving.end() || *place != id)
    {
      continue;
    }
    for (int i = handles.Offsets[h]; i < handles.Offsets[h + 1]; ++i)
    {
      const Eigen::Index row = targets.Row(handles.Points[i]);
      if (motions.count(id))
      {
        SetTarget(targets.Motions[place - moving.begin()], row, targets);
      }
      else
      {
        SetTarget(arrays, i, row, targets);
      }
    }
  }
  return targets;
}
}
