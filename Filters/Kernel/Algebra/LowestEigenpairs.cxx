// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/LowestEigenpairs.h"

#include "Algebra/ConstrainedSolver.h"
#include "Algebra/ThinProduct.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace cartan
{
namespace
{
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// So few unknowns are decomposed densely, in less time than it takes to factorize.
constexpr Index FewUnknowns = 300;

/// The shift in parts of the mean diagonal, which bounds the largest eigenvalue by half:
/// small against the eigenvalues that are asked for, large against rounding.
constexpr double Shift = 1e-8;

/// Vectors that are multiplied by the inverse at once: the factor and the basis, which no
/// cache holds, pass by once for all of them.
constexpr Index BlockSize = 4;

/// |S^-1 y - theta y| / theta of a pair that is accepted.
constexpr double Tolerance = 1e-12;

/// The most columns of the basis that are not accepted yet: enough to find most pairs
/// without a restart, few enough for the dense decomposition of their projection.
Index MostActive(int count, Index size)
{
  const Index wanted = std::min<Index>(2 * count + 40, 320);
  return std::min(wanted / BlockSize * BlockSize, size);
}

bool IsDense(int count, Index size)
{
  return size <= FewUnknowns || count + MostActive(count, size) > size / 2;
}

/// The block Lanczos method. Its basis holds the accepted eigenvectors, the active vectors V
/// with V^T S^-1 V = T, and the block that comes next:
///
///   S^-1 V = V T + next R E^T,   E^T the last rows of the identity.
class Lanczos
{
public:
  Lanczos(const SparseMatrix& matrix, const MatrixXd& nullSpace, int count, SolverBackend backend,
    const ExecutionContext& context)
    : Solver(backend)
    , Context(context)
    , Known(nullSpace.cols())
    , Count(count)
    , MostActive(cartan::MostActive(count, matrix.rows()))
    , Accepted(nullSpace.cols())
  {
    const Index size = matrix.rows();
    this->Solver.Factorize(matrix, std::vector<char>(size, 0),
      VectorXd::Constant(size, Shift * matrix.diagonal().mean()), {}, context.Part(0.0, 0.1));
    this->Basis.resize(size, count + this->MostActive + BlockSize);
    this->Basis.leftCols(this->Accepted) = nullSpace;
    this->Values = VectorXd::Constant(count + this->MostActive, HUGE_VAL);
    this->Projected.resize(this->MostActive + BlockSize, this->MostActive + BlockSize);
  }

  /// The eigenvectors, the known ones first.
  MatrixXd Run()
  {
    this->Start();
    while (this->Accepted < this->Count)
    {
      this->Fill(this->MostActive);
      this->Restart(this->Count - this->Accepted, 0.0);
    }
    // A block sees an eigenvalue no more often than it has columns, but for rounding. A
    // random one that is orthogonal to all that is accepted sees what has been missed.
    while (this->FindMissed())
    {
      this->KeepLargest();
    }
    return this->Basis.leftCols(this->Count);
  }

private:
  Eigen::Ref<MatrixXd> Next()
  {
    return this->Basis.middleCols(this->Accepted + this->Active, BlockSize);
  }

  void Randomize(Eigen::Ref<MatrixXd> vectors)
  {
    for (Index j = 0; j < vectors.cols(); ++j)
    {
      for (Index i = 0; i < vectors.rows(); ++i)
      {
        vectors(i, j) = 2.0 * this->Random() / std::mt19937::max() - 1.0;
      }
    }
  }

  /// Begins with a random block.
  void Start()
  {
    this->Active = 0;
    this->Coupled = 0;
    this->Projected.setZero();
    this->Randomize(this->Next());
    this->Orthogonalize(this->Next());
    this->Orthogonalize(this->Next());
    this->Orthonormalize();
  }

  /// Subtracts from `block` what lies in the basis before the next block, and returns it.
  MatrixXd Orthogonalize(Eigen::Ref<MatrixXd> block)
  {
    const auto before = this->Basis.leftCols(this->Accepted + this->Active);
    const MatrixXd part = ThinTransposedProduct(before, block, this->Context);
    SubtractThinProduct(before, part, block, this->Context);
    return part;
  }

  /// Makes the next block orthonormal and returns the factor R of its QR decomposition. A
  /// column that depends on the others, which happens when the basis holds an invariant
  /// space, becomes a random one, with zeros in R.
  MatrixXd Orthonormalize()
  {
    Eigen::Ref<MatrixXd> block = this->Next();
    MatrixXd factor = MatrixXd::Zero(BlockSize, BlockSize);
    const double least =
      std::max(1e-8 * block.colwise().norm().maxCoeff(), 1e-12 * this->InverseScale);
    for (Index j = 0; j < BlockSize; ++j)
    {
      for (int pass = 0; pass < 2; ++pass)
      {
        const VectorXd part = block.leftCols(j).transpose() * block.col(j);
        block.col(j) -= block.leftCols(j) * part;
        factor.col(j).head(j) += part;
      }
      factor(j, j) = block.col(j).norm();
      if (factor(j, j) <= least)
      {
        factor(j, j) = 0.0;
        this->Randomize(block.col(j));
        for (int pass = 0; pass < 2; ++pass)
        {
          this->Orthogonalize(block.col(j));
          block.col(j) -= block.leftCols(j) * (block.leftCols(j).transpose() * block.col(j)).eval();
        }
      }
      block.col(j).normalize();
    }
    return factor;
  }

  /// Makes the next block active: T grows by its products with the inverse.
  void Expand()
  {
    const Index active = this->Active;
    const MatrixXd block = this->Next();
    MatrixXd image = this->Solver.SolveFree(block);
    MatrixXd diagonal = ThinTransposedProduct(block, image, this->Context);
    this->InverseScale = std::max(this->InverseScale, diagonal.cwiseAbs().maxCoeff());
    // The part of the image in the vectors before is known. Subtracting it first leaves
    // nothing but rounding to the pass over the whole basis, and one pass suffices.
    const Index coupled = active - this->Coupled;
    SubtractThinProduct(block, diagonal, image, this->Context);
    SubtractThinProduct(this->Basis.middleCols(this->Accepted + this->Coupled, coupled),
      this->Projected.block(this->Coupled, active, coupled, BlockSize), image, this->Context);
    this->Active += BlockSize;
    diagonal += this->Orthogonalize(image).bottomRows(BlockSize);
    this->Projected.block(active, active, BlockSize, BlockSize) =
      0.5 * (diagonal + diagonal.transpose());
    this->Next() = image;
    this->Couple(this->Orthonormalize(), active);
    this->Coupled = active;
    // How many there will be is not known: the rest halves with every so many.
    ++this->Expansions;
    this->Context.Report(1.0 -
      0.9 * std::exp2(-static_cast<double>(BlockSize * this->Expansions) / (this->Count + 40.0)));
  }

  /// Puts the products of the next block with active vectors from `first` on into T.
  void Couple(const MatrixXd& factor, Index first)
  {
    this->Projected.block(this->Active, first, BlockSize, factor.cols()) = factor;
    this->Projected.block(first, this->Active, factor.cols(), BlockSize) = factor.transpose();
  }

  void Fill(Index mostActive)
  {
    while (this->Active + BlockSize <= mostActive)
    {
      this->Expand();
    }
  }

  /// Accepts up to `wanted` Ritz vectors that have converged, the largest first and none
  /// with a value up to `least`, and keeps others that come next. Returns how many.
  Index Restart(Index wanted, double least)
  {
    constexpr int MostRestarts = 1000;
    if (++this->Restarts > MostRestarts)
    {
      throw Error(ErrorCode::NotConverged,
        "Only " + std::to_string(this->Accepted) + " of " + std::to_string(this->Count) +
          " modes have converged: ask for fewer.");
    }
    const Index active = this->Active;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(
      this->Projected.topLeftCorner(active, active));
    const MatrixXd vectors = ritz.eigenvectors().rowwise().reverse();
    const VectorXd values = ritz.eigenvalues().reverse();
    const MatrixXd residuals =
      this->Projected.block(active, active - BlockSize, BlockSize, BlockSize) *
      vectors.bottomRows(BlockSize);
    Index accepted = 0;
    while (accepted < wanted && values[accepted] > least &&
      residuals.col(accepted).norm() <= Tolerance * values[accepted])
    {
      this->Values[this->Accepted + accepted] = values[accepted];
      ++accepted;
    }
    // Those that are wanted and a third of the others, but leave half of the room.
    const Index left = wanted - accepted;
    const Index kept = std::min({ left + (active - left) / 3, active / 2, active - accepted });
    this->Rotate(vectors.leftCols(accepted + kept));
    this->Accepted += accepted;
    this->Active = kept;
    this->Coupled = 0;
    this->Projected.setZero();
    this->Projected.diagonal().head(kept) = values.segment(accepted, kept);
    this->Couple(residuals.middleCols(accepted, kept), 0);
    return accepted;
  }

  /// Replaces the active vectors by combinations of them; the next block follows.
  void Rotate(const MatrixXd& combinations)
  {
    ForParts(this->Basis.rows(), 1024, this->Context,
      [&](Index first, Index count)
      {
        auto rows = this->Basis.block(first, this->Accepted, count, this->Active + BlockSize);
        const MatrixXd next = rows.rightCols(BlockSize);
        rows.leftCols(combinations.cols()) = (rows.leftCols(this->Active) * combinations).eval();
        rows.middleCols(combinations.cols(), BlockSize) = next;
      });
  }

  /// Accepts eigenvectors that have been missed; whether there are any.
  bool FindMissed()
  {
    if (this->Count == this->Known)
    {
      return false;
    }
    // So many blocks bring a value that is a few percent above the others above them.
    constexpr Index Blocks = 12;
    const double least = (1.0 + 1e-6) * this->Values.head(this->Count).minCoeff();
    this->Start();
    this->Fill(std::min(Blocks * BlockSize, this->MostActive));
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(
      this->Projected.topLeftCorner(this->Active, this->Active), Eigen::EigenvaluesOnly);
    if (ritz.eigenvalues()[this->Active - 1] <= least)
    {
      return false;
    }
    do
    {
      this->Fill(this->MostActive);
    } while (this->Restart(this->MostActive / 2, least) == 0);
    return true;
  }

  /// Keeps the best `Count` of more accepted eigenvectors.
  void KeepLargest()
  {
    std::vector<Index> order(this->Accepted);
    std::iota(order.begin(), order.end(), Index{ 0 });
    std::stable_sort(order.begin(), order.end(),
      [this](Index a, Index b) { return this->Values[a] > this->Values[b]; });
    this->Accepted = this->Count;
    this->Basis.leftCols(this->Count) =
      this->Basis(Eigen::all, std::vector<Index>(order.begin(), order.begin() + this->Count))
        .eval();
    std::sort(this->Values.data(), this->Values.data() + order.size(), std::greater<double>());
  }

  ConstrainedSolver Solver;
  const ExecutionContext& Context;
  Index Known;      // columns of the null space
  Index Count;      // wanted, the known ones included
  Index MostActive; // columns of V
  Index Accepted;
  Index Active = 0;
  Index Coupled = 0;         // the first active vector that the next block is coupled with
  MatrixXd Basis;            // #U x (accepted, active, next)
  MatrixXd Projected;        // T, and the products of the next block with V
  VectorXd Values;           // of the inverse, of the accepted vectors
  double InverseScale = 0.0; // about the largest eigenvalue of the inverse
  int Expansions = 0;
  int Restarts = 0;
  std::mt19937 Random;
};

/// Makes vectors that are nearly orthonormal orthonormal to all digits, keeping the span of
/// the first k for each k.
void Orthonormalize(MatrixXd& vectors, const ExecutionContext& context)
{
  MatrixXd gram = MatrixXd::Zero(vectors.cols(), vectors.cols());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(vectors.transpose());
  const Eigen::LLT<MatrixXd> factor(gram);
  ForParts(vectors.rows(), 1024, context,
    [&](Index first, Index count)
    {
      MatrixXd rows = vectors.middleRows(first, count);
      factor.matrixU().solveInPlace<Eigen::OnTheRight>(rows);
      vectors.middleRows(first, count) = rows;
    });
}

/// The pairs of these vectors in the order of their Rayleigh quotients.
Eigenpairs SortedPairs(const SparseMatrix& matrix, const MatrixXd& vectors, Index known)
{
  VectorXd values = VectorXd::Zero(vectors.cols());
  for (Index k = known; k < vectors.cols(); ++k)
  {
    values[k] = std::max(0.0, vectors.col(k).dot(matrix * vectors.col(k)));
  }
  std::vector<Index> order(vectors.cols());
  std::iota(order.begin(), order.end(), Index{ 0 });
  std::stable_sort(
    order.begin() + known, order.end(), [&](Index a, Index b) { return values[a] < values[b]; });
  return { values(order), vectors(Eigen::all, order) };
}
}

std::uint64_t VectorsOfEigenpairs(int count, Index size)
{
  // A dense matrix, its eigenvectors and work space.
  return static_cast<std::uint64_t>(
    IsDense(count, size) ? 3 * size : 2 * count + MostActive(count, size) + 5 * BlockSize);
}

Eigenpairs LowestEigenpairs(const SparseMatrix& matrix, const MatrixXd& nullSpace, int count,
  SolverBackend backend, const ExecutionContext& context)
{
  MatrixXd vectors = nullSpace;
  if (nullSpace.cols() == count)
  {
    return { VectorXd::Zero(count), vectors };
  }
  if (IsDense(count, matrix.rows()))
  {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver((MatrixXd(matrix)));
    vectors = solver.eigenvectors().leftCols(count);
    vectors.leftCols(nullSpace.cols()) = nullSpace;
  }
  else
  {
    vectors = Lanczos(matrix, nullSpace, count, backend, context.Part(0.0, 0.95)).Run();
  }
  Orthonormalize(vectors, context);
  return SortedPairs(matrix, vectors, nullSpace.cols());
}
}
