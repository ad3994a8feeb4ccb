// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Deformation/HandleLaplacian.h"

namespace cartan
{
/// The triangles of all poses between and beyond examples (Sumner, Zwicker, Gotsman,
/// Popovic, Mesh-based Inverse Kinematics, 2005, section 3). With weights w_k the triangle
/// t of the rest pose, whose frame is F, becomes
///
///   T_t(w) = F exp(sum_k w_k v_k) (C + sum_k w_k (C_k - C)),
///
/// where v_k and C_k are the rotation vector and the stretched corners of example k
/// (TriangleFeatures), and C are the corners at rest. w = 0 is the rest pose, a unit vector
/// an example. Of a triangle only its edges matter; the edge e is opposite to corner e.
class ExampleSpan
{
public:
  /// Of the triangles around the unknowns of a problem; `examples` are #V x 3 each. Throws
  /// what FeaturesOf throws.
  ExampleSpan(const HandleProblem& problem, std::vector<HandleLaplacian::Triangle> triangles,
    const std::vector<Points>& examples);

  int NumberOfExamples() const { return this->Count; }
  const std::vector<HandleLaplacian::Triangle>& GetTriangles() const { return this->Triangles; }

  /// Finds the edges for the weights.
  void Evaluate(const Eigen::VectorXd& weights, const ExecutionContext& context);

  /// The edges of a triangle as columns, and the rotation that it has turned by.
  auto Edges(Eigen::Index triangle) const { return MatrixAt(this->Turned, triangle); }
  Eigen::Matrix3d Rotation(Eigen::Index triangle) const;

  /// What the edges change by with weight k.
  Eigen::Matrix3d Derivative(Eigen::Index triangle, int k) const;

  /// sum over edges of r_e . d(edge e) / d(w_k), for all k, added to `sum`; the columns of
  /// `residual` are r_e.
  void AddProducts(
    Eigen::Index triangle, const Eigen::Matrix3d& residual, Eigen::VectorXd& sum) const;

  std::size_t GetBytes() const
  {
    return TotalBytes(this->Triangles, this->Frames, this->RestEdges, this->Features, this->Vectors,
      this->Rotations, this->Stretched, this->Turned);
  }

private:
  int Count = 0;
  std::vector<HandleLaplacian::Triangle> Triangles;
  Matrices Frames;
  Matrices RestEdges; // in the frames
  Field Features;     // a row per triangle, for each example 3 of v_k, 9 of the edges of C_k - C
  Points Vectors;     // the rest is for the last weights: sum_k w_k v_k
  Matrices Rotations; // its exponential
  Matrices Stretched; // edges before the rotation
  Matrices Turned;    // and after all
};
}
