// SPDX-License-Identifier: BSD-3-Clause
#include "Spectral/LeastSquaresMesh.h"

#include "Algebra/AnchoredSystem.h"
#include "Algebra/SparseProduct.h"
#include "Base/Bytes.h"
#include "Differential/Laplacian.h"
#include "Mesh/FarthestPoints.h"
#include "Mesh/UsedVertices.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
void RequireCount(const TriangleMesh& mesh, int count)
{
  const auto most = static_cast<int>(UsedVertices(mesh).size());
  if (count < mesh.NumberOfComponents() || count > most)
  {
    throw Error(ErrorCode::BadInput,
      std::to_string(count) + " anchors are asked for; the surface has " +
        std::to_string(mesh.NumberOfComponents()) + " components, each of which needs one, and " +
        std::to_string(most) + " points. Ask for " + std::to_string(mesh.NumberOfComponents()) +
        " to " + std::to_string(most) + ".");
  }
}

/// Refuses more functions than fit.
void RequireMemory(const TriangleMesh& mesh, std::size_t count, std::uint64_t maximumBytes)
{
  const std::uint64_t bytes = 8 * static_cast<std::uint64_t>(mesh.NumberOfVertices());
  if (bytes * count > maximumBytes)
  {
    throw Error(ErrorCode::OutOfMemory,
      std::to_string(count) + " functions of " + std::to_string(mesh.NumberOfVertices()) +
        " points take " + std::to_string(bytes * count / 1000000) +
        " megabytes, more than the limit of " + std::to_string(maximumBytes / 1000000) +
        ": ask for at most " + std::to_string(maximumBytes / bytes) +
        " anchors, or raise the memory limit.");
  }
}

/// The vertex, none of the anchors, whose error is the largest on average over a neighborhood.
/// A few anchors leave broad errors, and an anchor at the very peak, mostly the tip of a limb,
/// takes less of them than one further in. With k anchors .4 #V / k^2 averages over rings are
/// taken, a small part of what lies between anchors and none where these are many; at most 16,
/// so that they take less time than a solve. On elephant and camel, 20 anchors have 12 and 5 %
/// less error by it.
int WorstVertex(const TriangleMesh& mesh, Eigen::VectorXd squares, const std::vector<int>& anchors)
{
  const double count = static_cast<double>(anchors.size());
  const int rounds =
    static_cast<int>(std::min(16.0, 0.4 * mesh.NumberOfVertices() / (count * count)));
  Eigen::VectorXd averages = squares;
  for (int round = 0; round < rounds; ++round)
  {
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      double sum = squares[v];
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        sum += squares[mesh.Neighbor(d)];
      }
      averages[v] = sum / (1 + mesh.Valence(v));
    }
    squares.swap(averages);
  }
  for (const int anchor : anchors)
  {
    squares[anchor] = 0.0;
  }
  Eigen::Index worst = 0;
  squares.maxCoeff(&worst);
  return static_cast<int>(worst);
}
}

LeastSquaresMesh::LeastSquaresMesh(const TriangleMesh& mesh, const Points& points,
  const Settings& settings, const ExecutionContext& context)
{
  RequireCount(mesh, settings.NumberOfAnchors);
  RequireMemory(mesh, static_cast<std::size_t>(settings.NumberOfAnchors), settings.MaximumBytes);
  const int first = settings.Selection == AnchorSelection::Greedy ? mesh.NumberOfComponents()
                                                                  : settings.NumberOfAnchors;
  this->AnchorVertices = FarthestPoints(mesh, points, first, context.Part(0.0, 0.2));
  this->Prepare(mesh, points, mesh.NumberOfComponents(), settings.Backend, context.Part(0.2, 0.4));

  Points surface = this->BaseSurface;
  const int others = settings.NumberOfAnchors - mesh.NumberOfComponents();
  this->Columns.resize(mesh.NumberOfVertices(), others);
  this->Steps.resize(others, 3);
  int count = 0;
  for (; count < others; ++count)
  {
    const std::size_t place = static_cast<std::size_t>(count) + mesh.NumberOfComponents();
    if (place == this->AnchorVertices.size())
    {
      this->AnchorVertices.push_back(
        WorstVertex(mesh, (surface - points).rowwise().squaredNorm(), this->AnchorVertices));
    }
    const int anchor = this->AnchorVertices[place];
    // G_a = A^-1 e_a without what the anchors before it have taken.
    Field unit = Field::Zero(mesh.NumberOfVertices(), 1);
    unit(anchor, 0) = 1.0;
    Field column = Field::Zero(mesh.NumberOfVertices(), 1);
    this->System->Solve(unit, column);
    Eigen::VectorXd green = column.col(0) -
      this->Columns.leftCols(count) * this->Columns.row(anchor).head(count).transpose();
    if (!(green[anchor] > 1e-14 * column(anchor, 0)))
    {
      break; // everything is met to rounding
    }
    this->Columns.col(count) = green / std::sqrt(green[anchor]);
    this->Steps.row(count) = (points.row(anchor) - surface.row(anchor)) / std::sqrt(green[anchor]);
    surface += this->Columns.col(count) * this->Steps.row(count);
    this->RecordErrors(surface);
    context.Report(0.4 + 0.6 * (count + 1.0) / others);
  }
  this->Columns.conservativeResize(Eigen::NoChange, count);
  this->Steps.conservativeResize(count, Eigen::NoChange);
  this->AnchorVertices.resize(static_cast<std::size_t>(count) + mesh.NumberOfComponents());
}

