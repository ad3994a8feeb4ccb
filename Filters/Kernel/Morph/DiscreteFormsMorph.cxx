// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/DiscreteFormsMorph.h"

#include "Algebra/Rotation.h"
#include "Base/Constants.h"
#include "Differential/FrameReconstruction.h"
#include "Differential/Laplacian.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{

/// Chooses the branches of `angles` (#D, radians) so that they follow
/// `previous`: each differs from it by half a turn at most, and their sum around
/// each inner vertex is the same, without which the ring would not close in
/// between.
void FollowAngles(
  const TriangleMesh& mesh, const Eigen::VectorXd& previous, Eigen::VectorXd& angles)
{
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    double sum = 0.0;
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      angles[d] = previous[d] + std::remainder(angles[d] - previous[d], FullTurn);
      sum += angles[d] - previous[d];
    }
    if (mesh.IsBoundary(v))
    {
      continue;
    }
    // Whole turns too many go where a half turn leaves the direction open.
    for (int excess = static_cast<int>(std::lround(sum / FullTurn)); excess != 0;)
    {
      const int sign = excess > 0 ? 1 : -1;
      int widest = mesh.RingBegin(v);
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        if (sign * (angles[d] - previous[d]) > sign * (angles[widest] - previous[widest]))
        {
          widest = d;
        }
      }
      angles[widest] -= sign * FullTurn;
      excess -= sign;
    }
  }
}
}

DiscreteFormsMorph::DiscreteFormsMorph(const KeyFrames& keys, Transitions transitions,
  FrameSolver solver, const ExecutionContext& context)
  : Mesh(keys.Mesh)
  , Parameters(keys.Parameters)
  , Method(transitions)
  , Solver(solver)
  , Laplacian(std::make_shared<ConstrainedSolver>())
{
  const TriangleMesh& mesh = *this->Mesh;
  const int numberOfKeys = static_cast<int>(keys.Positions.size());
  const int directedEdges = mesh.NumberOfDirectedEdges();

  this->Laplacian->Factorize(cartan::Laplacian(mesh, Eigen::VectorXd::Ones(directedEdges)),
    mesh.Grounded(), {}, {}, context.Part(0.0, 0.3));

  std::vector<RotationAveraging::Edge> edges;
  edges.reserve(mesh.NumberOfEdges());
  for (int d = 0; d < directedEdges; ++d)
  {
    if (d < mesh.Twin(d))
    {
      edges.push_back({ mesh.Origin(d), mesh.Neighbor(d) });
      this->Directed.push_back(d);
    }
  }
  const auto numberOfEdges = static_cast<Eigen::Index>(edges.size());
  this->Averaging =
    std::make_unique<RotationAveraging>(mesh.NumberOfVertices(), std::move(edges), this->Laplacian);

  Field forms(3 * directedEdges, numberOfKeys);
  std::vector<Matrices> edgeTransitions;
  Eigen::VectorXd previousAngles;
  for (int k = 0; k < numberOfKeys; ++k)
  {
    const ExecutionContext part =
      context.Part(0.3 + 0.6 * k / numberOfKeys, 0.3 + 0.6 * (k + 1.0) / numberOfKeys);
    const Points& positions = keys.Positions[k];
    const Matrices frames = VertexFrames(mesh, positions, part);
    DiscreteForms form = ComputeDiscreteForms(mesh, positions, frames, part);
    // Where no triangle follows there is no angle.
    form.Angle = form.Angle.array().isNaN().select(0.0, form.Angle);
    if (k > 0)
    {
      FollowAngles(mesh, previousAngles, form.Angle);
    }
    previousAngles = form.Angle;
    forms.col(k) << form.Length, form.Angle, form.Height;
    if (this->Method == Transitions::Rotations)
    {
      Matrices ofEdges(numberOfEdges, 9);
      for (Eigen::Index e = 0; e < numberOfEdges; ++e)
      {
        const int d = this->Directed[e];
        MatrixAt(ofEdges, e) =
          MatrixAt(frames, mesh.Origin(d)).transpose() * MatrixAt(frames, mesh.Neighbor(d));
      }
      edgeTransitions.push_back(std::move(ofEdges));
    }
    this->Known.AddKey(this->Parameters[k], frames);
    part.Report(1.0);
  }
  this->Forms = KeyInterpolation(this->Parameters, std::move(forms));
  if (this->Method == Transitions::Rotations)
  {
    // From the mean, so that no key frame counts more than another.
    this->MeanTransitions = Matrices::Zero(numberOfEdges, 9);
    for (const Matrices& ofEdges : edgeTransitions)
    {
      this->MeanTransitions += ofEdges;
    }
    Field fromMean(3 * numberOfEdges, numberOfKeys);
    for (Eigen::Index e = 0; e < numberOfEdges; ++e)
    {
      auto mean = MatrixAt(this->MeanTransitions, e);
      mean = ProjectOnRotations(Eigen::Matrix3d(mean));
      for (int k = 0; k < numberOfKeys; ++k)
      {
        fromMean.block<3, 1>(3 * e, k) =
          VectorFromRotation(mean.transpose() * MatrixAt(edgeTransitions[k], e));
      }
    }
    this->FromMean = KeyInterpolation(this->Parameters, std::move(fromMean));
  }
}

