// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/VolumetricDeformer.h"

#include "Base/FloodFill.h"
#include "Deformation/HandleLaplacian.h"
#include "Deformation/MotionBlend.h"
#include "Deformation/PolyharmonicSystem.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// Neighbors that span less than this do not tell a gradient.
constexpr double FlatNeighborhood = 1e-4;

/// A round changes sizes at most so much, as far as any sound bend needs.
constexpr double LargestStep = 1.5;
}

VolumetricDeformer::VolumetricDeformer(
  HandleProblem problem, VolumeGraph graph, SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(RequirePositions(std::move(problem), "Volumetric deformation"))
  , Graph(std::move(graph))
  , MovingHandles(MovingHandleOfVertices(this->Problem))
  , System(RequireDirect(backend, "Volumetric deformation"))
{
  // Joined vertices are one node, the one that stands for them.
  for (Eigen::Index i = 0; i < this->Graph.Edges.size() && !this->Problem.JoinedWith.empty(); ++i)
  {
    int& node = this->Graph.Edges.data()[i];
    node = node < static_cast<int>(this->Problem.JoinedWith.size()) ? this->Problem.JoinedWith[node]
                                                                    : node;
  }
  this->FindUnknowns();
  const Anchors anchors = this->MakeAnchors();
  this->System.Factorize(
    GraphLaplacian(this->Graph.NumberOfNodes(), this->Graph.Edges, this->Graph.Weights), anchors,
    context);
  RequireTranslations(this->System, anchors);
  this->Displacements = Points::Zero(this->Graph.NumberOfNodes(), 3);
}

void VolumetricDeformer::FindUnknowns()
{
  const int vertices = static_cast<int>(this->Problem.Handle.size());
  const int size = this->Graph.NumberOfNodes();
  std::vector<std::vector<int>> neighbors(size);
  for (Eigen::Index e = 0; e < this->Graph.Edges.rows(); ++e)
  {
    neighbors[this->Graph.Edges(e, 0)].push_back(this->Graph.Edges(e, 1));
    neighbors[this->Graph.Edges(e, 1)].push_back(this->Graph.Edges(e, 0));
  }
  std::vector<char> isHeld(size, 0);
  std::vector<int> seeds;
  for (int v = 0; v < vertices; ++v)
  {
    isHeld[v] = this->Problem.Handle[v] > 0 &&
      (this->Problem.SoftWeights.size() == 0 || std::isinf(this->Problem.SoftWeights[v]));
    if (this->MovingHandles[v] >= 0 && !neighbors[v].empty())
    {
      seeds.push_back(v);
    }
  }
  this->IsReached.assign(size, 0);
  FloodFill(
    seeds,
    [&](int i)
    {
      const bool enters =
        !this->IsReached[i] && (!isHeld[i] || (i < vertices && this->MovingHandles[i] >= 0));
      this->IsReached[i] = this->IsReached[i] || enters;
      return enters;
    },
    [&](int i, const auto& reach)
    { std::for_each(neighbors[i].begin(), neighbors[i].end(), reach); });
  this->IsFree.assign(size, 0);
  for (int i = 0; i < size; ++i)
  {
    this->IsFree[i] = this->IsReached[i] && !isHeld[i];
  }
}

Anchors VolumetricDeformer::MakeAnchors() const
{
  Anchors anchors;
  for (int i = 0; i < this->Graph.NumberOfNodes(); ++i)
  {
    anchors.IsHard.push_back(!this->IsFree[i]);
    anchors.Vertices.push_back(i < this->Problem.Mesh->NumberOfVertices() ? i : -1);
  }
  const std::vector<char> isFreeVertex(
    this->IsFree.begin(), this->IsFree.begin() + this->Problem.Mesh->NumberOfVertices());
  // The graph's Laplacian stands for both directions of each edge.
  const Eigen::VectorXd soft =
    0.5 * SquaredSoftWeights(this->Problem, isFreeVertex, Hold::AllHandles);
  if (!soft.isZero(0.0))
  {
    anchors.Stiffness = Eigen::VectorXd::Zero(this->Graph.NumberOfNodes());
    anchors.Stiffness.head(soft.size()) = soft;
  }
  return anchors;
}

int VolumetricDeformer::GetNumberOfFreeVertices() const
{
  return static_cast<int>(std::count(this->IsFree.begin(),
    this->IsFree.begin() + this->Problem.Mesh->NumberOfVertices(), static_cast<char>(1)));
}

/// The handles' maps at the nodes: #N x #columns.
Field VolumetricDeformer::SpreadBlends(const Field& ofHandles) const
{
  Field blends = Field::Zero(this->Graph.NumberOfNodes(), ofHandles.cols());
  for (std::size_t v = 0; v < this->MovingHandles.size(); ++v)
  {
    if (this->MovingHandles[v] >= 0 && this->IsReached[v])
    {
      blends.row(static_cast<Eigen::Index>(v)) = ofHandles.row(this->MovingHandles[v]);
    }
  }
  this->System.Interpolate(blends);
  return blends;
}

/// L u = sum_j w_ij (T_ij - I) (p_i - p_j) for the displacements u; `targets` (#N x 3) has
/// those of anchors.
void VolumetricDeformer::SolvePositions(const Field& blends, const Eigen::VectorXd& scales,
  const Points& targets, const ExecutionContext& context)
{
  const auto count = static_cast<int>(this->Graph.Edges.rows());
  Points changes(count, 3);
  context.For(count,
    [&](int begin, int end)
    {
      for (int e = begin; e < end; ++e)
      {
        const int i = this->Graph.Edges(e, 0);
        const int j = this->Graph.Edges(e, 1);
        const Eigen::Vector3d edge = (this->Graph.Nodes.row(i) - this->Graph.Nodes.row(j));
        const Eigen::Matrix3d map =
          MotionBlend::FromCoordinates(0.5 * (blends.row(i) + blends.row(j)));
        changes.row(e) =
          this->Graph.Weights[e] * (0.5 * (scales[i] + scales[j]) * map * edge - edge).transpose();
      }
    });
  Field rightHandSide = Field::Zero(this->Graph.NumberOfNodes(), 3);
  for (Eigen::Index e = 0; e < this->Graph.Edges.rows(); ++e)
  {
    rightHandSide.row(this->Graph.Edges(e, 0)) += changes.row(e);
    rightHandSide.row(this->Graph.Edges(e, 1)) -= changes.row(e);
  }
  Field values = targets;
  this->System.Solve(rightHandSide, values);
  this->Displacements = values;
}

/// F_i = (sum_j w_ij d_ij e_ij^T) (sum_j w_ij e_ij e_ij^T)^-1 for edges e_ij that became
/// d_ij.
void VolumetricDeformer::RestoreVolume(
  const Field& blends, Eigen::VectorXd& scales, const ExecutionContext& context) const
{
  Matrices moments = Matrices::Zero(this->Graph.NumberOfNodes(), 9);
  Matrices changes = Matrices::Zero(this->Graph.NumberOfNodes(), 9);
  for (Eigen::Index e = 0; e < this->Graph.Edges.rows(); ++e)
  {
    const int i = this->Graph.Edges(e, 0);
    const int j = this->Graph.Edges(e, 1);
    const double weight = std::max(0.0, this->Graph.Weights[e]);
    const Eigen::Vector3d before = (this->Graph.Nodes.row(i) - this->Graph.Nodes.row(j));
    const Eigen::Vector3d change = (this->Displacements.row(i) - this->Displacements.row(j));
    const Eigen::Matrix3d moment = weight * before * before.transpose();
    const Eigen::Matrix3d product = weight * change * before.transpose();
    MatrixAt(moments, i) += moment;
    MatrixAt(moments, j) += moment;
    MatrixAt(changes, i) += product;
    MatrixAt(changes, j) += product;
  }
  context.For(this->Graph.NumberOfNodes(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const auto moment = MatrixAt(moments, i);
        if (!this->IsFree[i] ||
          !(moment.determinant() > FlatNeighborhood * std::pow(moment.trace() / 3.0, 3)))
        {
          continue;
        }
        const Eigen::Matrix3d gradient =
          Eigen::Matrix3d::Identity() + MatrixAt(changes, i) * moment.inverse();
        const double before = MotionBlend::FromCoordinates(blends.row(i)).determinant();
        const double ratio = before / gradient.determinant();
        if (ratio > 0.0)
        {
          scales[i] *= std::min(std::max(std::cbrt(ratio), 1.0 / LargestStep), LargestStep);
        }
      }
    });
}

