// SPDX-License-Identifier: BSD-3-Clause
// What Laplacian editing finds without a solve: the surface whose differential coordinates keep
// their direction.
#include "Deformation/LaplacianDeformer.h"

#include <algorithm>

namespace cartan
{
namespace
{
/// Each handle's fields take 32 bytes per vertex, and the time of a tenth of a solve.
constexpr std::size_t MostHandlesWithFields = 4;
}

/// With differential coordinates that keep their direction, displacements are linear in those of
/// the handles, (A_k - I) x + t_k: the sum over the handles k of
///
///   (A_k - I) g_k + h_k ((A_k - I) c_k + t_k),
///
/// g_k solved for with x - c_k on handle k and h_k with 1, c_k its center: the displacement is not
/// a difference of large numbers then.
bool LaplacianDeformer::SumHandleFields(
  const HandleTargets& targets, Points& displacements, const ExecutionContext& context)
{
  const std::vector<HandleMotion>& motions = targets.Motions;
  if (targets.IsPerVertex() || motions.size() > MostHandlesWithFields)
  {
    return false;
  }
  if (this->HandleFields.size() == 0)
  {
    this->ComputeHandleFields();
  }
  std::vector<Eigen::Matrix3d> changes;
  std::vector<Eigen::Vector3d> shifts;
  for (std::size_t k = 0; k < motions.size(); ++k)
  {
    changes.emplace_back(motions[k].Linear - Eigen::Matrix3d::Identity());
    shifts.emplace_back(changes[k] * this->HandleCenters[k] + motions[k].Translation);
  }
  context.For(this->System.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const double* fields = this->HandleFields.row(i).data();
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::size_t k = 0; k < changes.size(); ++k, fields += 4)
        {
          sum += changes[k] * Eigen::Map<const Eigen::Vector3d>(fields) + fields[3] * shifts[k];
        }
        displacements.row(this->System.GetVertices()[i]) = sum.transpose();
      }
    });
  return true;
}

void LaplacianDeformer::FindHandleCenters()
{
  this->HandleCenters.assign(this->Problem.Moving.size(), Eigen::Vector3d::Zero());
  std::vector<double> counts(this->HandleCenters.size(), 0.0);
  for (const int v : this->System.GetVertices())
  {
    if (const int k = this->MovingHandles[v]; k >= 0)
    {
      this->HandleCenters[k] += this->Problem.Rest->row(v).transpose();
      counts[k] += 1.0;
    }
  }
  for (std::size_t k = 0; k < counts.size(); ++k)
  {
    this->HandleCenters[k] /= std::max(counts[k], 1.0);
  }
}

void LaplacianDeformer::ComputeHandleFields()
{
  const Points& rest = *this->Problem.Rest;
  const std::vector<int>& vertices = this->System.GetVertices();
  const auto numberOfMoving = static_cast<int>(this->Problem.Moving.size());
  const Points zero = Points::Zero(this->System.NumberOfLocals(), 3);
  this->HandleFields.resize(this->System.NumberOfUnknowns(), 4 * numberOfMoving);
  for (int k = 0; k < numberOfMoving; ++k)
  {
    // One of them for the three coordinates, one for the constant.
    Points values[2] = { Points::Zero(rest.rows(), 3), Points::Zero(rest.rows(), 3) };
    for (const int v : vertices)
    {
      if (this->MovingHandles[v] == k)
      {
        values[0].row(v) = rest.row(v) - this->HandleCenters[k].transpose();
        values[1](v, 0) = 1.0;
      }
    }
    this->System.Solve(zero, values[0]);
    this->System.Solve(zero, values[1]);
    for (int i = 0; i < this->System.NumberOfUnknowns(); ++i)
    {
      this->HandleFields.block<1, 3>(i, 4 * k) = values[0].row(vertices[i]);
      this->HandleFields(i, 4 * k + 3) = values[1](vertices[i], 0);
    }
  }
}
}
