// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/MultiresolutionDeformer.h"

#include "Algebra/ClosestRotations.h"
#include "Differential/RotationFit.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// The direction of the sum of a ring's area vectors, or zero where that is rounding beside
/// the squared lengths of its edges.
Eigen::Vector3d NormalOf(const Eigen::Vector3d& areaVector, double squaredEdges)
{
  const double length = areaVector.norm();
  return length > 1e-12 * squaredEdges ? Eigen::Vector3d(areaVector / length)
                                       : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// The unit normal of one vertex, as VertexNormals has it.
Eigen::Vector3d RingNormal(const TriangleMesh& mesh, const Points& points, int v)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squaredEdges = 0.0;
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const Eigen::Vector3d edge = points.row(mesh.Neighbor(d)) - points.row(v);
    squaredEdges += edge.squaredNorm();
    if (mesh.LeftTriangle(d) >= 0)
    {
      const Eigen::Vector3d next = points.row(mesh.Opposite(d)) - points.row(v);
      sum += edge.cross(next);
    }
  }
  return NormalOf(sum, squaredEdges);
}

/// The radius of a one-ring across its narrower direction: in a round ring, where
/// half of the squared edges is along each direction, that of the ring.
double RingRadius(const TriangleMesh& mesh, const Points& points, int v)
{
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const Eigen::RowVector3d edge = points.row(mesh.Neighbor(d)) - points.row(v);
    covariance += edge.transpose() * edge;
  }
  const int valence = mesh.RingEnd(v) - mesh.RingBegin(v);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spectrum;
  spectrum.computeDirect(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(2.0 * std::max(0.0, spectrum.eigenvalues()[1]) / std::max(1, valence));
}

/// The matrix whose closest rotation FitRotations has at one vertex, at no cost for the others;
/// false where the displacements are all the same. `normal` is that of the reference.
bool FrameCovariance(const TriangleMesh& mesh, const Points& reference,
  const Eigen::RowVector3d& normal, const Points& displacements, int v,
  Eigen::Map<Eigen::Matrix3d> frame)
{
  struct Edge
  {
    Eigen::Vector3d Before;
    Eigen::Vector3d Change;
    Eigen::Vector3d After;
  };
  const auto edgeAt = [&](int d)
  {
    const int w = mesh.Neighbor(d);
    Edge edge;
    edge.Before = reference.row(w) - reference.row(v);
    edge.Change = displacements.row(w) - displacements.row(v);
    edge.After = edge.Before + edge.Change;
    return edge;
  };
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Eigen::Vector3d areaVector = Eigen::Vector3d::Zero();
  double size = 0.0;
  double squaredEdges = 0.0;
  bool isStill = true;
  const int begin = mesh.RingBegin(v);
  const int end = mesh.RingEnd(v);
  const Edge first = begin < end ? edgeAt(begin) : Edge();
  Edge edge = first;
  for (int d = begin; d < end; ++d)
  {
    covariance += edge.After * edge.Before.transpose();
    const double squaredAfter = edge.After.squaredNorm();
    size += std::sqrt(edge.Before.squaredNorm() * squaredAfter);
    squaredEdges += squaredAfter;
    isStill = isStill && edge.Change.isZero(0.0);
    // Nearly always the next one in the list, which each triangle shares with the loop.
    const Edge following = d + 1 < end ? edgeAt(d + 1) : first;
    const int next = mesh.NextAround(v, d);
    if (next >= 0)
    {
      const bool isFollowing = next == (d + 1 < end ? d + 1 : begin);
      areaVector += edge.After.cross(isFollowing ? following.After : edgeAt(next).After);
    }
    edge = following;
  }
  if (isStill || !(size > 0.0))
  {
    return false;
  }
  // The edges of a flat ring leave the rotation to rounding; the normal settles it.
  covariance += size * NormalOf(areaVector, squaredEdges) * normal;
  frame = covariance / size;
  return true;
}
}

