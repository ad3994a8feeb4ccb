// SPDX-License-Identifier: BSD-3-Clause
// What the filters advise for surfaces that they refuse or doubt.
#include "Advice.h"
#include "PrepareShapes.h"

#include "vtkCurvatureError.h"
#include "vtkDiscreteForms.h"
#include "vtkMarkHandle.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkSurfaceMorph.h"
#include "vtkVolumeChange.h"

#include "vtkDataSetSurfaceFilter.h"
#include "vtkTable.h"
#include "vtkTexturedSphereSource.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVariant.h"

#include <utility>

using vtktest::Advice;
using vtktest::Advised;
using vtktest::MakePolyData;

namespace
{
/// Points in the same place become one.
shapes::Shape Joined(const shapes::Shape& shape)
{
  std::vector<Eigen::Vector3d> positions;
  shapes::Shape joined = shape;
  for (Eigen::Index corner = 0; corner < shape.Faces.size(); ++corner)
  {
    const Eigen::Vector3d x = shape.Positions.row(shape.Faces.data()[corner]);
    const auto known = std::find_if(positions.begin(), positions.end(),
      [&x](const Eigen::Vector3d& y) { return (x - y).norm() < 1e-9; });
    joined.Faces.data()[corner] = static_cast<int>(known - positions.begin());
    if (known == positions.end())
    {
      positions.push_back(x);
    }
  }
  joined.Positions = shapes::ToPoints(positions);
  return joined;
}

/// All that the kinds of filters say to a surface.
std::vector<std::string> SaidTo(vtkPolyData* surface)
{
  vtkNew<vtkRotationInvariantDeformation> deform;
  vtktest::MarkEnds(surface, 0.1, 0.9);
  deform->SetHandleMotion(2, vtktest::Turn(5.0));
  vtkNew<vtkMarkHandle> mark;
  mark->SetRegionSourceToAllPoints();
  mark->SetGrowRings(1);
  vtkNew<vtkSurfaceMorph> morph;
  morph->AddInputData(surface);
  morph->AddInputData(surface);
  morph->SetParameter(0.5);
  vtkNew<vtkCurvatureError> curvature;
  vtkNew<vtkVolumeChange> volume;
  volume->SetReferenceData(surface);
  vtkNew<vtkDiscreteForms> forms;
  std::vector<std::string> said;
  for (vtkAlgorithm* filter :
    std::initializer_list<vtkAlgorithm*>{ deform, mark, morph, curvature, volume, forms })
  {
    if (filter != morph.Get())
    {
      filter->SetInputDataObject(0, surface);
    }
    const auto log = vtktest::Observe(filter);
    filter->Update();
    said.push_back("");
    for (const std::vector<std::string>& messages : { log->Errors, log->Warnings })
    {
      for (const std::string& message : messages)
      {
        said.back() += message;
      }
    }
  }
  return said;
}

double VolumeOf(vtkPolyData* surface)
{
  Advised<vtkVolumeChange> volume;
  volume->SetInputData(surface);
  volume->SetReferenceData(surface);
  volume.Works();
  EXPECT_EQ(volume->GetRelativeVolumeChange(), 0.0); // NaN where it is open
  return vtktest::SignedVolume(surface);
}

/// A surface that every filter refuses, or warns of, until it is prepared.
struct Unprepared
{
  shapes::Shape Surface;
  std::vector<std::string> Parts;
  double Volume = 0.0;
};

void ExpectPreparationHelps(
  const Unprepared& one, const std::function<void(vtkPrepareSurface*)>& set = {})
{
  const auto surface = MakePolyData(one.Surface);
  for (const std::string& message : SaidTo(surface))
  {
    vtktest::ExpectMessage({ message }, one.Parts);
  }
  const auto prepared = vtktest::Prepared(surface, set);
  for (const std::string& message : SaidTo(prepared))
  {
    EXPECT_EQ(message.find(one.Parts.back()), std::string::npos) << message;
    EXPECT_EQ(message.find("ERROR"), std::string::npos) << message;
  }
  EXPECT_NEAR(VolumeOf(prepared), one.Volume, 1e-9);
}
}

