// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Morph/DiscreteFormsMorph.h"
#include "Morph/KeyInterpolation.h"
#include "Morph/SurfaceMorph.h"

namespace cartan
{
/// Interpolates between key frames by their pyramid coordinates (Sheffer and Kraevoy,
/// Pyramid Coordinates for Morphing and Deformation, 2004; Sorkine, Differential
/// Representations for Mesh Processing, 2006, section 4.3): each one-ring is
/// projected on the plane normal to the mean of its triangles' normals, and the lengths
/// of the projected edges, the angles between them and the heights over the
/// plane are interpolated. The surface is the one whose one-rings are closest to these,
///
///   min over x of sum_i min over R_i sum_{j around i} w_ij |x_j - x_i - R_i p_ij|^2,
///
/// p_ij the edge i -> j by its coordinates and R_i a rotation. This is nonlinear and knows
/// of no transitions between neighbors: a reference for the linear methods. Rotations
/// and positions are found in turn, each turn lowering the sum, with Anderson
/// acceleration, from what DiscreteFormsMorph finds. w_ij = 1 / l_ij as there, so that
/// splitting an edge changes nothing.
///
/// In the paper the plane of a ring is made from its positions and each vertex has a place over its
/// neighbors' plane by mean value coordinates, which leave lengths open where the surface
/// is flat. Here the whole ring is fitted.
///
/// An edge that is nearly parallel to the normal has no direction in the plane. Angles go
/// the shorter way from key frame to key frame, which may be the wrong one for such edges;
/// where a ring then winds about its normal otherwise than before, its angles are changed
/// evenly to make it close.
class PyramidCoordinatesMorph : public SurfaceMorph
{
public:
  /// Factorizes the graph Laplacian twice. Throws Error(BadInput) where a point has no
  /// normal, and what DiscreteFormsMorph throws.
  explicit PyramidCoordinatesMorph(const KeyFrames& keys, const ExecutionContext& context = {});

  /// Throws Error(BadInput) far outside of the key frames, where a length is negative.
  Points Evaluate(const MorphPlace& place, const ExecutionContext& context) override;

  int GetNumberOfIterations() const override { return this->Iterations; }

  /// Where the iteration was ended by the largest number of iterations, and where edges of the
  /// last surface are off the length between those of the key frames by more than a quarter.
  std::string GetWarning() const override { return this->Warning; }
  std::size_t GetBytes() const override;

private:
  void InterpolateCoordinates(const KeyFrames& keys, const ExecutionContext& context);
  void FindWeights(const KeyFrames& keys);
  /// The edges by their coordinates, in frames of the one-rings: #D x 3.
  Points RingsAt(const MorphPlace& place, const ExecutionContext& context) const;
  /// The rotations that fit best, from those of `frames` (#V x 9), and the sum.
  double FitFrames(const Points& positions, const Points& rings, Matrices& frames,
    const ExecutionContext& context) const;
  Points Improve(Points positions, const Points& rings, double t, const ExecutionContext& context);
  void WarnOfLengths(double t, const Points& rings, const Points& positions);

  std::shared_ptr<const TriangleMesh> Mesh;
  DiscreteFormsMorph Start;
  KeyInterpolation KeyLengths; // #D, of projected edges
  KeyInterpolation KeyAngles;  // #D, to the next projected edge
  KeyInterpolation KeyHeights; // #D
  Eigen::VectorXd Weights;     // #D
  double MeanEdge = 0.0;
  AnchoredSystem Laplacian;
  int Iterations = 0;
  std::string Warning;
};
}
