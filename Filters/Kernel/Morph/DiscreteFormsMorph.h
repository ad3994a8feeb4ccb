// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Differential/RotationAveraging.h"
#include "Morph/FrameMemory.h"
#include "Morph/KeyInterpolation.h"
#include "Morph/SurfaceMorph.h"

#include <array>

namespace cartan
{
/// Interpolates between key frames by their discrete forms (Lipman et al.,
/// Linear Rotation-invariant Coordinates for Meshes, 2005, section 4.1): the
/// shapes of all one-rings are interpolated; then the frames are computed that
/// fit the transitions between neighbors best, and the positions that fit the
/// one-rings in these frames best. Bends and twists may have any number of full
/// turns, because neighboring one-rings turn only a little relative to each other.
///
/// It differs from the paper in three points, without which coarse meshes with
/// thin triangles are distorted.
///
/// - The forms describe a one-ring relative to its normal by projected lengths,
///   angles between projections, and heights. Between two surfaces an edge that is
///   nearly parallel to the normal may pass it on either side, and so its angle
///   and all that follow may gain a full turn. Here the edges are interpolated as
///   vectors in frames that follow the one-rings (RingFrames), and scaled to the
///   interpolated lengths.
/// - Terms of an edge of length l in both systems weigh 1 / l, as a bar's stiffness
///   does: the systems do not change when an edge is split in two, and errors of
///   long edges do not spoil short ones.
/// - The interpolated transitions do not fit together exactly. The frames of the
///   paper's linear system shrink with the distance from the given one, so all
///   solvers here end with rotations.
class DiscreteFormsMorph : public SurfaceMorph
{
public:
  enum class Transitions
  {
    /// C exp(t log(C^T D)) between the transitions C and D of two key frames:
    /// the turn from frame to frame at an even rate. With more key frames the
    /// logarithms from their mean go through KeyInterpolation.
    Rotations,
    /// Those that the interpolated one-rings determine, as in the paper (Theorem
    /// 3.1), by Procrustes.
    Forms
  };

  enum class FrameSolver
  {
    /// Rotations that fit best (RotationAveraging), found from those at the
    /// nearest parameter known, with a scalar factorization made once.
    RotationAveraging,
    /// The paper's 3 #V x 3 #V linear system by conjugate gradients from the
    /// result of RotationAveraging, projected on rotations.
    ConjugateGradients,
    /// The same by a factorization for each parameter, projected on rotations.
    Direct
  };

  /// Factorizes the graph Laplacian. Throws Error(BadInput) for what
  /// KeyInterpolation refuses.
  explicit DiscreteFormsMorph(const KeyFrames& keys,
    Transitions transitions = Transitions::Rotations,
    FrameSolver solver = FrameSolver::RotationAveraging, const ExecutionContext& context = {});

  /// Throws Error(BadInput) far outside of the key frames, where a length is
  /// negative.
  Points Evaluate(const MorphPlace& place, const ExecutionContext& context) override;

  int GetNumberOfIterations() const override { return this->Iterations; }

  /// Where the frames did not converge, and where edges of the last surface are
  /// off the length between those of the key frames by more than a quarter.
  std::string GetWarning() const override { return this->Warning; }
  std::size_t GetBytes() const override;

private:
  std::array<int, 2> EdgeVertices(int edge) const
  {
    const int d = this->Directed[edge];
    return { this->Mesh->Origin(d), this->Mesh->Neighbor(d) };
  }
  void InterpolateLengths(const KeyFrames& keys);
  void SetUpAveraging(const ExecutionContext& context);
  void InterpolateRings(const KeyFrames& keys, const std::vector<Matrices>& frames);
  void InterpolateTransitions(const std::vector<Matrices>& frames);
  Eigen::VectorXd LengthsAt(const MorphPlace& place, const ExecutionContext& context) const;
  /// The edges in the frames of their origins: #D x 3.
  Points RingsAt(
    const MorphPlace& place, const Eigen::VectorXd& lengths, const ExecutionContext& context) const;
  /// One per edge, in the direction of Directed: #E x 9.
  Matrices EdgeTransitionsAt(
    const MorphPlace& place, const Points& rings, const ExecutionContext& context) const;
  Matrices FramesAt(
    const MorphPlace& place, const Matrices& edgeTransitions, const ExecutionContext& context);
  bool Average(const Matrices& edgeTransitions, Matrices& frames, const ExecutionContext& context);
  Matrices LinearFrames(Matrices edgeTransitions, Matrices frames, const ExecutionContext& context);
  void WarnOfLengths(double t, const Eigen::VectorXd& lengths, const Points& positions);

  std::shared_ptr<const TriangleMesh> Mesh;
  std::vector<double> Parameters; // of the key frames
  Transitions Method;
  FrameSolver Solver;
  std::vector<int> Directed;   // #E, a directed edge of each
  Eigen::VectorXd Weights;     // #D
  KeyInterpolation KeyLengths; // #E
  KeyInterpolation KeyRings;   // 3 #D, the edges in the frames of their origins
  Matrices MeanTransitions;    // #E x 9, of Transitions::Rotations
  KeyInterpolation FromMean;   // 3 #E, rotation vectors
  std::shared_ptr<AnchoredSystem> Laplacian;
  std::unique_ptr<RotationAveraging> Averaging;
  AnchoredSystem FrameSystem; // of FrameSolver::Direct
  FrameMemory Known;
  int Iterations = 0;
  std::string Warning;
};
}
