// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/TriangleGradientMorph.h"

#include "Algebra/Rotation.h"
#include "Differential/Laplacian.h"
#include "Differential/TriangleFeatures.h"

#include <array>

namespace cartan
{
TriangleGradientMorph::TriangleGradientMorph(const KeyFrames& keys, const ExecutionContext& context)
  : Mesh(keys.Mesh)
{
  const TriangleMesh& mesh = *this->Mesh;
  const int numberOfKeys = static_cast<int>(keys.Positions.size());
  const Eigen::Index numberOfTriangles = mesh.NumberOfTriangles();
  const Matrices rest = TriangleCorners(mesh, keys.Positions[0]);
  this->Frames = TriangleFrames(mesh, rest);
  Field vectors = Field::Zero(3 * numberOfTriangles, numberOfKeys);
  Field corners(9 * numberOfTriangles, numberOfKeys);
  // The mean over the key frames, so that none counts more than another.
  Points weights = Points::Zero(numberOfTriangles, 3);
  for (int k = 0; k < numberOfKeys; ++k)
  {
    const Points& positions = keys.Positions[k];
    weights += CornerWeights(mesh, positions, LaplacianWeights::Cotangent, context) / numberOfKeys;
    TriangleFeatures features;
    if (k > 0)
    {
      features = FeaturesOf(mesh, rest, this->Frames, positions, MeanRotation::OfComponents);
      vectors.col(k) =
        Eigen::Map<const Eigen::VectorXd>(features.Vectors.data(), features.Vectors.size());
    }
    else
    {
      features.Corners = InFrames(this->Frames, rest);
    }
    const Matrices& local = features.Corners;
    corners.col(k) = Eigen::Map<const Eigen::VectorXd>(local.data(), local.size());
    context.Report((k + 1.0) / (numberOfKeys + 1.0));
  }
  this->RotationVectors = KeyInterpolation(keys.Parameters, std::move(vectors), 3);
  this->Corners = KeyInterpolation(keys.Parameters, std::move(corners), 3);
  this->Stitching = TriangleStitching(mesh.GetTriangles(), std::move(weights), mesh.Grounded(),
    context.Part(numberOfKeys / (numberOfKeys + 1.0), 1.0));
}

Points TriangleGradientMorph::Evaluate(const MorphPlace& place, const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Mesh;
  const auto verticesOf = [&mesh](int f)
  {
    const Triangles& triangles = mesh.GetTriangles();
    return std::array{ triangles(f, 0), triangles(f, 1), triangles(f, 2) };
  };
  const Eigen::VectorXd vectors =
    place.Sample(this->RotationVectors, mesh.NumberOfTriangles(), verticesOf, context);
  const Eigen::VectorXd local =
    place.Sample(this->Corners, mesh.NumberOfTriangles(), verticesOf, context);
  Matrices corners(mesh.NumberOfTriangles(), 9);
  context.For(mesh.NumberOfTriangles(),
    [&](int begin, int end)
    {
      for (int f = begin; f < end; ++f)
      {
        const auto row = static_cast<Eigen::Index>(f);
        MatrixAt(corners, f) = MatrixAt(this->Frames, f) *
          RotationFromVector(vectors.segment<3>(3 * row)) *
          Eigen::Map<const Eigen::Matrix3d>(local.data() + 9 * row);
      }
    });
  context.Report(0.5);
  Points positions = Points::Zero(mesh.NumberOfVertices(), 3);
  this->Stitching.Stitch(corners, positions);
  context.Report(1.0);
  return positions;
}
}
