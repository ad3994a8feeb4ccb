// SPDX-License-Identifier: BSD-3-Clause
// What the morph advises.
#include "Advice.h"
#include "MorphShapes.h"
#include "PrepareShapes.h"
#include "TimeSource.h"

#include "vtkMarkHandle.h"
#include "vtkSurfaceMorph.h"

#include "vtkAppendFilter.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkExtractBlock.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPlane.h"

#include <cmath>

using cartan::Points;
using shapes::Shape;
using vtktest::Advice;
using vtktest::Advised;
using vtktest::MakePolyData;

namespace
{
const Shape Tube = shapes::OpenCylinder(8, 12, 1.0, 6.0);
const double NaN = std::numeric_limits<double>::quiet_NaN();

Points BentTube(double degrees)
{
  return degrees == 0.0 ? Tube.Positions : morphshapes::Bend(Tube, degrees, 0.0, 6.0);
}

/// Key frames of one connectivity.
struct Morph : Advised<vtkSurfaceMorph>
{
  Morph(const Shape& first, const std::vector<Points>& others, double parameter = 0.5)
    : Faces(first.Faces)
  {
    this->SetKeys({ first.Positions });
    for (const Points& positions : others)
    {
      this->AddKey(positions);
    }
    (*this)->SetParameter(parameter);
  }
  void AddKey(const Points& positions)
  {
    this->Keys.push_back(MakePolyData({ positions, this->Faces }));
    (*this)->AddInputData(this->Keys.back());
  }
  void SetKeys(const std::vector<Points>& positions)
  {
    (*this)->RemoveAllInputConnections(0);
    this->Keys.clear();
    for (const Points& key : positions)
    {
      this->AddKey(key);
    }
  }
  /// Quiet, and each edge has a length between those in these two key frames, up to
  /// this part of it.
  void KeepsLengths(const Points& before, const Points& after, double t, double tolerance)
  {
    const auto keys = morphshapes::Keys({ before, this->Faces }, { before, after });
    const auto figures = morphshapes::MeasureMorph(keys, vtktest::PointsOf(this->Works()), t);
    EXPECT_LT(figures.EdgeMax, tolerance);
  }

  cartan::Triangles Faces;
  std::vector<vtkSmartPointer<vtkPolyData>> Keys;
};

/// All corners at point `from` move to point `to`; triangles that use it twice go.
cartan::Triangles Merged(const cartan::Triangles& faces, int from, int to)
{
  std::vector<Eigen::Vector3i> merged;
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    const Eigen::Vector3i face = (faces.row(t).array() == from).select(to, faces.row(t));
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0])
    {
      merged.push_back(face);
    }
  }
  return shapes::ToTriangles(merged);
}
}

TEST(AdviceOnMorphs, ArraysAreGivenToEveryKeyFrame)
{
  Morph morph(Tube, { BentTube(40.0) });
  const auto add = [&](std::size_t key, double value)
  {
    vtktest::AddArray(
      morph.Keys[key], "Heat", 1, [value](vtkIdType, double* heat) { *heat = value; });
    morph.Keys[key]->Modified();
  };
  add(0, 1.0);
  morph.Warns({ "The arrays \"Heat\" are left out", Advice("Give them to every key frame.") });
  add(1, 3.0);
  const auto between = morph.Works();
  ASSERT_NE(between->GetPointData()->GetArray("Heat"), nullptr);
  EXPECT_EQ(between->GetPointData()->GetArray("Heat")->GetTuple1(5), 2.0);
}

