// SPDX-License-Identifier: BSD-3-Clause
// What every filter has from vtkSurfaceFilter.
#include "VtkTestHelpers.h"

#include "vtkCurvatureError.h"
#include "vtkDiscreteForms.h"
#include "vtkFrameReconstruction.h"
#include "vtkHandleMotion.h"
#include "vtkMarkHandle.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkSurfaceMorph.h"
#include "vtkTable.h"

#include "Kernel/Mesh/Geometry.h"

#include "vtkErrorCode.h"
#include "vtkFloatArray.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <cmath>

namespace
{
vtkSmartPointer<vtkPolyData> MarkedBar(int length = 8)
{
  auto bar = vtktest::MakePolyData(shapes::Bar(2, 2, length, { 1.0, 1.0, 4.0 }));
  vtktest::AddHandles(
    bar, [](const Eigen::Vector3d& p) { return p.z() < 0.6 ? 1
                                          : p.z() > 3.4    ? 2
                                                           : 0; });
  return bar;
}

vtkSmartPointer<vtkHandleMotion> Turn(double degrees)
{
  auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  motion->SetAxis(1.0, 0.0, 0.0);
  motion->SetAngle(degrees);
  return motion;
}

double PlaneHeight(vtkPolyData* surface)
{
  return surface->GetBounds()[5] - surface->GetBounds()[4];
}
}

TEST(VtkSurfaceFilter, SeesPointsEditedInPlace)
{
  // Announced by the data set alone, as after an edit through a numpy view.
  const auto bar = MarkedBar();
  vtkNew<vtkRotationInvariantDeformation> deform;
  deform->SetInputData(bar);
  deform->SetHandleMotion(2, Turn(0.0));
  deform->Update();
  auto* points = vtkDoubleArray::SafeDownCast(bar->GetPoints()->GetData());
  for (vtkIdType v = 0; v < points->GetNumberOfTuples(); ++v)
  {
    points->GetPointer(3 * v)[2] *= 2.0;
  }
  bar->Modified();
  deform->Update();
  EXPECT_NEAR(PlaneHeight(deform->GetOutput()), 8.0, 1e-12);
}

TEST(VtkSurfaceFilter, ReportsOneErrorAndGoesOn)
{
  const auto bar = MarkedBar();
  vtkNew<vtkRotationInvariantDeformation> deform;
  // Here the executive is heard too: it has nothing to add.
  vtkNew<vtktest::Log> log;
  deform->AddObserver(vtkCommand::ErrorEvent, log);
  deform->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, log);
  deform->SetInputData(bar);
  deform->SetHandleMotion(5, Turn(10.0));
  deform->Update();
  vtktest::ExpectMessage(log->Errors, { "Handle 5 has a motion", "Handles with points: 1, 2" });
  EXPECT_EQ(deform->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::UserError));
  EXPECT_EQ(deform->GetOutput()->GetNumberOfPoints(), 0);

  log->Clear();
  deform->RemoveHandleMotion(5);
  deform->SetHandleMotion(2, Turn(10.0));
  deform->Update();
  EXPECT_TRUE(log->Errors.empty());
  EXPECT_EQ(deform->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
  EXPECT_EQ(deform->GetOutput()->GetNumberOfPoints(), bar->GetNumberOfPoints());
}

TEST(VtkSurfaceFilter, ChoosingTheActiveHandleMovesNothing)
{
  const auto bar = MarkedBar();
  vtkNew<vtkRotationInvariantDeformation> deform;
  deform->SetInputData(bar);
  const auto first = Turn(30.0);
  const auto second = Turn(-20.0);
  deform->SetHandleMotion(1, first);
  deform->SetHandleMotion(2, second);
  deform->Update();
  const auto before = vtktest::CopyOf(deform->GetOutput());
  deform->SetActiveHandle(2);
  deform->GetActiveHandleBounds();
  deform->Update();
  vtktest::ExpectSameSurface(deform->GetOutput(), before);
  EXPECT_EQ(deform->GetHandleMotion(1), first.Get());
  EXPECT_EQ(deform->GetHandleMotion(2), second.Get());
}

TEST(VtkSurfaceFilter, KeepsNoMoreThanItMay)
{
  // A time series: each step has points of its own.
  vtkNew<vtkRotationInvariantDeformation> deform;
  deform->SetHandleMotion(2, Turn(30.0));
  const auto run = [&](int step)
  {
    const auto bar = MarkedBar(60);
    auto* points = vtkDoubleArray::SafeDownCast(bar->GetPoints()->GetData());
    points->SetComponent(5, 0, points->GetComponent(5, 0) + 1e-3 * step);
    deform->SetInputData(bar);
    deform->Update();
  };
  run(0);
  const double ofOne = deform->GetKeptMemory();
  ASSERT_GT(ofOne, 0.05);
  for (int step = 1; step < 6; ++step)
  {
    run(step);
  }
  EXPECT_NEAR(deform->GetKeptMemory(), 6.0 * ofOne, 0.1 * ofOne); // far below the default limit
  const int limit = static_cast<int>(std::ceil(3.0 * ofOne));
  deform->SetKeptMemoryLimit(limit);
  for (int step = 6; step < 30; ++step)
  {
    run(step);
    ASSERT_LE(deform->GetKeptMemory(), std::max<double>(limit, ofOne));
  }
  deform->SetKeptMemoryLimit(0); // what is in use stays
  run(30);
  EXPECT_NEAR(deform->GetKeptMemory(), ofOne, 0.1 * ofOne);
  const int factorizations = deform->GetNumberOfFactorizations();
  run(30);
  EXPECT_EQ(deform->GetNumberOfFactorizations(), factorizations);
  deform->ReleaseKeptMemory();
  EXPECT_EQ(deform->GetKeptMemory(), 0.0);
}

