// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/ExampleSpan.h"

#include "Algebra/Rotation.h"
#include "Differential/TriangleFeatures.h"

#include <cmath>

namespace cartan
{
namespace
{
/// The numbers of an example in a triangle: a rotation vector and three edges.
constexpr int FeatureSize = 12;

Eigen::Matrix3d EdgesOf(const Eigen::Ref<const Eigen::Matrix3d>& corners)
{
  Eigen::Matrix3d edges;
  for (int e = 0; e < 3; ++e)
  {
    edges.col(e) = corners.col((e + 2) % 3) - corners.col((e + 1) % 3);
  }
  return edges;
}

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v)
{
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
  return matrix;
}

/// exp(v + d) = exp(J d) exp(v) to first order in d: with the angle a = |v|,
///
///   J = I + (1 - cos a) / a^2 [v] + (a - sin a) / a^3 [v]^2.
Eigen::Matrix3d DerivativeOfRotation(const Eigen::Vector3d& v)
{
  const double a = v.norm();
  // Below, the next terms of the series are rounding.
  const bool isSmall = a < 1e-4;
  const double first = isSmall ? 0.5 : (1.0 - std::cos(a)) / (a * a);
  const double second = isSmall ? 1.0 / 6.0 : (a - std::sin(a)) / (a * a * a);
  const Eigen::Matrix3d cross = CrossMatrix(v);
  return Eigen::Matrix3d::Identity() + first * cross + second * cross * cross;
}
}

ExampleSpan::ExampleSpan(const HandleProblem& problem,
  std::vector<HandleLaplacian::Triangle> triangles, const std::vector<Points>& examples)
  : Count(static_cast<int>(examples.size()))
  , Triangles(std::move(triangles))
{
  const TriangleMesh& mesh = *problem.Mesh;
  const Matrices rest = TriangleCorners(mesh, *problem.Rest);
  const Matrices frames = TriangleFrames(mesh, rest);
  const Matrices local = InFrames(frames, rest);
  const auto count = static_cast<Eigen::Index>(this->Triangles.size());
  for (Matrices* matrices :
    { &this->Frames, &this->RestEdges, &this->Rotations, &this->Stretched, &this->Turned })
  {
    matrices->resize(count, 9);
  }
  this->Vectors.resize(count, 3);
  this->Features.resize(count, FeatureSize * this->Count);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const int t = this->Triangles[i].Id;
    this->Frames.row(i) = frames.row(t);
    MatrixAt(this->RestEdges, i) = EdgesOf(MatrixAt(local, t));
  }
  for (int k = 0; k < this->Count; ++k)
  {
    const TriangleFeatures features =
      FeaturesOf(mesh, rest, frames, examples[k], MeanRotation::OfSurface);
    for (Eigen::Index i = 0; i < count; ++i)
    {
      const int t = this->Triangles[i].Id;
      double* values = this->Features.row(i).data() + FeatureSize * k;
      Eigen::Map<Eigen::Vector3d>(values + 0) = features.Vectors.row(t);
      Eigen::Map<Eigen::Matrix3d>(values + 3) =
        EdgesOf(MatrixAt(features.Corners, t)) - MatrixAt(this->RestEdges, i);
    }
  }
}

void ExampleSpan::Evaluate(const Eigen::VectorXd& weights, const ExecutionContext& context)
{
  context.For(static_cast<int>(this->Triangles.size()),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        Eigen::Vector3d vector = Eigen::Vector3d::Zero();
        Eigen::Matrix3d edges = MatrixAt(this->RestEdges, i);
        for (int k = 0; k < this->Count; ++k)
        {
          const double* values = this->Features.row(i).data() + FeatureSize * k;
          vector += weights[k] * Eigen::Map<const Eigen::Vector3d>(values);
          edges += weights[k] * Eigen::Map<const Eigen::Matrix3d>(values + 3);
        }
        this->Vectors.row(i) = vector.transpose();
        MatrixAt(this->Rotations, i) = RotationFromVector(vector);
        MatrixAt(this->Stretched, i) = edges;
        MatrixAt(this->Turned, i) =
          MatrixAt(this->Frames, i) * MatrixAt(this->Rotations, i) * edges;
      }
    });
}

Eigen::Matrix3d ExampleSpan::Rotation(Eigen::Index triangle) const
{
  const auto frame = MatrixAt(this->Frames, triangle);
  return frame * MatrixAt(this->Rotations, triangle) * frame.transpose();
}

/// F ((J v_k) x (exp(v) e) + exp(v) e_k) for the edges e of the stretched triangle.
Eigen::Matrix3d ExampleSpan::Derivative(Eigen::Index triangle, int k) const
{
  const double* values = this->Features.row(triangle).data() + FeatureSize * k;
  const auto rotation = MatrixAt(this->Rotations, triangle);
  const Eigen::Vector3d turn = DerivativeOfRotation(this->Vectors.row(triangle).transpose()) *
    Eigen::Map<const Eigen::Vector3d>(values);
  return MatrixAt(this->Frames, triangle) *
    (CrossMatrix(turn) * rotation * MatrixAt(this->Stretched, triangle) +
      rotation * Eigen::Map<const Eigen::Matrix3d>(values + 3));
}

void ExampleSpan::AddProducts(
  Eigen::Index triangle, const Eigen::Matrix3d& residual, Eigen::VectorXd& sum) const
{
  const auto rotation = MatrixAt(this->Rotations, triangle);
  const Eigen::Matrix3d inFrame = MatrixAt(this->Frames, triangle).transpose() * residual;
  const Eigen::Matrix3d edges = rotation * MatrixAt(this->Stretched, triangle);
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (int e = 0; e < 3; ++e)
  {
    torque += edges.col(e).cross(inFrame.col(e));
  }
  Eigen::Matrix<double, FeatureSize, 1> factors;
  factors.head<3>() =
    DerivativeOfRotation(this->Vectors.row(triangle).transpose()).transpose() * torque;
  Eigen::Map<Eigen::Matrix3d>(factors.data() + 3) = rotation.transpose() * inFrame;
  for (int k = 0; k < this->Count; ++k)
  {
    sum[k] += factors.dot(Eigen::Map<const Eigen::Matrix<double, FeatureSize, 1>>(
      this->Features.row(triangle).data() + FeatureSize * k));
  }
}
}
