// SPDX-License-Identifier: BSD-3-Clause
// Measures of surfaces that stay in pieces.
#include "AdviceWords.h"
#include "SurfaceInPieces.h"

#include "vtkVolumeChange.h"

#include "vtkTable.h"

#include <map>

namespace
{
using pieces::Kind;
using pieces::Rank;
using pieces::Size;
using shapes::Advice;

/// None has slivers; the last has two components.
std::map<std::string, shapes::Shape> MeasuredShapes()
{
  shapes::Shape apart = shapes::Ellipsoid(2, { 1.0, 0.7, 0.5 });
  apart.Positions.col(0).array() += 5.0;
  return { { "bar", shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 }) },
    { "noisy ellipsoid", shapes::Noisy(shapes::Ellipsoid(3, { 3.0, 1.0, 2.0 }), 0.01) },
    { "eight", shapes::RealMesh("eight") },
    { "two bodies", shapes::Union(shapes::Torus(40, 20), apart) } };
}

/// Bent about the y axis, and stretched.
shapes::Shape BentAndStretched(shapes::Shape shape)
{
  const double size = shape.Positions.rowwise().norm().maxCoeff();
  for (Eigen::Index v = 0; v < shape.Positions.rows(); ++v)
  {
    const Eigen::Vector3d p = shape.Positions.row(v);
    const double angle = 0.8 * (p[2] + 0.5 * p[0]) / size;
    shape.Positions.row(v) = Eigen::RowVector3d(
      p[0] + size * (1.0 - std::cos(angle)), 1.2 * p[1], 0.7 * p[2] + 0.4 * size * std::sin(angle));
  }
  return shape;
}

struct Compared
{
  vtkSmartPointer<vtkPolyData> Input;
  vtkSmartPointer<vtkPolyData> Reference;
};

Compared MakeCompared(const shapes::Shape& shape)
{
  return { vtktest::MakePolyData(BentAndStretched(shape)), vtktest::MakePolyData(shape) };
}

void SetPieces(vtkVolumeChange* filter, const Compared& whole,
  const pieces::Distribution& distribution = pieces::InBlocks, const Kind& kind = {})
{
  filter->SetInputData(pieces::MyPieceOf(whole.Input, distribution, kind));
  filter->SetReferenceData(pieces::MyPieceOf(whole.Reference, distribution, kind));
}

std::map<std::string, double> NumbersOf(vtkVolumeChange* filter)
{
  return { { "volume", filter->GetRelativeVolumeChange() },
    { "area", filter->GetRelativeAreaChange() }, { "RMS", filter->GetEdgeLengthRMS() },
    { "most", filter->GetEdgeLengthMax() }, { "shape", filter->GetShapeDistance() } };
}

/// Arrays of points that a whole surface has too; directions may point either way.
void ExpectArraysOfWhole(vtkPolyData* part, vtkPolyData* whole)
{
  for (const char* name : { "AreaRatio", "EdgeLengthRatio", "LocalVolume", "LocalVolumeRatio",
         "ShapeDistanceDensity", "Stretch1", "Stretch2", "HenckyStrain1", "HenckyStrain2" })
  {
    EXPECT_LT(pieces::ArrayDifference(part, whole, name), 1e-8) << name;
  }
  for (const char* name : { "StretchDirection1", "StretchDirection2" })
  {
    EXPECT_LT(pieces::AxisDifference(part, whole, name), 1e-6) << name;
  }
}

/// Cells of a piece have the numbers of the cells of the whole, ghosts too.
void ExpectCellsOfWhole(vtkPolyData* part, vtkPolyData* whole)
{
  for (const char* name : { "AreaRatio", "Stretch1", "Stretch2", "HenckyStrain1" })
  {
    vtkDataArray* here = part->GetCellData()->GetArray(name);
    vtkDataArray* there = whole->GetCellData()->GetArray(name);
    vtkDataArray* ids = part->GetCellData()->GetArray("CellOfWhole");
    ASSERT_TRUE(part->GetNumberOfCells() == 0 || (here && ids));
    for (vtkIdType c = 0; c < part->GetNumberOfCells(); ++c)
    {
      EXPECT_NEAR(
        here->GetTuple1(c), there->GetTuple1(static_cast<vtkIdType>(ids->GetTuple1(c))), 1e-8)
        << name;
    }
  }
}

void ExpectTableOnFirstRank(vtkVolumeChange* filter, vtkTable* whole)
{
  vtkTable* table = filter->GetChangeTable();
  EXPECT_EQ(table->GetNumberOfRows(), Rank() == 0 ? whole->GetNumberOfRows() : 0);
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    for (const char* column : { "Quantity", "Note" })
    {
      EXPECT_EQ(table->GetValueByName(row, column).ToString(),
        whole->GetValueByName(row, column).ToString());
    }
    for (const char* column : { "Reference", "Current", "RelativeChange" })
    {
      const double here = table->GetValueByName(row, column).ToDouble();
      const double there = whole->GetValueByName(row, column).ToDouble();
      EXPECT_EQ(std::isnan(here), std::isnan(there)) << row << column;
      EXPECT_TRUE(std::isnan(there) || std::abs(here - there) <= 1e-8 * (1.0 + std::abs(there)))
        << row << column << here << " " << there;
    }
  }
}