TEST(VtkSurfaceFilter, ReturnsToAnEarlierStepWithoutFactorizing)
{
  vtkNew<vtkRotationInvariantDeformation> deform;
  deform->SetHandleMotion(2, Turn(30.0));
  const auto first = MarkedBar(8);
  const auto second = MarkedBar(10);
  for (vtkPolyData* input : { first.Get(), second.Get() })
  {
    deform->SetInputData(input);
    deform->Update();
  }
  const int factorizations = deform->GetNumberOfFactorizations();
  // Copies: it is the contents that count.
  for (vtkPolyData* input : { first.Get(), second.Get(), first.Get() })
  {
    deform->SetInputData(vtktest::CopyOf(input));
    deform->Update();
  }
  EXPECT_EQ(deform->GetNumberOfFactorizations(), factorizations);
}

TEST(VtkSurfaceFilter, WarnsAtEachUpdate)
{
  auto bar = MarkedBar();
  bar->GetPolys()->InsertNextCell({ 3, 3, 4 }); // a point twice: ignored
  vtkNew<vtkRotationInvariantDeformation> deform;
  const auto log = vtktest::Observe(deform);
  deform->SetInputData(bar);
  for (const double angle : { 10.0, 20.0 })
  {
    log->Clear();
    deform->SetHandleMotion(2, Turn(angle));
    deform->Update();
    vtktest::ExpectMessage(log->Warnings, { "using a point twice" });
  }
}

TEST(VtkSurfaceFilter, RefusesResultsOutsideThePrecision)
{
  // So large that a motion out of the range is not large beside it.
  const shapes::Shape shape = shapes::Bar(2, 2, 8, { 1e37, 1e37, 4e37 });
  const auto bar = vtktest::MakePolyData(shape, VTK_FLOAT);
  vtktest::AddHandles(
    bar, [](const Eigen::Vector3d& p) { return p.z() < 0.6e37 ? 1
                                          : p.z() > 3.4e37    ? 2
                                                              : 0; });
  vtkNew<vtkRotationInvariantDeformation> deform;
  const auto log = vtktest::Observe(deform);
  const auto shift = vtkSmartPointer<vtkHandleMotion>::New();
  shift->SetTranslation(0.0, 1e39, 0.0);
  deform->SetHandleMotion(2, shift);
  deform->SetInputData(bar);
  deform->Update();
  vtktest::ExpectMessage(log->Errors, { "outside the range of single precision", "as double" });
  EXPECT_EQ(deform->GetOutput()->GetNumberOfPoints(), 0);

  // The advice works.
  log->Clear();
  const auto precise = vtktest::MakePolyData(shape);
  precise->GetPointData()->ShallowCopy(bar->GetPointData());
  deform->SetInputData(precise);
  deform->Update();
  vtktest::ExpectQuiet(*log);
  EXPECT_TRUE(vtktest::PointsOf(deform->GetOutput()).allFinite());
}

TEST(VtkSurfaceFilter, LeavesOutNormalsOfTheWrongLength)
{
  for (const int surplus : { -5, 5 })
  {
    const auto bar = MarkedBar();
    vtkNew<vtkFloatArray> normals;
    normals->SetName("N");
    normals->SetNumberOfComponents(3);
    normals->SetNumberOfTuples(bar->GetNumberOfPoints() + surplus);
    normals->FillValue(1.0f);
    bar->GetPointData()->SetNormals(normals);
    vtkNew<vtkRotationInvariantDeformation> deform;
    const auto log = vtktest::Observe(deform);
    deform->SetHandleMotion(2, Turn(30.0));
    deform->SetInputData(bar);
    deform->Update();
    vtktest::ExpectMessage(log->Warnings, { "normals \"N\"", "left out", "Surface Normals" });
    EXPECT_EQ(deform->GetOutput()->GetNumberOfPoints(), bar->GetNumberOfPoints());
    EXPECT_EQ(deform->GetOutput()->GetPointData()->GetArray("N"), nullptr);
    EXPECT_EQ(bar->GetPointData()->GetNormals(), normals.Get());
  }
}

