// SPDX-License-Identifier: BSD-3-Clause
#include "vtkRotationInvariantDeformation.h"

#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Mesh/Geometry.h"
#include "VtkTestHelpers.h"
#include "vtkHandleMotion.h"

#include "vtkMatrix4x4.h"
#include "vtkSMPTools.h"
#include "vtkTriangleFilter.h"

#include <cmath>

using cartan::Points;
using shapes::Shape;
using shapes::Volume;
using vtktest::MakePolyData;

namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

vtkSmartPointer<vtkHandleMotion> Turn(const Eigen::Vector3d& center, const Eigen::Vector3d& axis,
  double degrees, const Eigen::Vector3d& translation = Eigen::Vector3d::Zero())
{
  auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  motion->SetCenter(center.data());
  motion->SetAxis(axis.data());
  motion->SetAngle(degrees);
  motion->SetTranslation(translation.data());
  return motion;
}

/// Runs a filter that must have nothing to say.
Points Updated(vtkRotationInvariantDeformation* filter)
{
  const auto log = vtktest::Observe(filter);
  filter->Update();
  vtktest::ExpectQuiet(*log);
  return vtktest::PointsOf(filter->GetOutput());
}

Points Deform(vtkPolyData* surface, vtkHandleMotion* motion, int handle = 2)
{
  vtkNew<vtkRotationInvariantDeformation> filter;
  filter->SetInputData(surface);
  filter->SetHandleMotion(handle, motion);
  return Updated(filter);
}

double Distance(const Points& a, const Points& b)
{
  return (a - b).rowwise().norm().maxCoeff() / cartan::BoundingDiagonal(a);
}

Eigen::Vector3d Apply(vtkHandleMotion* motion, const Eigen::Vector3d& x)
{
  vtkNew<vtkMatrix4x4> matrix;
  motion->GetTransform(matrix);
  const double in[4] = { x[0], x[1], x[2], 1.0 };
  double out[4];
  matrix->MultiplyPoint(in, out);
  return Eigen::Vector3d(out);
}

/// A real mesh whose ends along y are handles 1 and 2, and a motion for 2.
struct Scene
{
  Shape Original;
  vtkSmartPointer<vtkPolyData> Surface;
  vtkSmartPointer<vtkHandleMotion> Motion;
  vtkDataArray* Handles;

  explicit Scene(const Shape& shape, int axis = 1)
    : Original(shape)
    , Surface(MakePolyData(shape))
  {
    vtktest::AddHandles(this->Surface, shapes::EndsAlong(shape, axis, 0.15));
    this->Handles = this->Surface->GetPointData()->GetArray("Handle");
    const Eigen::Vector3d center = shape.Positions.colwise().mean();
    const double size = cartan::BoundingDiagonal(shape.Positions);
    this->Motion = Turn(center, { 1, 0.3, -0.2 }, 70, size * Eigen::Vector3d(0.1, 0.05, 0));
  }
};
}

TEST(RotationInvariantDeformation, HoldsHandlesWhereTheirMotionsPutThem)
{
  const Scene scene(shapes::RealMesh("camel"));
  const Points points = Deform(scene.Surface, scene.Motion);
  for (vtkIdType v = 0; v < points.rows(); ++v)
  {
    const Eigen::Vector3d rest = scene.Original.Positions.row(v);
    const int handle = static_cast<int>(scene.Handles->GetTuple1(v));
    if (handle == 1)
    {
      ASSERT_EQ(points.row(v), scene.Original.Positions.row(v));
    }
    else if (handle == 2)
    {
      ASSERT_LT((points.row(v).transpose() - Apply(scene.Motion, rest)).norm(), 1e-14);
    }
  }
}

TEST(RotationInvariantDeformation, MovesRigidlyWhenAllHandlesDo)
{
  const Scene scene(shapes::RealMesh("camel"));
  vtkNew<vtkRotationInvariantDeformation> filter;
  filter->SetInputData(scene.Surface);
  filter->SetHandleMotion(1, scene.Motion);
  filter->SetHandleMotion(2, scene.Motion);
  Points expected(scene.Original.Positions.rows(), 3);
  for (Eigen::Index v = 0; v < expected.rows(); ++v)
  {
    expected.row(v) = Apply(scene.Motion, scene.Original.Positions.row(v).transpose()).transpose();
  }
  for (const int projection :
    { vtkRotationInvariantDeformation::NONE, vtkRotationInvariantDeformation::ROTATION })
  {
    filter->SetFrameProjection(projection);
    EXPECT_LT(Distance(Updated(filter), expected), 1e-10);
  }
}

