// SPDX-License-Identifier: BSD-3-Clause
#include "Spectral/SpectralWatermark.h"

#include "Algebra/LowestEigenpairs.h"
#include "Base/Bytes.h"
#include "Base/DisjointSets.h"
#include "Differential/Laplacian.h"
#include "Mesh/GraphPatches.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace cartan
{
namespace
{
using Edges = Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// The edges between vertices of one patch, by their places in `vertices`.
Edges EdgesWithin(
  const TriangleMesh& mesh, const std::vector<int>& patchOf, const std::vector<int>& vertices)
{
  std::vector<int> ends;
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    for (int d = mesh.RingBegin(vertices[i]); d < mesh.RingEnd(vertices[i]); ++d)
    {
      const int other = mesh.Neighbor(d);
      if (other > vertices[i] && patchOf[other] == patchOf[vertices[i]])
      {
        const auto place = std::lower_bound(vertices.begin(), vertices.end(), other);
        ends.push_back(static_cast<int>(i));
        ends.push_back(static_cast<int>(place - vertices.begin()));
      }
    }
  }
  return Eigen::Map<const Edges>(ends.data(), static_cast<Eigen::Index>(ends.size() / 2), 2);
}

/// An orthonormal basis of the functions that are constant on each part of a graph.
Eigen::MatrixXd Constants(int numberOfNodes, const Edges& edges)
{
  DisjointSets parts(numberOfNodes);
  for (Eigen::Index e = 0; e < edges.rows(); ++e)
  {
    parts.Join(edges(e, 0), edges(e, 1));
  }
  std::vector<int> roots;
  for (int i = 0; i < numberOfNodes; ++i)
  {
    if (parts.Find(i) == i)
    {
      roots.push_back(i);
    }
  }
  Eigen::MatrixXd constants =
    Eigen::MatrixXd::Zero(numberOfNodes, static_cast<Eigen::Index>(roots.size()));
  for (int i = 0; i < numberOfNodes; ++i)
  {
    const auto part = std::lower_bound(roots.begin(), roots.end(), parts.Find(i));
    constants(i, part - roots.begin()) = 1.0;
  }
  constants.colwise().normalize();
  return constants;
}

void RequirePlaces(int places, int bits)
{
  if (bits < 1 || bits > places)
  {
    throw Error(ErrorCode::BadInput,
      "The surface has " + std::to_string(places) + " places for a message of " +
        std::to_string(bits) +
        (bits < 1 ? " bits: give a message."
                  : " bits: shorten the message, or raise ModeFraction."));
  }
}
}

SpectralWatermark::SpectralWatermark(
  const TriangleMesh& mesh, const Settings& settings, const ExecutionContext& context)
{
  int used = 0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    used += mesh.IsUsed(v) ? 1 : 0;
  }
  const int patches = settings.PatchSize > 0
    ? std::max(1, static_cast<int>(std::lround(static_cast<double>(used) / settings.PatchSize)))
    : 1;
  this->PatchOfVertex = GraphPatches(mesh, patches);
  this->Patches.resize(patches);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (this->PatchOfVertex[v] >= 0)
    {
      this->Patches[this->PatchOfVertex[v]].Vertices.push_back(v);
    }
  }
  for (int p = 0; p < patches; ++p)
  {
    this->MakeModes(mesh, settings, this->Patches[p],
      context.Part(static_cast<double>(p) / patches, (p + 1.0) / patches));
    this->Places += 3 * static_cast<int>(this->Patches[p].Modes.cols());
    context.Report((p + 1.0) / patches);
  }
}

void SpectralWatermark::MakeModes(const TriangleMesh& mesh, const Settings& settings, Patch& patch,
  const ExecutionContext& context) const
{
  const auto size = static_cast<int>(patch.Vertices.size());
  const Edges edges = EdgesWithin(mesh, this->PatchOfVertex, patch.Vertices);
  const Eigen::MatrixXd constants = Constants(size, edges);
  const auto known = static_cast<int>(constants.cols());
  const int modes =
    std::min(static_cast<int>(settings.ModeFraction * static_cast<double>(size)), size - known);
  const std::uint64_t bytes =
    8 * static_cast<std::uint64_t>(size) * VectorsOfEigenpairs(known + modes, size);
  if (bytes > settings.MaximumBytes)
  {
    throw Error(ErrorCode::OutOfMemory,
      std::to_string(modes) + " modes of a patch of " + std::to_string(size) + " points take " +
        std::to_string(bytes / 1000000) + " megabytes, more than the limit of " +
        std::to_string(settings.MaximumBytes / 1000000) +
        ": use smaller patches or a smaller ModeFraction, or raise the memory limit.");
  }
  const SparseMatrix laplacian = GraphLaplacian(size, edges, Eigen::VectorXd::Ones(edges.rows()));
  const Eigenpairs pairs =
    LowestEigenpairs(laplacian, constants, known + modes, settings.Backend, context);
  patch.Modes = pairs.Vectors.rightCols(modes);
  for (int k = 0; k < modes; ++k)
  {
    // The sign of an eigenvector is arbitrary; that of its largest entry is not.
    Eigen::Index largest = 0;
    patch.Modes.col(k).cwiseAbs().maxCoeff(&largest);
    patch.Modes.col(k) *= patch.Modes(largest, k) < 0.0 ? -1.0 : 1.0;
  }
}

