// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Spectral/LaplacianSpectrum.h"

namespace cartan
{
/// A field in the basis of the modes, as offsets from its mean: what modes do to it does
/// not depend on where the origin is. Unused vertices have no part in it.
class SpectralField
{
public:
  /// `values` are #V x k.
  SpectralField(const LaplacianSpectrum& spectrum, const Field& values);

  /// The coefficients of the field, its mean included: #modes x k.
  const Eigen::MatrixXd& GetCoefficients() const { return this->Coefficients; }

  /// The sum of modes [first, last) around the mean: #V x k.
  Field Band(const LaplacianSpectrum& spectrum, int first, int last) const;

  /// All modes but [first, last), computed or not, around the mean: #V x k.
  Field ComplementOfBand(const LaplacianSpectrum& spectrum, int first, int last) const;

  /// The part of the squared norm of the offsets in the mass of the operator that the modes
  /// up to each one carry: #modes, increasing to 1 at most; 1 where there are no offsets.
  Eigen::VectorXd Energies(const LaplacianSpectrum& spectrum) const;

private:
  Field SumOfModes(const LaplacianSpectrum& spectrum, int first, int last) const;

  Eigen::RowVectorXd Mean;            // in the mass of the operator
  Field Offsets;                      // #V x k
  Eigen::MatrixXd OffsetCoefficients; // #modes x k
  Eigen::MatrixXd Coefficients;       // #modes x k
};
}
