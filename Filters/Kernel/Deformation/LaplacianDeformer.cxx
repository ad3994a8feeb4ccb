// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/LaplacianDeformer.h"

#include "Algebra/Rotation.h"

#include <Eigen/QR>

#include <algorithm>

namespace cartan
{
namespace
{
/// The vertex and its one-ring.
std::vector<int> ClosedRing(const TriangleMesh& mesh, int v)
{
  std::vector<int> ring{ v };
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    ring.push_back(mesh.Neighbor(d));
  }
  return ring;
}

std::vector<int> ClosedTwoRing(const TriangleMesh& mesh, int v)
{
  std::vector<int> ring;
  for (const int w : ClosedRing(mesh, v))
  {
    const std::vector<int> more = ClosedRing(mesh, w);
    ring.insert(ring.end(), more.begin(), more.end());
  }
  std::sort(ring.begin(), ring.end());
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  return ring;
}

/// d -> (s I + [h]x) d as a 3 x 4 matrix on (s, h).
Eigen::Matrix<double, 3, 4> SimilarityOf(const Eigen::Vector3d& d)
{
  Eigen::Matrix<double, 3, 4> matrix;
  matrix << d[0], 0.0, d[2], -d[1], d[1], -d[2], 0.0, d[0], d[2], d[1], -d[0], 0.0;
  return matrix;
}
}

LaplacianDeformer::LaplacianDeformer(HandleProblem problem, LaplacianRotations rotations,
  SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(std::move(problem))
  , Rotations(rotations)
  , System(this->Problem, 2, backend, context.Part(0.0, 0.5))
  , Differential(this->System.DifferentialCoordinates(*this->Problem.Rest))
  , ImplicitSolver(backend)
{
  RequirePositions(this->Problem, "Laplacian editing");
  this->FindRows();
  if (rotations == LaplacianRotations::Estimated)
  {
    for (const int v : this->Rows)
    {
      this->TwoRings.push_back(ClosedTwoRing(*this->Problem.Mesh, v));
    }
  }
  else if (rotations == LaplacianRotations::Implicit)
  {
    this->PrepareImplicit(context.Part(0.5, 1.0));
  }
  context.Report(1.0);
}

void LaplacianDeformer::FindRows()
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  std::vector<char> isRow(mesh.NumberOfVertices(), 0);
  for (const int v : this->System.GetUnknowns())
  {
    for (const int w : ClosedRing(mesh, v))
    {
      isRow[w] = 1;
    }
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (isRow[v])
    {
      this->Rows.push_back(v);
    }
  }
}

void LaplacianDeformer::PrepareImplicit(const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const Points& rest = *this->Problem.Rest;
  const SparseMatrix& laplacian = this->System.GetLaplacian();
  const int numberOfUnknowns = 3 * mesh.NumberOfVertices();
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t row = 0; row < this->Rows.size(); ++row)
  {
    const int v = this->Rows[row];
    const std::vector<int> ring = ClosedRing(mesh, v);
    // The best (s, h) and translation for given positions y of the ring:
    // (s I + [h]x) (x_j - mean x) = y_j - mean y. Centered on the mean, the
    // translation drops out.
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int w : ring)
    {
      mean += rest.row(w).transpose() / static_cast<double>(ring.size());
    }
    Eigen::MatrixXd design(3 * ring.size(), 4);
    for (std::size_t k = 0; k < ring.size(); ++k)
    {
      design.middleRows<3>(3 * static_cast<Eigen::Index>(k)) =
        SimilarityOf(rest.row(ring[k]).transpose() - mean);
    }
    // The columns of the design have mean zero, so the mean of y drops out too.
    Eigen::MatrixXd fit = design.completeOrthogonalDecomposition().pseudoInverse();
    // Equation row: (L y)_v - (s I + [h]x) (L x)_v, in the weight of M^-1/2.
    const double weight = std::sqrt(this->System.GetInverseMass()[v]);
    // L is symmetric, and stored by columns.
    const Eigen::Vector3d integrated = (laplacian.col(v).transpose() * rest).transpose();
    const Eigen::MatrixXd turned = SimilarityOf(integrated) * fit; // 3 x 3 k
    const int firstEquation = 3 * static_cast<int>(row);
    for (std::size_t k = 0; k < ring.size(); ++k)
    {
      const double l = laplacian.coeff(v, ring[k]);
      for (int r = 0; r < 3; ++r)
      {
        for (int c = 0; c < 3; ++c)
        {
          const double value = (r == c ? l : 0.0) - turned(r, 3 * static_cast<Eigen::Index>(k) + c);
          entries.emplace_back(firstEquation + r, 3 * ring[k] + c, weight * value);
        }
      }
    }
    this->Fits.push_back(std::move(fit));
  }
  SparseMatrix equations(3 * static_cast<Eigen::Index>(this->Rows.size()), numberOfUnknowns);
  equations.setFromTriplets(entries.begin(), entries.end());
  context.Report(0.3);
  std::vector<char> isFixed(numberOfUnknowns, 1);
  std::vector<int> vertices(numberOfUnknowns);
  for (int unknown = 0; unknown < numberOfUnknowns; ++unknown)
  {
    vertices[unknown] = unknown / 3;
  }
  for (const int v : this->System.GetUnknowns())
  {
    std::fill_n(isFixed.begin() + 3 * v, 3, 0);
  }
  Eigen::VectorXd stiffness(numberOfUnknowns);
  for (int unknown = 0; unknown < numberOfUnknowns; ++unknown)
  {
    stiffness[unknown] = this->System.GetStiffness()[unknown / 3];
  }
  const SparseMatrix normal = equations.transpose() * equations;
  this->ImplicitSolver.Factorize(normal, isFixed, stiffness, vertices, context.Part(0.3, 1.0));
}

