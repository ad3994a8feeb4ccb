// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/LaplacianDeformer.h"

#include "Algebra/ClosestRotations.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cartan
{
namespace
{
/// Estimated rotations have settled when the last round moves no vertex farther
/// than this, in parts of the surface's size. After five rounds that bend real
/// surfaces by 40 and 120 degrees it is .0001 to .03, and where rounds diverge .6 to
/// 10.
constexpr double SettledMove = 0.05;

/// Adds the vertices within two edges of v, v included, to `rings`, each once: those whose
/// `lastSeen` is not `row`.
void AddTwoRing(
  const TriangleMesh& mesh, int v, int row, std::vector<int>& lastSeen, std::vector<int>& rings)
{
  const auto add = [&](int w)
  {
    if (std::exchange(lastSeen[w], row) != row)
    {
      rings.push_back(w);
    }
  };
  add(v);
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const int w = mesh.Neighbor(d);
    add(w);
    for (int e = mesh.RingBegin(w); e < mesh.RingEnd(w); ++e)
    {
      add(mesh.Neighbor(e));
    }
  }
}

/// The sum over the points w of a ring of (s_w - s)(p_w - p)^T with the means p and s of the
/// rest positions and the deformed ones; false where all move alike. As the p_w - p add up to
/// zero, it is that of the rest plus the sum of (d_w - d_v)(p_w - p)^T, v the first point.
bool RingCovariance(const int* begin, const int* end, const Eigen::Vector3d& mean,
  const Points& rest, const Points& displacements, Eigen::Map<Eigen::Matrix3d> covariance)
{
  const double* const origin = displacements.row(*begin).data();
  double products[3][3] = {};
  bool isStill = true;
  for (const int* w = begin; w != end; ++w)
  {
    const double* const point = rest.data() + 3 * static_cast<Eigen::Index>(*w);
    const double* const moved = displacements.data() + 3 * static_cast<Eigen::Index>(*w);
    const double x = moved[0] - origin[0];
    const double y = moved[1] - origin[1];
    const double z = moved[2] - origin[2];
    isStill &= (x == 0.0) & (y == 0.0) & (z == 0.0);
    const double before[3] = { point[0] - mean[0], point[1] - mean[1], point[2] - mean[2] };
    const double after[3] = { before[0] + x, before[1] + y, before[2] + z };
    for (int c = 0; c < 3; ++c)
    {
      for (int r = 0; r < 3; ++r)
      {
        products[c][r] += after[r] * before[c];
      }
    }
  }
  covariance = Eigen::Map<const Eigen::Matrix3d>(products[0]);
  return !isStill;
}

/// The three coordinates of a point have the same neighbors. They make supernodes so large
/// that solves from those are faster than from columns, too.
FactorLimits LimitsOfCoordinates()
{
  FactorLimits limits;
  limits.Use = FactorUse::FewSolves;
  limits.GroupSize = 3;
  return limits;
}
}

LaplacianDeformer::LaplacianDeformer(HandleProblem problem, LaplacianRotations rotations,
  SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(RequirePositions(std::move(problem), "Laplacian editing"))
  , Rotations(rotations)
  , System(this->Problem, 2, backend,
      context.Part(0.0, rotations == LaplacianRotations::Implicit ? 0.5 : 0.9))
  , ImplicitSystem(backend, LimitsOfCoordinates())
  , MovingHandles(MovingHandleOfVertices(this->Problem))
{
  // M^-1 L p, whose rows up to the unknowns' neighbors are complete.
  this->Differential = this->System.Differential(this->System.Gather(*this->Problem.Rest))
                         .topRows(this->NumberOfRows());
  this->Transforms = Identities(this->NumberOfRows());
  this->FindHandleCenters();
  if (rotations == LaplacianRotations::Estimated)
  {
    this->FindTwoRings();
  }
  if (rotations == LaplacianRotations::Implicit)
  {
    this->FindRings();
    this->PrepareImplicit(context.Part(0.5, 1.0));
  }
  context.Report(1.0);
}

void LaplacianDeformer::FindTwoRings()
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const std::vector<int>& vertices = this->System.GetVertices();
  std::vector<int> lastSeen(mesh.NumberOfVertices(), -1);
  this->TwoRingOffsets.push_back(0);
  for (int row = 0; row < this->NumberOfRows(); ++row)
  {
    AddTwoRing(mesh, vertices[row], row, lastSeen, this->TwoRings);
    this->TwoRingOffsets.push_back(this->TwoRings.size());
  }
  this->TwoRingMeans.setZero(this->NumberOfRows(), 3);
  for (int row = 0; row < this->NumberOfRows(); ++row)
  {
    const std::size_t begin = this->TwoRingOffsets[row];
    const std::size_t end = this->TwoRingOffsets[row + 1];
    for (std::size_t k = begin; k < end; ++k)
    {
      this->TwoRingMeans.row(row) +=
        this->Problem.Rest->row(this->TwoRings[k]) / static_cast<double>(end - begin);
    }
  }
}