TEST(AdviceOnMorphs, PointsToPinAreMarkedOrTheSurfaceIsPlacedRigidly)
{
  Morph morph(Tube, { BentTube(40.0) });
  const auto first = vtktest::CopyOf(morph.Keys[0]);
  const auto last = morph.Keys[1];
  const auto setFirst = [&](vtkPolyData* surface)
  {
    morph->RemoveAllInputConnections(0);
    morph->AddInputData(surface);
    morph->AddInputData(last);
  };
  const auto mark = [&](double below, int points)
  {
    Advised<vtkMarkHandle> filter;
    vtkNew<vtkPlane> plane;
    plane->SetOrigin(0.0, 0.0, below);
    plane->SetNormal(0.0, 0.0, 1.0);
    filter->SetInputData(first);
    if (points > 0)
    {
      filter->SetRegion(plane);
      filter.Works();
      EXPECT_EQ(filter->GetNumberOfMarkedPoints(), points);
    }
    else
    {
      filter.Warns({ "No point is marked" });
    }
    return vtktest::CopyOf(filter->GetOutput());
  };
  const auto expectPinned = [&](vtkPolyData* between)
  {
    for (vtkIdType v = 0; v < 8; ++v) // the end that is the same in both
    {
      EXPECT_LT(
        (Eigen::Vector3d(between->GetPoint(v)) - Eigen::Vector3d(first->GetPoint(v))).norm(), 1e-3);
    }
  };
  morph->SetPlacementToPinnedHandle();
  setFirst(mark(0.0, 0));
  morph.Refuses({ "No point of the first key frame has a value above 0 in \"Handle\"",
    Advice("mark the points to pin (Mark Handle), or place by rigid interpolation.") });
  setFirst(mark(0.1, 8));
  expectPinned(morph.Works());
  setFirst(mark(0.0, 0));
  morph->SetPlacementToRigidInterpolation();
  morph.Works();

  const auto line = vtktest::CopyOf(first);
  vtktest::AddArray(line, "Handle", 1, [](vtkIdType v, double* handle) { *handle = v < 2; });
  setFirst(line);
  morph->SetPlacementToPinnedHandle();
  morph.Refuses(
    { "all on one line in 1 component (id 0)", Advice("mark three points or more that are not.") });
  vtktest::AddArray(line, "Handle", 1, [](vtkIdType v, double* handle) { *handle = v < 3; });
  setFirst(vtktest::CopyOf(line));
  expectPinned(morph.Works());
}

TEST(AdviceOnMorphs, ParametersStayNearTheKeyFrames)
{
  // Beyond the first key frame lengths would come to be 1 + 2 t times what they are.
  Morph morph(Tube, { 3.0 * Tube.Positions }, -1.0);
  morph.Refuses({ "At the parameter -1.0", "edges of negative length would be needed around",
    Advice("choose a parameter nearer to those of the key frames.") });
  const auto expectScale = [&](double parameter)
  {
    morph->SetParameter(parameter);
    morph.KeepsLengths(Tube.Positions, 3.0 * Tube.Positions, parameter, 1e-9);
  };
  expectScale(-0.4);
  expectScale(0.5);

  morph->SetMethodToIsometric();
  morph->SetParameter(-1.0);
  morph.Refuses({ "At the parameter -1.0", "edges (ids ", "would not be positive",
    Advice("stay closer to the key frames.") });
  expectScale(-0.4);

  morph->SetParameter(NaN);
  morph.Refuses({ "Parameter is not a number", Advice("give one in [0, 1].") });
  expectScale(1.0);
}

TEST(AdviceOnMorphs, LengthsAreKeptByTheIsometricMethodOrByAKeyFrameInBetween)
{
  const Shape tube = shapes::OpenCylinder(6, 6, 1.0, 6.0);
  const Points half = morphshapes::Twist(tube, 500.0, 0.0, 6.0);
  const Points last = morphshapes::Twist(tube, 1000.0, 0.0, 6.0);
  Morph morph(tube, { last });
  const std::string message = morph.Warns({ "At the parameter 0.5", "the length of ",
    "by more than 25 %", Advice("Try the Isometric method, or add a key frame in between.") });
  EXPECT_GT(vtktest::NumberAfter(message, "it is by "), 25.0);
  morph->SetMethodToIsometric();
  morph.KeepsLengths(tube.Positions, last, 0.5, 0.25);

  morph->SetMethodToDiscreteForms();
  morph.SetKeys({ tube.Positions, half, last });
  morph->SetParameter(0.25);
  morph.KeepsLengths(tube.Positions, half, 0.5, 0.1);

  // Bent by more than a circle, through itself: one in between asks for two more.
  Morph bent(Tube, { BentTube(400.0) }, 0.7);
  bent->SetMethodToIsometric();
  const std::vector<std::string> parts = { "At the parameter 0.7", "by more than 25 %",
    Advice("Add a key frame in between.") };
  bent.Warns(parts);
  bent.SetKeys({ Tube.Positions, BentTube(200.0), BentTube(400.0) });
  bent.Warns(parts);
  bent.SetKeys(
    { Tube.Positions, BentTube(100.0), BentTube(200.0), BentTube(300.0), BentTube(400.0) });
  bent.KeepsLengths(BentTube(200.0), BentTube(300.0), 0.8, 0.25);
}

