// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Deformation/FrameDeformer.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Measure/ComponentVolumes.h"
#include "Kernel/Measure/VolumeClosing.h"
#include "Kernel/Measure/VolumeModel.h"
#include "Kernel/Mesh/RayTree.h"
#include "Kernel/Morph/MorphVolume.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <memory>

using namespace cartan;
using shapes::Inverted;
using shapes::MakeMesh;
using shapes::Shape;
using shapes::Union;

namespace
{
Shape Bar(double width, double length, double bottom)
{
  Shape bar = shapes::Bar(4, 4, 16, { width, width, length });
  bar.Positions.col(2).array() += bottom;
  return bar;
}

/// A bar along z with a cavity, walls of 0.2, its components in either order.
Shape HollowBar(bool isCavityFirst)
{
  const Shape outer = Bar(1.0, 4.0, 0.0);
  const Shape cavity = Inverted(Bar(0.6, 3.6, 0.2));
  return isCavityFirst ? Union(cavity, outer) : Union(outer, cavity);
}

VolumeModel ModelOf(const Shape& shape)
{
  const RayTree tree(shape.Faces, shape.Positions);
  return MeasureVolumeModel(MakeMesh(shape), shape.Positions,
    [&tree](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
    { return tree.FirstHit(from, direction); });
}

/// The lower end is pinned, the upper one is turned.
Points Bent(const Shape& shape, VolumeCorrection correction, double angle)
{
  HandleProblem problem;
  problem.Mesh = std::make_shared<TriangleMesh>(MakeMesh(shape));
  problem.Rest = std::make_shared<Points>(shape.Positions);
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    const double z = shape.Positions(v, 2);
    problem.Handle.push_back(z < 0.6 ? 1 : (z > 3.4 ? 2 : 0));
  }
  problem.Moving = { 2 };
  RotationInvariantDeformer deformer(problem);
  deformer.SetVolumeModel(std::make_shared<const VolumeModel>(ModelOf(shape)));
  deformer.SetVolumeCorrection(correction);
  deformer.SetCloseVolume(true);
  HandleTargets targets;
  targets.Motions.resize(1);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Vector3d center(0.0, 0.0, 2.0);
  targets.Motions[0].Linear = turn;
  targets.Motions[0].Translation = center - turn * center;
  DeformedSurface result;
  deformer.Deform(targets, false, result, {});
  EXPECT_EQ(deformer.GetWarning(), "");
  return result.Positions;
}
}

/// A double pyramid between two tops on the z axis, whose rim is a square of that radius.
Shape DoublePyramid(double bottom, double top, double radius)
{
  Shape pyramid;
  pyramid.Positions.resize(6, 3);
  const double middle = 0.5 * (bottom + top);
  pyramid.Positions << 0.0, 0.0, bottom, 0.0, 0.0, top, radius, 0.0, middle, 0.0, radius, middle,
    -radius, 0.0, middle, 0.0, -radius, middle;
  pyramid.Faces.resize(8, 3);
  pyramid.Faces << 0, 3, 2, 0, 4, 3, 0, 5, 4, 0, 2, 5, 1, 2, 3, 1, 3, 4, 1, 4, 5, 1, 5, 2;
  return pyramid;
}

/// The ray from the lower top passes through the upper one, where another body begins.
TEST(HollowBodies, WhatTouchesABodyChangesNoDepth)
{
  const Shape body = DoublePyramid(0.0, 2.0, 1.0);
  const double expected = ModelOf(body).LocalDepth[0];
  for (const double radius : { 0.05, 1.0, 20.0 })
  {
    const Shape other = DoublePyramid(2.0, 3.0, radius);
    EXPECT_NEAR(ModelOf(Union(body, other)).LocalDepth[0], expected, 1e-9) << radius;
    EXPECT_NEAR(ModelOf(Union(other, body)).LocalDepth[6], expected, 1e-9) << radius;
  }
}

TEST(HollowBody, TakesPartWithItsCavityAndWithoutAWord)
{
  for (const bool isCavityFirst : { false, true })
  {
    const VolumeModel model = ModelOf(HollowBar(isCavityFirst));
    EXPECT_EQ(model.EnclosesVolume, std::vector<char>({ 1, 1 }));
    EXPECT_EQ(model.Warning, "");
    EXPECT_NEAR(model.Volumes[isCavityFirst], 4.0, 1e-12);
    EXPECT_NEAR(model.Volumes[!isCavityFirst], -0.36 * 3.6, 1e-12);
  }
}

