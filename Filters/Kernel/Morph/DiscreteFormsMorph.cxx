// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/DiscreteFormsMorph.h"

#include "Algebra/Rotation.h"
#include "Differential/DiscreteForms.h"
#include "Differential/FrameReconstruction.h"
#include "Differential/Laplacian.h"
#include "Morph/LengthErrors.h"
#include "Morph/RingFrames.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
DiscreteFormsMorph::DiscreteFormsMorph(const KeyFrames& keys, Transitions transitions,
  FrameSolver solver, const ExecutionContext& context)
  : Mesh(keys.Mesh)
  , Parameters(keys.Parameters)
  , Method(transitions)
  , Solver(solver)
  , Laplacian(std::make_shared<AnchoredSystem>())
  , FrameSystem(SolverBackend::Automatic, FrameLimits())
{
  for (int d = 0; d < this->Mesh->NumberOfDirectedEdges(); ++d)
  {
    if (d < this->Mesh->Twin(d))
    {
      this->Directed.push_back(d);
    }
  }
  this->InterpolateLengths(keys);
  this->SetUpAveraging(context.Part(0.0, 0.4));
  std::vector<Matrices> frames = RingFrames(*this->Mesh, keys.Positions, context.Part(0.4, 0.7));
  this->InterpolateRings(keys, frames);
  context.Report(0.8);
  if (this->Method == Transitions::Rotations)
  {
    this->InterpolateTransitions(frames);
  }
  for (std::size_t k = 0; k < frames.size(); ++k)
  {
    this->Known.AddKey(this->Parameters[k], std::move(frames[k]));
  }
  context.Report(1.0);
}

void DiscreteFormsMorph::InterpolateLengths(const KeyFrames& keys)
{
  // With weights that are much larger than the others the systems lose digits.
  constexpr double negligible = 1e-4;
  const TriangleMesh& mesh = *this->Mesh;
  const auto numberOfEdges = static_cast<Eigen::Index>(this->Directed.size());
  Field lengths(numberOfEdges, static_cast<Eigen::Index>(keys.Positions.size()));
  for (Eigen::Index k = 0; k < lengths.cols(); ++k)
  {
    const Points& positions = keys.Positions[k];
    for (Eigen::Index e = 0; e < numberOfEdges; ++e)
    {
      const int d = this->Directed[e];
      lengths(e, k) = (positions.row(mesh.Neighbor(d)) - positions.row(mesh.Origin(d))).norm();
    }
  }
  const Eigen::VectorXd means = lengths.rowwise().mean();
  const double shortest = negligible * means.mean();
  this->Weights = Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges());
  for (Eigen::Index e = 0; e < numberOfEdges && shortest > 0.0; ++e)
  {
    // Relative to the mean, so that the unit of length does not matter.
    const int d = this->Directed[e];
    this->Weights[d] = this->Weights[mesh.Twin(d)] =
      shortest / negligible / std::max(means[e], shortest);
  }
  this->KeyLengths = KeyInterpolation(this->Parameters, std::move(lengths));
}

void DiscreteFormsMorph::SetUpAveraging(const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Mesh;
  this->Laplacian->Factorize(
    cartan::Laplacian(mesh, this->Weights), Anchors::Hard(mesh.Grounded()), context);
  std::vector<RotationAveraging::Edge> edges;
  edges.reserve(this->Directed.size());
  for (const int d : this->Directed)
  {
    edges.push_back({ mesh.Origin(d), mesh.Neighbor(d), this->Weights[d] });
  }
  this->Averaging =
    std::make_unique<RotationAveraging>(mesh.NumberOfVertices(), std::move(edges), this->Laplacian);
}

void DiscreteFormsMorph::InterpolateRings(
  const KeyFrames& keys, const std::vector<Matrices>& frames)
{
  const TriangleMesh& mesh = *this->Mesh;
  Field rings(3 * static_cast<Eigen::Index>(mesh.NumberOfDirectedEdges()),
    static_cast<Eigen::Index>(frames.size()));
  for (Eigen::Index k = 0; k < rings.cols(); ++k)
  {
    const Points& positions = keys.Positions[k];
    for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
    {
      const int v = mesh.Origin(d);
      rings.block<3, 1>(3 * static_cast<Eigen::Index>(d), k) = MatrixAt(frames[k], v).transpose() *
        (positions.row(mesh.Neighbor(d)) - positions.row(v)).transpose();
    }
  }
  this->KeyRings = KeyInterpolation(this->Parameters, std::move(rings), 3);
}

