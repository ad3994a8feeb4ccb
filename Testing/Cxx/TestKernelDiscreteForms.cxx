// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Differential/DiscreteForms.h"

#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

using cartan::DiscreteForms;
using cartan::Matrices;
using cartan::MatrixAt;
using cartan::Points;
using cartan::TransitionMethod;
using cartan::TriangleMesh;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using shapes::MakeMesh;
using shapes::Shape;

namespace
{
const char* const RealMeshes[] = { "armadillo", "camel", "bunny00" };

DiscreteForms FormsOf(const Shape& shape)
{
  const TriangleMesh mesh = MakeMesh(shape);
  return cartan::ComputeDiscreteForms(
    mesh, shape.Positions, cartan::VertexFrames(mesh, shape.Positions));
}

/// The difference of angles modulo a full turn.
double AngleDifference(double a, double b)
{
  return std::abs(std::remainder(a - b, 2.0 * shapes::Pi));
}

/// A disk of six edges around vertex 0, two of which (to 2 and 5) are parallel
/// to its normal: upright triangles on both sides of each, whose area vectors
/// cancel.
Shape DiskWithUprightEdges()
{
  Shape shape;
  shape.Positions = shapes::ToPoints({ { 0, 0, 0 }, { 1, -1, 0 }, { 0, 0, 1 }, { 1, 1, 0 },
    { -1, 0.5, 0 }, { 0, 0, 2 }, { -1, -0.5, 0 } });
  shape.Faces = shapes::ToTriangles(
    { { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 4 }, { 0, 4, 5 }, { 0, 5, 6 }, { 0, 6, 1 } });
  return shape;
}

void ExpectTransitions(const Shape& shape, TransitionMethod method, double tolerance)
{
  const TriangleMesh mesh = MakeMesh(shape);
  const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
  const DiscreteForms forms = cartan::ComputeDiscreteForms(mesh, shape.Positions, frames);
  const Matrices fromForms = cartan::TransitionsFromForms(mesh, forms, method);
  const Matrices fromFrames = cartan::TransitionsFromFrames(mesh, frames);
  EXPECT_LT((fromForms - fromFrames).cwiseAbs().maxCoeff(), tolerance);
}
}

TEST(VertexFrames, AreOrthonormalRightHandedAndStartAtTheFirstEdge)
{
  for (const Shape& shape : { shapes::Plane(6, 1.0, 0.3), shapes::Torus(9, 7),
         shapes::RealMesh("camel"), shapes::RealMesh("lion-head") })
  {
    const TriangleMesh mesh = MakeMesh(shape);
    const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
    const Points normals = cartan::VertexNormals(mesh, shape.Positions);
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      if (!mesh.IsUsed(v))
      {
        continue;
      }
      const Matrix3d frame = MatrixAt(frames, v);
      ASSERT_LT((frame.transpose() * frame - Matrix3d::Identity()).norm(), 1e-13);
      ASSERT_GT(frame.determinant(), 0.0);
      ASSERT_EQ(frame.col(2), normals.row(v).transpose());
      const Vector3d edge =
        (shape.Positions.row(mesh.Neighbor(mesh.RingBegin(v))) - shape.Positions.row(v))
          .transpose();
      ASSERT_GT(frame.col(0).dot(edge), 0.0);
      ASSERT_NEAR(frame.col(1).dot(edge), 0.0, 1e-12 * edge.norm());
    }
  }
}

TEST(VertexFrames, OfUnusedVerticesAreTheAxes)
{
  Shape shape = shapes::Plane(2);
  shape.Positions.conservativeResize(10, 3);
  shape.Positions.row(9) << 1, 2, 3;
  const Matrices frames = cartan::VertexFrames(MakeMesh(shape), shape.Positions);
  EXPECT_EQ(Matrix3d(MatrixAt(frames, 9)), Matrix3d::Identity());
}

