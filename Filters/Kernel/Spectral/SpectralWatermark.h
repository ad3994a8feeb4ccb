// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SymmetricSolver.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace cartan
{
/// What is read from a surface.
struct WatermarkReading
{
  std::vector<char> Bits; ///< 0 or 1
  /// How much the places of each bit agree: positive for 1. Without a watermark of the key,
  /// they have mean 0 and variance 1 and tails below those of a normal distribution.
  Eigen::VectorXd Scores;
};

/// A watermark in the low frequencies of a surface (Ohbuchi, Mukaiyama, Takahashi, A
/// Frequency-Domain Approach to Watermarking 3D Shapes, Computer Graphics Forum 21(3), 2002;
/// Sorkine, Differential Representations for Mesh Processing, 2006, section 3.3).
///
/// The surface is split into patches. In each one, the coefficients of the positions in the
/// modes of lowest frequency of the graph Laplacian, but for constants, are *places*: mode m
/// and axis s of patch P. A key shuffles the places, gives them to the bits in turn, and
/// gives each a sign p = +-1. A bit b = +-1 adds b p a to the coefficients of its places. The
/// difference of a suspect surface from the original has, at these places, b p a and noise.
class SpectralWatermark
{
public:
  struct Settings
  {
    int PatchSize = 1000;       ///< about how many vertices a patch has; 0: one patch
    double ModeFraction = 0.07; ///< how many modes are used, in parts of a patch's vertices
    std::uint64_t MaximumBytes = 4000000000U; ///< of the modes and their computation
    SolverBackend Backend = SolverBackend::Automatic;
  };

  /// Throws Error(OutOfMemory) when the modes do not fit, and what GraphPatches and
  /// LowestEigenpairs throw.
  SpectralWatermark(
    const TriangleMesh& mesh, const Settings& settings, const ExecutionContext& context = {});

  int NumberOfPlaces() const { return this->Places; }
  int NumberOfPatches() const { return static_cast<int>(this->Patches.size()); }

  /// #V: the patch of each vertex, -1 for unused ones.
  const std::vector<int>& GetPatchOfVertex() const { return this->PatchOfVertex; }

  /// What the watermark adds to the positions, #V x 3: its root mean square over the used
  /// vertices is at most `amplitude` sqrt(3 ModeFraction). `amplitude` is in length units.
  /// Throws Error(BadInput) for more bits than places, or none.
  Points Signal(const std::vector<char>& bits, const std::string& key, double amplitude) const;

  /// Reads bits from `difference`, a suspect's positions minus the original's: #V x 3. Modes
  /// with more noise count less. Throws as Signal.
  WatermarkReading Read(const Points& difference, int numberOfBits, const std::string& key) const;

  std::size_t GetBytes() const;

private:
  struct Patch
  {
    std::vector<int> Vertices;
    Eigen::MatrixXd Modes; ///< #vertices x #modes, orthonormal
  };
  struct Place
  {
    int Bit;
    double Sign;
  };

  std::vector<Place> MakePlaces(int numberOfBits, const std::string& key) const;
  void MakeModes(const TriangleMesh& mesh, const Settings& settings, Patch& patch,
    const ExecutionContext& context) const;

  std::vector<int> PatchOfVertex;
  std::vector<Patch> Patches;
  int Places = 0;
};

/// The probability that a bit of this score is right, in [.5, 1]: of a normal variable below
/// |score|.
double WatermarkConfidence(double score);

/// The probability that at least `matches` of `bits` random bits agree with given ones.
double ChanceOfMatches(int matches, int bits);

/// A bound of the probability that a surface without a watermark gives scores as large as
/// these in the sum of their squares (Chernoff's bound; the signs make scores sub-Gaussian).
double ChanceOfScores(const Eigen::VectorXd& scores);
}