TEST(HollowBody, DepthsAreThoseOfItsWalls)
{
  // Between concentric spheres the ray along the normal is 0.3 long.
  const Shape shell = Union(shapes::Icosphere(3, 2.0), Inverted(shapes::Icosphere(3, 1.7)));
  const VolumeModel model = ModelOf(shell);
  for (Eigen::Index v = 0; v < shell.Positions.rows(); ++v)
  {
    EXPECT_GT(model.LocalDepth[v], 0.29);
    EXPECT_LT(model.LocalDepth[v], 0.34);
  }
}

TEST(HollowBody, KeepsTheVolumesOfMaterialAndCavity)
{
  for (const VolumeCorrection correction :
    { VolumeCorrection::None, VolumeCorrection::NeutralOffset, VolumeCorrection::FrameScaling })
  {
    for (const bool isCavityFirst : { false, true })
    {
      const Shape bar = HollowBar(isCavityFirst);
      const TriangleMesh mesh = MakeMesh(bar);
      const auto before = MeasureComponents(mesh, bar.Positions);
      const auto after = MeasureComponents(mesh, Bent(bar, correction, 1.5));
      for (std::size_t c = 0; c < before.size(); ++c)
      {
        EXPECT_NEAR(after[c].Volume, before[c].Volume, 1e-9) << c;
      }
    }
  }
}

TEST(HollowBody, InsideOutIsNamedWithAllThatIsInside)
{
  const VolumeModel model = ModelOf(Inverted(HollowBar(false)));
  EXPECT_TRUE(model.IsEmpty());
  EXPECT_NE(model.Warning.find("2 components (ids 0, 1) that are oriented inside out: flip the "
                               "triangles (Surface Normals with Flip Normals"),
    std::string::npos)
    << model.Warning;
  // Following the advice helps.
  EXPECT_EQ(ModelOf(HollowBar(false)).Warning, "");

  Shape beside = Inverted(Bar(1.0, 4.0, 0.0));
  beside.Positions.col(0).array() += 5.0;
  const VolumeModel mixed = ModelOf(Union(HollowBar(false), beside));
  EXPECT_EQ(mixed.EnclosesVolume, std::vector<char>({ 1, 1, 0 }));
  EXPECT_NE(mixed.Warning.find("1 component (id 2) that are oriented inside out: flip the "
                               "triangles of these components alone"),
    std::string::npos)
    << mixed.Warning;
}

TEST(HollowBody, SheetsWithTwoSidesAreNoInsideOutSurfaces)
{
  Shape sheet = Bar(0.4, 1.0, 0.0);
  sheet.Positions.col(0).setConstant(3.0);
  for (const Shape& either : { sheet, Inverted(sheet) })
  {
    const VolumeModel model = ModelOf(Union(Bar(1.0, 4.0, 0.0), either));
    EXPECT_EQ(model.EnclosesVolume, std::vector<char>({ 1, 0 }));
    EXPECT_NE(model.Warning.find("1 component (id 1) that enclose none"), std::string::npos)
      << model.Warning;
    EXPECT_EQ(model.Warning.find("flip"), std::string::npos) << model.Warning;
  }
}

TEST(HollowBody, MorphsClosePartsOfEitherSignAlike)
{
  const Shape bar = HollowBar(false);
  const auto close = [](const Shape& shape)
  {
    KeyFrames keys;
    keys.Mesh = std::make_shared<TriangleMesh>(MakeMesh(shape));
    keys.Positions = { shape.Positions, 2.0 * shape.Positions };
    keys.Parameters = { 0.0, 1.0 };
    const MorphVolume volume(keys);
    EXPECT_EQ(volume.GetWarning(), "");
    Points positions = 1.2 * shape.Positions;
    EXPECT_EQ(volume.Close(0.5, positions), "");
    const auto components = MeasureComponents(*keys.Mesh, positions);
    const auto rest = MeasureComponents(*keys.Mesh, shape.Positions);
    for (std::size_t c = 0; c < rest.size(); ++c)
    {
      EXPECT_NEAR(components[c].Volume, 4.5 * rest[c].Volume, 1e-8);
    }
    return positions;
  };
  EXPECT_LT((close(bar) - close(Inverted(bar))).cwiseAbs().maxCoeff(), 1e-10);
}
