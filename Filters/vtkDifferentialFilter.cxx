// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDifferentialFilter.h"

#include "Kernel/Differential/DifferentialCoordinates.h"

using cartan::DeltaNormalization;
using cartan::LaplacianWeights;

static_assert(static_cast<int>(LaplacianWeights::Uniform) == vtkDifferentialFilter::UNIFORM &&
    static_cast<int>(LaplacianWeights::Cotangent) == vtkDifferentialFilter::COTANGENT &&
    static_cast<int>(LaplacianWeights::MeanValue) == vtkDifferentialFilter::MEAN_VALUE &&
    static_cast<int>(DeltaNormalization::Row) == vtkDifferentialFilter::ROW &&
    static_cast<int>(DeltaNormalization::Integrated) == vtkDifferentialFilter::INTEGRATED &&
    static_cast<int>(DeltaNormalization::Area) == vtkDifferentialFilter::AREA,
  "the enumerations agree");

void vtkDifferentialFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "LaplacianWeights: " << this->LaplacianWeights << "\n";
  os << indent << "Normalization: " << this->Normalization << "\n";
  os << indent << "DifferentialCoordinatesArrayName: " << this->DifferentialCoordinatesArrayName
     << "\n";
}
