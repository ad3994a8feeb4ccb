// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleLaplacian.h"
#include "Deformation/PositionRows.h"

#include <functional>
#include <vector>

namespace cartan
{
/// What a rotation by an angle f is made of: with K = [axis]x it is I + Sine K + Versine K^2.
struct TurnParts
{
  double Sine = 0.0;    ///< sin f
  double Versine = 0.0; ///< 1 - cos f
};

/// How the angles of everything follow from one angle: that of the handle that turns most.
/// `Local` is for a local vertex of the position system, known or unknown, `Handle` for a
/// handle of HandleProblem::Moving. Both must be odd in the angle (the sine) and even (the
/// versine).
struct TurnsOfAngle
{
  std::function<TurnParts(int local, double angle)> Local;
  std::function<TurnParts(int handle, double angle)> Handle;
};

/// The deformed surface as a function of the angle, for handles that turn about one axis
/// in a fixed ratio. The system of the positions is linear in the frames' changes
/// R_i = I + s_i K + c_i K^2, and K acts from the left, so that its solution is
///
///   x = p + K S(angle) + K^2 C(angle) + sum_k h_k t_k
///
/// with the translations t_k of the handles, their harmonic fields h_k and two vector fields S
/// and C that do not depend on the axis. S is odd in the angle and C is even, and both are as
/// smooth in it as sin and cos: few Chebyshev polynomials suffice, each of which costs one
/// solve. A motion is then a sum over them, without a solve.
class TurnTable
{
public:
  /// Angles in radians, tolerance in units of length.
  struct Options
  {
    double Range = 0.0;
    double Tolerance = 0.0;
  };

  /// `offsets` (#V x 3) are those of the neutral offset, or nothing. Where the range needs
  /// too many polynomials, it is shortened; where the tolerance cannot be met, it is 0.
  TurnTable(std::shared_ptr<const HandleLaplacian> system, std::shared_ptr<const Points> rest,
    const Points* offsets, const TurnsOfAngle& turns, const Options& options,
    const ExecutionContext& context);

  /// The largest angle that the table serves.
  double GetRange() const { return this->Range; }

  /// The largest distance to the solution, for any axis, measured at the end of the range and
  /// in its middle: the error of a sum of Chebyshev polynomials is largest at the end.
  double GetError() const { return this->Error; }

  /// The positions of ranges of unknowns, as long as the table is there. A translation per moving
  /// handle.
  PositionRows Evaluate(double angle, const Eigen::Vector3d& axis,
    const std::vector<Eigen::Vector3d>& translations) const;

  std::size_t GetBytes() const { return TotalBytes(this->Fields); }

private:
  /// A polynomial T_order(angle / Range) of S or of C.
  struct Mode
  {
    int Order;
    bool IsVersine;
  };
  /// Single precision: half the memory traffic, and its rounding is far below any tolerance.
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  double RestDiagonal() const;
  Eigen::VectorXd ModeSizes(
    const TurnsOfAngle& turns, const std::vector<Mode>& modes, double range) const;
  void ChooseModes(const TurnsOfAngle& turns, double tolerance);
  Eigen::MatrixXd Coefficients(const TurnsOfAngle& turns, const ExecutionContext& context) const;
  void RightHandSide(const Points* offsets, const double* values, Eigen::Index column,
    Eigen::MatrixXd& result, const ExecutionContext& context) const;
  void Fill(const Points* offsets, const TurnsOfAngle& turns, const ExecutionContext& context);
  double ErrorAt(double angle, const Points* offsets, const TurnsOfAngle& turns,
    const ExecutionContext& context) const;
  Eigen::VectorXf Polynomials(double angle) const;

  std::shared_ptr<const HandleLaplacian> System;
  std::shared_ptr<const Points> Rest;
  double Range = 0.0;
  double Error = 0.0;
  int NumberOfHandles;
  std::vector<Mode> Modes; ///< those of S, then those of C
  int NumberOfSines = 0;
  /// A row per unknown: the vectors of the modes, then the harmonic fields.
  Rows Fields;
};
}
