// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SymmetricSolver.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace cartan
{
class DifferentialReconstruction;

/// The points of a surface as whole numbers (Sorkine, Cohen-Or, Toledo, High-pass
/// Quantization for Mesh Encoding, 2003; Sorkine, Differential Representations for Mesh
/// Processing, 2006, section 3.2). The differential coordinates L_s v of uniform weights
/// are rounded, not the positions: the error of the decoded surface is smooth, and a
/// smooth error of a given size is much less visible than a rough one. Anchors, which are
/// positions, keep it small.
///
/// All numbers are relative to the longest side of the bounding box, in which anchors are
/// given with AnchorBits.
struct HighPassCode
{
  static constexpr int AnchorBits = 18;

  int Bits = 0;             ///< of a differential coordinate, 1 to 16
  Eigen::Vector3d Corner;   ///< of the bounding box
  double Side = 0.0;        ///< its longest one
  double Low = 0.0;         ///< the smallest differential coordinate over Side
  double Range = 0.0;       ///< the largest minus the smallest over Side
  std::vector<int> Anchors; ///< vertices, increasing, at least one per component
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>
    AnchorPositions; ///< #anchors x 3, in [0, 2^AnchorBits)
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>
    Deltas; ///< #V x 3, in [0, 2^Bits); of used vertices, 0 for others

  /// The bits per vertex that an ideal code of order 0 needs: the entropy of each
  /// coordinate's numbers, and the anchors' positions as they are.
  double BitsPerVertex(const TriangleMesh& mesh) const;
};

/// The lengths in which codes are given, so that several may share them.
struct HighPassScale
{
  double Side = 0.0; ///< the longest side of the bounding box
  double Low = 0.0;  ///< the smallest differential coordinate
  double High = 0.0; ///< the largest

  /// The smallest scale that is enough for both.
  HighPassScale Joined(const HighPassScale& other) const;
};

/// Makes and decodes codes of a connectivity: one factorization serves all precisions and
/// all surfaces of it.
class HighPassCoder
{
public:
  /// Chooses `numberOfAnchors` of the points, spread over the surface, at least one per
  /// component. Throws Error(BadInput) for more than there are.
  HighPassCoder(std::shared_ptr<const TriangleMesh> mesh, const Points& points, int numberOfAnchors,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});

  /// With the anchors of a code, to decode it.
  HighPassCoder(std::shared_ptr<const TriangleMesh> mesh, std::vector<int> anchors,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});

  HighPassCode Encode(const Points& points, int bits) const
  {
    return this->Encode(points, bits, this->ScaleOf(points));
  }

  /// In a scale of several surfaces, this one among them.
  HighPassCode Encode(const Points& points, int bits, const HighPassScale& scale) const;
  HighPassScale ScaleOf(const Points& points) const;

  /// Vertices in no triangle get the corner of the box.
  Points Decode(const HighPassCode& code, const ExecutionContext& context = {}) const;

  int NumberOfAnchors() const { return static_cast<int>(this->AnchorVertices.size()); }
  std::size_t GetBytes() const;

private:
  Eigen::AlignedBox3d BoxOf(const Points& points) const;
  void Factorize(SolverBackend backend, const ExecutionContext& context);

  std::shared_ptr<const TriangleMesh> Mesh;
  std::vector<int> AnchorVertices;
  std::shared_ptr<const DifferentialReconstruction> Reconstruction;
};

/// How visible the difference of two surfaces is at each vertex (Karni and Gotsman,
/// Spectral Compression of Mesh Geometry, 2000):
///
///   alpha |v - v'| + (1 - alpha) |S(v) - S(v')|,
///   S(v)_i = v_i - sum_j v_j / l_ij / sum_j 1 / l_ij
///
/// with the lengths l of edges, each surface with its own. #V, in length units; its sign
/// says whether the vertex moved outwards (+) or inwards of the first surface.
Eigen::VectorXd VisualError(const TriangleMesh& mesh, const Points& original, const Points& decoded,
  double alpha, const ExecutionContext& context = {});
}