TEST(RotationInvariantDeformation, WithoutMotionReturnsTheSameBits)
{
  // Coordinates that no shift by the center and back would leave alone.
  for (const int precision : { VTK_FLOAT, VTK_DOUBLE })
  {
    Shape shape = shapes::RandomRigidMotion(3, 1234.5)(shapes::RealMesh("elephant"));
    const auto surface = MakePolyData(shape, precision);
    vtktest::AddHandles(surface, shapes::EndsAlong(shape, 1, 0.15));
    vtkNew<vtkRotationInvariantDeformation> filter;
    filter->SetInputData(surface);
    Updated(filter);
    vtktest::ExpectSameSurface(filter->GetOutput(), surface);
    EXPECT_EQ(filter->GetNumberOfFreePoints(), 0);

    // A motion that is the identity counts as moving, but its handle and the
    // pinned one stay to the bit, and the rest to rounding.
    filter->SetHandleMotion(2, vtkSmartPointer<vtkHandleMotion>::New());
    const Points points = Updated(filter);
    const Points rest = vtktest::PointsOf(surface);
    EXPECT_GT(filter->GetNumberOfFreePoints(), 0);
    vtkDataArray* handles = surface->GetPointData()->GetArray("Handle");
    for (vtkIdType v = 0; v < points.rows(); ++v)
    {
      ASSERT_TRUE(handles->GetTuple1(v) == 0.0 || points.row(v) == rest.row(v)) << v;
    }
    EXPECT_LT((points - rest).norm(), precision == VTK_FLOAT ? 1e-2 : 1e-9);
  }
}

TEST(RotationInvariantDeformation, LeavesWhatNoMovingHandleReachesToTheBit)
{
  // Handle 2 at one end of a tube moves, handle 1 in its middle is pinned; beyond
  // it, and on another component, points are free and untouched.
  const Shape tube = shapes::OpenCylinder(12, 30, 0.7, 9.1);
  Shape other = tube;
  other.Positions.rowwise() += Eigen::RowVector3d(3.3, 0.1, 0.2);
  const Shape shape = shapes::RandomRigidMotion(2, 100.0)(shapes::Union(tube, other));
  for (const int precision : { VTK_FLOAT, VTK_DOUBLE })
  {
    const auto surface = MakePolyData(shape, precision);
    vtkNew<vtkIntArray> handles;
    handles->SetName("Handle");
    int expectedFree = 0;
    for (int v = 0; v < shape.NumberOfVertices(); ++v)
    {
      const int row = v % tube.NumberOfVertices() / 12;
      const bool isFirst = v < tube.NumberOfVertices();
      handles->InsertNextValue(!isFirst ? 0 : row == 15 ? 1 : row >= 29 ? 2 : 0);
      expectedFree += isFirst && row > 15 && row < 29;
    }
    surface->GetPointData()->AddArray(handles);
    for (const bool constrain : { true, false })
    {
      vtkNew<vtkRotationInvariantDeformation> filter;
      filter->SetInputData(surface);
      filter->SetConstrainHandlePositions(constrain);
      filter->SetHandleMotion(2, Turn({ 0, 0, 9 }, { 0, 1, 0 }, 50));
      const Points points = Updated(filter);
      const Points rest = vtktest::PointsOf(surface);
      EXPECT_EQ(filter->GetNumberOfFreePoints(), expectedFree);
      for (int v = 0; v < shape.NumberOfVertices(); ++v)
      {
        const int row = v % tube.NumberOfVertices() / 12;
        const bool isUntouched = v >= tube.NumberOfVertices() || row <= 15;
        ASSERT_EQ(points.row(v) == rest.row(v), isUntouched) << v;
      }
    }
  }
}