void DiscreteFormsMorph::InterpolateTransitions(const std::vector<Matrices>& frames)
{
  const TriangleMesh& mesh = *this->Mesh;
  const auto numberOfEdges = static_cast<Eigen::Index>(this->Directed.size());
  Field fromMean(3 * numberOfEdges, static_cast<Eigen::Index>(frames.size()));
  this->MeanTransitions.resize(numberOfEdges, 9);
  for (Eigen::Index e = 0; e < numberOfEdges; ++e)
  {
    const int i = mesh.Origin(this->Directed[e]);
    const int j = mesh.Neighbor(this->Directed[e]);
    // From the mean, so that no key frame counts more than another.
    Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
    for (const Matrices& ofKey : frames)
    {
      mean += MatrixAt(ofKey, i).transpose() * MatrixAt(ofKey, j);
    }
    mean = ProjectOnRotations(mean);
    MatrixAt(this->MeanTransitions, e) = mean;
    for (Eigen::Index k = 0; k < fromMean.cols(); ++k)
    {
      fromMean.block<3, 1>(3 * e, k) = VectorFromRotation(
        mean.transpose() * MatrixAt(frames[k], i).transpose() * MatrixAt(frames[k], j));
    }
  }
  this->FromMean = KeyInterpolation(this->Parameters, std::move(fromMean), 3);
}

std::size_t DiscreteFormsMorph::GetBytes() const
{
  return this->KeyLengths.GetBytes() + this->KeyRings.GetBytes() + this->FromMean.GetBytes() +
    this->Averaging->GetBytes() + this->FrameSystem.GetBytes() + this->Known.GetBytes() +
    TotalBytes(this->Parameters, this->MeanTransitions, this->Directed, this->Weights);
}

Eigen::VectorXd DiscreteFormsMorph::LengthsAt(
  const MorphPlace& place, const ExecutionContext& context) const
{
  Eigen::VectorXd lengths = place.Sample(
    this->KeyLengths, static_cast<int>(this->Directed.size()),
    [this](int e) { return this->EdgeVertices(e); }, context);
  IdSample negative;
  for (Eigen::Index e = 0; e < lengths.size(); ++e)
  {
    if (lengths[e] < 0.0)
    {
      negative.Add(this->Mesh->Origin(this->Directed[e]));
    }
  }
  if (!negative.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "At the parameter " + std::to_string(place.GetParameter()) +
        " edges of negative length would be needed around " + negative.Describe("point", "points") +
        ": choose a parameter nearer to those of the key frames.");
  }
  return lengths;
}

Points DiscreteFormsMorph::RingsAt(
  const MorphPlace& place, const Eigen::VectorXd& lengths, const ExecutionContext& context) const
{
  // A ring is at the parameter of its center.
  const Eigen::VectorXd values = place.Sample(
    this->KeyRings, this->Mesh->NumberOfDirectedEdges(),
    [this](int d) { return std::array{ this->Mesh->Origin(d) }; }, context);
  Points rings = Eigen::Map<const Points>(values.data(), values.size() / 3, 3);
  for (std::size_t e = 0; e < this->Directed.size(); ++e)
  {
    for (const int d : { this->Directed[e], this->Mesh->Twin(this->Directed[e]) })
    {
      const double length = rings.row(d).norm();
      if (length > 0.0)
      {
        rings.row(d) *= lengths[static_cast<Eigen::Index>(e)] / length;
      }
    }
  }
  return rings;
}