void LaplacianDeformer::EstimateRotations(const Points& current, const ExecutionContext& context)
{
  const Points& rest = *this->Problem.Rest;
  context.For(static_cast<int>(this->Rows.size()),
    [&](int begin, int end)
    {
      for (int row = begin; row < end; ++row)
      {
        const std::vector<int>& ring = this->TwoRings[row];
        Eigen::Vector3d restMean = Eigen::Vector3d::Zero();
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        for (const int w : ring)
        {
          restMean += rest.row(w).transpose();
          mean += current.row(w).transpose();
        }
        restMean /= static_cast<double>(ring.size());
        mean /= static_cast<double>(ring.size());
        Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
        for (const int w : ring)
        {
          covariance += (current.row(w).transpose() - mean) * (rest.row(w) - restMean.transpose());
        }
        MatrixAt(this->Transforms, this->Rows[row]) = ProjectOnRotations(covariance);
      }
    });
}

void LaplacianDeformer::SolveImplicitly(Points& positions)
{
  const Eigen::Index size = positions.rows();
  Field unknowns(3 * size, 1);
  Field rightHandSide(3 * size, 1);
  for (Eigen::Index v = 0; v < size; ++v)
  {
    unknowns.middleRows<3>(3 * v) = positions.row(v).transpose();
    rightHandSide.middleRows<3>(3 * v) =
      this->System.GetStiffness()[v] * positions.row(v).transpose();
  }
  this->ImplicitSolver.Solve(rightHandSide, unknowns);
  for (std::size_t row = 0; row < this->Rows.size(); ++row)
  {
    const int v = this->Rows[row];
    const std::vector<int> ring = ClosedRing(*this->Problem.Mesh, v);
    Eigen::VectorXd ringPositions(3 * ring.size());
    for (std::size_t k = 0; k < ring.size(); ++k)
    {
      ringPositions.segment<3>(3 * static_cast<Eigen::Index>(k)) =
        unknowns.middleRows<3>(3 * static_cast<Eigen::Index>(ring[k]));
    }
    const Eigen::Vector4d similarity = this->Fits[row] * ringPositions;
    const double s = similarity[0];
    Eigen::Matrix3d transform;
    transform << s, -similarity[3], similarity[2], similarity[3], s, -similarity[1], -similarity[2],
      similarity[1], s;
    MatrixAt(this->Transforms, v) = ProjectOnRotations(transform);
  }
}

void LaplacianDeformer::SolveRotated(const HandleTargets& targets, Points& positions) const
{
  Points rotated = this->Differential;
  for (const int v : this->Rows)
  {
    const Eigen::Vector3d differential = this->Differential.row(v);
    rotated.row(v) = (MatrixAt(this->Transforms, v) * differential).transpose();
  }
  positions = this->System.Targets(targets);
  this->System.Solve(this->System.GetLaplacian() * rotated, positions);
}

void LaplacianDeformer::Deform(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  this->Transforms = Identities(this->Problem.Mesh->NumberOfVertices());
  if (this->Rotations == LaplacianRotations::Implicit)
  {
    result.Positions = this->System.Targets(targets);
    this->SolveImplicitly(result.Positions);
    this->SolveRotated(targets, result.Positions);
  }
  else
  {
    this->SolveRotated(targets, result.Positions);
    const int rounds = this->Rotations == LaplacianRotations::Estimated ? this->Rounds : 0;
    for (int round = 0; round < rounds; ++round)
    {
      context.Report(static_cast<double>(round) / rounds);
      this->EstimateRotations(result.Positions, context);
      this->SolveRotated(targets, result.Positions);
    }
  }
  if (wantTransforms)
  {
    result.Transforms = this->Transforms;
  }
  context.Report(1.0);
}
}