TEST(AdviceOnSurfaces, PrepareSurfaceCutsEdgesOfFourTriangles)
{
  ExpectPreparationHelps({ Joined(shapes::Union(shapes::Box(), shapes::Box({ 1, 1, 0 }))),
    { "1 edge (id ", "more than two triangles",
      Advice("cut the surface there with Prepare Surface.") },
    2.0 });
}

TEST(AdviceOnSurfaces, PrepareSurfaceGivesEachFanAPoint)
{
  ExpectPreparationHelps({ Joined(shapes::Union(shapes::Box(), shapes::Box({ 1, 1, 1 }))),
    { "1 point (id ", "several fans",
      Advice("give each fan a point of its own with Prepare Surface.") },
    2.0 });
}

TEST(AdviceOnSurfaces, PrepareSurfaceOrients)
{
  const shapes::Shape sphere = shapes::Icosphere(2);
  ExpectPreparationHelps({ shapes::RandomlyTurned(sphere, 3),
    { "edges (ids ", "opposite orientation", Advice("orient the surface with Prepare Surface.") },
    shapes::Volume(sphere.Positions, sphere.Faces) });
}

TEST(AdviceOnSurfaces, PrepareSurfaceMergesBordersWithTheToleranceThatIsNamed)
{
  const shapes::Shape sphere = shapes::Icosphere(2);
  for (const double noise : { 0.0, 1e-9 })
  {
    const shapes::Shape soup = shapes::Noisy(shapes::Soup(sphere), noise);
    const std::string advice =
      Advice("Merge these points with vtkPrepareSurface (Prepare Surface), Tolerance ");
    std::string message;
    for (const std::string& said : SaidTo(MakePolyData(soup)))
    {
      message = said.empty() ? message : said; // Mark Handle needs no closed surface
    }
    const double tolerance = vtktest::NumberAfter(message, advice);
    EXPECT_EQ(tolerance > 0.0, noise > 0.0);
    Advised<vtkDiscreteForms> forms;
    forms->SetInputData(MakePolyData(soup));
    forms.Warns({ "960 border edges that coincide, at 960 points (ids 0, 1, 2, 3, 4, ...)" });
    const auto prepared = vtktest::Prepared(MakePolyData(soup),
      [tolerance](vtkPrepareSurface* prepare) { prepare->SetTolerance(tolerance); });
    EXPECT_EQ(prepared->GetNumberOfPoints(), sphere.NumberOfVertices());
    forms->SetInputData(prepared);
    forms.Works();
    EXPECT_NEAR(VolumeOf(prepared), shapes::Volume(sphere.Positions, sphere.Faces), 1e-6);
  }
}

TEST(AdviceOnSurfaces, TheNoteOfAnOpenVolumeNamesTheTolerance)
{
  vtkNew<vtkTexturedSphereSource> source; // its seam is open by rounding
  source->SetThetaResolution(40);
  source->SetPhiResolution(20);
  source->Update();
  vtkNew<vtkVolumeChange> volume;
  const auto log = vtktest::Observe(volume);
  volume->SetInputData(source->GetOutput());
  volume->SetReferenceData(source->GetOutput());
  volume->Update();
  const std::string note = volume->GetChangeTable()->GetValueByName(0, "Note").ToString();
  EXPECT_NE(note.find("40 border edges coincide"), std::string::npos) << note;
  const double tolerance =
    vtktest::NumberAfter(note, Advice("merge their points (Prepare Surface, Tolerance "));
  const auto prepared = vtktest::Prepared(source->GetOutput(),
    [tolerance](vtkPrepareSurface* prepare) { prepare->SetTolerance(tolerance); });
  EXPECT_NEAR(VolumeOf(prepared), shapes::Pi / 6.0, 0.02);
}

