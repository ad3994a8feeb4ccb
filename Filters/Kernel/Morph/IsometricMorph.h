// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Differential/DualForest.h"
#include "Differential/Hinges.h"
#include "Differential/RotationAveraging.h"
#include "Differential/TriangleStitching.h"
#include "Morph/FrameMemory.h"
#include "Morph/KeyInterpolation.h"
#include "Morph/SurfaceMorph.h"

#include <memory>
#include <vector>

namespace cartan
{
/// The averaging of triangles' frames over hinges, whose transitions Q go from
/// the left triangle to the right one. The triangles of `isHeld` (#T) keep
/// their frames; each component needs at least one.
std::unique_ptr<RotationAveraging> HingeAveraging(const HingeTopology& topology,
  const std::vector<char>& isHeld, const ExecutionContext& context = {});

struct IsometricMorphOptions
{
  /// How to reconstruct a component whose dual graph is not a tree: its
  /// interpolated lengths and angles do not fit together exactly. If the dual
  /// graph is a tree, all methods give the same result.
  enum class Method
  {
    /// First the frames of triangles that fit all angles best, then the
    /// positions that fit the triangles in these frames best.
    Automatic,
    /// Frames from a walk over a spanning tree of the dual graph, through the
    /// hinges that turn least; then positions as above.
    TreeStitched,
    /// The paper's: triangles are placed one after the other in a walk over the
    /// spanning tree; each vertex is at the mean of the positions that its
    /// triangles give it. The paper's own mean is over all combinations of
    /// placements on the way, whose errors grow without bound on large meshes.
    TreeAverage
  };
  Method Type = Method::Automatic;

  /// Rounds of the damped Gauss-Newton method on the edge lengths, after
  /// stitching. Each costs a factorization with 3 #V unknowns.
  int LengthPolish = 0;
};

/// The isometric morph of Bose, O'Rourke, Shu, Wuhrer, Isometric Morphing of
/// Triangular Meshes, 2008. Edge lengths and the signed angles of hinges (the
/// edges between two triangles, see UnwrappedAngles) are interpolated, linearly
/// between two key frames and by monotone cubics through more, and a surface is
/// reconstructed from them. The paper interpolates normals rather than angles;
/// these do not fit to the edges in general, not even for three triangles in a
/// row, but give the same where all hinges that move are parallel, as in its
/// example.
///
/// - Where the dual graph of a component is a tree (no interior vertices, as in
///   strips and triangulated polygons), lengths and angles are just as many as
///   the shape has freedoms: they are exactly those interpolated, in linear time.
/// - Elsewhere RotationAveraging finds the frames B of the triangles, and the
///   positions minimize the sum over triangles and their edges, with cotangent
///   weights w of the mean edge lengths and the edges e laid out in the plane,
///
///     sum w |x_j - x_i - B e_ij|^2.
///
/// Reversing the key frames reverses the motion; moving one of them rigidly does
/// not change it.
class IsometricMorph : public SurfaceMorph
{
public:
  /// Triangles without area are allowed: in a key frame where a triangle has
  /// none, it takes the normal of a neighbor.
  ///
  /// Throws Error(BadInput) for what KeyInterpolation refuses, key frames of
  /// another size, coordinates that are not finite, and edges of no length, which
  /// have no direction to hinge about.
  explicit IsometricMorph(const KeyFrames& keys, const IsometricMorphOptions& options = {},
    const ExecutionContext& context = {});

  /// The surface at t, #V x 3, each component up to a rigid motion that is
  /// continuous in t; zero for unused vertices. At the parameter of a key frame
  /// it is that key frame.
  ///
  /// Angles and lengths are extrapolated beyond the first and last key frame.
  /// Lengths that break the triangle inequality give a flat triangle. Throws
  /// Error(BadInput) if a length is not positive.
  Points Evaluate(const MorphPlace& place, const ExecutionContext& context = {}) override;

  /// The edge lengths at t, which Evaluate reaches or comes close to: #E, in the
  /// order of GetEdges().
  Eigen::VectorXd Lengths(double t) const { return this->KeyLengths.Evaluate(t); }
  const Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>& GetEdges() const
  {
    return this->Topology.Edges;
  }

  /// Triangles without area in any key frame, and in how many components the
  /// interpolated lengths and angles do not fit together exactly.
  const IdSample& GetDegenerateTriangles() const { return this->Degenerate; }
  int GetNumberOfStitchedComponents() const { return this->StitchedComponents; }

  /// How many steps the frames took in the last Evaluate.
  int GetNumberOfIterations() const override { return this->FrameSteps; }
  std::string GetWarning() const override { return this->Warning; }
  std::size_t GetBytes() const override;

private:
  void Interpolate(const std::vector<Points>& keys, std::vector<double> parameters,
    const ExecutionContext& context);
  void SetUpStitching(const ExecutionContext& context);
  void Average(
    double t, const Matrices& transitions, Matrices& frames, const ExecutionContext& context);
  void Place(const Layouts& layouts, const Matrices& frames, Points& points) const;
  void Stitch(const Layouts& layouts, const Matrices& frames, Points& points) const;

  HingeTopology Topology;
  IsometricMorphOptions Options;
  KeyInterpolation KeyLengths; // a row per edge
  KeyInterpolation KeyAngles;  // a row per hinge
  IdSample Degenerate;
  DualForest Forest;
  int StitchedComponents = 0;

  // Only where something is stitched.
  std::vector<char> IsHeld;       // #V, the vertices that Stitch does not move
  std::vector<char> IsUnstitched; // vertices of components whose dual graph is a tree
  TriangleStitching Stitching;
  std::unique_ptr<RotationAveraging> Averaging;
  FrameMemory Known;
  int FrameSteps = 0;
  std::string Warning;
};
}