TEST(VtkSurfaceFilter, TurnsNormalsPartByPart)
{
  // Two parts, one with normals against its faces, both bent a little: none turns
  // over, and where nothing moves nothing changes.
  const shapes::Shape one = shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 });
  shapes::Shape other = one;
  other.Positions.col(0).array() += 3.0;
  const shapes::Shape both = shapes::Union(one, other);
  const auto surface = vtktest::MakePolyData(both);
  vtktest::AddHandles(
    surface, [](const Eigen::Vector3d& p) { return p.z() < 1.1 ? 1
                                              : p.z() > 3.4    ? 2
                                                               : 0; });
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  normals->SetName("Normals");
  const cartan::Points computed = cartan::VertexNormals(shapes::MakeMesh(both), both.Positions);
  for (Eigen::Index v = 0; v < computed.rows(); ++v)
  {
    const Eigen::RowVector3d normal = (v < one.NumberOfVertices() ? 1.0 : -1.0) * computed.row(v);
    normals->InsertNextTuple(normal.data());
  }
  surface->GetPointData()->SetNormals(normals);
  vtkNew<vtkRotationInvariantDeformation> deform;
  deform->SetHandleMotion(2, Turn(2.0));
  deform->SetInputData(surface);
  deform->Update();
  vtkDataArray* turned = deform->GetOutput()->GetPointData()->GetNormals();
  for (vtkIdType v = 0; v < turned->GetNumberOfTuples(); ++v)
  {
    const Eigen::RowVector3d before(normals->GetTuple3(v));
    const Eigen::RowVector3d after(turned->GetTuple3(v));
    EXPECT_GT(before.dot(after), 0.99);
    if (both.Positions(v, 2) < 0.9)
    {
      EXPECT_EQ(before, after);
    }
  }
}

TEST(VtkFrameReconstruction, ComputesNormalsOfWhatItReconstructs)
{
  // A plane in x and y whose forms are those of one in x and z.
  const auto flat = vtktest::MakePolyData(shapes::Plane(4));
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  for (vtkIdType v = 0; v < flat->GetNumberOfPoints(); ++v)
  {
    normals->InsertNextTuple3(0.0, 0.0, 1.0);
  }
  flat->GetPointData()->SetNormals(normals);
  vtkNew<vtkDiscreteForms> forms;
  forms->SetInputData(flat);
  vtkNew<vtkFrameReconstruction> reconstruct;
  reconstruct->SetInputConnection(0, forms->GetOutputPort(0));
  reconstruct->SetFormsConnection(forms->GetOutputPort(1));
  reconstruct->SetSeedFrame(1, 0, 0, 0, 0, 1, 0, -1, 0); // the normal is -y
  reconstruct->Update();
  vtkDataArray* updated = reconstruct->GetOutput()->GetPointData()->GetNormals();
  ASSERT_NE(updated, nullptr);
  for (vtkIdType v = 0; v < updated->GetNumberOfTuples(); ++v)
  {
    EXPECT_NEAR(updated->GetComponent(v, 1), -1.0, 1e-6);
  }
}

TEST(VtkFrameReconstruction, RefusesTablesThatDoNotFit)
{
  const auto bar = MarkedBar();
  vtkNew<vtkDiscreteForms> forms;
  forms->SetInputData(bar);
  forms->Update();
  const auto refuse = [&](const char* column, const std::function<void(vtkDataArray*)>& spoil,
                        const std::vector<std::string>& parts)
  {
    vtkNew<vtkTable> table;
    table->DeepCopy(forms->GetFormsTable());
    spoil(vtkDataArray::SafeDownCast(table->GetColumnByName(column)));
    vtkNew<vtkFrameReconstruction> reconstruct;
    const auto log = vtktest::Observe(reconstruct);
    reconstruct->SetInputData(bar);
    reconstruct->SetFormsData(table);
    reconstruct->Update();
    vtktest::ExpectMessage(log->Errors, parts);
  };
  refuse("Length", [](vtkDataArray* column) { column->SetNumberOfTuples(7); },
    { "\"Length\"", "7 values for" });
  // A number between two ids is no id.
  vtkNew<vtkTable> table;
  table->DeepCopy(forms->GetFormsTable());
  vtkNew<vtkDoubleArray> vertices;
  vertices->DeepCopy(table->GetColumnByName("Vertex"));
  vertices->SetName("Vertex");
  vertices->SetValue(3, vertices->GetValue(3) + 0.4);
  table->RemoveColumnByName("Vertex");
  table->AddColumn(vertices);
  vtkNew<vtkFrameReconstruction> reconstruct;
  const auto log = vtktest::Observe(reconstruct);
  reconstruct->SetInputData(bar);
  reconstruct->SetFormsData(table);
  reconstruct->Update();
  vtktest::ExpectMessage(log->Errors, { "not an edge of the connectivity" });
}

TEST(VtkSurfaceMorph, SaysThatAKeyFrameIsEmpty)
{
  vtkNew<vtkPolyData> empty;
  vtkNew<vtkSurfaceMorph> morph;
  const auto log = vtktest::Observe(morph);
  morph->AddInputData(empty);
  morph->AddInputData(MarkedBar());
  morph->Update();
  vtktest::ExpectMessage(log->Errors, { "key frame 0 has no triangles" });
}
