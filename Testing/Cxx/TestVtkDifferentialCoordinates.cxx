// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDifferentialCoordinates.h"
#include "vtkDifferentialReconstruction.h"

#include "Advice.h"
#include "SliverShapes.h"

#include "vtkPrepareSurface.h"
#include "vtkUnsignedCharArray.h"

namespace
{
using vtktest::MakePolyData;
using vtktest::PointsOf;

/// A torus with two handles, its coordinates computed.
vtkSmartPointer<vtkPolyData> TorusWithCoordinates(
  int weights = vtkDifferentialFilter::COTANGENT, int normalization = vtkDifferentialFilter::AREA)
{
  const vtkSmartPointer<vtkPolyData> torus =
    MakePolyData(shapes::Noisy(shapes::Torus(20, 12), 0.03));
  vtktest::AddHandles(torus, [](const Eigen::Vector3d& p) { return p[0] > 2.4 ? 1 : 0; });
  vtkNew<vtkDifferentialCoordinates> coordinates;
  coordinates->SetInputData(torus);
  coordinates->SetLaplacianWeights(weights);
  coordinates->SetNormalization(normalization);
  coordinates->Update();
  return vtktest::CopyOf(coordinates->GetOutput());
}

void ScaleCoordinates(vtkPolyData* surface, double factor)
{
  vtkDataArray* array = surface->GetPointData()->GetArray("DifferentialCoordinates");
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    Eigen::Vector3d value;
    array->GetTuple(i, value.data());
    value *= factor;
    array->SetTuple(i, value.data());
  }
}

class ReconstructionFilter : public testing::Test
{
protected:
  void SetUp() override { this->Log = vtktest::Observe(this->Filter); }

  cartan::Points Result(vtkPolyData* input)
  {
    this->Filter->SetInputData(input);
    this->Filter->Update();
    return PointsOf(this->Filter->GetOutput());
  }

