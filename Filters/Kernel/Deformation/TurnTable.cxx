// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/TurnTable.h"

#include "Base/Constants.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartan
{
namespace
{
/// Chebyshev nodes in (0, range], as many as there are below 0: enough for polynomials of any
/// order that a table has.
constexpr int NumberOfNodes = 40;

/// Polynomials of S and C together; more would cost more than they save.
constexpr int MaximumModes = 32;

double Node(int index)
{
  return std::cos(Pi * (index + 0.5) / (2 * NumberOfNodes));
}

/// The weight of a value at a node in the coefficient of T_order: the parity of the function
/// stands for the nodes below 0.
double NodeWeight(int index, int order)
{
  const double weight =
    2.0 / NumberOfNodes * std::cos(order * Pi * (index + 0.5) / (2 * NumberOfNodes));
  return order == 0 ? 0.5 * weight : weight;
}
}

TurnTable::TurnTable(std::shared_ptr<const HandleLaplacian> system,
  std::shared_ptr<const Points> rest, const Points* offsets, const TurnsOfAngle& turns,
  const Options& options, const ExecutionContext& context)
  : System(std::move(system))
  , Rest(std::move(rest))
  , Range(options.Range)
  , NumberOfHandles(this->System->NumberOfMovingHandles())
{
  // Angles move points by their distance from the axis.
  const double size = this->RestDiagonal();
  // What the fields S and C make of an error of the frames is known afterwards only.
  for (const double share : { 1.0, 0.02 })
  {
    this->ChooseModes(turns, share * options.Tolerance / size);
    this->Fill(offsets, turns, context.Part(0.0, 0.9));
    this->Error = std::max(this->ErrorAt(this->Range, offsets, turns, context),
      this->ErrorAt(0.5 * this->Range, offsets, turns, context));
    if (this->Error <= options.Tolerance)
    {
      return;
    }
  }
  this->Range = 0.0;
  this->Fields.resize(0, 0);
}

double TurnTable::RestDiagonal() const
{
  Eigen::VectorXd extremes = // of x and -x
    Eigen::VectorXd::Constant(6, -std::numeric_limits<double>::infinity());
  if (this->Rest->rows() > 0)
  {
    extremes << this->Rest->colwise().maxCoeff().transpose(),
      -this->Rest->colwise().minCoeff().transpose();
  }
  this->System->MaximumOverPieces(extremes);
  return (extremes.head<3>() + extremes.tail<3>()).norm();
}

/// The largest coefficient of each polynomial, on a sample of the vertices.
Eigen::VectorXd TurnTable::ModeSizes(
  const TurnsOfAngle& turns, const std::vector<Mode>& modes, double range) const
{
  const int numberOfLocals = this->System->NumberOfLocals();
  const int step = std::max(1, numberOfLocals / 4000);
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(modes.size()));
  Eigen::VectorXd coefficients(sizes.size());
  for (int local = 0; local < numberOfLocals; local += step)
  {
    coefficients.setZero();
    for (int q = 0; q < NumberOfNodes; ++q)
    {
      const TurnParts parts = turns.Local(local, range * Node(q));
      for (std::size_t m = 0; m < modes.size(); ++m)
      {
        coefficients[static_cast<Eigen::Index>(m)] +=
          NodeWeight(q, modes[m].Order) * (modes[m].IsVersine ? parts.Versine : parts.Sine);
      }
    }
    sizes = sizes.cwiseMax(coefficients.cwiseAbs());
  }
  this->System->MaximumOverPieces(sizes);
  return sizes;
}

/// The polynomials beyond which all coefficients together are below the tolerance, in the
/// longest range for which there are not too many.
void TurnTable::ChooseModes(const TurnsOfAngle& turns, double tolerance)
{
  std::vector<Mode> all;
  all.reserve(NumberOfNodes);
  for (int order = 0; order < NumberOfNodes; ++order)
  {
    all.push_back({ order, order % 2 == 0 });
  }
  for (;;)
  {
    const Eigen::VectorXd sizes = this->ModeSizes(turns, all, this->Range);
    double tail = 0.0;
    int count = NumberOfNodes;
    while (count > 2 && tail + sizes[count - 1] <= tolerance)
    {
      --count;
      tail += sizes[count];
    }
    if (count <= MaximumModes)
    {
      all.resize(static_cast<std::size_t>(count));
      break;
    }
    this->Range *= 0.9;
  }
  std::stable_partition(all.begin(), all.end(), [](const Mode& mode) { return !mode.IsVersine; });
  this->Modes = std::move(all);
  this->NumberOfSines = static_cast<int>(std::count_if(
    this->Modes.begin(), this->Modes.end(), [](const Mode& mode) { return !mode.IsVersine; }));
}

