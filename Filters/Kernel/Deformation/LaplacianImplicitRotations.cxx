// SPDX-License-Identifier: BSD-3-Clause
// The rotations of Laplacian editing that are linear in the unknown positions: a system over three
// unknowns for each vertex, or the sums over handles of what it makes of their motions.
#include "Deformation/LaplacianDeformer.h"

#include "Algebra/Rotation.h"
#include "Algebra/SparseProduct.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cartan
{
namespace
{
/// Each handle's fields take 384 bytes per row, and as long to find as ten motions without.
constexpr std::size_t MostHandlesWithSimilarities = 4;

/// A motion is twelve numbers, a similarity of a row four.
constexpr int MotionSize = 12;
constexpr int SimilaritySize = 4;

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

/// d -> (s I + [h]x) d as a 3 x 4 matrix on (s, h).
Eigen::Matrix<double, 3, 4> SimilarityOf(const Eigen::Vector3d& d)
{
  Eigen::Matrix<double, 3, 4> matrix;
  matrix << d[0], 0.0, d[2], -d[1], d[1], -d[2], 0.0, d[0], d[2], d[1], -d[0], 0.0;
  return matrix;
}

/// The rotation closest to s I + [h]x. That turns about h by the angle of (s, |h|), stretched
/// by q = (s^2 + |h|^2)^1/2 across h and by s along it, so for s > 0 it is
///
///   (s I + [h]x + h h^T / (q + s)) / q.
Eigen::Matrix3d RotationOfSimilarity(double s, const Eigen::Vector3d& h)
{
  Eigen::Matrix3d similarity;
  similarity << s, -h[2], h[1], h[2], s, -h[0], -h[1], h[0], s;
  const double q = std::sqrt(s * s + h.squaredNorm());
  if (!(s > 0.0 && std::isfinite(q)))
  {
    return ProjectOnRotations(similarity);
  }
  return (similarity + h * (h / (q + s)).transpose()) / q;
}
}

void LaplacianDeformer::FindRings()
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const std::vector<int>& vertices = this->System.GetVertices();
  std::vector<int> lastRow(this->System.NumberOfLocals(), -1);
  std::vector<int> local(mesh.NumberOfVertices(), -1);
  for (int i = 0; i < this->System.NumberOfLocals(); ++i)
  {
    local[vertices[i]] = i;
  }
  for (int row = 0; row < this->NumberOfRows(); ++row)
  {
    this->Rings.push_back(ClosedRing(mesh, vertices[row]));
    std::vector<int>& ring = this->Rings.back();
    for (int& vertex : ring)
    {
      vertex = local[vertex];
    }
    // Several edges may lead to one vertex where vertices are joined.
    const auto isKnown = [&lastRow, row](int i) { return std::exchange(lastRow[i], row) == row; };
    ring.erase(std::remove_if(ring.begin(), ring.end(), isKnown), ring.end());
  }
}

/// Three equations for each row, (L y)_v - (s I + [h]x) (L x)_v in the weight of
/// M^-1/2, over three unknowns for each local vertex; keeps the fits of (s, h).
SparseMatrix LaplacianDeformer::ImplicitEquations()
{
  const Points rest = this->System.Gather(*this->Problem.Rest);
  const SparseMatrix& laplacian = this->System.GetLaplacian();
  std::int64_t numberOfEntries = 0; // 3 x 3 for each vertex of each ring
  for (const std::vector<int>& ring : this->Rings)
  {
    numberOfEntries += 9 * static_cast<std::int64_t>(ring.size());
  }
  RequireIndexable(numberOfEntries, "The system of implicit rotations");
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(numberOfEntries);
  for (int row = 0; row < this->NumberOfRows(); ++row)
  {
    const std::vector<int>& ring = this->Rings[row];
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
    const double weight = std::sqrt(this->System.GetInverseMass()[row]);
    // L is symmetric, and stored by columns.
    const Eigen::Vector3d integrated = (laplacian.col(row).transpose() * rest).transpose();
    const Eigen::MatrixXd turned = SimilarityOf(integrated) * fit; // 3 x 3 k
    for (std::size_t k = 0; k < ring.size(); ++k)
    {
      const double l = laplacian.coeff(row, ring[k]);
      for (int r = 0; r < 3; ++r)
      {
        for (int c = 0; c < 3; ++c)
        {
          const double value = (r == c ? l : 0.0) - turned(r, 3 * static_cast<Eigen::Index>(k) + c);
          entries.emplace_back(3 * row + r, 3 * ring[k] + c, weight * value);
        }
      }
    }
    this->Fits.push_back(std::move(fit));
  }
  SparseMatrix equations(3 * this->NumberOfRows(), 3 * this->System.NumberOfLocals());
  equations.setFromTriplets(entries.begin(), entries.end());
  return equations;
}

void LaplacianDeformer::PrepareImplicit(const ExecutionContext& context)
{
  SparseMatrix normal;
  {
    const SparseMatrix equations = this->ImplicitEquations();
    context.Report(0.3);
    CheckedProduct(equations.transpose(), equations, "The system of implicit rotations")
      .swap(normal);
  }
  this->ImplicitSystem.Factorize(
    std::move(normal), this->System.GetAnchors().Repeated(3), context.Part(0.3, 1.0));
}

