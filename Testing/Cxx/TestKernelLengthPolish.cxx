// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Morph/IsometricMorph.h"
#include "Kernel/Morph/LengthPolish.h"
#include "MorphShapes.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

using cartan::KeyFrames;
using cartan::Points;
using morphshapes::Keys;
using morphshapes::MeasureMorph;
using morphshapes::MorphFigures;
using shapes::Shape;
using shapes::ShowFigure;

TEST(LengthPolish, ReportsEachStepAndStops)
{
  const Shape bar = shapes::Bar(4, 4, 24, { 1, 1, 6 });
  const KeyFrames keys = Keys(bar, { bar.Positions, morphshapes::Twist(bar, 180, 1, 5) });
  cartan::IsometricMorphOptions options;
  options.LengthPolish = 2;
  cartan::IsometricMorph morph(keys, options);
  int reports = 0;
  double last = 0.0;
  const auto count = [&](double fraction)
  {
    EXPECT_GE(fraction, last);
    last = fraction;
    ++reports;
    return true;
  };
  morph.Evaluate(0.5, cartan::ExecutionContext({}, count));
  EXPECT_GT(reports, 50);
  EXPECT_LE(last, 1.0);
  int left = reports / 2;
  try
  {
    morph.Evaluate(0.5, cartan::ExecutionContext({}, [&](double) { return --left > 0; }));
    FAIL() << "not stopped";
  }
  catch (const cartan::Error& error)
  {
    EXPECT_EQ(error.GetCode(), cartan::ErrorCode::Aborted);
  }
  EXPECT_EQ(left, 0);
}

TEST(LengthPolish, ReachesLengthsThatASurfaceHas)
{
  // From a surface with noise back to the lengths without it.
  const Shape bar = shapes::Bar(4, 4, 12, { 1, 1, 3 });
  const KeyFrames keys = Keys(bar, { bar.Positions, bar.Positions });
  const cartan::IsometricMorph morph(keys);
  Points positions = shapes::Noisy(bar, 0.01).Positions;
  std::vector<char> isHeld(positions.rows(), 0);
  isHeld[7] = 1;
  const Points start = positions;
  const MorphFigures before = MeasureMorph(keys, positions, 0.5);
  cartan::PolishLengths(morph.GetEdges(), morph.Lengths(0.5), isHeld, 10, positions);
  const MorphFigures after = MeasureMorph(keys, positions, 0.5);
  ShowFigure("edge rms before", before.EdgeRms);
  ShowFigure("edge rms after", after.EdgeRms);
  EXPECT_LT(after.EdgeRms, 1e-3 * before.EdgeRms);
  EXPECT_EQ(positions.row(7), start.row(7));
}