MultiresolutionDeformer::MultiresolutionDeformer(
  HandleProblem problem, int order, SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(RequirePositions(std::move(problem), "Multiresolution editing"))
  , System(this->Problem, order, backend, context.Part(0.0, 0.8))
  , Spreading(backend)
  , Warning(System.GetWarning())
  , MovingHandles(MovingHandleOfVertices(this->Problem))
  , Zero(Points::Zero(this->System.NumberOfLocals(), 3))
  , StoresFields(StoresHandleFields(this->Problem))
  , RestBase(Points::Zero(this->Problem.Rest->rows(), 3))
{
  // K (x + w) = 0 with handles at rest.
  this->System.Solve(-this->System.Apply(this->System.Gather(*this->Problem.Rest)), this->RestBase);
  this->RestBase += *this->Problem.Rest;
  this->PrepareSpreading(context.Part(0.8, 1.0));
  // Frames of held vertices are needed to spread from alone.
  this->RestNormals.resize(
    this->NumberOfSpread ? this->System.NumberWithin(1) : this->System.NumberOfUnknowns(), 3);
  for (Eigen::Index i = 0; i < this->RestNormals.rows(); ++i)
  {
    this->RestNormals.row(i) =
      RingNormal(*this->Problem.Mesh, this->RestBase, this->System.GetVertices()[i]).transpose();
  }
  context.Report(1.0);
}

/// Finds the vertices whose rings in the base are too small for their details, and
/// makes the system of the functions on them that are harmonic on the graph.
void MultiresolutionDeformer::PrepareSpreading(const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const Points& rest = *this->Problem.Rest;
  const std::vector<int>& vertices = this->System.GetVertices();
  const int numberOfLocals = this->System.NumberWithin(1);
  Anchors anchors = Anchors::After(0, numberOfLocals);
  // Next to nothing, which decides only where no other frame is around.
  anchors.Stiffness = Eigen::VectorXd::Constant(numberOfLocals, 1e-8);
  IdSample collapsed;
  for (int i = 0; i < this->System.NumberOfUnknowns(); ++i)
  {
    const int v = vertices[i];
    const double detail = (rest.row(v) - this->RestBase.row(v)).norm();
    const double radius = RingRadius(mesh, this->RestBase, v);
    if (detail > LongestDetail * radius)
    {
      anchors.IsHard[i] = 0;
      ++this->NumberOfSpread;
      if (radius < SmallestRing * RingRadius(mesh, rest, v))
      {
        collapsed.Add(v);
      }
    }
  }
  if (this->NumberOfSpread == 0)
  {
    return;
  }
  if (!collapsed.IsEmpty())
  {
    this->Warning += (this->Warning.empty() ? "" : " ") +
      ("The smooth base has collapsed at " + collapsed.Describe("point", "points") +
        ": it is smaller than a tenth of the surface there, as that of limbs without handles is. "
        "Their details turn with the base around them. Mark handles there, or use a method without "
        "a base, such as Rotation Invariant Deformation.");
  }
  anchors.Vertices.assign(vertices.begin(), vertices.begin() + numberOfLocals);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges());
  const SparseMatrix graph = Laplacian(mesh, ones, anchors.Vertices);
  this->Spreading.Factorize(graph, anchors, context);
}

/// Handle k relative to the middle of what the system sees of it and all others at the
/// origin, then handle k all in one place.
void MultiresolutionDeformer::ComputeBaseFields()
{
  const Points& rest = *this->Problem.Rest;
  const auto count = static_cast<Eigen::Index>(this->Problem.Moving.size());
  this->HandleCenters.setZero(count, 3);
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(count);
  for (const int v : this->System.GetVertices())
  {
    if (const int k = this->MovingHandles[v]; k >= 0)
    {
      this->HandleCenters.row(k) += rest.row(v);
      sizes[k] += 1.0;
    }
  }
  this->HandleCenters.array().colwise() /= sizes.cwiseMax(1.0).array();
  Field fields = Field::Zero(this->System.NumberOfLocals(), 4 * count);
  for (int i = 0; i < this->System.NumberOfLocals(); ++i)
  {
    const int v = this->System.GetVertices()[i];
    if (const int k = this->MovingHandles[v]; k >= 0)
    {
      Eigen::RowVector4d target;
      target << rest.row(v) - this->HandleCenters.row(k), 1.0;
      fields.block<1, 4>(i, 4 * k) = target;
    }
  }
  this->System.Interpolate(fields);
  this->BaseFields = fields.topRows(this->System.NumberOfUnknowns());
}

