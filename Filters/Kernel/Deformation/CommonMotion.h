// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleRegions.h"

namespace cartan
{
/// x -> Rotation x + Translation.
struct RigidMotion
{
  Eigen::Matrix3d Rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d Translation = Eigen::Vector3d::Zero();
  /// Of Rotation, in radians: with the full turns of the handle it was taken from.
  Eigen::Vector3d RotationVector = Eigen::Vector3d::Zero();
};

/// What all handles do together, taken out of the targets before a method sees
/// them and given back to its result. So every method commutes with rigid
/// motions of everything, however it treats large rotations:
///
///   Deform(G m_1, G m_2, ...) = G Deform(m_1, m_2, ...),
///
/// and handles that move as one carry the surface along.
///
/// G is the identity where a handle is pinned. Otherwise it is the motion of the
/// moving handle with the lowest id; where that has scale or shear, the rotation
/// of its polar decomposition, and where it takes the handle's centroid; where
/// targets differ from point to point, the rigid motion that fits them best.
///
/// Rotations that are known as matrices only (HandleMotion::CountsTurns off) say
/// nothing about full turns and may be taken the one way around or the other. What
/// twists the surface is the turn between handles that share a region, so the
/// vectors are chosen together: along a tree of least turns (Prim) from the
/// pinned handles, or from the lowest id, each handle takes the vector nearest
/// to that of the handle it is joined to.
class CommonMotion
{
public:
  explicit CommonMotion(const HandleProblem& problem);

  /// The targets as seen from G, which is kept until the next call.
  HandleTargets Remove(const HandleTargets& targets);

  /// Moves each region whose handles all make one rigid motion by just that,
  /// which is what it does without any solver's error. Not for targets that
  /// differ from point to point, or handles that are not held in position.
  void Follow(const HandleTargets& relative, bool wantTransforms, DeformedSurface& result) const;

  /// Whether there are such regions.
  bool HasRigidRegions(const HandleTargets& relative) const;

  /// From the result for the relative targets to that for the given ones.
  void Restore(bool wantTransforms, DeformedSurface& result) const;

  /// The same for the positions of a range of vertices, three numbers each.
  void RestoreRows(int begin, int end, double* positions) const;

  const RigidMotion& GetMotion() const { return this->Motion; }

  std::size_t GetBytes() const { return this->Regions.GetBytes() + BytesOf(this->Centroid); }

private:
  RigidMotion Reference(const HandleTargets& targets) const;
  RigidMotion BestFit(const HandleTargets& targets) const;
  void MakeRelative(HandleTargets& targets) const;
  std::vector<Eigen::Matrix3d> HandleRotations(const HandleTargets& targets) const;
  void ChooseTurns(HandleTargets& targets) const;
  std::vector<char> RigidRegions(const HandleTargets& relative) const;

  const HandleProblem& Problem;
  HandleRegions Regions;
  bool HasPinned;
  Eigen::Vector3d Centroid = Eigen::Vector3d::Zero(); ///< of the lowest moving handle
  double ExtentOfPieces = 0.0; ///< where there are some: the largest coordinate on any rank
  RigidMotion Motion;
  bool IsIdentity = true;
};
}
