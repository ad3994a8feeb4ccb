// SPDX-License-Identifier: BSD-3-Clause
#include "TestShapes.h"
#include "VtkTestHelpers.h"

#include "vtkAsRigidAsPossibleDeformation.h"
#include "vtkDiscreteForms.h"
#include "vtkFrameReconstruction.h"
#include "vtkHandleMotion.h"
#include "vtkLaplacianDeformation.h"
#include "vtkMultiresolutionDeformation.h"
#include "vtkPoissonDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkSimilarityDeformation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

// Parts that are much smaller than the whole, joined to it or not: what is exact
// for ordinary surfaces is for them up to the rounding of coordinates.

namespace
{
constexpr int Around = 12;

/// A closed surface of revolution around z through these radii and heights, with
/// poles at the heights `south` and `north`.
shapes::Shape Turned(
  double south, const std::vector<Eigen::Vector2d>& radiiAndHeights, double north)
{
  std::vector<Eigen::Vector3d> points{ { 0.0, 0.0, south } };
  std::vector<Eigen::Vector3i> faces;
  const int rings = static_cast<int>(radiiAndHeights.size());
  for (const Eigen::Vector2d& ring : radiiAndHeights)
  {
    for (int i = 0; i < Around; ++i)
    {
      const double angle = 2.0 * shapes::Pi * i / Around;
      points.emplace_back(ring[0] * std::cos(angle), ring[0] * std::sin(angle), ring[1]);
    }
  }
  points.emplace_back(0.0, 0.0, north);
  const int last = static_cast<int>(points.size()) - 1;
  for (int i = 0; i < Around; ++i)
  {
    const int next = (i + 1) % Around;
    faces.emplace_back(0, 1 + next, 1 + i);
    for (int j = 0; j + 1 < rings; ++j)
    {
      const int row = 1 + j * Around;
      faces.emplace_back(row + i, row + next, row + Around + next);
      faces.emplace_back(row + i, row + Around + next, row + Around + i);
    }
    faces.emplace_back(last - Around + i, last - Around + next, last);
  }
  return { shapes::ToPoints(points), shapes::ToTriangles(faces) };
}

/// A ball of radius 1 below the origin whose rings shrink to a knob of this size on
/// its north pole.
shapes::Shape BallWithKnob(double size)
{
  std::vector<Eigen::Vector2d> rings;
  for (double angle = 0.9 * shapes::Pi; angle > 2.5 * size; angle *= angle < 0.6 ? 0.55 : 0.8)
  {
    rings.emplace_back(std::sin(angle), -2.0 * std::pow(std::sin(0.5 * angle), 2));
  }
  for (int k = 1; k < 9; ++k)
  {
    const double angle = 0.85 * shapes::Pi * (1.0 - k / 9.0);
    rings.emplace_back(size * std::sin(angle), size * (1.0 + std::cos(angle)));
  }
  return Turned(-2.0, rings, 2.0 * size);
}

/// A ball of radius 1 below the origin, and a ball of this size elsewhere.
shapes::Shape BallAndBall(double size, const Eigen::RowVector3d& place)
{
  shapes::Shape big = shapes::UvSphere(16, 8);
  big.Positions.col(2).array() -= 1.0;
  shapes::Shape small = shapes::UvSphere(12, 8, size);
  small.Positions.rowwise() += place;
  return shapes::Union(big, small);
}

struct Kind
{
  std::string Name;
  std::function<shapes::Shape(double)> Make;
};

const std::vector<Kind> Kinds = {
  { "joined", BallWithKnob },
  { "apart",
    [](double size) {
      return BallAndBall(size, { 0.0, 0.0, 0.0 });
    } },
  { "apart, far from the origin",
    [](double size) {
      return BallAndBall(size, { 1.3, -0.4, 0.7 });
    } },
};

const std::vector<double> Sizes = { 1e-2, 1e-4, 1e-6, 1e-8 };

/// The largest difference of the length of an edge.
double LengthError(const shapes::Shape& shape, const cartan::Points& points)
{
  double largest = 0.0;
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      const int i = shape.Faces(t, c);
      const int j = shape.Faces(t, (c + 1) % 3);
      const double length = (shape.Positions.row(i) - shape.Positions.row(j)).norm();
      const double error = std::abs((points.row(i) - points.row(j)).norm() - length);
      largest = std::max(largest, error);
    }
  }
  return largest;
}

