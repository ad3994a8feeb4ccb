// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Differential/DiscreteForms.h"
#include "Differential/RotationAveraging.h"
#include "Morph/FrameMemory.h"
#include "Morph/KeyInterpolation.h"
#include "Morph/SurfaceMorph.h"

namespace cartan
{
/// Interpolates between key frames by their discrete forms (Lipman et al.,
/// Linear Rotation-invariant Coordinates for Meshes, 2005, section 4.1): the
/// projected lengths, angles and heights of all one-rings are interpolated;
/// then the frames are computed that fit the transitions between neighbors
/// best, and the positions that fit the one-rings in these frames best. Bends
/// and twists may have any number of full turns, because neighboring one-rings
/// turn only a little relative to each other.
///
/// The interpolated transitions do not fit together exactly. The frames of the
/// paper's linear system shrink with the distance from the given one, so all
/// solvers here end with rotations.
class DiscreteFormsMorph : public SurfaceMorph
{
public:
  enum class Transitions
  {
    /// C exp(t log(C^T D)) between the transitions C and D of two key frames:
    /// the turn from frame to frame at an even rate. With more key frames the
    /// logarithms from their mean go through KeyInterpolation.
    Rotations,
    /// Those that the interpolated forms determine (Theorem 3.1): the paper's.
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

  /// Factorizes the graph Laplacian. Throws Error(BadInput) where a vertex of a
  /// key frame has no normal.
  explicit DiscreteFormsMorph(const KeyFrames& keys,
    Transitions transitions = Transitions::Rotations,
    FrameSolver solver = FrameSolver::RotationAveraging, const ExecutionContext& context = {});

  /// Throws Error(BadInput) far outside of the key frames, where a length is
  /// negative.
  Points Evaluate(double t, const ExecutionContext& context) override;

  int GetNumberOfIterations() const override { return this->Iterations; }
  std::string GetWarning() const override { return this->Warning; }
  std::size_t GetBytes() const override;

private:
  DiscreteForms FormsAt(double t, const ExecutionContext& context) const;
  /// One per edge, in the direction of Directed: #edges x 9.
  Matrices EdgeTransitionsAt(
    double t, const DiscreteForms& forms, const ExecutionContext& context) const;
  Matrices FramesAt(double t, const Matrices& edgeTransitions, const ExecutionContext& context);
  bool Average(const Matrices& edgeTransitions, Matrices& frames, const ExecutionContext& context);

  std::shared_ptr<const TriangleMesh> Mesh;
  std::vector<double> Parameters; // of the key frames
  Transitions Method;
  FrameSolver Solver;
  KeyInterpolation Forms;    // rows: lengths, angles, heights of all directed edges
  Matrices MeanTransitions;  // #edges x 9, of Transitions::Rotations
  KeyInterpolation FromMean; // 3 #edges rows, rotation vectors
  std::vector<int> Directed; // #edges, the directed edge of each
  std::shared_ptr<ConstrainedSolver> Laplacian;
  std::unique_ptr<RotationAveraging> Averaging;
  ConstrainedSolver FrameSystem; // of FrameSolver::Direct
  FrameMemory Known;
  int Iterations = 0;
  std::string Warning;
};
}
