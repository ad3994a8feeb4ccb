// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/SurfaceDeformer.h"

#include <algorithm>

namespace cartan
{
bool SurfaceDeformer::Serves(const HandleProblem& problem) const
{
  const HandleProblem& own = this->Problem;
  return own.Mesh == problem.Mesh && own.Rest == problem.Rest && own.Weights == problem.Weights &&
    own.PositionWeights == problem.PositionWeights && own.ClampWeights == problem.ClampWeights &&
    own.ConstrainPositions == problem.ConstrainPositions && own.Handle == problem.Handle &&
    own.SoftWeights.size() == problem.SoftWeights.size() &&
    own.SoftWeights == problem.SoftWeights &&
    // A handle that may move need not; but without held positions it would be
    // solved for where it is pinned otherwise.
    (own.ConstrainPositions ? std::includes(own.Moving.begin(), own.Moving.end(),
                                problem.Moving.begin(), problem.Moving.end())
                            : own.Moving == problem.Moving);
}
}
