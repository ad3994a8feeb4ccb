// SPDX-License-Identifier: BSD-3-Clause
#include "Advice.h"
#include "VolumeShapes.h"

#include "vtkPrepareSurface.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkVolumetricDeformation.h"

#include "vtkCellTypes.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkDataSetTriangleFilter.h"
#include "vtkUnstructuredGrid.h"

namespace
{
using vtktest::Advice;
using vtktest::Advised;
using vtktest::MarkedBar;
using vtktest::Turn;

/// The solid of MarkedBar().
vtkSmartPointer<vtkUnstructuredGrid> SolidBar(int precision = VTK_DOUBLE)
{
  const shapes::SolidBar bar(2, 2, 8, { 1.0, 1.0, 4.0 });
  vtkNew<vtkPoints> points;
  points->SetDataType(precision);
  for (Eigen::Index i = bar.Nodes.rows() - 1; i >= 0; --i) // not in the surface's order
  {
    points->InsertNextPoint(bar.Nodes.row(i).data());
  }
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(points);
  for (Eigen::Index t = 0; t < bar.Cells.rows(); ++t)
  {
    const Eigen::RowVector4i nodes = bar.Cells.row(t);
    const vtkIdType last = bar.Nodes.rows() - 1;
    const vtkIdType ids[4] = { last - nodes[0], last - nodes[1], last - nodes[2], last - nodes[3] };
    grid->InsertNextCell(VTK_TETRA, 4, ids);
  }
  vtkNew<vtkDoubleArray> array;
  array->SetName("Pressure");
  array->SetNumberOfTuples(grid->GetNumberOfPoints());
  array->Fill(7.0);
  grid->GetPointData()->AddArray(array);
  return grid;
}

Advised<vtkVolumetricDeformation>& Bend(
  Advised<vtkVolumetricDeformation>& filter, vtkPolyData* surface, double degrees = 60.0)
{
  filter->SetInputData(surface);
  filter->SetHandleMotion(2, Turn(degrees));
  return filter;
}

TEST(VolumetricDeformation, DeformsTheSurfaceWithItsInside)
{
  const auto bar = MarkedBar();
  Advised<vtkVolumetricDeformation> filter;
  const auto result = Bend(filter, bar).Works();
  vtktest::ExpectEnds(result, bar, Turn(60.0));
  EXPECT_GT(filter->GetNumberOfAddedPoints(), bar->GetNumberOfPoints());
  EXPECT_EQ(filter->GetVolumeMesh()->GetNumberOfPoints(), 0);
  const int withLayer = filter->GetNumberOfAddedPoints();
  filter->OuterLayerOff();
  filter.Works();
  EXPECT_EQ(filter->GetNumberOfAddedPoints(), withLayer - bar->GetNumberOfPoints());
  // A motion alone needs no factorization, nor do rounds.
  const int factorizations = filter->GetNumberOfFactorizations();
  filter->SetVolumeRounds(5);
  filter->SetHandleMotion(2, Turn(30.0));
  filter.Works();
  EXPECT_EQ(filter->GetNumberOfFactorizations(), factorizations);
  filter->SetLatticeSpacing(0.21);
  filter.Works();
  EXPECT_GT(filter->GetNumberOfFactorizations(), factorizations);
}

TEST(VolumetricDeformation, MovesAVolumeMeshWithItsSurface)
{
  for (const int precision : { VTK_DOUBLE, VTK_FLOAT })
  {
    const auto bar = MarkedBar();
    const auto solid = SolidBar(precision);
    Advised<vtkVolumetricDeformation> filter;
    filter->SetVolumeMeshData(solid);
    const auto surface = Bend(filter, bar).Works();
    vtkUnstructuredGrid* deformed = filter->GetVolumeMesh();
    ASSERT_EQ(deformed->GetNumberOfPoints(), solid->GetNumberOfPoints());
    ASSERT_EQ(deformed->GetNumberOfCells(), solid->GetNumberOfCells());
    EXPECT_EQ(deformed->GetPoints()->GetDataType(), precision);
    EXPECT_NE(deformed->GetPointData()->GetArray("Pressure"), nullptr);
    EXPECT_EQ(filter->GetNumberOfInvertedCells(), 0);
    EXPECT_EQ(filter->GetNumberOfAddedPoints(), 7); // 3 x 3 x 9 points, 74 on the surface
    int found = 0;
    for (vtkIdType v = 0; v < bar->GetNumberOfPoints(); ++v)
    {
      const Eigen::Vector3d place(bar->GetPoint(v));
      for (vtkIdType p = 0; p < solid->GetNumberOfPoints(); ++p)
      {
        if ((Eigen::Vector3d(solid->GetPoint(p)) - place).norm() < 1e-6)
        {
          ++found;
          EXPECT_LT(
            (Eigen::Vector3d(deformed->GetPoint(p)) - Eigen::Vector3d(surface->GetPoint(v))).norm(),
            1e-6);
        }
      }
    }
    EXPECT_EQ(found, bar->GetNumberOfPoints());
    // Without the mesh again, as if it had never been there.
    filter->SetVolumeMeshData(nullptr);
    const auto without = filter.Works();
    EXPECT_EQ(filter->GetVolumeMesh()->GetNumberOfPoints(), 0);
    Advised<vtkVolumetricDeformation> fresh;
    vtktest::ExpectSameSurface(without, Bend(fresh, bar).Works());
  }
}

TEST(VolumetricDeformation, AnOpenSurfaceIsClosedOrAnotherMethodBendsIt)
{
  const auto open = vtktest::MakePolyData(shapes::OpenCylinder(12, 12, 0.5, 4.0));
  vtktest::MarkEnds(open, 0.6, 3.4);
  Advised<vtkVolumetricDeformation> filter;
  const std::string advice = Advice("A volumetric graph needs an inside: close it (Prepare Surface "
                                    "with Maximum Hole Edges), give a "
                                    "volume mesh, or use Shape Preserving Deformation.");
  Bend(filter, open).Refuses({ "24 border points", advice });
  const auto closed =
    vtktest::Prepared(open, [](vtkPrepareSurface* prepare) { prepare->SetMaximumHoleEdges(100); });
  vtktest::ExpectHandle(Bend(filter, closed).Works(), closed, 2, Turn(60.0));
  Advised<vtkShapePreservingDeformation> other;
  other->SetInputData(open);
  other->SetVolumeCorrectionToNone();
  other->SetHandleMotion(2, Turn(60.0));
  vtktest::ExpectEnds(other.Works(), open, Turn(60.0));
}

TEST(VolumetricDeformation, WhatEnclosesNothingIsBentAsASurface)
{
  shapes::Shape shape = shapes::Icosphere(2, 2.0);
  shape.Positions.col(0) *= 1e-14;
  shape.Positions.col(2).array() += 2.0;
  const auto flat = vtktest::MakePolyData(shape);
  vtktest::MarkEnds(flat, 0.6, 3.4);
  Advised<vtkVolumetricDeformation> filter;
  Bend(filter, flat, 20.0)
    .Refuses({ Advice("The surface encloses no volume, so there is no lattice inside: use Shape "
                      "Preserving Deformation.") });
  Advised<vtkShapePreservingDeformation> other;
  other->SetInputData(flat);
  other->SetHandleMotion(2, Turn(20.0));
  other->Update();
  vtktest::ExpectEnds(other->GetOutput(), flat, Turn(20.0), 1e-6);
}

TEST(VolumetricDeformation, ALatticeThatIsTooFineGetsTheSpacingThatFits)
{
  const auto bar = MarkedBar();
  Advised<vtkVolumetricDeformation> filter;
  filter->SetLatticeSpacing(1e-3);
  const std::string message = Bend(filter, bar).Refuses({ Advice("Set LatticeSpacing to ") });
  const double spacing = vtktest::NumberAfter(message, "Set LatticeSpacing to ");
  EXPECT_GT(spacing, 1e-3);
  EXPECT_LT(spacing, 0.03);
  filter->SetLatticeSpacing(10.0 * spacing); // as it says, "or more", to spare time
  vtktest::ExpectEnds(filter.Works(), bar, Turn(60.0));
  filter->SetLatticeSpacing(1e-3);
  filter.Refuses({ Advice(" or more, or to 0.") });
  filter->SetLatticeSpacing(0.0);
  filter.Works();
}

TEST(VolumetricDeformation, ArraysNeedAnotherMethod)
{
  const auto bar = MarkedBar();
  vtktest::AddArray(bar, "Turn", 3,
    [&](vtkIdType v, double* vector)
    {
      vector[0] = bar->GetPoint(v)[2] > 3.4 ? 0.5 : 0.0;
      vector[1] = vector[2] = 0.0;
    });
  Advised<vtkVolumetricDeformation> filter;
  filter->SetInputData(bar);
  filter->SetRotationVectorArrayName("Turn");
  filter.Refuses(
    { "Volumetric deformation", Advice("give each handle a motion, or choose another method.") });
  filter->SetHandleMotion(1, Turn(0.0));
  vtktest::ExpectEnds(Bend(filter, bar).Works(), bar, Turn(60.0));
}

TEST(VolumetricDeformation, VolumeMeshesAreTetrahedraAroundTheSurfacesPoints)
{
  const auto bar = MarkedBar();
  Advised<vtkVolumetricDeformation> filter;
  Bend(filter, bar);
  // Bricks instead of tetrahedra.
  vtkNew<vtkUnstructuredGrid> bricks;
  const auto solid = SolidBar();
  bricks->SetPoints(solid->GetPoints());
  for (int brick = 0; brick < 2 * 2 * 8; ++brick)
  {
    const double low[3] = { brick % 2 * 0.5 - 0.5, brick / 2 % 2 * 0.5 - 0.5, brick / 4 * 0.5 };
    vtkIdType corners[8];
    for (int c = 0; c < 8; ++c)
    {
      corners[c] = solid->FindPoint(
        low[0] + (c & 1 ? 0.5 : 0.0), low[1] + (c & 2 ? 0.5 : 0.0), low[2] + (c & 4 ? 0.5 : 0.0));
    }
    bricks->InsertNextCell(VTK_VOXEL, 8, corners);
  }
  filter->SetVolumeMeshData(bricks);
  filter.Refuses({ "32 cells (ids 0, 1,", Advice("use Tetrahedralize first.") });
  vtkNew<vtkDataSetTriangleFilter> tetrahedralize;
  tetrahedralize->SetInputData(bricks);
  filter->SetVolumeMeshConnection(tetrahedralize->GetOutputPort());
  filter.Works();
  EXPECT_GT(filter->GetVolumeMesh()->GetNumberOfCells(), 32);
  EXPECT_EQ(filter->GetNumberOfInvertedCells(), 0);

  vtkNew<vtkUnstructuredGrid> points;
  points->SetPoints(solid->GetPoints());
  filter->SetVolumeMeshData(points);
  filter.Refuses({ Advice("The volume mesh has no tetrahedra: make some (Delaunay 3D), or "
                          "disconnect it for a lattice inside of the surface.") });
  filter->SetVolumeMeshData(nullptr);
  filter.Works();
}

TEST(VolumetricDeformation, TheSurfaceIsTakenFromTheMesh)
{
  const auto solid = SolidBar();
  const auto other = vtktest::MakePolyData(shapes::Bar(3, 3, 9, { 1.0, 1.0, 4.0 }));
  vtktest::MarkEnds(other, 0.6, 3.4);
  Advised<vtkVolumetricDeformation> filter;
  filter->SetVolumeMeshData(solid);
  Bend(filter, other).Refuses({ Advice("take the surface from it with Extract Surface.") });
  vtkNew<vtkDataSetSurfaceFilter> extract;
  extract->SetInputData(solid);
  extract->Update();
  const auto skin = vtktest::CopyOf(extract->GetOutput());
  vtktest::MarkEnds(skin, 0.6, 3.4);
  vtktest::ExpectEnds(Bend(filter, skin).Works(), skin, Turn(60.0));
  EXPECT_EQ(filter->GetNumberOfAddedPoints(), 7);
}

TEST(VolumetricDeformation, PointsInOnePlaceAreMerged)
{
  // Each triangle with points of its own.
  const auto bar = MarkedBar();
  shapes::Shape soup;
  soup.Positions.resize(3 * bar->GetNumberOfCells(), 3);
  soup.Faces.resize(bar->GetNumberOfCells(), 3);
  vtkNew<vtkIdList> ids;
  for (vtkIdType t = 0; t < bar->GetNumberOfCells(); ++t)
  {
    bar->GetCellPoints(t, ids);
    for (int c = 0; c < 3; ++c)
    {
      bar->GetPoint(ids->GetId(c), soup.Positions.row(3 * t + c).data());
      soup.Faces(t, c) = static_cast<int>(3 * t + c);
    }
  }
  const auto split = vtktest::MakePolyData(soup);
  vtktest::MarkEnds(split, 0.6, 3.4);
  Advised<vtkVolumetricDeformation> filter;
  filter->SetVolumeMeshData(SolidBar());
  const auto log = vtktest::Observe(filter.Get());
  Bend(filter, split)->Update();
  vtktest::ExpectMessage(log->Errors, { Advice("merge them with Prepare Surface.") });
  const auto prepared = vtktest::Prepared(split);
  vtktest::ExpectEnds(Bend(filter, prepared).Works(), prepared, Turn(60.0));
}

TEST(VolumetricDeformation, InvertedCellsAreCountedAndNamed)
{
  const auto bar = MarkedBar();
  Advised<vtkVolumetricDeformation> filter;
  filter->SetVolumeMeshData(SolidBar());
  // Through the other end.
  vtkNew<vtkHandleMotion> push;
  push->SetTranslation(0.0, 0.0, -4.0);
  filter->SetInputData(bar);
  filter->SetHandleMotion(2, push);
  filter->SetVolumeRounds(0);
  filter.Warns({ "cells (ids", Advice("move the handles less far.") });
  EXPECT_GT(filter->GetNumberOfInvertedCells(), 0);
  push->SetTranslation(0.0, 0.0, -0.4);
  filter.Works();
  EXPECT_EQ(filter->GetNumberOfInvertedCells(), 0);
}
}