void VolumetricDeformer::RequireMotions(const HandleTargets& targets)
{
  cartan::RequireMotions(targets, "Volumetric deformation");
}

void VolumetricDeformer::DeformRelative(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  RequireMotions(targets);
  const Points& rest = *this->Problem.Rest;
  const Eigen::Index vertices = rest.rows();
  const Field blends = this->SpreadBlends(MotionBlend(targets.Motions).Coordinates());
  context.Report(0.3);
  Points goals = Points::Zero(this->Graph.NumberOfNodes(), 3);
  goals.topRows(vertices) = HandlePositions(this->Problem, targets, this->MovingHandles) - rest;
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(this->Graph.NumberOfNodes());
  this->SolvePositions(blends, scales, goals, context);
  for (int round = 0; round < this->VolumeRounds; ++round)
  {
    context.Report(0.4 + 0.6 * round / this->VolumeRounds);
    this->RestoreVolume(blends, scales, context);
    this->SolvePositions(blends, scales, goals, context);
  }
  result.FrameScale.setOnes(vertices);
  result.Positions = rest + this->Displacements.topRows(vertices);
  this->CarryInside(result);
  if (wantTransforms)
  {
    result.Transforms.resize(vertices, 9);
    for (Eigen::Index v = 0; v < vertices; ++v)
    {
      MatrixAt(result.Transforms, v) = MotionBlend::FromCoordinates(blends.row(v));
    }
  }
  context.Report(1.0);
}

/// Walls of cavities that the graph alone joins to handles are not of the surfaces that
/// the common motion is given back to.
void VolumetricDeformer::CarryInside(DeformedSurface& result) const
{
  const RigidMotion& common = this->GetCommonMotion();
  const std::vector<char> isUnknown = UnknownVertices(this->Problem, Hold::AllHandles);
  for (std::size_t v = 0; v < isUnknown.size(); ++v)
  {
    if (this->IsFree[v] && !isUnknown[v])
    {
      const auto row = static_cast<Eigen::Index>(v);
      result.Positions.row(row) =
        (common.Rotation * result.Positions.row(row).transpose() + common.Translation).transpose();
    }
  }
}

Points VolumetricDeformer::NodesAfter(const DeformedSurface& result) const
{
  const RigidMotion& common = this->GetCommonMotion();
  Points nodes = this->Graph.Nodes + this->Displacements;
  for (int i = 0; i < this->Graph.NumberOfNodes(); ++i)
  {
    if (this->IsReached[i])
    {
      nodes.row(i) = (common.Rotation * nodes.row(i).transpose() + common.Translation).transpose();
    }
  }
  nodes.topRows(result.Positions.rows()) = result.Positions;
  return nodes;
}
}
