// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/HarmonicBlend.h"

namespace cartan
{
HarmonicBlend::HarmonicBlend(
  const HandleProblem& problem, std::shared_ptr<const HandleLaplacian> system)
  : System(std::move(system))
  , Stores(StoresHandleFields(problem))
{
  if (this->Stores)
  {
    this->Weights = this->System->HarmonicFields();
  }
}

Field HarmonicBlend::Blend(const Field& ofHandles, const ExecutionContext& context) const
{
  const int components = static_cast<int>(ofHandles.cols());
  if (!this->Stores)
  {
    return this->System->Spread(
      components,
      [&](int local, double* values)
      {
        Eigen::Map<Eigen::RowVectorXd>(values, components) =
          ofHandles.row(this->System->MovingHandle(local));
      },
      context);
  }
  Field blend(this->Weights.rows(), components);
  context.For(static_cast<int>(blend.rows()),
    [&](int begin, int end)
    {
      blend.middleRows(begin, end - begin) =
        this->Weights.middleRows(begin, end - begin).lazyProduct(ofHandles);
    });
  return blend;
}
}