std::vector<SpectralWatermark::Place> SpectralWatermark::MakePlaces(
  int numberOfBits, const std::string& key) const
{
  RequirePlaces(this->Places, numberOfBits);
  // The standard fixes this generator's numbers, but not those of its distributions.
  std::seed_seq seed(key.begin(), key.end());
  std::mt19937_64 random(seed);
  std::vector<int> order(this->Places);
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i)
  {
    std::swap(order[i - 1], order[random() % i]);
  }
  std::vector<Place> places(this->Places);
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    places[order[i]] = { static_cast<int>(i) % numberOfBits, random() >> 63U ? 1.0 : -1.0 };
  }
  return places;
}

Points SpectralWatermark::Signal(
  const std::vector<char>& bits, const std::string& key, double amplitude) const
{
  const std::vector<Place> places = this->MakePlaces(static_cast<int>(bits.size()), key);
  Points signal = Points::Zero(static_cast<Eigen::Index>(this->PatchOfVertex.size()), 3);
  std::size_t next = 0;
  for (const Patch& patch : this->Patches)
  {
    Eigen::MatrixXd coefficients(patch.Modes.cols(), 3);
    for (Eigen::Index k = 0; k < 3 * patch.Modes.cols(); ++k)
    {
      const Place& place = places[next++];
      coefficients(k / 3, k % 3) = amplitude * place.Sign * (bits[place.Bit] ? 1.0 : -1.0);
    }
    signal(patch.Vertices, Eigen::all) = patch.Modes * coefficients;
  }
  return signal;
}

WatermarkReading SpectralWatermark::Read(
  const Points& difference, int numberOfBits, const std::string& key) const
{
  const std::vector<Place> places = this->MakePlaces(numberOfBits, key);
  std::vector<Eigen::MatrixXd> coefficients;
  Eigen::Index most = 0;
  for (const Patch& patch : this->Patches)
  {
    coefficients.emplace_back(patch.Modes.transpose() * difference(patch.Vertices, Eigen::all));
    most = std::max(most, patch.Modes.cols());
  }
  // The mean square of each mode's coefficients: a little of the watermark, and the noise,
  // which alignment and smooth distortions leave larger in the first modes.
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(most);
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(most);
  for (const Eigen::MatrixXd& patch : coefficients)
  {
    squares.head(patch.rows()) += patch.rowwise().squaredNorm();
    counts.head(patch.rows()).array() += 3.0;
  }
  const Eigen::VectorXd meanSquares = squares.cwiseQuotient(counts);

  // With weights w that do not depend on the signs p, the sum of w p c over a bit's places
  // has the variance sum (w c)^2 where the signs have nothing to do with c.
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(numberOfBits);
  Eigen::VectorXd variances = Eigen::VectorXd::Zero(numberOfBits);
  std::size_t next = 0;
  for (const Eigen::MatrixXd& patch : coefficients)
  {
    for (Eigen::Index k = 0; k < patch.size(); ++k)
    {
      const Place& place = places[next++];
      const double meanSquare = meanSquares[k / 3];
      const double value = meanSquare > 0.0 ? patch(k / 3, k % 3) / meanSquare : 0.0;
      sums[place.Bit] += place.Sign * value;
      variances[place.Bit] += value * value;
    }
  }
  WatermarkReading reading;
  reading.Scores = (variances.array() > 0.0).select(sums.array() / variances.array().sqrt(), 0.0);
  reading.Bits.resize(numberOfBits);
  std::transform(reading.Scores.data(), reading.Scores.data() + numberOfBits, reading.Bits.begin(),
    [](double score) { return static_cast<char>(score > 0.0); });
  return reading;
}

std::size_t SpectralWatermark::GetBytes() const
{
  std::size_t bytes = BytesOf(this->PatchOfVertex);
  for (const Patch& patch : this->Patches)
  {
    bytes += TotalBytes(patch.Vertices, patch.Modes);
  }
  return bytes;
}

double WatermarkConfidence(double score)
{
  return 1.0 - 0.5 * std::erfc(std::abs(score) / std::sqrt(2.0));
}

double ChanceOfMatches(int matches, int bits)
{
  // The sum of binomial coefficients over 2^bits, each term by logarithms.
  double chance = 0.0;
  for (int k = matches; k <= bits; ++k)
  {
    chance += std::exp(std::lgamma(bits + 1.0) - std::lgamma(k + 1.0) -
      std::lgamma(bits - k + 1.0) - bits * std::log(2.0));
  }
  return std::min(chance, 1.0);
}

double ChanceOfScores(const Eigen::VectorXd& scores)
{
  // P(sum z^2 >= n t) <= exp(-n/2 (t - 1 - ln t)) for t >= 1.
  const auto count = static_cast<double>(scores.size());
  const double t = scores.squaredNorm() / count;
  return t > 1.0 ? std::exp(-0.5 * count * (t - 1.0 - std::log(t))) : 1.0;
}
}