Matrices DiscreteFormsMorph::EdgeTransitionsAt(
  const MorphPlace& place, const Points& rings, const ExecutionContext& context) const
{
  const int numberOfEdges = static_cast<int>(this->Directed.size());
  Matrices result(numberOfEdges, 9);
  if (this->Method == Transitions::Forms)
  {
    const cartan::Transitions all = TransitionsFromRings(*this->Mesh, rings, context);
    for (int e = 0; e < numberOfEdges; ++e)
    {
      result.row(e) = all.row(this->Directed[e]);
    }
    return result;
  }
  const Eigen::VectorXd vectors = place.Sample(
    this->FromMean, numberOfEdges, [this](int e) { return this->EdgeVertices(e); }, context);
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
  const MorphPlace& place, const Matrices& edgeTransitions, const ExecutionContext& context)
{
  // From the nearest parameter whose frames are known, and where that is too far,
  // by way of parameters in between.
  constexpr int parts = 8;
  const FrameMemory::Known start = this->Known.Nearest(place.GetParameter());
  Matrices frames = start.Frames;
  bool isConverged = this->Average(edgeTransitions, frames, context.Part(0.0, 0.1));
  if (!isConverged)
  {
    frames = start.Frames;
    for (int part = 1; part < parts; ++part)
    {
      const MorphPlace between = place.From(start.Parameter, part, parts);
      const Points rings = this->RingsAt(between, this->LengthsAt(between, context), context);
      this->Average(this->EdgeTransitionsAt(between, rings, context), frames,
        context.Part(0.1 * part, 0.1 * (part + 1)));
    }
    isConverged = this->Average(edgeTransitions, frames, context.Part(0.9, 1.0));
  }
  if (!isConverged)
  {
    this->Warning = "The frames at the parameter " + std::to_string(place.GetParameter()) +
      " are not the best: their improvement did not end. The key frames are far from each other; "
      "add one in between.";
  }
  return frames;
}

Matrices DiscreteFormsMorph::LinearFrames(
  Matrices edgeTransitions, Matrices frames, const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Mesh;
  cartan::Transitions transitions(mesh.NumberOfDirectedEdges(), 9);
  for (std::size_t e = 0; e < this->Directed.size(); ++e)
  {
    const int d = this->Directed[e];
    const Eigen::Matrix3d forward = MatrixAt(edgeTransitions, static_cast<Eigen::Index>(e));
    MatrixAt(transitions, d) = forward;
    MatrixAt(transitions, mesh.Twin(d)) = forward.transpose();
  }
  edgeTransitions.resize(0, 9);
  if (this->Solver == FrameSolver::Direct)
  {
    SparseMatrix matrix = FrameMatrix(mesh, transitions, this->Weights);
    transitions.resize(0, 9); // before the factorization takes its memory
    frames = SolveFrames(
      mesh, std::move(matrix), mesh.Grounded(), std::move(frames), this->FrameSystem, context);
  }
  else
  {
    frames = SolveFramesFrom(mesh, transitions, mesh.Grounded(), std::move(frames),
      *this->Laplacian, &this->Iterations, context, this->Weights);
  }
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        MatrixAt(frames, v) = ProjectOnRotations(Eigen::Matrix3d(MatrixAt(frames, v)));
      }
    });
  return frames;
}

void DiscreteFormsMorph::WarnOfLengths(
  double t, const Eigen::VectorXd& lengths, const Points& positions)
{
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> edges(lengths.size(), 2);
  for (Eigen::Index e = 0; e < lengths.size(); ++e)
  {
    const int d = this->Directed[e];
    edges.row(e) << this->Mesh->Origin(d), this->Mesh->Neighbor(d);
  }
  const std::string errors = DescribeLengthErrors(t, edges, lengths, positions);
  if (!errors.empty())
  {
    this->Warning += (this->Warning.empty() ? "" : " ") + errors +
      " Try the Isometric method, or add a key frame in between.";
  }
}

Points DiscreteFormsMorph::Evaluate(const MorphPlace& place, const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Mesh;
  this->Iterations = 0;
  this->Warning.clear();
  const Eigen::VectorXd lengths = this->LengthsAt(place, context);
  const Points rings = this->RingsAt(place, lengths, context);
  Matrices edgeTransitions = this->EdgeTransitionsAt(place, rings, context);
  const bool isLinear = this->Solver != FrameSolver::RotationAveraging;
  Matrices frames = this->FramesAt(place, edgeTransitions, context.Part(0.1, isLinear ? 0.4 : 0.8));
  if (isLinear)
  {
    frames =
      this->LinearFrames(std::move(edgeTransitions), std::move(frames), context.Part(0.4, 0.8));
  }
  context.Report(0.8);
  Field positions = Field::Zero(mesh.NumberOfVertices(), 3);
  this->Laplacian->Solve(
    PositionRightHandSide(mesh, frames, rings, context, this->Weights), positions);
  this->WarnOfLengths(place.GetParameter(), lengths, positions);
  context.Report(1.0);
  return positions;
}
}