void NumberCells(vtkPolyData* surface)
{
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("CellOfWhole");
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    ids->InsertNextValue(c);
  }
  surface->GetCellData()->AddArray(ids);
}

void ExpectLikeWhole(vtkVolumeChange* filter, const Compared& both,
  const std::vector<pieces::Distribution>& distributions, const std::vector<Kind>& kinds)
{
  filter->SetStrainMeasureToHencky();
  filter->SetInputData(both.Input);
  filter->SetReferenceData(both.Reference);
  filter->Update();
  const auto whole = vtktest::CopyOf(filter->GetOutput());
  vtkNew<vtkTable> table;
  table->DeepCopy(filter->GetChangeTable());
  const auto numbers = NumbersOf(filter);
  for (const pieces::Distribution& distribution : distributions)
  {
    for (const Kind& kind : kinds)
    {
      SCOPED_TRACE(&distribution - distributions.data());
      const auto log = vtktest::Observe(filter);
      SetPieces(filter, both, distribution, kind);
      pieces::UpdateTogether(filter);
      vtktest::ExpectQuiet(*log); // it was not gathered
      ExpectArraysOfWhole(filter->GetOutput(), whole);
      ExpectCellsOfWhole(filter->GetOutput(), whole);
      ExpectTableOnFirstRank(filter, table);
      for (const auto& [name, value] : NumbersOf(filter))
      {
        EXPECT_EQ(std::isnan(value), std::isnan(numbers.at(name))) << name;
        EXPECT_TRUE(std::isnan(value) || std::abs(value - numbers.at(name)) < 1e-8)
          << name << value << numbers.at(name);
      }
    }
  }
}

std::vector<Kind> SomeKinds()
{
  return { { true, true }, { false, false } };
}

TEST(KeptMeasures, VolumesChangeAsOfOneSurface)
{
  for (const auto& [name, shape] : MeasuredShapes())
  {
    SCOPED_TRACE(name);
    const Compared both = MakeCompared(shape);
    NumberCells(both.Input);
    vtkNew<vtkVolumeChange> filter;
    ExpectLikeWhole(filter, both, { pieces::InBlocks, pieces::Scattered }, SomeKinds());
  }
}

TEST(KeptMeasures, MayBeOpenEmptyOrOneTriangle)
{
  for (const shapes::Shape& shape : { shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }), shapes::Plane(9) })
  {
    SCOPED_TRACE(shape.Faces.rows());
    const Compared both = MakeCompared(shape);
    NumberCells(both.Input);
    vtkNew<vtkVolumeChange> filter;
    ExpectLikeWhole(filter, both,
      { pieces::AllOn(0), pieces::AllOn(Size() - 1),
        [](vtkIdType cell, vtkIdType)
        { return cell < Size() - 1 ? static_cast<int>(cell) : Size() - 1; } },
      SomeKinds());
  }
}

TEST(KeptMeasures, MotionsUseWhatIsKept)
{
  const auto shape = MeasuredShapes().at("bar");
  Compared both = MakeCompared(shape);
  vtkNew<vtkVolumeChange> filter;
  const auto log = vtktest::Observe(filter);
  SetPieces(filter, both);
  pieces::UpdateTogether(filter);
  const double before = filter->GetRelativeVolumeChange();
  // A surface moves alone on its way through a drag; the reference stays.
  shapes::Shape larger = shape;
  larger.Positions *= 2.0;
  both.Input = vtktest::MakePolyData(larger);
  filter->SetInputData(pieces::MyPieceOf(both.Input));
  pieces::UpdateTogether(filter);
  EXPECT_NE(filter->GetRelativeVolumeChange(), before);
  EXPECT_NEAR(filter->GetRelativeVolumeChange(), 7.0, 1e-10);
  EXPECT_NEAR(filter->GetRelativeAreaChange(), 3.0, 1e-10);
  EXPECT_NEAR(filter->GetEdgeLengthMax(), 1.0, 1e-10);
  EXPECT_NEAR(filter->GetShapeDistance(), 0.0, 1e-10);
  vtktest::ExpectQuiet(*log);
}