/// The frames' coefficients: a row per local vertex, then one per handle; a column per mode.
Eigen::MatrixXd TurnTable::Coefficients(
  const TurnsOfAngle& turns, const ExecutionContext& context) const
{
  const int numberOfLocals = this->System->NumberOfLocals();
  const auto numberOfModes = static_cast<Eigen::Index>(this->Modes.size());
  Eigen::MatrixXd weights(NumberOfNodes, numberOfModes);
  for (Eigen::Index m = 0; m < numberOfModes; ++m)
  {
    for (int q = 0; q < NumberOfNodes; ++q)
    {
      weights(q, m) = NodeWeight(q, this->Modes[static_cast<std::size_t>(m)].Order);
    }
  }
  Eigen::MatrixXd coefficients =
    Eigen::MatrixXd::Zero(numberOfLocals + this->NumberOfHandles, numberOfModes);
  context.For(static_cast<int>(coefficients.rows()),
    [&](int begin, int end)
    {
      for (int row = begin; row < end; ++row)
      {
        for (int q = 0; q < NumberOfNodes; ++q)
        {
          const double angle = this->Range * Node(q);
          const TurnParts parts = row < numberOfLocals ? turns.Local(row, angle)
                                                       : turns.Handle(row - numberOfLocals, angle);
          for (Eigen::Index m = 0; m < numberOfModes; ++m)
          {
            coefficients(row, m) +=
              weights(q, m) * (m < this->NumberOfSines ? parts.Sine : parts.Versine);
          }
        }
      }
    });
  return coefficients;
}

/// b of FrameDeformer::RightHandSide for frames s_i K, without K: three columns from `column`
/// on. `values` are the s of the locals, then of the handles.
void TurnTable::RightHandSide(const Points* offsets, const double* values, Eigen::Index column,
  Eigen::MatrixXd& result, const ExecutionContext& context) const
{
  const HandleLaplacian& system = *this->System;
  const Points& rest = *this->Rest;
  const double* ofHandles = values + system.NumberOfLocals();
  context.For(system.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const int v = system.Vertex(i);
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        for (const auto* edge = system.EdgesBegin(i); edge != system.EdgesEnd(i); ++edge)
        {
          const int j = edge->Neighbor;
          const int w = system.Vertex(j);
          const double half = 0.5 * edge->Weight;
          sum += half * (values[i] + values[j]) * (rest.row(v) - rest.row(w));
          if (offsets)
          {
            sum += half * (values[i] - values[j]) * (offsets->row(v) + offsets->row(w));
          }
          if (j >= system.NumberOfUnknowns() && system.MovingHandle(j) >= 0)
          {
            sum += edge->Weight * ofHandles[system.MovingHandle(j)] * rest.row(w);
          }
        }
        if (system.SquaredSoftWeight(i) > 0.0 && system.MovingHandle(i) >= 0)
        {
          sum +=
            0.5 * system.SquaredSoftWeight(i) * ofHandles[system.MovingHandle(i)] * rest.row(v);
        }
        result.block<1, 3>(i, column) = sum;
      }
    });
}

void TurnTable::Fill(
  const Points* offsets, const TurnsOfAngle& turns, const ExecutionContext& context)
{
  const int numberOfUnknowns = this->System->NumberOfUnknowns();
  const auto numberOfModes = static_cast<Eigen::Index>(this->Modes.size());
  const Eigen::MatrixXd coefficients = this->Coefficients(turns, context);
  context.Report(0.1);
  this->Fields.resize(numberOfUnknowns, 3 * numberOfModes + this->NumberOfHandles);
  this->Fields.rightCols(this->NumberOfHandles) =
    this->System->HarmonicFields()
      .topLeftCorner(numberOfUnknowns, this->NumberOfHandles)
      .cast<float>();
  // Several columns at once: the factor is read once for all of them.
  constexpr Eigen::Index chunk = 4;
  Eigen::MatrixXd rightHandSide(numberOfUnknowns, 3 * chunk);
  for (Eigen::Index first = 0; first < numberOfModes; first += chunk)
  {
    const Eigen::Index count = std::min(chunk, numberOfModes - first);
    for (Eigen::Index m = 0; m < count; ++m)
    {
      this->RightHandSide(
        offsets, coefficients.col(first + m).data(), 3 * m, rightHandSide, context);
    }
    const double done = 0.1 + 0.9 * static_cast<double>(first) / numberOfModes;
    this->Fields.middleCols(3 * first, 3 * count) =
      this->System->Solve(rightHandSide.leftCols(3 * count), context.Part(done, done))
        .cast<float>();
    context.Report(0.1 + 0.9 * static_cast<double>(first + count) / numberOfModes);
  }
}