std::size_t DiscreteFormsMorph::GetBytes() const
{
  return this->Forms.GetBytes() + this->FromMean.GetBytes() + this->Averaging->GetBytes() +
    this->FrameSystem.GetBytes() + this->Known.GetBytes() +
    TotalBytes(this->Parameters, this->MeanTransitions, this->Directed);
}

DiscreteForms DiscreteFormsMorph::FormsAt(double t, const ExecutionContext& context) const
{
  const Eigen::VectorXd values = this->Forms.Evaluate(t, context);
  const Eigen::Index directedEdges = this->Mesh->NumberOfDirectedEdges();
  DiscreteForms forms;
  forms.Length = values.head(directedEdges);
  forms.Angle = values.segment(directedEdges, directedEdges);
  forms.Height = values.tail(directedEdges);
  IdSample negative;
  for (int d = 0; d < directedEdges; ++d)
  {
    if (forms.Length[d] < 0.0)
    {
      negative.Add(this->Mesh->Origin(d));
    }
  }
  if (!negative.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "At the parameter " + std::to_string(t) +
        " edges of negative length would be needed around " + negative.Describe("point", "points") +
        ": choose a parameter nearer to those of the key frames.");
  }
  return forms;
}

Matrices DiscreteFormsMorph::EdgeTransitionsAt(
  double t, const DiscreteForms& forms, const ExecutionContext& context) const
{
  const int numberOfEdges = static_cast<int>(this->Directed.size());
  Matrices result(numberOfEdges, 9);
  if (this->Method == Transitions::Forms)
  {
    const cartan::Transitions all =
      TransitionsFromForms(*this->Mesh, forms, TransitionMethod::Procrustes, context);
    for (int e = 0; e < numberOfEdges; ++e)
    {
      result.row(e) = all.row(this->Directed[e]);
    }
    return result;
  }
  const Eigen::VectorXd vectors = this->FromMean.Evaluate(t, context);
  context.For(numberOfEdges,
    [&](int begin, int end)
    {
      for (int e = begin; e < end; ++e)
      {
        MatrixAt(result, e) = MatrixAt(this->MeanTransitions, e) *
          RotationFromVector(vectors.segment<3>(3 * static_cast<Eigen::Index>(e)));
      }
    });
  return result;
}

bool DiscreteFormsMorph::Average(
  const Matrices& edgeTransitions, Matrices& frames, const ExecutionContext& context)
{
  const RotationAveraging::Result result =
    this->Averaging->Improve(edgeTransitions, frames, context);
  this->Iterations += result.Steps;
  // What nobody sees is not worth another start.
  return result.LastTurn < 1e-4;
}

Matrices DiscreteFormsMorph::FramesAt(
  double t, const Matrices& edgeTransitions, const ExecutionContext& context)
{
  // From the nearest parameter whose frames are known, and where that is too far,
  // by way of parameters in between.
  constexpr int parts = 8;
  const FrameMemory::Known start = this->Known.Nearest(t);
  Matrices frames = start.Frames;
  bool isConverged = this->Average(edgeTransitions, frames, context);
  if (!isConverged)
  {
    frames = start.Frames;
    for (int part = 1; part < parts; ++part)
    {
      const double between = start.Parameter + (t - start.Parameter) * part / parts;
      this->Average(this->EdgeTransitionsAt(between, this->FormsAt(between, context), context),
        frames, context);
    }
    isConverged = this->Average(edgeTransitions, frames, context);
  }
  if (!isConverged)
  {
    this->Warning = "The frames at the parameter " + std::to_string(t) +
      " are not the best: their improvement did not end. The key frames are far from each other; "
      "add one in between.";
  }
  return frames;
}

Points DiscreteFormsMorph::Evaluate(double t, const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Mesh;
  this->Iterations = 0;
  this->Warning.clear();
  const DiscreteForms forms = this->FormsAt(t, context);
  const Points ring = RingCoordinates(mesh, forms);
  const Matrices edgeTransitions = this->EdgeTransitionsAt(t, forms, context);
  Matrices frames = this->FramesAt(t, edgeTransitions, context.Part(0.1, 0.7));

  this->Known.SetLast(t, frames);

  if (this->Solver != FrameSolver::RotationAveraging)
  {
    cartan::Transitions transitions(mesh.NumberOfDirectedEdges(), 9);
    for (std::size_t e = 0; e < this->Directed.size(); ++e)
    {
      const int d = this->Directed[e];
      const Eigen::Matrix3d forward = MatrixAt(edgeTransitions, static_cast<Eigen::Index>(e));
      MatrixAt(transitions, d) = forward;
      MatrixAt(transitions, mesh.Twin(d)) = forward.transpose();
    }
    frames = this->Solver == FrameSolver::Direct
      ? SolveFrames(
          mesh, transitions, mesh.Grounded(), std::move(frames), this->FrameSystem, context)
      : SolveFramesFrom(mesh, transitions, mesh.Grounded(), std::move(frames), *this->Laplacian,
          &this->Iterations, context);
    context.For(mesh.NumberOfVertices(),
      [&](int begin, int end)
      {
        for (int v = begin; v < end; ++v)
        {
          MatrixAt(frames, v) = ProjectOnRotations(Eigen::Matrix3d(MatrixAt(frames, v)));
        }
      });
  }
  Field positions = Field::Zero(mesh.NumberOfVertices(), 3);
  this->Laplacian->Solve(PositionRightHandSide(mesh, frames, ring, context), positions);
  context.Report(1.0);
  return positions;
}
}