/// (s - 1, h) of each row, one below the other (4 #rows x n), for displacements of the held
/// vertices (3 #locals x n). The rest fulfills the equations, so displacements have no
/// right-hand side.
Field LaplacianDeformer::SolveSimilarities(Field unknowns) const
{
  this->ImplicitSystem.Interpolate(unknowns);
  Field similarities(SimilaritySize * this->NumberOfRows(), unknowns.cols());
  Field ofRing;
  for (int row = 0; row < this->NumberOfRows(); ++row)
  {
    const std::vector<int>& ring = this->Rings[row];
    ofRing.resize(3 * static_cast<Eigen::Index>(ring.size()), unknowns.cols());
    for (std::size_t k = 0; k < ring.size(); ++k)
    {
      ofRing.middleRows<3>(3 * static_cast<Eigen::Index>(k)) =
        unknowns.middleRows<3>(3 * static_cast<Eigen::Index>(ring[k]));
    }
    similarities.middleRows<SimilaritySize>(SimilaritySize * row) = this->Fits[row] * ofRing;
  }
  return similarities;
}

/// As similarities are linear in the displacements of handles, (A_k - I) (x - c_k) + t'_k with
/// t'_k = (A_k - I) c_k + t_k, those of each row are a sum over the numbers of A_k - I, column
/// by column, and of t'_k. Writes what is solved for with one of these numbers at a time.
void LaplacianDeformer::ComputeSimilarityFields()
{
  const std::vector<int>& vertices = this->System.GetVertices();
  const auto numberOfMoving = static_cast<int>(this->Problem.Moving.size());
  this->SimilarityFields.resize(this->NumberOfRows(), SimilaritySize * MotionSize * numberOfMoving);
  for (int k = 0; k < numberOfMoving; ++k)
  {
    Field unknowns = Field::Zero(3 * this->System.NumberOfLocals(), MotionSize);
    for (int i = 0; i < this->System.NumberOfLocals(); ++i)
    {
      if (this->MovingHandles[vertices[i]] == k)
      {
        const Eigen::Vector3d x =
          this->Problem.Rest->row(vertices[i]).transpose() - this->HandleCenters[k];
        for (int r = 0; r < 3; ++r)
        {
          unknowns(3 * i + r, r) = x[0];
          unknowns(3 * i + r, 3 + r) = x[1];
          unknowns(3 * i + r, 6 + r) = x[2];
          unknowns(3 * i + r, 9 + r) = 1.0;
        }
      }
    }
    const Field similarities = this->SolveSimilarities(std::move(unknowns));
    for (int row = 0; row < this->NumberOfRows(); ++row)
    {
      Eigen::Map<Eigen::Matrix<double, SimilaritySize, MotionSize>>(
        this->SimilarityFields.row(row).data() + SimilaritySize * MotionSize * k) =
        similarities.middleRows<SimilaritySize>(SimilaritySize * row);
    }
  }
}

void LaplacianDeformer::FindImplicitRotations(
  const HandleTargets& targets, const Points& displacements, const ExecutionContext& context)
{
  const auto setRotation = [this](int row, const Eigen::Vector4d& change)
  {
    if (change.isZero(0.0))
    {
      MatrixAt(this->Transforms, row).setIdentity();
      return;
    }
    MatrixAt(this->Transforms, row) = RotationOfSimilarity(1.0 + change[0], change.tail<3>());
  };
  if (targets.IsPerVertex() || targets.Motions.size() > MostHandlesWithSimilarities)
  {
    // Three unknowns side by side for each local vertex.
    const Points locals = this->System.Gather(displacements);
    const Field similarities =
      this->SolveSimilarities(Eigen::Map<const Field>(locals.data(), locals.size(), 1));
    for (int row = 0; row < this->NumberOfRows(); ++row)
    {
      setRotation(row, similarities.middleRows<SimilaritySize>(SimilaritySize * row));
    }
    return;
  }
  if (this->SimilarityFields.size() == 0)
  {
    this->ComputeSimilarityFields();
  }
  Eigen::VectorXd motions(MotionSize * static_cast<Eigen::Index>(targets.Motions.size()));
  for (std::size_t k = 0; k < targets.Motions.size(); ++k)
  {
    const HandleMotion& motion = targets.Motions[k];
    const Eigen::Matrix3d change = motion.Linear - Eigen::Matrix3d::Identity();
    motions.segment<MotionSize>(MotionSize * static_cast<Eigen::Index>(k))
      << Eigen::Map<const Eigen::Matrix<double, 9, 1>>(change.data()),
      change * this->HandleCenters[k] + motion.Translation;
  }
  context.For(this->NumberOfRows(),
    [&](int begin, int end)
    {
      for (int row = begin; row < end; ++row)
      {
        const double* field = this->SimilarityFields.row(row).data();
        Eigen::Vector4d change = Eigen::Vector4d::Zero();
        for (Eigen::Index i = 0; i < motions.size(); ++i, field += SimilaritySize)
        {
          change += motions[i] * Eigen::Map<const Eigen::Vector4d>(field);
        }
        setRotation(row, change);
      }
    });
}
}