TEST(AdviceOnMorphs, FramesAreTheBestWithAKeyFrameInBetween)
{
  Morph isometric(Tube, { BentTube(400.0) });
  isometric->SetMethodToIsometric();
  isometric.Warns({ "The frames at the parameter 0.5", "are not the best",
    Advice("The surface passes through itself, or the key frames are far from each other; add one "
           "in between.") });
  for (const double parameter : { 0.5, 0.4 })
  {
    isometric.SetKeys({ Tube.Positions, BentTube(200.0), BentTube(400.0) });
    isometric->SetParameter(parameter);
    isometric.KeepsLengths(Tube.Positions, BentTube(200.0), 2.0 * parameter, 0.1);
  }

  const Points last = shapes::Noisy(Tube, 20.0, 3).Positions;
  Morph forms(Tube, { last });
  forms->SetTransitionInterpolationToForms();
  forms.Warns({ "The frames at the parameter 0.5", "are not the best",
    Advice("The key frames are far from each other; add one in between.") });
  std::vector<Points> keys;
  for (int k = 0; k <= 4; ++k)
  {
    keys.emplace_back((1.0 - 0.25 * k) * Tube.Positions + 0.25 * k * last);
  }
  forms.SetKeys(keys);
  EXPECT_EQ(vtktest::PointsOf(forms.Works()), keys[2]);
  forms->SetParameter(0.6);
  forms.Works();
}

TEST(AdviceOnMorphs, EdgesOfNoLengthArePulledApartOrMergedEverywhere)
{
  Points last = BentTube(40.0);
  last.row(1) = last.row(0);
  Morph morph(Tube, { last });
  morph->SetMethodToIsometric();
  vtkNew<vtkSurfaceMorph> filter; // which warns of triangles without area, too
  filter->AddInputData(morph.Keys[0]);
  filter->AddInputData(morph.Keys[1]);
  filter->SetMethodToIsometric();
  filter->SetParameter(0.5);
  const auto log = vtktest::Observe(filter);
  filter->Update();
  vtktest::ExpectMessage(log->Errors,
    { "Key frame 1 has 1 edge (id 0) of no length",
      Advice("move their end points apart, or merge them in all key frames.") });
  morph.SetKeys({ Tube.Positions, BentTube(40.0) });
  morph.KeepsLengths(Tube.Positions, BentTube(40.0), 0.5, 0.1);
  morph.Faces = Merged(Tube.Faces, 1, 0);
  morph.SetKeys({ Tube.Positions, last });
  morph.KeepsLengths(Tube.Positions, last, 0.5, 0.1);
}