/// `displacements` (#V x 3) has those of handles, and gets those of the unknowns.
void MultiresolutionDeformer::MoveBase(
  const HandleTargets& targets, Points& displacements, const ExecutionContext& context)
{
  if (targets.IsPerVertex() || !this->StoresFields)
  {
    this->System.Solve(this->Zero, displacements);
    return;
  }
  if (this->BaseFields.rows() == 0)
  {
    this->ComputeBaseFields();
  }
  // A_k - I and t_k, one below the other, as the fields are side by side.
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> motions(this->BaseFields.cols(), 3);
  for (Eigen::Index k = 0; k < this->HandleCenters.rows(); ++k)
  {
    const HandleMotion& motion = targets.Motions[static_cast<std::size_t>(k)];
    const Eigen::Matrix3d change = motion.Linear - Eigen::Matrix3d::Identity();
    motions.middleRows<3>(4 * k) = change.transpose();
    motions.row(4 * k + 3) =
      (change * this->HandleCenters.row(k).transpose() + motion.Translation).transpose();
  }
  const std::vector<int>& vertices = this->System.GetVertices();
  context.For(this->System.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        displacements.row(vertices[i]) = this->BaseFields.row(i).lazyProduct(motions);
      }
    });
}

/// The base's local frame turns as its one-ring and normal do.
void MultiresolutionDeformer::FitFrames(
  const Points& displacements, const ExecutionContext& context)
{
  const int numberOfFrames = static_cast<int>(this->RestNormals.rows());
  const std::vector<int>& vertices = this->System.GetVertices();
  this->Changes.resize(numberOfFrames, 9);
  const auto readFrame = [&](int i, const Eigen::Map<Eigen::Matrix3d>& frame)
  {
    MatrixAt(this->Changes, i).setZero();
    return FrameCovariance(*this->Problem.Mesh, this->RestBase, this->RestNormals.row(i),
      displacements, vertices[i], frame);
  };
  const auto writeChange = [&](int i, const Eigen::Map<Eigen::Matrix3d>& rotation)
  { MatrixAt(this->Changes, i) = rotation - Eigen::Matrix3d::Identity(); };
  context.For(numberOfFrames,
    [&](int begin, int end) { ForClosestRotations(begin, end, readFrame, writeChange); });
  if (this->NumberOfSpread == 0)
  {
    return;
  }
  this->Spreading.Interpolate(this->Changes);
  const std::vector<int>& spread = this->Spreading.GetFree();
  ForClosestRotations(
    0, static_cast<int>(spread.size()),
    [&](int k, Eigen::Map<Eigen::Matrix3d> frame)
    {
      frame = Eigen::Matrix3d::Identity() + MatrixAt(this->Changes, spread[k]);
      return !MatrixAt(this->Changes, spread[k]).isZero(0.0);
    },
    [&](int k, const Eigen::Map<Eigen::Matrix3d>& rotation) { writeChange(spread[k], rotation); });
}

void MultiresolutionDeformer::DeformRelative(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  const Points& rest = *this->Problem.Rest;
  result.Positions = HandlePositions(this->Problem, targets, this->MovingHandles);
  result.FrameScale.setOnes(rest.rows());
  Points displacements = result.Positions - rest;
  this->MoveBase(targets, displacements, context);
  context.Report(0.5);
  if (wantTransforms)
  {
    const Points base = this->RestBase + displacements;
    result.Transforms = FitRotations(*this->Problem.Mesh, this->RestBase, base, context);
  }
  this->FitFrames(displacements, context);
  const std::vector<int>& vertices = this->System.GetVertices();
  context.For(this->System.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const int v = vertices[i];
        const Eigen::Vector3d detail = (rest.row(v) - this->RestBase.row(v)).transpose();
        result.Positions.row(v) =
          rest.row(v) + displacements.row(v) + (MatrixAt(this->Changes, i) * detail).transpose();
      }
    });
  context.Report(1.0);
}
}