/// Every method, and those that preserve volume in each way.
std::vector<vtkSmartPointer<vtkSurfaceDeformation>> Methods()
{
  std::vector<vtkSmartPointer<vtkSurfaceDeformation>> methods{
    vtkSmartPointer<vtkRotationInvariantDeformation>::New(),
    vtkSmartPointer<vtkPoissonDeformation>::New(),
    vtkSmartPointer<vtkSimilarityDeformation>::New(),
    vtkSmartPointer<vtkLaplacianDeformation>::New(),
    vtkSmartPointer<vtkMultiresolutionDeformation>::New(),
    vtkSmartPointer<vtkAsRigidAsPossibleDeformation>::New(),
  };
  for (int correction = 0; correction < 3; ++correction)
  {
    auto preserving = vtkSmartPointer<vtkShapePreservingDeformation>::New();
    preserving->SetVolumeCorrection(correction);
    preserving->SetCloseVolume(correction != 0);
    methods.push_back(preserving);
  }
  return methods;
}

TEST(SmallParts, ACommonMotionIsExact)
{
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(4, 1.0);
  double matrix[16] = { 0.0 };
  for (int r = 0; r < 3; ++r)
  {
    for (int c = 0; c < 3; ++c)
    {
      matrix[4 * r + c] = motion.Rotation(r, c);
    }
    matrix[4 * r + 3] = motion.Translation[r];
  }
  matrix[15] = 1.0;
  vtkNew<vtkHandleMotion> handleMotion;
  handleMotion->SetMatrixElements(matrix);
  handleMotion->SetModeToMatrix();
  for (const Kind& kind : Kinds)
  {
    for (const double size : Sizes)
    {
      const shapes::Shape shape = kind.Make(size);
      auto surface = vtktest::MakePolyData(shape);
      const int count = shape.NumberOfVertices();
      int id = 0;
      vtktest::AddHandles(surface,
        [&](const Eigen::Vector3d& x)
        {
          // The bottom of the big part, and the last points of the small one.
          ++id;
          return x[2] < -1.5 ? 1 : id > count - Around - 1 ? 2 : 0;
        });
      for (const auto& method : Methods())
      {
        auto log = vtktest::Observe(method);
        method->SetInputData(surface);
        method->SetHandleMotion(1, handleMotion);
        method->SetHandleMotion(2, handleMotion);
        method->Update();
        ASSERT_TRUE(log->Errors.empty()) << log->Errors[0];
        const cartan::Points expected = motion(shape.Positions);
        const double error =
          (vtktest::PointsOf(method->GetOutput()) - expected).cwiseAbs().maxCoeff();
        EXPECT_LT(error, 1e-14) << kind.Name << " " << size << " " << method->GetClassName();
      }
    }
  }
}

TEST(SmallParts, FormsGiveThemBack)
{
  for (const Kind& kind : Kinds)
  {
    for (const double size : Sizes)
    {
      const shapes::Shape shape = kind.Make(size);
      auto surface = vtktest::MakePolyData(shape);
      vtkNew<vtkDiscreteForms> forms;
      forms->SetInputData(surface);
      vtkNew<vtkFrameReconstruction> reconstruction;
      reconstruction->SetInputConnection(0, forms->GetOutputPort(0));
      reconstruction->SetInputConnection(1, forms->GetOutputPort(1));
      auto log = vtktest::Observe(reconstruction);
      reconstruction->Update();
      ASSERT_TRUE(log->Errors.empty()) << log->Errors[0];
      EXPECT_LT(LengthError(shape, vtktest::PointsOf(reconstruction->GetOutput())), 1e-13)
        << kind.Name << " " << size;
    }
  }
}
}