TEST(AdviceOnMorphs, ComponentsWithoutAreaGoOrAnotherMethodTakesThem)
{
  Shape flat;
  flat.Positions.resize(3, 3);
  flat.Positions << 5, 0, 0, 6, 0, 0, 8, 0, 0;
  flat.Faces.resize(1, 3);
  flat.Faces << 0, 1, 2;
  const Shape both = shapes::Union(Tube, flat);
  const auto first = MakePolyData(both);
  const auto last = MakePolyData({ 2.0 * both.Positions, both.Faces });
  vtkNew<vtkSurfaceMorph> filter; // which warns of the triangle, too
  filter->AddInputData(first);
  filter->AddInputData(last);
  filter->SetMethodToDeformationGradient();
  filter->SetParameter(0.5);
  const auto log = vtktest::Observe(filter);
  filter->Update();
  vtktest::ExpectMessage(log->Errors,
    { "1 component (id 1) in which no triangle has an area",
      Advice("remove such components, or choose another method.") });
  log->Clear();
  filter->SetMethodToIsometric();
  filter->Update();
  EXPECT_TRUE(log->Errors.empty());

  const auto remove = [](vtkPrepareSurface* prepare) { prepare->SetMinimumComponentArea(1e-9); };
  const auto before = vtktest::Prepared(first, remove);
  const auto after = vtktest::Prepared(last, remove);
  EXPECT_EQ(before->GetNumberOfPoints(), Tube.NumberOfVertices());
  Advised<vtkSurfaceMorph> morph;
  morph->AddInputData(before);
  morph->AddInputData(after);
  morph->SetMethodToDeformationGradient();
  morph->SetParameter(0.5);
  const Points middle = vtktest::PointsOf(morph.Works());
  EXPECT_LT((middle - 1.5 * Tube.Positions).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(AdviceOnMorphs, BlocksBecomeSurfacesOfTheirOwn)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, MakePolyData(Tube));
  blocks->SetBlock(1, MakePolyData({ 2.0 * Tube.Positions, Tube.Faces }));
  vtkNew<vtkSurfaceMorph> refusing;
  const auto log = vtktest::Observe(refusing);
  refusing->SetInputDataObject(blocks);
  refusing->Update();
  ASSERT_FALSE(log->Errors.empty()); // one for each block
  vtktest::ExpectMessage({ log->Errors.front() },
    { "composite",
      Advice("make a surface of it (Merge Blocks, then Extract Surface), or one of each of its "
             "blocks (Extract Block first).") });
  Advised<vtkSurfaceMorph> morph;
  for (unsigned int block = 1; block <= 2; ++block)
  {
    vtkNew<vtkExtractBlock> extract;
    extract->SetInputData(blocks);
    extract->AddIndex(block);
    extract->Update(); // still a composite
    vtkNew<vtkAppendFilter> merge;
    auto* extracted = vtkMultiBlockDataSet::SafeDownCast(extract->GetOutputDataObject(0));
    for (unsigned int i = 0; i < extracted->GetNumberOfBlocks(); ++i)
    {
      merge->AddInputDataObject(extracted->GetBlock(i));
    }
    vtkNew<vtkDataSetSurfaceFilter> surface;
    surface->SetInputConnection(merge->GetOutputPort());
    surface->Update();
    morph->AddInputData(vtktest::CopyOf(surface->GetOutput()));
  }
  morph->SetParameter(0.5);
  EXPECT_EQ(morph.Works()->GetNumberOfPoints(), Tube.NumberOfVertices());
}

TEST(AdviceOnMorphs, KeyFramesAreOneSurfaceInSeveralPoses)
{
  Morph morph(Tube, {});
  morph.Refuses({ "There is one key frame only",
    Advice("give two surfaces or more, or one with time steps.") });
  morph->AddInputData(MakePolyData(shapes::Plane(4)));
  const std::string advice = Advice("Key frames need the same points and cells in the same order, "
                                    "such as one surface in several poses.");
  morph.Refuses({ "The key frame 0 has 104 points, the key frame 1 25.", advice });
  Shape reordered = Tube;
  reordered.Faces.row(5).swap(reordered.Faces.row(6));
  morph.SetKeys({ Tube.Positions });
  morph->AddInputData(MakePolyData(reordered));
  morph.Refuses({ "2 cells (ids 5, 6)", advice });
  morph.SetKeys({ Tube.Positions, BentTube(40.0) });
  morph.KeepsLengths(Tube.Positions, BentTube(40.0), 0.5, 0.1);
}

TEST(AdviceOnMorphs, TimesComeOnceInIncreasingOrder)
{
  vtkNew<vtktest::TimeSource> source;
  const std::vector<vtkSmartPointer<vtkPolyData>> steps = { MakePolyData(Tube),
    MakePolyData({ BentTube(20.0), Tube.Faces }), MakePolyData({ BentTube(40.0), Tube.Faces }) };
  source->SetSteps({ 0.0, 1.0, 1.0 }, steps);
  Advised<vtkSurfaceMorph> morph;
  morph->SetInputConnection(source->GetOutputPort());
  morph->SetParameter(1.0);
  morph.Refuses({ "time step 2 is at 1.000000 after 1.000000",
    Advice("Give each time once, in increasing order.") });
  source->SetSteps({ 0.0, 1.0, 2.0 }, steps);
  EXPECT_EQ(vtktest::PointsOf(morph.Works()), BentTube(40.0));
}
