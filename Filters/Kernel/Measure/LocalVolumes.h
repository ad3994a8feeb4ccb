// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Base/Bytes.h"
#include "Base/ExecutionContext.h"
#include "Differential/PieceSystem.h"
#include "Measure/SurfaceComponents.h"
#include "Mesh/TriangleMesh.h"

#include <memory>
#include <vector>

namespace cartan
{
/// Local volumes with what the digits of coordinates leave open.
struct MeasuredVolumes
{
  Eigen::VectorXd Values; ///< #V
  /// By how much one may be off for the rounding of coordinates, in parts of the largest of
  /// these and of the reference: next to nothing unless a surface is stretched so much that the
  /// products of long edges cancel. The same on all ranks.
  double Rounding = 0.0;
};

/// Volumes that are off by more than this are mostly noise.
constexpr double LargestVolumeRounding = 1e-5;

/// The part of the enclosed volume that lies under each vertex, in the spirit
/// of Lipman et al., Volume and Shape Preservation via Moving Frame
/// Manipulation, 2007, section 4 (volume below a surface element in the
/// direction of the inward normal), but so that the parts of a closed component
/// sum to its volume exactly, whatever the shape.
///
/// Tetrahedra between the triangles and the centroid have that property too,
/// but are not local: bending one end of a bar moves the centroid and changes
/// them all. So each point p_i gets its own center c_i, and a vertex a third of
/// each adjacent prism between triangle (p_i) and (c_i). By Stokes' theorem
///
///   Volume = sum over triangles of  int_0^1 a(s) . d ds  +  Volume(c),
///
/// with d the mean of p_i - c_i and a(s) the area vector of c_i + s (p_i - c_i),
/// quadratic in s, so that Simpson's rule is exact. The little that the c_i
/// still enclose, Volume(c), is spread evenly over the component's area.
///
/// The centers of the reference are the surface after one implicit smoothing
/// step, (M + tau L) c = M p, with tau = (6 volume / area)^2. That is (3 r)^2 in
/// a tube of radius r, where it leaves a tenth of the distance from the axis; in
/// a ball the result is all but the centroid. The current centers c' keep the
/// differences of the reference's, turned with the surface:
///
///   (M + tau L) c' = M (p' - R (p - c)) + tau b,
///   b_i = sum over triangles t and their edges at i of  w_t,ij R_t (c_i - c_j),
///
/// with the mean R_t of the FitRotations at the corners of t: one for all edges of a triangle,
/// so that the large weights of both signs cancel which a triangle without height has. Without
/// b smoothing would cut the corner of every bend. Where a
/// part of the surface moves rigidly, its local volumes stay what they are but
/// for the change of Volume(c).
class LocalVolumes
{
public:
  /// Factorizes M / tau + L once for all current surfaces. Of a surface in pieces (`pieces`, may
  /// be nothing) all functions but GetReference() and GetBytes() are collective, the system is
  /// solved by conjugate gradients, and rows are right at vertices with all of their triangles.
  LocalVolumes(std::shared_ptr<const TriangleMesh> mesh, const Points& reference,
    const ExecutionContext& context = {}, std::shared_ptr<const DistributedRows> pieces = nullptr);

  /// The local volumes of the reference in cubed length units; 0 at unused
  /// vertices, NaN in components that enclose nothing (open ones, and those
  /// without volume). Negative where the surface faces its own center: #V.
  const Eigen::VectorXd& GetReference() const { return this->Reference; }

  /// The same for the current surface.
  MeasuredVolumes Measure(const Points& current, const ExecutionContext& context = {}) const;

  /// Without the mesh, which others hold too.
  std::size_t GetBytes() const
  {
    return this->System.GetBytes() + this->Parts.GetBytes() +
      (this->OnPieces ? this->OnPieces->GetBytes() : 0) +
      TotalBytes(
        this->Positions, this->EnclosesVolume, this->CornerWeight, this->Centers, this->Reference);
  }

private:
  void Factorize(
    const Points& reference, const std::vector<double>& steps, const ExecutionContext& context);
  void Solve(Field& centers, const Field& rightHandSide, const ExecutionContext& context) const;
  Eigen::VectorXd Sum(const Points& points, const Points& centers) const;
  double RoundingOf(
    const Eigen::VectorXd& volumes, const Points& points, const Points& centers) const;

  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const DistributedRows> Pieces;
  SurfaceComponents Parts;
  Points Positions;
  std::vector<char> EnclosesVolume;      // #components
  Points CornerWeight;                   // #T x 3
  AnchoredSystem System;                 // M / tau + L
  std::unique_ptr<PieceSystem> OnPieces; // the same of pieces
  std::vector<int> Unknowns;             // of pieces
  Eigen::VectorXd Stiffness;             // M / tau of these
  Points Centers;
  Eigen::VectorXd Reference;
};
}
