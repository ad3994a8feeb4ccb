// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morph/KeyInterpolation.h"

namespace cartan
{
/// Where a surface is between its key frames: at one parameter; with a parameter for each
/// vertex, so that parts arrive at different times (Alexa, Differential coordinates for local
/// mesh morphing and deformation, The Visual Computer 19, 2003); or at weights of the key frames,
/// a blend shape.
class MorphPlace
{
public:
  /// Everywhere at t.
  MorphPlace(double t)
    : Parameter(t)
  {
  }

  /// A parameter for each vertex (#V); `mean` is one for what belongs to all of them.
  static MorphPlace Local(Eigen::VectorXd parameters, double mean);

  /// Weights of the key frames (#keys), which sum to 1. `keyParameters` are theirs.
  static MorphPlace Blend(Eigen::VectorXd weights, const std::vector<double>& keyParameters);

  bool IsUniform() const { return !this->IsLocal() && !this->IsBlend(); }
  bool IsLocal() const { return this->Parameters.size() > 0; }
  bool IsBlend() const { return this->Weights.size() > 0; }

  /// The parameter; the mean one; that of the key frame with the largest weight.
  double GetParameter() const { return this->Parameter; }
  const Eigen::VectorXd& GetParameters() const { return this->Parameters; }
  const Eigen::VectorXd& GetWeights() const { return this->Weights; }

  /// `part` of `parts` of the way from the key frame at `start` to here.
  MorphPlace From(double start, int part, int parts) const;

  /// The numbers of `items` here, `values` having as many rows for each: an item is at the
  /// mean parameter of its vertices, the container verticesOf(item).
  template <typename VerticesOf>
  Eigen::VectorXd Sample(const KeyInterpolation& values, int items, const VerticesOf& verticesOf,
    const ExecutionContext& context) const
  {
    if (this->IsBlend())
    {
      return values.Blend(this->Weights);
    }
    if (!this->IsLocal())
    {
      return values.Evaluate(this->Parameter, context);
    }
    Eigen::VectorXd parameters(items);
    context.For(items,
      [&](int begin, int end)
      {
        for (int item = begin; item < end; ++item)
        {
          double sum = 0.0;
          int count = 0;
          for (const int v : verticesOf(item))
          {
            sum += this->Parameters[v];
            ++count;
          }
          parameters[item] = sum / count;
        }
      });
    return values.EvaluateEach(parameters, context);
  }

private:
  double Parameter;
  Eigen::VectorXd Parameters;
  Eigen::VectorXd Weights;
  std::vector<double> KeyParameters;
};
}