TEST(VertexFrames, RefuseVerticesWithoutNormal)
{
  Shape shape = shapes::Plane(2);
  shape = shapes::Union(shape,
    { shapes::ToPoints({ { 0, 0, 0 }, { 1, 1, 1 }, { 2, 2, 2 } }),
      shapes::ToTriangles({ { 0, 1, 2 } }) });
  try
  {
    cartan::VertexFrames(MakeMesh(shape), shape.Positions);
    FAIL() << "accepted";
  }
  catch (const cartan::Error& error)
  {
    EXPECT_EQ(error.GetCode(), cartan::ErrorCode::BadInput);
    const std::string text = error.what();
    EXPECT_NE(text.find("3 points (ids 9, 10, 11) without a normal"), std::string::npos) << text;
    EXPECT_NE(text.find("Prepare Surface"), std::string::npos) << text;
  }
}

//------------------------------------------------------------------------------
TEST(DiscreteForms, DoNotChangeUnderRigidMotions)
{
  for (const char* name : RealMeshes)
  {
    const Shape shape = shapes::RealMesh(name);
    const double size = cartan::BoundingDiagonal(shape.Positions);
    const DiscreteForms before = FormsOf(shape);
    double length = 0.0;
    double height = 0.0;
    double angle = 0.0;
    for (const unsigned int seed : { 1u, 2u })
    {
      const DiscreteForms after = FormsOf(shapes::RandomRigidMotion(seed, size)(shape));
      length = std::max(length, (after.Length - before.Length).cwiseAbs().maxCoeff() / size);
      height = std::max(height, (after.Height - before.Height).cwiseAbs().maxCoeff() / size);
      for (Eigen::Index d = 0; d < before.Angle.size(); ++d)
      {
        ASSERT_EQ(std::isnan(before.Angle[d]), std::isnan(after.Angle[d]));
        if (!std::isnan(before.Angle[d]))
        {
          angle = std::max(angle, AngleDifference(after.Angle[d], before.Angle[d]));
        }
      }
    }
    shapes::ShowFigure(std::string(name) + ", rigid motion, length / diagonal", length);
    shapes::ShowFigure(std::string(name) + ", rigid motion, height / diagonal", height);
    shapes::ShowFigure(std::string(name) + ", rigid motion, angle", angle);
    EXPECT_LT(length, 1e-12);
    EXPECT_LT(height, 1e-12);
    EXPECT_LT(angle, 1e-10);
  }
}

TEST(DiscreteForms, AreThreeNumbersPerEdgeAndOneLessAtABoundary)
{
  for (const Shape& shape : { shapes::Plane(5, 1.0, 0.2), shapes::OpenCylinder(7, 3),
         shapes::Icosphere(2), shapes::RealMesh("lion-head") })
  {
    const TriangleMesh mesh = MakeMesh(shape);
    const DiscreteForms forms = FormsOf(shape);
    ASSERT_EQ(forms.Length.size(), mesh.NumberOfDirectedEdges());
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      int numbers = 0;
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        numbers += std::isfinite(forms.Length[d]) + std::isfinite(forms.Height[d]) +
          std::isfinite(forms.Angle[d]);
        ASSERT_EQ(std::isnan(forms.Angle[d]), mesh.LeftTriangle(d) < 0);
        ASSERT_TRUE(mesh.LeftTriangle(d) >= 0 || forms.Orientation[d] == 0);
      }
      ASSERT_EQ(numbers, 3 * mesh.Valence(v) - mesh.IsBoundary(v));
    }
  }
}

TEST(DiscreteForms, DetermineTheEdgesInTheFrame)
{
  // Lemma 2.1: F_i c_ij = x_j - x_i.
  for (const char* name : RealMeshes)
  {
    const Shape shape = shapes::RealMesh(name);
    const TriangleMesh mesh = MakeMesh(shape);
    const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
    const Points ring =
      cartan::RingCoordinates(mesh, cartan::ComputeDiscreteForms(mesh, shape.Positions, frames));
    double worst = 0.0;
    for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
    {
      const Vector3d edge =
        (shape.Positions.row(mesh.Neighbor(d)) - shape.Positions.row(mesh.Origin(d))).transpose();
      worst =
        std::max(worst, (MatrixAt(frames, mesh.Origin(d)) * ring.row(d).transpose() - edge).norm());
    }
    EXPECT_LT(worst, 1e-12 * cartan::BoundingDiagonal(shape.Positions));
  }
}