void LaplacianDeformer::EstimateRotations(
  const Points& displacements, const ExecutionContext& context)
{
  const auto readCovariance = [&](int row, const Eigen::Map<Eigen::Matrix3d>& covariance)
  {
    // Exact where nothing moves: differential coordinates next to short edges
    // would make much of the rounding of a fit.
    MatrixAt(this->Transforms, row).setIdentity();
    return RingCovariance(this->TwoRings.data() + this->TwoRingOffsets[row],
      this->TwoRings.data() + this->TwoRingOffsets[row + 1],
      this->TwoRingMeans.row(row).transpose(), *this->Problem.Rest, displacements, covariance);
  };
  const auto writeTransform = [&](int row, const Eigen::Map<Eigen::Matrix3d>& rotation)
  { MatrixAt(this->Transforms, row) = rotation; };
  context.For(this->NumberOfRows(),
    [&](int begin, int end) { ForClosestRotations(begin, end, readCovariance, writeTransform); });
}

/// L (T - I) d is what displacements have on the right where positions have L T d;
/// `displacements` (#V x 3) has the handles' and gets the unknowns', from
/// `targetsOfLocals` where those are held softly.
void LaplacianDeformer::SolveRotated(
  const Points& targetsOfLocals, Points& displacements, const ExecutionContext& context) const
{
  for (int i = 0; i < this->System.NumberOfUnknowns(); ++i)
  {
    displacements.row(this->System.GetVertices()[i]) = targetsOfLocals.row(i);
  }
  Points turned = Points::Zero(this->System.NumberOfLocals(), 3);
  context.For(this->NumberOfRows(),
    [&](int begin, int end)
    {
      for (int row = begin; row < end; ++row)
      {
        const Eigen::Vector3d differential = this->Differential.row(row);
        turned.row(row) =
          (MatrixAt(this->Transforms, row) * differential - differential).transpose();
      }
    });
  this->System.Solve(this->System.GetLaplacian() * turned, displacements);
}

void LaplacianDeformer::WarnIfUnsettled(const Eigen::VectorXd& moves, double before)
{
  const double largest = moves.maxCoeff();
  if (largest <= 0.5 * before)
  {
    return;
  }
  const double size = BoundingDiagonal(*this->Problem.Rest);
  IdSample moved;
  for (Eigen::Index i = 0; i < moves.size(); ++i)
  {
    if (moves[i] > SettledMove * size)
    {
      moved.Add(this->System.GetVertices()[i]);
    }
  }
  if (moved.IsEmpty())
  {
    return;
  }
  this->Unsettled = "The estimated rotations do not settle: the last of " +
    std::to_string(this->Rounds) + " rounds moves " + moved.Describe("point", "points") +
    " by more than 5 % of the surface's size, at most by " +
    std::to_string(std::lround(100.0 * largest / size)) +
    " %. Do not use this result. Rotation Invariant Deformation and Rotations None solve without "
    "rounds; merge pieces that belong together (Prepare Surface).";
}

void LaplacianDeformer::DeformRelative(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  const int numberOfVertices = this->Problem.Mesh->NumberOfVertices();
  const std::vector<int>& vertices = this->System.GetVertices();
  this->Transforms = Identities(this->NumberOfRows());
  result.FrameScale.setOnes(numberOfVertices);
  result.Positions = HandlePositions(this->Problem, targets, this->MovingHandles);
  Points displacements = result.Positions - *this->Problem.Rest;
  // The targets of softly held vertices, which each solve overwrites.
  const Points targetsOfLocals = this->System.Gather(displacements);
  if (this->Rotations == LaplacianRotations::Implicit)
  {
    this->FindImplicitRotations(targets, displacements, context);
  }
  this->Unsettled.clear();
  if (this->Rotations == LaplacianRotations::Implicit ||
    !this->SumHandleFields(targets, displacements, context))
  {
    this->SolveRotated(targetsOfLocals, displacements, context);
  }
  Points earlier = this->System.Gather(displacements);
  const bool isEstimated = this->Rotations == LaplacianRotations::Estimated && earlier.rows() > 0;
  const int rounds = isEstimated ? this->Rounds : 0;
  double before = isEstimated ? earlier.rowwise().norm().maxCoeff() : 0.0;
  for (int round = 0; round < rounds; ++round)
  {
    context.Report(static_cast<double>(round) / rounds);
    this->EstimateRotations(displacements, context);
    this->SolveRotated(targetsOfLocals, displacements, context);
    Points locals = this->System.Gather(displacements);
    const Eigen::VectorXd moves = (locals - earlier).rowwise().norm();
    if (round == rounds - 1)
    {
      this->WarnIfUnsettled(moves, before);
    }
    before = moves.maxCoeff();
    earlier.swap(locals);
  }
  for (int i = 0; i < this->System.NumberOfUnknowns(); ++i)
  {
    result.Positions.row(vertices[i]) =
      this->Problem.Rest->row(vertices[i]) + displacements.row(vertices[i]);
  }
  if (wantTransforms)
  {
    result.Transforms = Identities(numberOfVertices);
    for (int row = 0; row < this->NumberOfRows(); ++row)
    {
      result.Transforms.row(vertices[row]) = this->Transforms.row(row);
    }
  }
  context.Report(1.0);
}
}