TEST(RotationInvariantDeformation, DoesNotDependOnUnitOrPlace)
{
  const Shape shape = shapes::RealMesh("elephant");
  const Scene scene(shape);
  const Points expected = Deform(scene.Surface, scene.Motion);
  struct Case
  {
    double Unit;
    double Far; // in units
    int Precision;
    double Tolerance; // what the coordinates can say there
  };
  for (const Case& test : { Case{ 1e-9, 0.0, VTK_DOUBLE, 1e-11 },
         Case{ 1e6, 0.0, VTK_DOUBLE, 1e-11 }, Case{ 1.0, 1e6, VTK_DOUBLE, 1e-8 },
         Case{ 1e-9, 1e6, VTK_DOUBLE, 1e-8 }, Case{ 1e6, 1e6, VTK_DOUBLE, 1e-8 },
         Case{ 1.0, 0.0, VTK_FLOAT, 1e-6 }, Case{ 1e-9, 0.0, VTK_FLOAT, 1e-6 },
         Case{ 1e6, 0.0, VTK_FLOAT, 1e-6 }, Case{ 1.0, 1e3, VTK_FLOAT, 1e-2 } })
  {
    SCOPED_TRACE(testing::Message() << test.Unit << " " << test.Far << " " << test.Precision);
    const Eigen::RowVector3d shift = test.Far * Eigen::RowVector3d(1, -1, 0.5);
    Shape moved = shape;
    moved.Positions = test.Unit * (shape.Positions.rowwise() + shift);
    const auto surface = MakePolyData(moved, test.Precision);
    surface->GetPointData()->AddArray(scene.Handles);
    vtkNew<vtkHandleMotion> motion;
    const Eigen::Vector3d center =
      test.Unit * (Eigen::Vector3d(scene.Motion->GetCenter()) + shift.transpose());
    motion->SetCenter(center.data());
    motion->SetAxis(scene.Motion->GetAxis());
    motion->SetAngle(scene.Motion->GetAngle());
    const Eigen::Vector3d translation = test.Unit * Eigen::Vector3d(scene.Motion->GetTranslation());
    motion->SetTranslation(translation.data());
    const Points points = Deform(surface, motion);
    EXPECT_LT(Distance((points / test.Unit).rowwise() - shift, expected), test.Tolerance);
  }
}

TEST(RotationInvariantDeformation, DoesNotDependOnThreads)
{
  const Scene scene(shapes::RealMesh("camel"));
  const std::string before = vtkSMPTools::GetBackend();
  std::vector<Points> results;
  for (const auto& [backend, threads] : std::vector<std::pair<const char*, int>>{
         { "Sequential", 1 }, { "STDThread", 2 }, { "STDThread", 7 } })
  {
    if (!vtkSMPTools::SetBackend(backend))
    {
      continue; // not in this VTK
    }
    vtkSMPTools::Initialize(threads);
    vtkNew<vtkRotationInvariantDeformation> filter;
    filter->SetInputData(scene.Surface);
    filter->SetHandleMotion(2, scene.Motion);
    for (const int projection :
      { vtkRotationInvariantDeformation::NONE, vtkRotationInvariantDeformation::ROTATION })
    {
      filter->SetFrameProjection(projection);
      results.push_back(Updated(filter));
    }
  }
  vtkSMPTools::SetBackend(before.c_str());
  vtkSMPTools::Initialize();
  ASSERT_GE(results.size(), 4u);
  for (std::size_t i = 2; i < results.size(); ++i)
  {
    EXPECT_EQ(results[i], results[i % 2]);
  }
}

TEST(RotationInvariantDeformation, DoesNotDependOnTheNumbersOfHandles)
{
  const Scene scene(shapes::RealMesh("elephant"));
  const Points expected = Deform(scene.Surface, scene.Motion);
  vtkNew<vtkIntArray> renumbered;
  renumbered->SetName("Handle");
  for (vtkIdType v = 0; v < scene.Surface->GetNumberOfPoints(); ++v)
  {
    const double handle = scene.Handles->GetTuple1(v);
    renumbered->InsertNextValue(handle == 1 ? VTK_INT_MAX : handle == 2 ? 17 : 0);
  }
  scene.Surface->GetPointData()->AddArray(renumbered);
  EXPECT_EQ(Deform(scene.Surface, scene.Motion, 17), expected);
}

TEST(RotationInvariantDeformation, BendsABarWithThePublishedLossOfVolume)
{
  const Shape bar = shapes::Bar(8, 8, 48, { 1, 1, 6 });
  const auto surface = MakePolyData(bar);
  vtktest::AddHandles(surface,
    [](const Eigen::Vector3d& x) { return x[2] < 0.5 + 1e-9 ? 1
                                     : x[2] > 5.5 - 1e-9    ? 2
                                                            : 0; });
  vtkNew<vtkRotationInvariantDeformation> filter;
  filter->SetInputData(surface);
  filter->ConstrainHandlePositionsOff();
  const auto ratio = [&](double degrees)
  {
    filter->SetHandleMotion(2, Turn({ 7, 7, 7 }, { 1, 0, 0 }, degrees, { 3, 2, 1 }));
    return Volume(Updated(filter), bar.Faces) / 6.0;
  };
  EXPECT_NEAR(ratio(90), 0.971, 0.02 * 0.971); // projected by default
  EXPECT_NEAR(ratio(170), 0.832, 0.02 * 0.832);
  filter->SetFrameProjectionToNone();
  EXPECT_NEAR(ratio(90), 0.713, 0.02 * 0.713);
  EXPECT_NEAR(ratio(170), 0.431, 0.02 * 0.431);
}

