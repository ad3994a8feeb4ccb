// SPDX-License-Identifier: BSD-3-Clause
// The fit of rotations to positions, one of the two steps that take turns.
#include "Algebra/ClosestRotation.h"
#include "Algebra/Rotation.h"
#include "Deformation/AsRigidAsPossibleDeformer.h"

namespace cartan
{
namespace
{
using Row = Eigen::RowVector3d;

/// How often coupled rotations are fitted between two solves for positions.
constexpr int CoupledSweeps = 2;
}

/// S_i = sum_j w_ij (x_i - x_j) (p_i - p_j)^T, with rims over their edges too: the
/// spokes' and rims' energy is least for the rotation closest to it.
Eigen::Matrix3d AsRigidAsPossibleDeformer::Covariance(int cell) const
{
  const Row rest = this->Rest.row(cell);
  const Row current = this->Current.row(cell);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int s = this->Cells.SpokeOffsets[cell]; s < this->Cells.SpokeOffsets[cell + 1]; ++s)
  {
    const RigidCells::Spoke& spoke = this->Cells.Spokes[s];
    const Row edge = current - this->Current.row(spoke.Neighbor);
    const Row restEdge = spoke.Weight * (rest - this->Rest.row(spoke.Neighbor));
    covariance += edge.transpose() * restEdge;
  }
  if (!this->Rims.empty())
  {
    for (int s = this->Cells.SpokeOffsets[cell]; s < this->Cells.SpokeOffsets[cell + 1]; ++s)
    {
      const RigidCells::Rim& rim = this->Rims[s];
      if (rim.Left >= 0)
      {
        const int neighbor = this->Cells.Spokes[s].Neighbor;
        const Row edge = this->Current.row(neighbor) - this->Current.row(rim.Left);
        const Row restEdge = rim.RimWeight * (this->Rest.row(neighbor) - this->Rest.row(rim.Left));
        covariance += edge.transpose() * restEdge;
      }
    }
  }
  return covariance;
}

/// sum_j w_ij (R_j + R_i) of the rotations before the sweep.
Eigen::Matrix3d AsRigidAsPossibleDeformer::CoupledRotations(int cell) const
{
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double weights = 0.0;
  for (int s = this->Cells.SpokeOffsets[cell]; s < this->Cells.SpokeOffsets[cell + 1]; ++s)
  {
    const RigidCells::Spoke& spoke = this->Cells.Spokes[s];
    sum += spoke.Weight * MatrixAt(this->Before, spoke.Neighbor);
    weights += spoke.Weight;
  }
  return sum + weights * MatrixAt(this->Before, cell);
}

void AsRigidAsPossibleDeformer::FitRotations(const ExecutionContext& context)
{
  // Of all active cells that do not keep theirs, in blocks on all threads.
  const auto fitCells = [&](const Matrices& before, const auto& covariance)
  {
    context.For(this->Cells.ActiveCount,
      [&](int begin, int end)
      {
        for (int cell = begin; cell < end; ++cell)
        {
          const auto rotation = MatrixAt(before, cell);
          MatrixAt(this->Rotations, cell) = this->HoldsRotation[cell]
            ? Eigen::Matrix3d(rotation)
            : ClosestRotationNear(covariance(cell), rotation);
        }
      });
  };
  const double bending = this->BendingFactor();
  if (bending == 0.0)
  {
    fitCells(this->Rotations, [&](int cell) { return this->Covariance(cell); });
    return;
  }
  // Coupled rotations minimize - tr R^T S - alpha d^2 tr R^T (W + D) R, concave in R, as
  // W + D with the row sums D of W is not negative; D adds a constant. So the
  // rotations closest to its negative gradient do not raise it, all at once: to
  // S_i + 2 alpha d^2 sum_j w_ij (R_j + R_i), whatever the order of the cells.
  this->Covariances.resize(this->Cells.ActiveCount, 9);
  for (int sweep = 0; sweep < CoupledSweeps; ++sweep)
  {
    // The other cells' are the same in both.
    this->Before.swap(this->Rotations);
    fitCells(this->Before,
      [&](int cell) -> Eigen::Matrix3d
      {
        auto covariance = MatrixAt(this->Covariances, cell);
        if (sweep == 0)
        {
          covariance = this->Covariance(cell);
        }
        return covariance + 2.0 * bending * this->CoupledRotations(cell);
      });
  }
}
}
