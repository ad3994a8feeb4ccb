// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshMerge.h"

#include "Advice.h"
#include "MergeShapes.h"

#include "vtkBoundaryLoops.h"

namespace
{
using vtktest::Advice;
using vtktest::ExpectMessage;
using vtktest::ExpectQuiet;
using vtktest::MakePolyData;

constexpr int Around = 24;

/// A tube from z = `from` to `from` + 3, with what is measured on it.
vtkSmartPointer<vtkPolyData> Tube(double from, double value)
{
  shapes::Shape tube = shapes::OpenCylinder(Around, 30, 1.0, 3.0);
  tube.Positions.col(2).array() += from;
  auto surface = MakePolyData(tube);
  vtktest::AddArray(surface, "Value", 1, [=](vtkIdType, double* x) { *x = value; });
  vtktest::AddArray(
    surface, "Height", 1, [&](vtkIdType v, double* x) { *x = surface->GetPoint(v)[2]; });
  vtkNew<vtkIntArray> labels;
  labels->SetName("Label");
  labels->SetNumberOfValues(surface->GetNumberOfPoints());
  labels->Fill(value);
  surface->GetPointData()->AddArray(labels);
  vtkNew<vtkIntArray> keys;
  keys->SetName("BoundaryKey");
  keys->SetNumberOfValues(surface->GetNumberOfPoints());
  keys->Fill(0.0);
  keys->SetValue(from > 0.0 ? 0 : surface->GetNumberOfPoints() - Around, 1);
  surface->GetPointData()->AddArray(keys);
  return surface;
}

class MeshMergeTransition : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Target = Tube(0.0, 1.0);
    this->Source = Tube(2.0, 3.0);
    this->Filter->SetInputData(this->Target);
    this->Filter->SetSourceData(this->Source);
    this->Log = vtktest::Observe(this->Filter);
  }

  vtkPolyData* Output()
  {
    this->Log->Clear();
    this->Filter->Update();
    return this->Filter->GetOutput();
  }

  vtkSmartPointer<vtkPolyData> Target;
  vtkSmartPointer<vtkPolyData> Source;
  vtkNew<vtkMeshMerge> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST_F(MeshMergeTransition, FadesPointArrays)
{
  EXPECT_EQ(this->Output()->GetPointData()->GetArray("SourcePart"), nullptr);
  // No ring of points is at the isoline.
  this->Filter->SetTransitionWidth(1.05);
  vtkPolyData* output = this->Output();
  ExpectQuiet(*this->Log);
  vtkNew<vtkBoundaryLoops> boundary;
  boundary->SetInputData(output);
  boundary->Update();
  EXPECT_EQ(boundary->GetNumberOfLoops(), 2);
  vtkPointData* data = output->GetPointData();
  int between = 0;
  for (vtkIdType v = 0; v < output->GetNumberOfPoints(); ++v)
  {
    const double part = data->GetArray("SourcePart")->GetTuple1(v);
    const double z = output->GetPoint(v)[2];
    const auto origin = static_cast<int>(data->GetArray("MergeOrigin")->GetTuple1(v));
    const auto id = static_cast<vtkIdType>(data->GetArray("OriginalPointIds")->GetTuple1(v));
    // 3 t^2 - 2 t^3 from the isoline at 1.95 to the target's end at 3.
    const double t = std::min(1.0, std::max(0.0, (z - 1.95) / 1.05));
    EXPECT_NEAR(part, t * t * (3.0 - 2.0 * t), 0.01);
    EXPECT_NEAR(data->GetArray("Value")->GetTuple1(v), 1.0 + 2.0 * part, 1e-12);
    EXPECT_EQ(data->GetArray("Label")->GetTuple1(v), part > 0.5 ? 3.0 : 1.0);
    EXPECT_EQ(origin, z < 1.949 ? 0 : z < 1.951 ? 2 : 1);
    ASSERT_LT(id, (origin == 1 ? this->Source : this->Target)->GetNumberOfPoints());
    if (origin != 1)
    {
      EXPECT_LT(std::abs(this->Target->GetPoint(id)[2] - z), 0.06);
      EXPECT_NEAR(data->GetArray("Height")->GetTuple1(v), z, 1e-12);
    }
    between += part > 0.0 && part < 1.0;
  }
  EXPECT_EQ(between, 10 * Around); // rings in 1.05 are .1 apart
  vtkDataArray* cellIds = output->GetCellData()->GetArray("OriginalCellIds");
  for (vtkIdType c = 0; c < output->GetNumberOfCells(); ++c)
  {
    const bool isSources = output->GetCellData()->GetArray("MergeOrigin")->GetTuple1(c) == 1.0;
    ASSERT_LT(cellIds->GetTuple1(c), (isSources ? this->Source : this->Target)->GetNumberOfCells());
  }
}