TEST(RotationInvariantDeformation, LetsTheSurfaceFindItsPlaceWherePositionsAreFree)
{
  // Where a handle with free positions would be put does not matter.
  const Scene scene(shapes::RealMesh("elephant"));
  vtkNew<vtkRotationInvariantDeformation> filter;
  filter->SetInputData(scene.Surface);
  filter->ConstrainHandlePositionsOff();
  filter->SetHandleMotion(2, scene.Motion);
  const Points first = Updated(filter);
  scene.Motion->SetTranslation(100, -50, 20);
  scene.Motion->SetCenter(3, 3, 3);
  EXPECT_LT(Distance(Updated(filter), first), 1e-12);
  EXPECT_GT(Distance(first, scene.Original.Positions), 0.05);
}

TEST(RotationInvariantDeformation, SeesRotationsModuloALap)
{
  const Scene scene(shapes::RealMesh("elephant"));
  const Points once = Deform(scene.Surface, scene.Motion);
  scene.Motion->SetAngle(70 + 720);
  EXPECT_LT(Distance(Deform(scene.Surface, scene.Motion), once), 1e-12);
}

TEST(RotationInvariantDeformation, ScalesAndShearsWithoutProjection)
{
  // All handles shear: the surface shears.
  const Scene scene(shapes::RealMesh("elephant"));
  vtkNew<vtkMatrix4x4> matrix;
  const double elements[16] = { 1.2, 0.4, 0, 0.1, 0, 0.7, 0.2, -0.3, 0, 0, 2, 0.5, 0, 0, 0, 1 };
  matrix->DeepCopy(elements);
  scene.Motion->SetMatrix(matrix);
  vtkNew<vtkRotationInvariantDeformation> filter;
  filter->SetInputData(scene.Surface);
  filter->SetHandleMotion(1, scene.Motion);
  filter->SetHandleMotion(2, scene.Motion);
  const Points automatic = Updated(filter);
  for (Eigen::Index v = 0; v < automatic.rows(); ++v)
  {
    ASSERT_LT((automatic.row(v).transpose() -
                Apply(scene.Motion, scene.Original.Positions.row(v).transpose()))
                .norm(),
      1e-10);
  }
  filter->SetFrameProjectionToNone();
  EXPECT_EQ(Updated(filter), automatic);
  filter->SetFrameProjectionToRotation();
  EXPECT_GT(Distance(Updated(filter), automatic), 1e-3);
}

//------------------------------------------------------------------------------
TEST(RotationInvariantDeformation, ArraysOfTargetsReplaceAMotion)
{
  const Scene scene(shapes::RealMesh("elephant"));
  const Points expected = Deform(scene.Surface, scene.Motion);
  double vector[3];
  scene.Motion->GetRotationVector(vector);
  const Eigen::Matrix3d rotation = cartan::RotationFromVector(Eigen::Vector3d(vector));
  // Read at handle points only: elsewhere there may be anything.
  const auto atHandle2 = [&](int components, const std::function<void(vtkIdType, double*)>& value)
  {
    return [&scene, components, value](vtkIdType v, double* x)
    {
      std::fill(x, x + components, std::numeric_limits<double>::quiet_NaN());
      if (scene.Handles->GetTuple1(v) == 2)
      {
        value(v, x);
      }
      else if (scene.Handles->GetTuple1(v) == 1)
      {
        std::fill(x, x + components, 0.0);
        for (int k = 0; k < 3; ++k)
        {
          x[components == 9 ? 4 * k : k] = components == 9 ? 1.0 : 0.0;
        }
      }
    };
  };
  const auto positions = vtktest::AddArray(scene.Surface, "Target", 3,
    [&](vtkIdType v, double* x)
    {
      const Eigen::Vector3d rest = scene.Original.Positions.row(v);
      Eigen::Map<Eigen::Vector3d> target(x);
      target = scene.Handles->GetTuple1(v) == 2 ? Apply(scene.Motion, rest)
        : scene.Handles->GetTuple1(v) == 1      ? rest
                                                : Eigen::Vector3d(Eigen::Vector3d::Constant(NAN));
    });
  vtktest::AddArray(scene.Surface, "Vector", 3,
    atHandle2(3, [&](vtkIdType, double* x) { std::copy(vector, vector + 3, x); }));
  vtktest::AddArray(scene.Surface, "Laps", 3,
    atHandle2(3,
      [&](vtkIdType, double* x)
      {
        Eigen::Map<Eigen::Vector3d> laps(x);
        laps = Eigen::Vector3d(vector) * (1.0 + 2 * shapes::Pi / Eigen::Vector3d(vector).norm());
      }));
  vtktest::AddArray(scene.Surface, "Matrix", 9,
    atHandle2(9,
      [&](vtkIdType, double* x)
      {
        for (int i = 0; i < 9; ++i) // row by row
        {
          x[i] = rotation(i / 3, i % 3);
        }
      }));

  vtkNew<vtkRotationInvariantDeformation> filter;
  filter->SetInputData(scene.Surface);
  filter->SetTargetPositionArrayName("Target");
  for (const char* name : { "Vector", "Laps" })
  {
    filter->SetRotationVectorArrayName(name);
    EXPECT_LT(Distance(Updated(filter), expected), 1e-10) << name;
  }
  filter->SetRotationVectorArrayName("");
  filter->SetTransformArrayName("Matrix");
  EXPECT_LT(Distance(Updated(filter), expected), 1e-10);
  EXPECT_EQ(filter->GetNumberOfFactorizations(), 1);

  // Positions alone: the handle is moved but nothing turns.
  filter->SetTransformArrayName("");
  filter->GenerateFrameChangeOn();
  Updated(filter);
  EXPECT_LT(filter->GetOutput()->GetPointData()->GetArray("FrameChange")->GetMaxNorm(), 1e-12);

  // A motion takes precedence over arrays.
  filter->SetTransformArrayName("Matrix");
  filter->SetHandleMotion(2, vtkSmartPointer<vtkHandleMotion>::New());
  EXPECT_LT(Distance(Updated(filter), scene.Original.Positions), 1e-12);
}