TEST(DiscreteForms, OfASphereAreThoseOfThePolyhedron)
{
  // The ring of a vertex of the regular icosahedron is a regular pentagon.
  const DiscreteForms forms = FormsOf(shapes::Icosphere(0));
  const double edge = 1.0 / std::sin(0.4 * shapes::Pi); // with circumradius 1
  const double height = -0.5 * edge * edge; // over the tangent plane, sphere of radius 1
  for (Eigen::Index d = 0; d < forms.Length.size(); ++d)
  {
    EXPECT_NEAR(forms.Height[d], height, 1e-14);
    EXPECT_NEAR(forms.Length[d], std::sqrt(edge * edge - height * height), 1e-14);
    EXPECT_NEAR(forms.Angle[d], 0.4 * shapes::Pi, 1e-14);
    EXPECT_EQ(forms.Orientation[d], 1);
  }
}

TEST(DiscreteForms, OrientationIsTheSignOfTheAnglesSineAndBothSignsOccur)
{
  int negative = 0;
  for (const char* name : RealMeshes)
  {
    const DiscreteForms forms = FormsOf(shapes::RealMesh(name));
    for (Eigen::Index d = 0; d < forms.Angle.size(); ++d)
    {
      if (!std::isnan(forms.Angle[d]))
      {
        ASSERT_GT(forms.Angle[d], -shapes::Pi);
        ASSERT_LE(forms.Angle[d], shapes::Pi);
        const double sine = std::sin(forms.Angle[d]);
        ASSERT_TRUE(std::abs(sine) < 1e-14 || forms.Orientation[d] == (sine > 0.0 ? 1 : -1));
        negative += forms.Orientation[d] < 0;
      }
    }
  }
  shapes::ShowFigure("corners of negative orientation, three meshes", negative);
  EXPECT_GT(negative, 0);
}

TEST(DiscreteForms, AnglesAroundAnInteriorVertexSumToAWholeNumberOfLaps)
{
  int folded = 0;
  for (const char* name : RealMeshes)
  {
    const Shape shape = shapes::RealMesh(name);
    const TriangleMesh mesh = MakeMesh(shape);
    const DiscreteForms forms = FormsOf(shape);
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      if (mesh.IsUsed(v) && !mesh.IsBoundary(v))
      {
        const double sum = forms.Angle.segment(mesh.RingBegin(v), mesh.Valence(v)).sum();
        ASSERT_LT(AngleDifference(sum, 0.0), 1e-10);
        folded += std::abs(sum - 2.0 * shapes::Pi) > 1.0;
      }
    }
  }
  shapes::ShowFigure("vertices whose angles sum to no single full turn, three meshes", folded);
  EXPECT_GT(folded, 0);
}

