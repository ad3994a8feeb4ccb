// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/TriangleStitching.h"

#include "Differential/Laplacian.h"

namespace cartan
{
TriangleStitching::TriangleStitching(Triangles triangles, Points cornerWeights,
  const std::vector<char>& isHeld, const ExecutionContext& context)
  : Corners(std::move(triangles))
  , Weights(std::move(cornerWeights))
{
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> edges(3 * this->Corners.rows(), 2);
  for (Eigen::Index t = 0; t < this->Corners.rows(); ++t)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      edges.row(3 * t + corner) << this->Corners(t, (corner + 1) % 3),
        this->Corners(t, (corner + 2) % 3);
    }
  }
  const Eigen::Map<const Eigen::VectorXd> weights(this->Weights.data(), this->Weights.size());
  this->System.Factorize(GraphLaplacian(static_cast<int>(isHeld.size()), edges, weights),
    Anchors::Hard(isHeld), context);
}

void TriangleStitching::Stitch(const Matrices& corners, Points& positions) const
{
  Field rightHandSide = Field::Zero(positions.rows(), 3);
  for (Eigen::Index t = 0; t < this->Corners.rows(); ++t)
  {
    const auto triangle = MatrixAt(corners, t);
    for (int corner = 0; corner < 3; ++corner)
    {
      const int from = (corner + 1) % 3;
      const int to = (corner + 2) % 3;
      const Eigen::RowVector3d pull =
        this->Weights(t, corner) * (triangle.col(to) - triangle.col(from)).transpose();
      rightHandSide.row(this->Corners(t, to)) += pull;
      rightHandSide.row(this->Corners(t, from)) -= pull;
    }
  }
  Field values = positions;
  this->System.Solve(rightHandSide, values);
  positions = values;
}
}
