// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleStitching.h"

#include "Laplacian.h"

namespace cartan
{
TriangleStitching::TriangleStitching(
  const TriangleMesh& mesh, Points cornerWeights, const ExecutionContext& context)
  : CornerWeights(std::move(cornerWeights))
{
  Eigen::VectorXd edgeWeights(mesh.NumberOfDirectedEdges());
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    edgeWeights[d] = 0.0;
    for (const int side : { d, mesh.Twin(d) })
    {
      const int triangle = mesh.LeftTriangle(side);
      for (int corner = 0; triangle >= 0 && corner < 3; ++corner)
      {
        if (mesh.GetTriangles()(triangle, corner) == mesh.Opposite(side))
        {
          edgeWeights[d] += this->CornerWeights(triangle, corner);
        }
      }
    }
  }
  this->Solver.Factorize(
    Laplacian(mesh, edgeWeights), mesh.Grounded(), {}, {}, context);
}

Points TriangleStitching::Stitch(const TriangleMesh& mesh, const Matrices& corners) const
{
  Field rightHandSide = Field::Zero(mesh.NumberOfVertices(), 3);
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto triangle = MatrixAt(corners, t);
    for (int corner = 0; corner < 3; ++corner)
    {
      const int from = (corner + 1) % 3;
      const int to = (corner + 2) % 3;
      const Eigen::Vector3d pull =
        this->CornerWeights(t, corner) * (triangle.col(to) - triangle.col(from));
      rightHandSide.row(mesh.GetTriangles()(t, to)) += pull.transpose();
      rightHandSide.row(mesh.GetTriangles()(t, from)) -= pull.transpose();
    }
  }
  Field positions = Field::Zero(mesh.NumberOfVertices(), 3);
  this->Solver.Solve(rightHandSide, positions);
  return positions;
}
}