TEST_F(MeshMergeTransition, ChangesItsWidthWithoutFactorizingTheSource)
{
  this->Filter->SetTransitionWidth(0.8);
  this->Output();
  const int factorizations = this->Filter->GetNumberOfFactorizations();
  this->Filter->SetTransitionWidth(1.3);
  this->Output();
  ExpectQuiet(*this->Log);
  EXPECT_EQ(this->Filter->GetNumberOfFactorizations(), factorizations);
}

TEST_F(MeshMergeTransition, IsKeptWhenAKeyMoves)
{
  const auto moveKey = [&](vtkIdType by)
  {
    vtkDataArray* keys = this->Target->GetPointData()->GetArray("BoundaryKey");
    keys->Fill(0.0);
    keys->SetTuple1(this->Target->GetNumberOfPoints() - Around + by, 1.0);
    keys->Modified();
    this->Target->Modified();
  };
  this->Output();
  const double without = this->Filter->GetKeptMemory();
  this->Filter->SetTransitionWidth(0.8);
  const cartan::Points before = vtktest::PointsOf(this->Output());
  const double kept = this->Filter->GetKeptMemory();
  EXPECT_GT(kept, without);
  moveKey(5);
  const cartan::Points after = vtktest::PointsOf(this->Output());
  ExpectQuiet(*this->Log);
  EXPECT_EQ(this->Filter->GetKeptMemory(), kept);
  EXPECT_GT((after.bottomRows(Around) - before.bottomRows(Around)).norm(), 0.1);
  // As a filter that keeps nothing has it.
  vtkNew<vtkMeshMerge> fresh;
  fresh->SetInputData(this->Target);
  fresh->SetSourceData(this->Source);
  fresh->SetTransitionWidth(0.8);
  fresh->Update();
  EXPECT_EQ((vtktest::PointsOf(fresh->GetOutput()) - after).norm(), 0.0);
  // Another width is another transition.
  this->Filter->SetTransitionWidth(1.3);
  this->Output();
  EXPECT_GT(this->Filter->GetKeptMemory(), kept);
}

TEST_F(MeshMergeTransition, RefusesWhatIsTooWideOrHeld)
{
  this->Filter->SetTransitionWidth(3.5);
  EXPECT_EQ(this->Output()->GetNumberOfPoints(), 0);
  EXPECT_EQ(this->Filter->GetCorrespondences()->GetNumberOfPoints(), 0);
  ExpectMessage(
    this->Log->Errors, { "3.5", "too wide for the target", Advice("Lower TransitionWidth.") });
  this->Filter->SetTransitionWidth(1.0);
  EXPECT_GT(this->Output()->GetNumberOfPoints(), 0);
  ExpectQuiet(*this->Log);

  this->Filter->SetConfigurationToDependent();
  this->Filter->SetBendWidth(0.75);
  EXPECT_EQ(this->Output()->GetNumberOfPoints(), 0);
  ExpectMessage(this->Log->Errors,
    { "of the source are held", Advice("or raise BendWidth where that holds them.") });
  this->Filter->SetBendWidth(1.55);
  EXPECT_GT(this->Output()->GetNumberOfPoints(), 0);
  ExpectQuiet(*this->Log);
}