TEST(DiscreteForms, EdgesParallelToTheNormalTakeTheDirectionOfTheEdgeBefore)
{
  for (const double unit : { 1e-9, 1.0, 1e6 })
  {
    Shape shape = DiskWithUprightEdges();
    shape.Positions *= unit;
    const TriangleMesh mesh = MakeMesh(shape);
    const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
    ASSERT_LT((MatrixAt(frames, 0).col(2) - Vector3d::UnitZ()).norm(), 1e-15);
    const DiscreteForms forms = cartan::ComputeDiscreteForms(mesh, shape.Positions, frames);
    for (int d = mesh.RingBegin(0); d < mesh.RingEnd(0); ++d)
    {
      const bool isUpright = mesh.Neighbor(d) == 2 || mesh.Neighbor(d) == 5;
      EXPECT_EQ(forms.Length[d] < 1e-12 * unit, isUpright);
      if (isUpright)
      {
        const int before = d > mesh.RingBegin(0) ? d - 1 : mesh.RingEnd(0) - 1;
        EXPECT_EQ(forms.Angle[before], 0.0);
        EXPECT_EQ(forms.Orientation[before], 0);
        EXPECT_NEAR(forms.Height[d], unit * (mesh.Neighbor(d) == 2 ? 1.0 : 2.0), 1e-12 * unit);
      }
    }
    EXPECT_NEAR(forms.Angle.segment(mesh.RingBegin(0), 6).sum(), 2.0 * shapes::Pi, 1e-13);
    ExpectTransitions(shape, TransitionMethod::Procrustes, 1e-12);
    // A normal that lies in the triangle's plane is a double root of Eq. 3: what
    // comes out is the square root of rounding.
    ExpectTransitions(shape, TransitionMethod::OrientationBits, 1e-7);
  }
}

TEST(DiscreteForms, AtAFirstEdgeParallelToTheNormalStillHaveAFrame)
{
  // The ring of vertex 0 starts with an upright edge, inside and at a boundary.
  Shape closed = DiskWithUprightEdges();
  const cartan::Triangles faces = closed.Faces;
  for (int t = 0; t < 6; ++t)
  {
    closed.Faces.row(t) = faces.row((t + 1) % 6);
  }
  Shape open;
  // The area vectors of the upright triangles at both ends cancel.
  open.Positions = shapes::ToPoints(
    { { 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 }, { 0, 1, 0 }, { -1, 0, 0 }, { 0, 0, 1 } });
  open.Faces = shapes::ToTriangles({ { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 4 }, { 0, 4, 5 } });
  for (const Shape& shape : { closed, open })
  {
    const TriangleMesh mesh = MakeMesh(shape);
    const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
    const DiscreteForms forms = cartan::ComputeDiscreteForms(mesh, shape.Positions, frames);
    const Points ring = cartan::RingCoordinates(mesh, forms);
    for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
    {
      const int v = mesh.Origin(d);
      const Vector3d edge =
        (shape.Positions.row(mesh.Neighbor(d)) - shape.Positions.row(v)).transpose();
      EXPECT_LT((MatrixAt(frames, v) * ring.row(d).transpose() - edge).norm(), 1e-14);
    }
    ExpectTransitions(shape, TransitionMethod::Procrustes, 1e-12);
  }
}

//------------------------------------------------------------------------------
TEST(Transitions, FromFormsAreThoseOfTheFramesOnRealMeshes)
{
  for (const char* name : RealMeshes)
  {
    const Shape shape = shapes::RealMesh(name);
    const TriangleMesh mesh = MakeMesh(shape);
    const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
    const DiscreteForms forms = cartan::ComputeDiscreteForms(mesh, shape.Positions, frames);
    const Matrices expected = cartan::TransitionsFromFrames(mesh, frames);
    for (int d = 0; d < 100; ++d)
    {
      EXPECT_LT((MatrixAt(frames, mesh.Origin(d)) * MatrixAt(expected, d) -
                  MatrixAt(frames, mesh.Neighbor(d)))
                  .norm(),
        1e-14); // Eq. 2
    }
    for (const TransitionMethod method :
      { TransitionMethod::Procrustes, TransitionMethod::OrientationBits })
    {
      const double worst =
        (cartan::TransitionsFromForms(mesh, forms, method) - expected).cwiseAbs().maxCoeff();
      shapes::ShowFigure(std::string(name) +
          (method == TransitionMethod::Procrustes ? ", transitions, Procrustes"
                                                  : ", transitions, Theorem 3.1"),
        worst);
      EXPECT_LT(worst, 1e-9);
    }
  }
}

