// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Error.h"
#include "Deformation/HandleProblem.h"

namespace cartan
{
/// Whether a deformation is determined by what is known of the surface is found by
/// deforming it twice, the second time with points moved at random by RoundingOfInput
/// of the size: more than rounding, less than any surface is known to. Where handles
/// leave a system singular, where neighbors turn by half a turn against each other or
/// are equally far from two handles, the results differ by any amount.
constexpr double RoundingOfInput = 1e-12;

/// By how much motions are turned with them, in radians: little enough that handles which move as
/// one still count as such (see CommonMotion).
constexpr double RoundingOfTurns = 2e-13;

/// How far they may differ, in parts of the size.
constexpr double RoundingOfResult = 1e-5;

/// The problem with other rest positions, for everything that is found from them, such
/// as slivers. The same numbers on every machine.
HandleProblem WithMovedPoints(HandleProblem problem);

/// The targets with maps and vectors that are turned at random by RoundingOfTurns, so that a
/// turn which the motions alone leave open comes out otherwise too, as that of a point half-way
/// between two handles of which one makes half a turn. What is not turned at all stays exact.
HandleTargets WithMovedTargets(HandleTargets targets);

/// What is compared beside positions: Transforms, the rotations in them, and the
/// normals of the surface.
struct ComparedFields
{
  bool Transforms = false;
  bool Rotations = false;
  bool Normals = false;
};

/// What two results differ in by more than RoundingOfResult.
struct RoundingDifference
{
  IdSample Vertices;
  /// Whether it decides which slivers are taken out (see WithoutSlivers).
  bool IsOfSlivers = false;
  double Largest = 0.0; ///< of positions, in parts of the size

  /// In a sentence, with what to do; empty where there is nothing.
  std::string Describe() const;
};

/// How far points may go, in sizes of the surface: coordinates of 16 digits have seven
/// left for its shape there.
constexpr double FarthestMotion = 1e9;

/// A motion along each axis that is far less, found in no time, for all that move no farther:
/// one edge is enough to see that.
double ShortMotion(const HandleProblem& problem);

/// A sentence on a result with points farther away, with what to do; empty where there
/// are none.
std::string DescribeLostDigits(const HandleProblem& problem, const DeformedSurface& result);

/// Compares at the vertices of the mesh with slivers.
RoundingDifference CompareResults(const HandleProblem& problem, const DeformedSurface& result,
  const DeformedSurface& other, const ComparedFields& fields);
}