/// T_order(angle / range) of each mode.
Eigen::VectorXf TurnTable::Polynomials(double angle) const
{
  const double node = std::acos(std::clamp(angle / this->Range, -1.0, 1.0));
  Eigen::VectorXf values(static_cast<Eigen::Index>(this->Modes.size()));
  for (std::size_t m = 0; m < this->Modes.size(); ++m)
  {
    values[static_cast<Eigen::Index>(m)] =
      static_cast<float>(std::cos(this->Modes[m].Order * node));
  }
  return values;
}

/// The largest |dS| + |dC|, which for any axis is at least the distance of the positions.
double TurnTable::ErrorAt(double angle, const Points* offsets, const TurnsOfAngle& turns,
  const ExecutionContext& context) const
{
  const int numberOfLocals = this->System->NumberOfLocals();
  Eigen::MatrixXd values(numberOfLocals + this->NumberOfHandles, 2);
  for (Eigen::Index row = 0; row < values.rows(); ++row)
  {
    const int index = static_cast<int>(row);
    const TurnParts parts = index < numberOfLocals ? turns.Local(index, angle)
                                                   : turns.Handle(index - numberOfLocals, angle);
    values.row(row) << parts.Sine, parts.Versine;
  }
  Eigen::MatrixXd rightHandSide(this->System->NumberOfUnknowns(), 6);
  this->RightHandSide(offsets, values.col(0).data(), 0, rightHandSide, context);
  this->RightHandSide(offsets, values.col(1).data(), 3, rightHandSide, context);
  const Eigen::Map<const Eigen::MatrixXd> solution = this->System->Solve(rightHandSide);
  const Eigen::VectorXf polynomials = this->Polynomials(angle);
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(1);
  for (Eigen::Index i = 0; i < solution.rows(); ++i)
  {
    Eigen::RowVector3f sums[2] = { Eigen::RowVector3f::Zero(), Eigen::RowVector3f::Zero() };
    for (Eigen::Index m = 0; m < polynomials.size(); ++m)
    {
      sums[m < this->NumberOfSines ? 0 : 1] +=
        polynomials[m] * this->Fields.row(i).segment<3>(3 * m);
    }
    largest[0] = std::max(largest[0],
      (sums[0].cast<double>() - solution.row(i).head<3>()).norm() +
        (sums[1].cast<double>() - solution.row(i).tail<3>()).norm());
  }
  this->System->MaximumOverPieces(largest);
  return largest[0];
}

PositionRows TurnTable::Evaluate(
  double angle, const Eigen::Vector3d& axis, const std::vector<Eigen::Vector3d>& translations) const
{
  std::vector<Eigen::Vector3f> shifts;
  shifts.reserve(static_cast<std::size_t>(this->NumberOfHandles));
  for (int k = 0; k < this->NumberOfHandles; ++k)
  {
    shifts.push_back(translations[static_cast<std::size_t>(k)].cast<float>());
  }
  return [this, polynomials = this->Polynomials(angle), unit = Eigen::Vector3f(axis.cast<float>()),
           shifts = std::move(shifts)](int begin, int end, double* rows)
  {
    const int numberOfModes = static_cast<int>(this->Modes.size());
    for (int i = begin; i < end; ++i, rows += 3)
    {
      const float* field = this->Fields.data() + i * this->Fields.cols();
      Eigen::Vector3f sines = Eigen::Vector3f::Zero();
      Eigen::Vector3f versines = Eigen::Vector3f::Zero();
      for (int m = 0; m < this->NumberOfSines; ++m)
      {
        sines += polynomials[m] * Eigen::Map<const Eigen::Vector3f>(field + 3 * m);
      }
      for (int m = this->NumberOfSines; m < numberOfModes; ++m)
      {
        versines += polynomials[m] * Eigen::Map<const Eigen::Vector3f>(field + 3 * m);
      }
      Eigen::Vector3f shift = unit.cross(Eigen::Vector3f(sines + unit.cross(versines)));
      for (int k = 0; k < this->NumberOfHandles; ++k)
      {
        shift += field[3 * numberOfModes + k] * shifts[static_cast<std::size_t>(k)];
      }
      Eigen::Map<Eigen::RowVector3d> position(rows);
      position = this->Rest->row(this->System->Vertex(i)) + shift.cast<double>().transpose();
    }
  };
}
}