TEST(RotationInvariantDeformation, ArraysThatLeaveAHandleAloneMoveNothing)
{
  const Scene scene(shapes::RandomRigidMotion(1, 77.7)(shapes::RealMesh("elephant")));
  vtktest::AddArray(
    scene.Surface, "Target", 3, [&](vtkIdType v, double* x) { scene.Surface->GetPoint(v, x); });
  vtktest::AddArray(
    scene.Surface, "Vector", 3, [&](vtkIdType, double* x) { std::fill(x, x + 3, 0.0); });
  vtkNew<vtkRotationInvariantDeformation> filter;
  filter->SetInputData(scene.Surface);
  filter->SetTargetPositionArrayName("Target");
  filter->SetRotationVectorArrayName("Vector");
  Updated(filter);
  vtktest::ExpectSameSurface(filter->GetOutput(), scene.Surface);
  EXPECT_EQ(filter->GetNumberOfFreePoints(), 0);
}

TEST(RotationInvariantDeformation, WeightsRunFromFreeToHeld)
{
  const Scene scene(shapes::RealMesh("elephant"));
  vtkNew<vtkRotationInvariantDeformation> filter;
  filter->SetInputData(scene.Surface);
  filter->SetHandleMotion(2, scene.Motion);
  const Points hard = Updated(filter);
  const auto setWeights = [&](const std::function<double(vtkIdType)>& weight)
  {
    vtktest::AddArray(
      scene.Surface, "Weight", 1, [&weight](vtkIdType v, double* x) { *x = weight(v); });
    filter->SetConstraintWeightArrayName("Weight");
    filter->Modified();
  };
  setWeights([](vtkIdType) { return Infinity; });
  EXPECT_EQ(Updated(filter), hard);

  // Stiffer and stiffer constraints come closer and closer to hard ones.
  double last = 1.0;
  for (const double weight : { 0.1, 1.0, 10.0, 100.0 })
  {
    setWeights([weight](vtkIdType) { return weight; });
    const double distance = Distance(Updated(filter), hard);
    EXPECT_LT(distance, last) << weight;
    last = distance;
  }
  EXPECT_LT(last, 1e-3);

  // A weight of 0 is no handle.
  const auto inner = [&](vtkIdType v) { return v % 3 == 0; };
  setWeights([&](vtkIdType v) { return inner(v) ? 0.0 : Infinity; });
  const Points someFree = Updated(filter);
  vtkNew<vtkIntArray> fewer;
  fewer->SetName("Handle");
  for (vtkIdType v = 0; v < scene.Surface->GetNumberOfPoints(); ++v)
  {
    fewer->InsertNextValue(inner(v) ? 0 : static_cast<int>(scene.Handles->GetTuple1(v)));
  }
  const auto other = vtktest::CopyOf(scene.Surface);
  other->GetPointData()->AddArray(fewer);
  EXPECT_LT(Distance(Deform(other, scene.Motion), someFree), 1e-11);
}