TEST(AdviceOnSurfaces, CellsWithMissingPointsAreRepairedByRemoval)
{
  const shapes::Shape sphere = shapes::Icosphere(1);
  const auto bad = MakePolyData(sphere);
  bad->GetPolys()->InsertNextCell({ 0, 1, 1000 });
  for (const std::string& message : SaidTo(bad))
  {
    vtktest::ExpectMessage({ message },
      { "1 cell (id 80)", "a point that does not exist", Advice("repair the cells.") });
  }
  bad->SetPolys(MakePolyData(sphere)->GetPolys());
  EXPECT_NEAR(VolumeOf(bad), shapes::Volume(sphere.Positions, sphere.Faces), 1e-12);
}

TEST(AdviceOnSurfaces, PointsThatAreNotFiniteAreRepairedOrRemoved)
{
  const shapes::Shape sphere = shapes::Icosphere(2);
  shapes::Shape bad = sphere;
  bad.Positions(7, 2) = std::numeric_limits<double>::quiet_NaN();
  std::vector<vtkIdType> ids;
  for (const std::string& message : SaidTo(MakePolyData(bad)))
  {
    vtktest::ExpectMessage(
      { message }, { "1 point (id 7)", "NaN or infinite", Advice("repair or remove them.") });
    ids = vtktest::IdsAfter(message, "1 point (id ");
  }
  ASSERT_EQ(ids, std::vector<vtkIdType>{ 7 });
  shapes::Shape repaired = bad;
  repaired.Positions(ids[0], 2) = sphere.Positions(ids[0], 2);
  EXPECT_NEAR(
    VolumeOf(MakePolyData(repaired)), shapes::Volume(sphere.Positions, sphere.Faces), 1e-12);

  // A point that is in no triangle is not looked at.
  std::vector<Eigen::Vector3i> without;
  for (Eigen::Index t = 0; t < bad.Faces.rows(); ++t)
  {
    if ((bad.Faces.row(t).array() != static_cast<int>(ids[0])).all())
    {
      without.emplace_back(bad.Faces.row(t));
    }
  }
  bad.Faces = shapes::ToTriangles(without);
  for (const std::string& message : SaidTo(MakePolyData(bad)))
  {
    EXPECT_EQ(message.find("NaN"), std::string::npos) << message;
  }
}

TEST(AdviceOnSurfaces, AVolumeMeshNeedsItsSurface)
{
  vtkNew<vtkPolyData> none;
  none->SetPoints(MakePolyData(shapes::Plane(1))->GetPoints());
  Advised<vtkDiscreteForms> forms;
  forms->SetInputData(none);
  forms.Refuses({ "no triangles: 0 polygons",
    Advice("Give a surface (Extract Surface makes one of a volume mesh).") });
  vtkNew<vtkUnstructuredGrid> tetrahedron;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 4; ++i)
  {
    points->InsertNextPoint(i == 1, i == 2, i == 3);
  }
  tetrahedron->SetPoints(points);
  const vtkIdType ids[4] = { 0, 1, 2, 3 };
  tetrahedron->InsertNextCell(VTK_TETRA, 4, ids);
  vtkNew<vtkDataSetSurfaceFilter> extract;
  extract->SetInputData(tetrahedron);
  extract->Update();
  forms->SetInputData(extract->GetOutput());
  forms.Works();
  EXPECT_NEAR(VolumeOf(extract->GetOutput()), 1.0 / 6.0, 1e-12);
}

TEST(AdviceOnSurfaces, DoubledCornersGoWithPrepareSurface)
{
  // Filters ignore such cells; the kernel refuses them.
  shapes::Shape shape = shapes::Icosphere(1);
  const double volume = shapes::Volume(shape.Positions, shape.Faces);
  shape.Faces.conservativeResize(81, 3);
  shape.Faces.row(80) << 3, 3, 5;
  const cartan::MeshReport report = cartan::TriangleMesh::Check(shape.Positions, shape.Faces);
  vtktest::ExpectMessage({ report.DescribeErrors() },
    { "1 triangle (id 80)", Advice("using a point twice: remove them with Prepare Surface.") });
  const auto prepared = vtktest::Prepared(MakePolyData(shape));
  EXPECT_EQ(prepared->GetNumberOfPolys(), 80);
  EXPECT_NEAR(VolumeOf(prepared), volume, 1e-12);
}