TEST(KeptMeasures, NaNOfOneRankIsToldOnce)
{
  const Compared both = MakeCompared(MeasuredShapes().at("bar"));
  vtkNew<vtkVolumeChange> filter;
  const auto log = vtktest::Observe(filter);
  SetPieces(filter, both);
  const vtkIdType last = both.Input->GetNumberOfPoints() - 1;
  auto* piece = vtkPolyData::SafeDownCast(filter->GetInputDataObject(0, 0));
  vtkDataArray* ids = piece->GetPointData()->GetArray("Id");
  for (vtkIdType v = 0; v < piece->GetNumberOfPoints(); ++v)
  {
    if (ids->GetTuple1(v) == static_cast<double>(last))
    {
      piece->GetPoints()->SetPoint(v, std::nan(""), 0.0, 0.0);
    }
  }
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Errors,
    { "1 point (id " + std::to_string(last) + ")", "NaN", "repair or remove", "global ids" });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(std::isnan(filter->GetRelativeAreaChange()));
  log->Clear();
  SetPieces(filter, both);
  pieces::UpdateTogether(filter);
  vtktest::ExpectQuiet(*log);
  EXPECT_FALSE(std::isnan(filter->GetRelativeAreaChange()));
}

TEST(KeptMeasures, DefectsBetweenRanksAreToldOnce)
{
  shapes::Shape shape = MeasuredShapes().at("bar");
  const Eigen::Index middle = shape.Faces.rows() / Size(); // the first of another rank
  std::swap(shape.Faces(middle, 1), shape.Faces(middle, 2));
  const Compared both = MakeCompared(shape);
  vtkNew<vtkVolumeChange> filter;
  const auto log = vtktest::Observe(filter);
  SetPieces(filter, both);
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Errors, { "global ids", "orient" });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(KeptMeasures, OtherPiecesThanTheReferencesAreToldOnce)
{
  const Compared both = MakeCompared(MeasuredShapes().at("bar"));
  vtkNew<vtkVolumeChange> filter;
  const auto log = vtktest::Observe(filter);
  SetPieces(filter, both);
  filter->SetReferenceData(pieces::MyPieceOf(both.Reference, pieces::Scattered));
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(
    log->Errors, { "On rank", "the reference", "same points and cells in the same order" });
  log->Clear();
  SetPieces(filter, both);
  pieces::UpdateTogether(filter);
  vtktest::ExpectQuiet(*log);
}

TEST(KeptMeasures, CopiesOfAPointInDifferentPlacesAreToldOnce)
{
  const Compared both = MakeCompared(MeasuredShapes().at("bar"));
  vtkNew<vtkVolumeChange> filter;
  const auto log = vtktest::Observe(filter);
  SetPieces(filter, both);
  auto* piece = vtkPolyData::SafeDownCast(filter->GetInputDataObject(0, 0));
  vtkNew<vtkPoints> right;
  right->DeepCopy(piece->GetPoints());
  if (Rank() == Size() - 1)
  {
    for (vtkIdType v = 0; v < right->GetNumberOfPoints(); ++v)
    {
      double place[3];
      right->GetPoint(v, place);
      piece->GetPoints()->SetPoint(v, place[0] + 0.1, place[1], place[2]);
    }
  }
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Errors,
    { "in different places on several ranks", Advice("move the copies of a point together.") });
  log->Clear();
  piece->SetPoints(right);
  piece->Modified();
  pieces::UpdateTogether(filter);
  vtktest::ExpectQuiet(*log);
}

TEST(KeptMeasures, WhatTheWholeDecidesIsGathered)
{
  // One body inside of another.
  shapes::Shape inner = shapes::Ellipsoid(2, { 0.2, 0.3, 0.4 });
  const Compared both = MakeCompared(shapes::Union(shapes::Ellipsoid(2, { 1.0, 2.0, 1.5 }), inner));
  vtkNew<vtkVolumeChange> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(both.Input);
  filter->SetReferenceData(both.Reference);
  filter->Update();
  const auto whole = vtktest::CopyOf(filter->GetOutput());
  SetPieces(filter, both);
  pieces::UpdateTogether(filter);
  pieces::ExpectOneMessage(log->Warnings, { "may be inside another", "gathered on the first" });
  EXPECT_LT(pieces::ArrayDifference(filter->GetOutput(), whole, "LocalVolume"), 1e-8);
}

TEST(KeptMeasures, AnAbortOfOneRankStopsAll)
{
  const Compared both = MakeCompared(MeasuredShapes().at("bar"));
  for (const int report : { 1, 2, 4 })
  {
    vtkNew<vtkVolumeChange> filter;
    const auto log = vtktest::Observe(filter);
    vtkNew<vtktest::ProgressLog> progress;
    progress->AbortAt = Rank() == Size() - 1 ? report : 0;
    filter->AddObserver(vtkCommand::ProgressEvent, progress);
    SetPieces(filter, both);
    pieces::UpdateTogether(filter);
    EXPECT_TRUE(log->Errors.empty());
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    progress->AbortAt = 0;
    filter->SetAbortExecute(0);
    SetPieces(filter, both);
    pieces::UpdateTogether(filter);
    vtktest::ExpectQuiet(*log);
    EXPECT_GT(pieces::SumOverRanks(filter->GetOutput()->GetNumberOfPoints()), 0.0);
  }
}
}