TEST(Transitions, FromFormsAreThoseOfTheFramesAtBoundaries)
{
  const Shape triangle{ shapes::ToPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.2, 0.6, 0.3 } }),
    shapes::ToTriangles({ { 0, 1, 2 } }) };
  for (const Shape& shape : { triangle, shapes::Saddle(5, 1.0, 0.2), shapes::OpenCylinder(6, 3),
         shapes::Noisy(shapes::Plane(7), 0.05), shapes::RealMesh("lion-head") })
  {
    for (const TransitionMethod method :
      { TransitionMethod::Procrustes, TransitionMethod::OrientationBits })
    {
      ExpectTransitions(shape, method, 1e-9);
    }
  }
}

TEST(Transitions, NeedTheOrientationBitsOfTheirTheorem)
{
  // With all bits set to +1 Theorem 3.1 goes wrong where a corner is folded.
  const Shape shape = shapes::RealMesh("camel");
  const TriangleMesh mesh = MakeMesh(shape);
  const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
  DiscreteForms forms = cartan::ComputeDiscreteForms(mesh, shape.Positions, frames);
  for (signed char& bit : forms.Orientation)
  {
    bit = static_cast<signed char>(bit < 0 ? -bit : bit);
  }
  const Matrices expected = cartan::TransitionsFromFrames(mesh, frames);
  const auto worst = [&](TransitionMethod method)
  { return (cartan::TransitionsFromForms(mesh, forms, method) - expected).cwiseAbs().maxCoeff(); };
  EXPECT_GT(worst(TransitionMethod::OrientationBits), 0.1);
  EXPECT_LT(worst(TransitionMethod::Procrustes), 1e-9); // does without them
}

TEST(Transitions, AcrossATriangleWithoutAreaUseTheOtherOne)
{
  // A square with a fifth point on its diagonal: triangle (0, 4, 2) is a needle.
  Shape shape;
  shape.Positions =
    shapes::ToPoints({ { 0, 0, 0 }, { 1, 0, 0.2 }, { 1, 1, 0 }, { 0, 1, 0.3 }, { 0.5, 0.5, 0 } });
  shape.Faces = shapes::ToTriangles({ { 0, 1, 2 }, { 0, 2, 4 }, { 0, 4, 3 }, { 4, 2, 3 } });
  const TriangleMesh mesh = MakeMesh(shape);
  const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
  const DiscreteForms forms = cartan::ComputeDiscreteForms(mesh, shape.Positions, frames);
  const Matrices expected = cartan::TransitionsFromFrames(mesh, frames);
  for (const TransitionMethod method :
    { TransitionMethod::Procrustes, TransitionMethod::OrientationBits })
  {
    const Matrices found = cartan::TransitionsFromForms(mesh, forms, method);
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Transitions, AreDroppedWhereNothingDeterminesThem)
{
  // Two needles side by side share the edge (0, 1).
  Shape shape;
  shape.Positions = shapes::ToPoints(
    { { 0, 0, 0 }, { 3, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 1.5, 1, 0 }, { 1.5, -1, 0.5 } });
  shape.Faces = shapes::ToTriangles(
    { { 0, 1, 2 }, { 1, 0, 3 }, { 0, 2, 4 }, { 2, 1, 4 }, { 0, 5, 3 }, { 3, 5, 1 } });
  const TriangleMesh mesh = MakeMesh(shape);
  const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
  const DiscreteForms forms = cartan::ComputeDiscreteForms(mesh, shape.Positions, frames);
  const Matrices expected = cartan::TransitionsFromFrames(mesh, frames);
  for (const TransitionMethod method :
    { TransitionMethod::Procrustes, TransitionMethod::OrientationBits })
  {
    const Matrices found = cartan::TransitionsFromForms(mesh, forms, method);
    for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
    {
      const bool isBetweenNeedles = mesh.Origin(d) + mesh.Neighbor(d) == 1;
      if (isBetweenNeedles)
      {
        EXPECT_TRUE(found.row(d).isZero(0.0));
      }
      else
      {
        EXPECT_LT((found.row(d) - expected.row(d)).cwiseAbs().maxCoeff(), 1e-9);
      }
    }
  }
}
