// SPDX-License-Identifier: BSD-3-Clause
#include "Spectral/SpectralField.h"

#include <numeric>

namespace cartan
{
SpectralField::SpectralField(const LaplacianSpectrum& spectrum, const Field& values)
  : Mean(spectrum.Mass.transpose() * values / spectrum.Mass.sum())
  , Offsets((spectrum.Mass.array() > 0.0).cast<double>().matrix().asDiagonal() *
      (values.rowwise() - this->Mean))
  , OffsetCoefficients(spectrum.Coefficients(this->Offsets))
  , Coefficients(this->OffsetCoefficients +
      spectrum.Coefficients(Field(this->Mean.replicate(values.rows(), 1))))
{
}

Field SpectralField::SumOfModes(const LaplacianSpectrum& spectrum, int first, int last) const
{
  return spectrum.Sum(this->OffsetCoefficients, first, last);
}

Field SpectralField::Band(const LaplacianSpectrum& spectrum, int first, int last) const
{
  return this->SumOfModes(spectrum, first, last).rowwise() + this->Mean;
}

Field SpectralField::ComplementOfBand(const LaplacianSpectrum& spectrum, int first, int last) const
{
  return (this->Offsets - this->SumOfModes(spectrum, first, last)).rowwise() + this->Mean;
}

Eigen::VectorXd SpectralField::Energies(const LaplacianSpectrum& spectrum) const
{
  const double whole =
    (spectrum.Mass.asDiagonal() * this->Offsets).cwiseProduct(this->Offsets).sum();
  if (whole == 0.0)
  {
    return Eigen::VectorXd::Ones(spectrum.NumberOfModes());
  }
  Eigen::VectorXd energies = this->OffsetCoefficients.rowwise().squaredNorm() / whole;
  std::partial_sum(energies.data(), energies.data() + energies.size(), energies.data());
  return energies;
}
}