LeastSquaresMesh::LeastSquaresMesh(const TriangleMesh& mesh, const Points& points,
  std::vector<int> anchors, std::uint64_t maximumBytes, SolverBackend backend,
  const ExecutionContext& context)
  : AnchorVertices(std::move(anchors))
{
  RequireMemory(mesh, this->AnchorVertices.size(), maximumBytes);
  const auto count = static_cast<int>(this->AnchorVertices.size());
  this->Prepare(mesh, points, count, backend, context);
  this->Columns.resize(mesh.NumberOfVertices(), 0);
  this->Steps.resize(0, 3);
}

void LeastSquaresMesh::Prepare(const TriangleMesh& mesh, const Points& points, int numberOfBase,
  SolverBackend backend, const ExecutionContext& context)
{
  const int size = mesh.NumberOfVertices();
  this->Rest = points;
  this->IsUsed.resize(size);
  Eigen::VectorXd inverseValences = Eigen::VectorXd::Zero(size);
  Anchors anchors = Anchors::After(size, size);
  for (int v = 0; v < size; ++v)
  {
    this->IsUsed[v] = mesh.IsUsed(v) ? 1 : 0;
    anchors.IsHard[v] = mesh.IsUsed(v) ? 0 : 1;
    inverseValences[v] = mesh.IsUsed(v) ? 1.0 / mesh.Valence(v) : 0.0;
  }
  for (int i = 0; i < numberOfBase; ++i)
  {
    anchors.IsHard[this->AnchorVertices[i]] = 1;
  }
  // |v_i - mean of its ring|^2 is the square of row i of D^-1 L.
  const SparseMatrix laplacian =
    Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges()));
  // A vector of its own: Eigen evaluates an expression anew for each column.
  const Eigen::VectorXd weights = inverseValences.cwiseAbs2();
  const SparseMatrix weighted = weights.asDiagonal() * laplacian;
  auto system = std::make_shared<AnchoredSystem>(backend);
  system->Factorize(CheckedProduct(laplacian, weighted, "The system of the least-squares mesh"),
    anchors, context.Part(0.0, 0.9));
  this->System = system;

  Field functions = Field::Zero(size, numberOfBase);
  for (int i = 0; i < numberOfBase; ++i)
  {
    functions(this->AnchorVertices[i], i) = 1.0;
  }
  system->Interpolate(functions);
  this->Base = functions;
  this->BaseSurface = points;
  Points held(numberOfBase, 3);
  for (int i = 0; i < numberOfBase; ++i)
  {
    held.row(i) = points.row(this->AnchorVertices[i]);
  }
  const Points through = this->Base * held;
  for (int v = 0; v < size; ++v)
  {
    if (this->IsUsed[v])
    {
      this->BaseSurface.row(v) = through.row(v);
    }
  }
  this->RecordErrors(this->BaseSurface);
  context.Report(1.0);
}

void LeastSquaresMesh::RecordErrors(const Points& surface)
{
  const Eigen::VectorXd squares = (surface - this->Rest).rowwise().squaredNorm();
  const auto count = std::count(this->IsUsed.begin(), this->IsUsed.end(), 1);
  this->RootMeanSquares.push_back(std::sqrt(squares.sum() / static_cast<double>(count)));
  this->Maxima.push_back(std::sqrt(squares.maxCoeff()));
}

Points LeastSquaresMesh::Surface(int count) const
{
  const int others = count - this->NumberOfBaseAnchors();
  return this->BaseSurface + this->Columns.leftCols(others) * this->Steps.topRows(others);
}

Eigen::MatrixXd LeastSquaresMesh::BasisFunctions(int count) const
{
  // Combinations C T^-1 of the columns, with T their values at the anchors, are 1 at
  // one of them and 0 at the others; the base anchors' functions lose what they have there.
  const int base = this->NumberOfBaseAnchors();
  const int others = count - base;
  Eigen::MatrixXd triangle(others, others);
  Eigen::MatrixXd baseThere(others, base);
  for (int i = 0; i < others; ++i)
  {
    triangle.row(i) = this->Columns.row(this->AnchorVertices[base + i]).head(others);
    baseThere.row(i) = this->Base.row(this->AnchorVertices[base + i]);
  }
  Eigen::MatrixXd functions(this->Base.rows(), count);
  functions.rightCols(others) = this->Columns.leftCols(others);
  triangle.triangularView<Eigen::Lower>().solveInPlace<Eigen::OnTheRight>(
    functions.rightCols(others));
  functions.leftCols(base) = this->Base - functions.rightCols(others) * baseThere;
  return functions;
}

std::size_t LeastSquaresMesh::GetBytes() const
{
  return this->System->GetBytes() +
    TotalBytes(this->AnchorVertices, this->Rest, this->IsUsed, this->BaseSurface, this->Base,
      this->Columns, this->Steps, this->RootMeanSquares, this->Maxima);
}
}
