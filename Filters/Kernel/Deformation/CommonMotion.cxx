// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/CommonMotion.h"

#include "Algebra/Rotation.h"
#include "Deformation/HandleLaplacian.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <functional>

namespace cartan
{
namespace
{
/// Above rounding in products of a few matrices of one motion, far below what
/// anyone sees.
constexpr double SameMotion = 1e-12;

/// A rotation vector for a handle's linear map: the given one if it belongs to
/// the map's rotation, with its full turns.
Eigen::Vector3d VectorOf(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& given)
{
  return RotationFromVector(given).isApprox(rotation, 1e-9) ? given : VectorFromRotation(rotation);
}

/// The rotation vector r as seen from g: the one of R(g)^T R(r) nearest to r - g,
/// so that full turns about a common axis stay. What rounding leaves has no axis and is
/// zero.
Eigen::Vector3d RelativeVector(
  const Eigen::Vector3d& r, const Eigen::Vector3d& g, const Eigen::Matrix3d& rotationOfG)
{
  Eigen::Vector3d vector = r - g;
  if (r.cross(g).norm() > SameMotion * r.norm() * g.norm())
  {
    const Eigen::Matrix3d relative = rotationOfG.transpose() * RotationFromVector(r);
    // Full turns about axes that differ by the rounding of users' numbers leave
    // no rotation to take an axis from.
    const bool areFullTurns = vector.norm() > 1.0 && VectorFromRotation(relative).norm() < 1e-5;
    vector = areFullTurns ? vector : VectorFromRotation(relative, vector);
  }
  return vector.norm() > SameMotion ? vector : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// Of the vectors of the rotation that `vector` means, the nearest to `guess`;
/// `vector` itself unless another is nearer.
Eigen::Vector3d NearestTurn(const Eigen::Vector3d& vector, const Eigen::Vector3d& guess)
{
  const Eigen::Vector3d other = VectorFromRotation(RotationFromVector(vector), guess);
  return (other - guess).norm() < (1.0 - 1e-9) * (vector - guess).norm() ? other : vector;
}

/// Whether two handles' motions of a surface are the same to rounding, full turns
/// included. `extent` is its largest coordinate.
bool AreSame(const HandleMotion& a, const HandleMotion& b, const std::function<double()>& extent)
{
  // Looks at the surface last, which takes longest.
  return (a.Linear - b.Linear).norm() <= SameMotion &&
    (a.RotationVector - b.RotationVector).norm() <= 1e-6 &&
    (a.Translation - b.Translation).norm() <= SameMotion * (extent() + a.Translation.norm());
}

bool IsRigid(const HandleMotion& motion)
{
  return (motion.Linear.transpose() * motion.Linear - Eigen::Matrix3d::Identity()).norm() <= 1e-9 &&
    motion.Linear.determinant() > 0.0;
}

Eigen::Matrix3d HandleRotation(const HandleTargets& targets, int v, int handle)
{
  return targets.Transforms.rows() || !targets.Motions.empty()
    ? ProjectOnRotations(HandleTransform(targets, v, handle))
    : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

HandleMotion MotionOf(const HandleTargets& targets, int handle)
{
  return handle == HandleRegions::Pinned ? HandleMotion() : targets.Motions[handle];
}

constexpr int NoParent = -2;

/// A moving handle and the one it turns least against: NoParent where it is the
/// first that is met in its part of the surface.
struct Branch
{
  int Handle;
  int Parent;
};

/// The tree of least turns between handles that share a region, from the pinned
/// ones or the lowest id on (Prim); parents come before their branches.
std::vector<Branch> LeastTurns(
  const HandleRegions& regions, const std::vector<Eigen::Matrix3d>& rotations)
{
  const int numberOfMoving = static_cast<int>(rotations.size());
  std::vector<std::vector<int>> regionsOf(numberOfMoving + 1); // the first is Pinned
  for (int region = 0; region < regions.NumberOfRegions(); ++region)
  {
    for (const int handle : regions.GetHandles(region))
    {
      regionsOf[handle + 1].push_back(region);
    }
  }
  const std::vector<Eigen::Quaterniond> quaternions(rotations.begin(), rotations.end());
  // The cosine of half the turn against the parent.
  std::vector<double> nearness(numberOfMoving, -1.0);
  std::vector<int> parents(numberOfMoving, NoParent);
  std::vector<char> isInTree(numberOfMoving, 0);
  const auto join = [&](int handle, const Eigen::Quaterniond& quaternion)
  {
    for (const int region : regionsOf[handle + 1])
    {
      for (const int k : regions.GetHandles(region))
      {
        if (k == HandleRegions::Pinned || isInTree[k])
        {
          continue;
        }
        const double cosine = std::abs(quaternion.dot(quaternions[k]));
        if (cosine > nearness[k] + SameMotion) // by more than rounding
        {
          nearness[k] = cosine;
          parents[k] = handle;
        }
      }
    }
  };
  join(HandleRegions::Pinned, Eigen::Quaterniond::Identity());
  std::vector<Branch> branches;
  for (int step = 0; step < numberOfMoving; ++step)
  {
    int next = -1;
    for (int k = 0; k < numberOfMoving; ++k)
    {
      if (!isInTree[k] && (next < 0 || nearness[k] > nearness[next] + SameMotion))
      {
        next = k;
      }
    }
    isInTree[next] = 1;
    branches.push_back({ next, parents[next] });
    join(next, quaternions[next]);
  }
  return branches;
}
}

CommonMotion::CommonMotion(const HandleProblem& problem)
  : Problem(problem)
  , Regions(problem)
  , HasPinned(HasPinnedHandle(problem))
{
  const DistributedRows* pieces = problem.Pieces.get();
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(4); // of the points and their number
  for (int v = 0; v < problem.Mesh->NumberOfVertices(); ++v)
  {
    if (this->Regions.GetMoving()[v] == 0 && (!pieces || pieces->IsOwned(v)))
    {
      sums.head<3>() += problem.Rest->row(v).transpose();
      sums[3] += 1.0;
    }
  }
  if (pieces)
  {
    pieces->Sum(sums);
    Eigen::VectorXd extent(1);
    extent[0] = problem.Rest->size() > 0 ? problem.Rest->cwiseAbs().maxCoeff() : 0.0;
    pieces->Max(extent);
    this->ExtentOfPieces = extent[0];
  }
  this->Centroid = sums.head<3>() / std::max(sums[3], 1.0);
}

/// The rotation and translation that fit the target positions of the lowest
/// handle best (Kabsch, A Solution for the Best Rotation to Relate Two Sets of
/// Vectors, 1976); of all moving handles where its points lie on a line.
RigidMotion CommonMotion::BestFit(const HandleTargets& targets) const
{
  const Points& rest = *this->Problem.Rest;
  const std::vector<int>& moving = this->Regions.GetMoving();
  RigidMotion motion;
  for (const bool isLowestOnly : { true, false })
  {
    Eigen::RowVector3d restMean = Eigen::RowVector3d::Zero();
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
    std::vector<Eigen::Index> rows;
    for (Eigen::Index row = 0; row < targets.Positions.rows(); ++row)
    {
      const int v = targets.Vertices[row];
      if ((isLowestOnly ? moving[v] == 0 : moving[v] >= 0) && this->Problem.Mesh->IsUsed(v))
      {
        rows.push_back(row);
        restMean += rest.row(v);
        mean += targets.Positions.row(row);
        turns += HandleRotation(targets, v, moving[v]);
      }
    }
    const double count = std::max<double>(1.0, static_cast<double>(rows.size()));
    restMean /= count;
    mean /= count;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Eigen::Index row : rows)
    {
      covariance += (targets.Positions.row(row) - mean).transpose() *
        (rest.row(targets.Vertices[row]) - restMean);
    }
    const Eigen::Vector3d extents = covariance.jacobiSvd().singularValues();
    // Points on a line leave the rotation about it open: the transforms tell.
    const bool isDetermined = extents[1] > 1e-9 * extents[0];
    motion.Rotation = ProjectOnRotations(isDetermined ? covariance : turns);
    motion.Translation = mean.transpose() - motion.Rotation * restMean.transpose();
    motion.RotationVector = VectorFromRotation(motion.Rotation);
    if (isDetermined)
    {
      break;
    }
  }
  return motion;
}

RigidMotion CommonMotion::Reference(const HandleTargets& targets) const
{
  RigidMotion motion;
  if (this->HasPinned || this->Problem.Moving.empty())
  {
    return motion;
  }
  if (targets.Positions.rows())
  {
    return this->BestFit(targets);
  }
  const HandleMotion& lowest = targets.Motions.front();
  if (lowest.Linear.isIdentity(0.0))
  {
    motion.RotationVector = lowest.RotationVector;
    motion.Translation = lowest.Translation;
    return motion;
  }
  // A map that flattens or mirrors has no closest rotation to rely on.
  const bool isRegular = lowest.Linear.determinant() > 1e-12 * std::pow(lowest.Linear.norm(), 3);
  motion.Rotation =
    isRegular ? ProjectOnRotations(lowest.Linear) : RotationFromVector(lowest.RotationVector);
  motion.RotationVector = VectorOf(motion.Rotation, lowest.RotationVector);
  motion.Translation = (lowest.Linear - motion.Rotation) * this->Centroid + lowest.Translation;
  return motion;
}

void CommonMotion::MakeRelative(HandleTargets& targets) const
{
  const Eigen::Matrix3d back = this->Motion.Rotation.transpose();
  const Eigen::Vector3d& turn = this->Motion.RotationVector;
  for (HandleMotion& motion : targets.Motions)
  {
    motion.Linear = back * motion.Linear;
    motion.Translation = back * (motion.Translation - this->Motion.Translation);
    motion.RotationVector = RelativeVector(motion.RotationVector, turn, this->Motion.Rotation);
  }
  for (Eigen::Index row = 0; row < targets.Positions.rows(); ++row)
  {
    targets.Positions.row(row) =
      (back * (targets.Positions.row(row).transpose() - this->Motion.Translation)).transpose();
  }
  for (Eigen::Index row = 0; row < targets.Transforms.rows(); ++row)
  {
    MatrixAt(targets.Transforms, row) = back * MatrixAt(targets.Transforms, row).eval();
  }
  for (Eigen::Index row = 0; row < targets.RotationVectors.rows(); ++row)
  {
    targets.RotationVectors.row(row) =
      RelativeVector(targets.RotationVectors.row(row).transpose(), turn, this->Motion.Rotation)
        .transpose();
  }
}

/// The rotation of each moving handle; of rotations that differ from point to
/// point, the closest to their mean.
std::vector<Eigen::Matrix3d> CommonMotion::HandleRotations(const HandleTargets& targets) const
{
  std::vector<Eigen::Matrix3d> rotations(
    this->Problem.Moving.size(), Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
  if (targets.RotationVectors.rows() == 0)
  {
    for (std::size_t k = 0; k < rotations.size(); ++k)
    {
      rotations[k] = RotationFromVector(targets.Motions[k].RotationVector);
    }
    return rotations;
  }
  for (Eigen::Index row = 0; row < targets.RotationVectors.rows(); ++row)
  {
    const int handle = this->Regions.GetMoving()[targets.Vertices[row]];
    if (handle >= 0)
    {
      rotations[handle] += RotationFromVector(targets.RotationVectors.row(row).transpose());
    }
  }
  for (Eigen::Matrix3d& rotation : rotations)
  {
    rotation = ProjectOnRotations(rotation);
  }
  return rotations;
}

void CommonMotion::ChooseTurns(HandleTargets& targets) const
{
  const auto countsTurns = [](const HandleMotion& motion) { return motion.CountsTurns; };
  if (std::all_of(targets.Motions.begin(), targets.Motions.end(), countsTurns))
  {
    return;
  }
  const std::vector<Eigen::Matrix3d> rotations = this->HandleRotations(targets);
  std::vector<Eigen::Vector3d> turns;
  for (std::size_t k = 0; k < rotations.size(); ++k)
  {
    turns.push_back(VectorOf(rotations[k], targets.Motions[k].RotationVector));
  }
  for (const Branch& branch : LeastTurns(this->Regions, rotations))
  {
    HandleMotion& motion = targets.Motions[branch.Handle];
    if (!motion.CountsTurns && branch.Parent != NoParent)
    {
      turns[branch.Handle] = NearestTurn(turns[branch.Handle],
        branch.Parent == HandleRegions::Pinned ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                               : turns[branch.Parent]);
      motion.RotationVector = NearestTurn(motion.RotationVector, turns[branch.Handle]);
    }
  }
  for (Eigen::Index row = 0; row < targets.RotationVectors.rows(); ++row)
  {
    const int k = this->Regions.GetMoving()[targets.Vertices[row]];
    if (k >= 0 && !targets.Motions[k].CountsTurns)
    {
      targets.RotationVectors.row(row) =
        NearestTurn(targets.RotationVectors.row(row).transpose(), turns[k]).transpose();
    }
  }
}

HandleTargets CommonMotion::Remove(const HandleTargets& targets)
{
  HandleTargets relative = targets;
  this->Motion = this->Reference(targets);
  this->IsIdentity = this->Motion.Rotation.isIdentity(0.0) &&
    this->Motion.Translation.isZero(0.0) && this->Motion.RotationVector.isZero(0.0);
  if (!this->IsIdentity)
  {
    this->MakeRelative(relative);
  }
  this->ChooseTurns(relative);
  return relative;
}

/// Whether all handles that a region sees make one rigid motion: #regions; empty for targets that
/// differ from point to point and handles that are not held in position.
std::vector<char> CommonMotion::RigidRegions(const HandleTargets& relative) const
{
  const auto extent = [this] {
    return this->Problem.Pieces ? this->ExtentOfPieces : this->Problem.Rest->cwiseAbs().maxCoeff();
  };
  std::vector<char> isRigid;
  if (relative.IsPerVertex() || relative.RotationVectors.rows() ||
    !this->Problem.ConstrainPositions)
  {
    return isRigid;
  }
  for (int region = 0; region < this->Regions.NumberOfRegions(); ++region)
  {
    const std::vector<int>& handles = this->Regions.GetHandles(region);
    isRigid.push_back(!handles.empty() && IsRigid(MotionOf(relative, handles.back())) &&
      std::all_of(handles.begin(), handles.end(),
        [&](int k)
        { return AreSame(MotionOf(relative, k), MotionOf(relative, handles.back()), extent); }));
  }
  return isRigid;
}

bool CommonMotion::HasRigidRegions(const HandleTargets& relative) const
{
  const std::vector<char> isRigid = this->RigidRegions(relative);
  return std::find(isRigid.begin(), isRigid.end(), 1) != isRigid.end();
}

void CommonMotion::Follow(
  const HandleTargets& relative, bool wantTransforms, DeformedSurface& result) const
{
  const std::vector<char> isRigid = this->RigidRegions(relative);
  if (std::find(isRigid.begin(), isRigid.end(), 1) == isRigid.end())
  {
    return;
  }
  for (int v = 0; v < this->Problem.Mesh->NumberOfVertices(); ++v)
  {
    const int region = this->Regions.OfVertex(v);
    if (region >= 0 && isRigid[region])
    {
      const HandleMotion& motion = MotionOf(relative, this->Regions.GetHandles(region).back());
      result.Positions.row(v) =
        (motion.Linear * this->Problem.Rest->row(v).transpose() + motion.Translation).transpose();
      if (wantTransforms)
      {
        MatrixAt(result.Transforms, v) = motion.Linear;
      }
    }
  }
}

void CommonMotion::Restore(bool wantTransforms, DeformedSurface& result) const
{
  const int count = this->Problem.Mesh->NumberOfVertices();
  this->RestoreRows(0, count, result.Positions.data());
  for (int v = 0; v < count && wantTransforms && !this->IsIdentity; ++v)
  {
    if (this->Regions.IsReached(v) && this->Problem.Mesh->IsUsed(v))
    {
      MatrixAt(result.Transforms, v) =
        this->Motion.Rotation * MatrixAt(result.Transforms, v).eval();
    }
  }
}

void CommonMotion::RestoreRows(int begin, int end, double* positions) const
{
  for (int v = begin; v < end && !this->IsIdentity; ++v, positions += 3)
  {
    if (this->Regions.IsReached(v) && this->Problem.Mesh->IsUsed(v))
    {
      Eigen::Map<Eigen::Vector3d> position(positions);
      position = (this->Motion.Rotation * position + this->Motion.Translation).eval();
    }
  }
}
}