  vtkNew<vtkDifferentialReconstruction> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST(DifferentialCoordinatesFilter, WritesTheDocumentedArrays)
{
  const vtkSmartPointer<vtkPolyData> input =
    MakePolyData(shapes::Union(shapes::Plane(4), shapes::Icosphere(3, 2.0)), VTK_FLOAT);
  const vtkSmartPointer<vtkPolyData> before = vtktest::CopyOf(input);
  vtkNew<vtkDifferentialCoordinates> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(input);
  filter->Update();
  vtktest::ExpectQuiet(*log);
  vtktest::ExpectSameSurface(input, before);
  vtkPointData* arrays = filter->GetOutput()->GetPointData();
  vtkDataArray* deltas = arrays->GetArray("DifferentialCoordinates");
  ASSERT_NE(deltas, nullptr);
  EXPECT_EQ(deltas->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(deltas->GetNumberOfComponents(), 3);
  auto* areDefined =
    vtkUnsignedCharArray::SafeDownCast(arrays->GetArray("DifferentialCoordinatesAreDefined"));
  ASSERT_NE(areDefined, nullptr);
  const cartan::Points points = PointsOf(input);
  for (vtkIdType v = 0; v < input->GetNumberOfPoints(); ++v)
  {
    Eigen::RowVector3d delta;
    deltas->GetTuple(v, delta.data());
    if (v < 25)
    {
      const bool isInside = v % 5 > 0 && v % 5 < 4 && v / 5 > 0 && v / 5 < 4;
      EXPECT_EQ(areDefined->GetValue(v), isInside) << v;
      EXPECT_EQ(delta.norm() < 1e-6, isInside) << v;
    }
    else
    {
      // Twice the mean curvature of a sphere of radius 2, outwards.
      EXPECT_NEAR(delta.dot(points.row(v).normalized()), 1.0, 0.03) << v;
    }
  }
}

TEST_F(ReconstructionFilter, GivesTheSurfaceBack)
{
  for (int weights = 0; weights < 3; ++weights)
  {
    for (int normalization = 0; normalization < 3; ++normalization)
    {
      const vtkSmartPointer<vtkPolyData> input = TorusWithCoordinates(weights, normalization);
      this->Filter->SetLaplacianWeights(weights);
      this->Filter->SetNormalization(normalization);
      for (int mode = 0; mode < 3; ++mode)
      {
        this->Filter->SetAnchorMode(mode);
        EXPECT_LT((this->Result(input) - PointsOf(input)).cwiseAbs().maxCoeff(), 1e-12);
      }
    }
  }
  vtktest::ExpectQuiet(*this->Log);
}

TEST_F(ReconstructionFilter, UniformWeightsNeedTheConnectivityAlone)
{
  const vtkSmartPointer<vtkPolyData> input =
    TorusWithCoordinates(vtkDifferentialFilter::UNIFORM, vtkDifferentialFilter::ROW);
  const cartan::Points expected = PointsOf(input);
  vtktest::AddArray(input, "Place", 3,
    [&](vtkIdType v, double* value)
    { Eigen::RowVector3d::Map(value) = expected.row(v) + Eigen::RowVector3d(1, 2, 3); });
  for (vtkIdType v = 0; v < input->GetNumberOfPoints(); ++v)
  {
    const Eigen::RowVector3d place(std::sin(v), std::cos(3.0 * v), 0.1 * v);
    input->GetPoints()->SetPoint(v, place.data());
  }
  this->Filter->SetLaplacianWeightsToUniform();
  this->Filter->SetNormalizationToRow();
  this->Filter->SetAnchorPositionArrayName("Place");
  const cartan::Points result = this->Result(input);
  vtktest::ExpectQuiet(*this->Log);
  EXPECT_LT(
    ((result - expected).rowwise() - Eigen::RowVector3d(1, 2, 3)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(ReconstructionFilter, FactorizesOnceWhileCoordinatesAndAnchorPositionsChange)
{
  const vtkSmartPointer<vtkPolyData> input = TorusWithCoordinates();
  const cartan::Points rest = this->Result(input);
  EXPECT_EQ(this->Filter->GetNumberOfFactorizations(), 1);
  const vtkSmartPointer<vtkPolyData> exaggerated = vtktest::CopyOf(input);
  ScaleCoordinates(exaggerated, 1.5);
  const cartan::Points result = this->Result(exaggerated);
  EXPECT_EQ(this->Filter->GetNumberOfFactorizations(), 0);
  // Linear in the coordinates: the mean of none and twice is the once.
  const vtkSmartPointer<vtkPolyData> reduced = vtktest::CopyOf(input);
  ScaleCoordinates(reduced, 0.5);
  EXPECT_LT((0.5 * (result + this->Result(reduced)) - rest).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_GT((result - rest).cwiseAbs().maxCoeff(), 0.05);
}

TEST_F(ReconstructionFilter, BlendsTwoSurfacesByAWeightPerPoint)
{
  const vtkSmartPointer<vtkPolyData> input = TorusWithCoordinates();
  const vtkSmartPointer<vtkPolyData> flat = vtktest::CopyOf(input);
  ScaleCoordinates(flat, 0.8);
  vtkNew<vtkDoubleArray> other;
  other->DeepCopy(flat->GetPointData()->GetArray("DifferentialCoordinates"));
  other->SetName("Other");
  input->GetPointData()->AddArray(other);
  const cartan::Points expected = this->Result(flat);
  const cartan::Points rest = this->Result(input);
  this->Filter->SetOtherDifferentialCoordinatesArrayName("Other");
  this->Filter->SetBlendWeightArrayName("Weight");
  for (const double weight : { 0.0, 0.25, 1.0 })
  {
    vtktest::AddArray(input, "Weight", 1, [weight](vtkIdType, double* value) { *value = weight; });
    input->Modified();
    EXPECT_LT(
      (this->Result(input) - (1.0 - weight) * rest - weight * expected).cwiseAbs().maxCoeff(),
      1e-10);
  }
  vtktest::ExpectQuiet(*this->Log);
  this->Filter->SetBlendWeightArrayName("");
  this->Result(input);
  vtktest::ExpectMessage(this->Log->Errors,
    { shapes::Advice("Blending needs two names: set OtherDifferentialCoordinatesArrayName and "
                     "BlendWeightArrayName, or neither.") });
  this->Log->Clear();
  this->Filter->SetOtherDifferentialCoordinatesArrayName("");
  EXPECT_LT((this->Result(input) - rest).cwiseAbs().maxCoeff(), 1e-12);
  vtktest::ExpectQuiet(*this->Log);
}

TEST_F(ReconstructionFilter, HoldsSoftAnchorsByTheirWeights)
{
  const vtkSmartPointer<vtkPolyData> input = TorusWithCoordinates();
  const cartan::Points rest = PointsOf(input);
  vtkDataArray* handles = input->GetPointData()->GetArray("Handle");
  handles->SetTuple1(0, 2.0);
  vtktest::AddArray(input, "Place", 3,
    [&](vtkIdType v, double* value) {
      Eigen::RowVector3d::Map(value) = rest.row(v) + (v == 0 ? 1 : 0) * Eigen::RowVector3d(0, 0, 1);
    });
  this->Filter->SetAnchorPositionArrayName("Place");
  const auto miss = [&] { return (this->Result(input).row(0) - rest.row(0)).z() - 1.0; };
  EXPECT_NEAR(miss(), 0.0, 1e-12);
  this->Filter->SetAnchorModeToSoft();
  this->Filter->SetConstraintWeight(30.0);
  const double near = std::abs(miss());
  this->Filter->SetConstraintWeight(1.0);
  const double far = std::abs(miss());
  EXPECT_GT(near, 1e-6);
  EXPECT_GT(far, 2.0 * near);
  vtktest::AddArray(
    input, "Weight", 1, [](vtkIdType v, double* value) { *value = v == 0 ? 0 : 1; });
  this->Filter->SetConstraintWeightArrayName("Weight");
  EXPECT_NEAR(miss(), -1.0, 1e-9); // weight 0: no anchor
  vtktest::ExpectQuiet(*this->Log);
}

TEST_F(ReconstructionFilter, RefusesOtherSettingsThanTheCoordinates)
{
  const vtkSmartPointer<vtkPolyData> input =
    TorusWithCoordinates(vtkDifferentialFilter::MEAN_VALUE, vtkDifferentialFilter::INTEGRATED);
  this->Result(input);
  vtktest::ExpectMessage(this->Log->Errors,
    { "mean value weights, integrated", "cotangent weights, normalized by area",
      shapes::Advice("set LaplacianWeights and Normalization as they were.") });
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
  this->Log->Clear();
  this->Filter->SetLaplacianWeightsToMeanValue();
  this->Filter->SetNormalizationToIntegrated();
  this->Result(input);
  vtktest::ExpectQuiet(*this->Log);
}

TEST_F(ReconstructionFilter, SaysWhereCapsLeaveNoDigits)
{
  shapes::Shape torus = shapes::Torus(20, 12);
  const int cap = slivers::MiddleTriangle(torus);
  slivers::SplitTriangle(torus, cap, { 0.5 - 0.5e-8, 0.5 - 0.5e-8, 1e-8 });
  auto surface = MakePolyData(torus);
  vtktest::AddArray(
    surface, "Handle", 1, [](vtkIdType v, double* value) { *value = v == 0 ? 1.0 : 0.0; });
  // Coordinates of the surface at 1.5 of its size give that surface.
  const auto miss = [&](vtkPolyData* rest)
  {
    vtkNew<vtkDifferentialCoordinates> coordinates;
    coordinates->SetInputData(rest);
    coordinates->Update();
    const vtkSmartPointer<vtkPolyData> exaggerated = vtktest::CopyOf(coordinates->GetOutput());
    ScaleCoordinates(exaggerated, 1.5);
    const cartan::Points points = PointsOf(rest);
    const cartan::Points expected = (1.5 * points).rowwise() - 0.5 * points.row(0);
    return (this->Result(exaggerated) - expected).cwiseAbs().maxCoeff();
  };
  EXPECT_GT(miss(surface), 1e-3);
  vtktest::ExpectMessage(this->Log->Warnings,
    { "Rounding leaves",
      shapes::Advice("flip edges before the coordinates are made (Prepare "
                     "Surface, Flip Edges), or hold more points.") });

  this->Log->Clear();
  vtkNew<vtkPrepareSurface> flip;
  flip->SetInputData(surface);
  flip->FlipEdgesOn();
  flip->Update();
  EXPECT_LT(miss(flip->GetOutput()), 1e-9);
  vtktest::ExpectQuiet(*this->Log);

  // Held where the cap is, with the neighbors of its corners.
  const Eigen::RowVector3d center = torus.Positions.row(torus.NumberOfVertices() - 1);
  for (int v = 0; v < torus.NumberOfVertices(); ++v)
  {
    const bool isNear = (torus.Positions.row(v) - center).norm() < 0.8;
    surface->GetPointData()->GetArray("Handle")->SetTuple1(v, isNear || v == 0 ? 1.0 : 0.0);
  }
  miss(surface);
  vtktest::ExpectQuiet(*this->Log);
}

// A cap's weights hang on the last digits of its corners. Coordinates of a surface where it
// is none ask for what these weights cannot give.
TEST_F(ReconstructionFilter, SaysWhereTheSurfacesLastDigitsDecide)
{
  for (const double height : { 2e-9, 0.2 })
  {
    shapes::Shape torus = shapes::Torus(20, 12);
    const int cap = slivers::MiddleTriangle(torus);
    slivers::SplitTriangle(torus, cap, { 0.5 - 0.5 * height, 0.5 - 0.5 * height, height });
    auto surface = MakePolyData(torus);
    vtktest::AddArray(
      surface, "Handle", 1, [](vtkIdType v, double* value) { *value = v % 20 == 0 ? 1.0 : 0.0; });
    const vtkSmartPointer<vtkPolyData> bent = vtktest::CopyOf(surface);
    for (vtkIdType v = 0; v < bent->GetNumberOfPoints(); ++v)
    {
      const Eigen::Vector3d x(bent->GetPoint(v));
      bent->GetPoints()->SetPoint(
        v, x.x() + 0.3 * x.y() * x.y(), x.y() + 0.2 * x.z() * x.z(), x.z() + 0.3 * x.x() * x.x());
    }
    vtkNew<vtkDifferentialCoordinates> coordinates;
    coordinates->SetInputData(bent);
    coordinates->Update();
    const vtkSmartPointer<vtkPolyData> input = vtktest::CopyOf(coordinates->GetOutput());
    input->SetPoints(surface->GetPoints());
    this->Log->Clear();
    this->Result(input);
    EXPECT_EQ(this->Log->Warnings.size(), height < 0.1 ? 1u : 0u) << height;
    EXPECT_TRUE(this->Log->Errors.empty());
  }
}

TEST_F(ReconstructionFilter, SaysWhatIsMissing)
{
  vtkSmartPointer<vtkPolyData> input = TorusWithCoordinates();
  input->GetPointData()->GetArray("Handle")->Fill(0.0);
  this->Result(input);
  vtktest::ExpectMessage(
    this->Log->Errors, { shapes::Advice("mark at least one point of each, such as"), "id 0" });
  this->Log->Clear();
  input->GetPointData()->GetArray("Handle")->SetTuple1(0, 1.0);
  input->Modified();
  this->Result(input);
  vtktest::ExpectQuiet(*this->Log);

  input = TorusWithCoordinates();
  input->GetPointData()->GetArray("DifferentialCoordinates")->SetComponent(7, 1, NAN);
  this->Result(input);
  vtktest::ExpectMessage(this->Log->Errors, { "DifferentialCoordinates", "id 7", "NaN" });
  this->Log->Clear();
  input->GetPointData()->RemoveArray("DifferentialCoordinates");
  this->Result(input);
  vtktest::ExpectMessage(
    this->Log->Errors, { "no numeric point array", "DifferentialCoordinates" });
  this->Log->Clear();
  input->GetPointData()->RemoveArray("Handle");
  this->Result(input);
  EXPECT_EQ(this->Log->Errors.size(), 1u);
}

TEST_F(ReconstructionFilter, KeepsTheInputsPrecisionAndUnusedPoints)
{
  vtkSmartPointer<vtkPolyData> input = TorusWithCoordinates();
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_FLOAT);
  points->DeepCopy(input->GetPoints());
  const vtkIdType unused = points->InsertNextPoint(5.0, 6.0, NAN);
  input->SetPoints(points);
  for (int i = 0; i < input->GetPointData()->GetNumberOfArrays(); ++i)
  {
    input->GetPointData()->GetArray(i)->InsertNextTuple(0, input->GetPointData()->GetArray(i));
  }
  input->GetPointData()->GetArray("DifferentialCoordinates")->SetComponent(unused, 0, NAN);
  const cartan::Points result = this->Result(input);
  EXPECT_EQ(
    this->Filter->GetOutput()->GetPoints()->GetDataType(), input->GetPoints()->GetDataType());
  EXPECT_EQ(result(unused, 1), 6.0);
  EXPECT_TRUE(std::isnan(result(unused, 2)));
  EXPECT_LT((result.topRows(unused) - PointsOf(input).topRows(unused)).cwiseAbs().maxCoeff(), 1e-5);
}
