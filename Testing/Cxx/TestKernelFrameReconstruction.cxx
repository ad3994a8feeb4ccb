// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Differential/FrameReconstruction.h"

#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Differential/Laplacian.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <Eigen/QR>
#include <gtest/gtest.h>

using cartan::DiscreteForms;
using cartan::Matrices;
using cartan::MatrixAt;
using cartan::Points;
using cartan::SparseMatrix;
using cartan::TransitionMethod;
using cartan::TriangleMesh;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using shapes::MakeMesh;
using shapes::Shape;

namespace
{
/// The rectangular system of Eq. 1, three rows for each directed edge i -> j:
/// X_j - C_ij^T X_i = 0 with X_i = F_i^T.
SparseMatrix FrameEquations(const TriangleMesh& mesh, const Matrices& transitions)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const int i = mesh.Origin(d);
    const int j = mesh.Neighbor(d);
    const Matrix3d transition = MatrixAt(transitions, d);
    for (int row = 0; row < 3; ++row)
    {
      entries.emplace_back(3 * d + row, 3 * j + row, 1.0);
      for (int column = 0; column < 3; ++column)
      {
        entries.emplace_back(3 * d + row, 3 * i + column, -transition(column, row));
      }
    }
  }
  SparseMatrix equations(3 * mesh.NumberOfDirectedEdges(), 3 * mesh.NumberOfVertices());
  equations.setFromTriplets(entries.begin(), entries.end());
  return equations;
}

/// Minimizes |A x - b| under x = values where fixed, by QR of the dense system.
Eigen::MatrixXd LeastSquares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
  const std::vector<char>& isFixed, Eigen::MatrixXd values)
{
  std::vector<int> free;
  Eigen::MatrixXd right = b;
  for (int i = 0; i < static_cast<int>(isFixed.size()); ++i)
  {
    if (isFixed[i])
    {
      right -= a.col(i) * values.row(i);
    }
    else
    {
      free.push_back(i);
    }
  }
  const Eigen::MatrixXd solution = a(Eigen::all, free).colPivHouseholderQr().solve(right);
  for (std::size_t i = 0; i < free.size(); ++i)
  {
    values.row(free[i]) = solution.row(static_cast<Eigen::Index>(i));
  }
  return values;
}

struct Reconstruction
{
  Matrices Frames;
  Points Positions;
};

/// From the forms alone: `seed` gets the given frame and position.
Reconstruction Reconstruct(const TriangleMesh& mesh, const DiscreteForms& forms, int seed,
  const Matrix3d& frame, const Vector3d& position,
  TransitionMethod method = TransitionMethod::Procrustes)
{
  std::vector<char> isFixed(mesh.NumberOfVertices(), 0);
  isFixed[seed] = 1;
  Matrices frames = Matrices::Zero(mesh.NumberOfVertices(), 9);
  MatrixAt(frames, seed) = frame;
  Points positions = Points::Zero(mesh.NumberOfVertices(), 3);
  positions.row(seed) = position.transpose();
  const cartan::AnchoredSystem system = cartan::ReconstructionSystem(mesh, isFixed);
  frames = cartan::ReconstructFrames(
    mesh, cartan::TransitionsFromForms(mesh, forms, method), isFixed, frames, system);
  positions = cartan::SolvePositions(
    mesh, frames, cartan::RingCoordinates(mesh, forms), isFixed, positions, system);
  return { frames, positions };
}

/// The largest distance from the surface after the seed's rigid motion.
double ReconstructionError(const Shape& shape, TransitionMethod method, double seedDistance = 1.0)
{
  const TriangleMesh mesh = MakeMesh(shape);
  const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
  const DiscreteForms forms = cartan::ComputeDiscreteForms(mesh, shape.Positions, frames);
  const int seed = mesh.NumberOfVertices() / 2;
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(5, seedDistance);
  const Reconstruction result =
    Reconstruct(mesh, forms, seed, motion.Rotation * MatrixAt(frames, seed),
      motion(Points(shape.Positions.row(seed))).transpose(), method);
  return (result.Positions - motion(shape.Positions)).rowwise().norm().maxCoeff() /
    cartan::BoundingDiagonal(shape.Positions);
}

/// Transitions that fit together nowhere, turned by up to `angle` about each axis.
Matrices NoisyTransitions(const TriangleMesh& mesh, const Points& points, double angle = 0.3)
{
  Matrices transitions = cartan::TransitionsFromFrames(mesh, cartan::VertexFrames(mesh, points));
  shapes::Random random(6);
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const Vector3d turn{ random(), random(), random() };
    MatrixAt(transitions, d) =
      (MatrixAt(transitions, d) * cartan::RotationFromVector(angle * turn)).eval();
  }
  return transitions;
}
}

TEST(FrameMatrix, IsTheNormalMatrixOfThePapersEquations)
{
  for (const Shape& shape : { shapes::Icosphere(1), shapes::Plane(4, 1.0, 0.2) })
  {
    const TriangleMesh mesh = MakeMesh(shape);
    const Matrices transitions = NoisyTransitions(mesh, shape.Positions);
    const SparseMatrix equations = FrameEquations(mesh, transitions);
    const SparseMatrix expected = equations.transpose() * equations;
    EXPECT_LT((cartan::FrameMatrix(mesh, transitions) - expected).norm(), 1e-13);
  }
}

TEST(FrameMatrix, OfARealMeshIsTwiceTheGraphLaplacianInItsOwnFrames)
{
  // U^T N U = 2 L (x) I with U = diag(F_i^T): X_i = F_i^T Y_i.
  for (const char* name : { "armadillo", "camel", "lion-head" })
  {
    const Shape shape = shapes::RealMesh(name);
    const TriangleMesh mesh = MakeMesh(shape);
    const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
    const DiscreteForms forms = cartan::ComputeDiscreteForms(mesh, shape.Positions, frames);
    const SparseMatrix matrix =
      cartan::FrameMatrix(mesh, cartan::TransitionsFromForms(mesh, forms));
    std::vector<Eigen::Triplet<double>> entries;
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      const Matrix3d frame = MatrixAt(frames, v);
      for (int i = 0; i < 9; ++i)
      {
        entries.emplace_back(3 * v + i / 3, 3 * v + i % 3, frame(i % 3, i / 3));
      }
    }
    SparseMatrix u(matrix.rows(), matrix.cols());
    u.setFromTriplets(entries.begin(), entries.end());
    const SparseMatrix product = u.transpose() * matrix * u;

    const SparseMatrix laplacian =
      cartan::Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges()));
    entries.clear();
    for (int column = 0; column < laplacian.cols(); ++column)
    {
      for (SparseMatrix::InnerIterator entry(laplacian, column); entry; ++entry)
      {
        for (int k = 0; k < 3; ++k)
        {
          entries.emplace_back(
            3 * static_cast<int>(entry.row()) + k, 3 * column + k, 2.0 * entry.value());
        }
      }
    }
    SparseMatrix expected(matrix.rows(), matrix.cols());
    expected.setFromTriplets(entries.begin(), entries.end());
    const SparseMatrix difference = product - expected;
    const double worst =
      Eigen::Map<const Eigen::VectorXd>(difference.valuePtr(), difference.nonZeros())
        .cwiseAbs()
        .maxCoeff();
    shapes::ShowFigure(std::string(name) + ", U^T N U - 2 L (x) I", worst);
    EXPECT_LT(worst, 1e-12);
  }
}

TEST(SolveFrames, IsTheLeastSquaresSolutionOfInconsistentEquations)
{
  const Shape shape = shapes::Saddle(4, 1.0, 0.2);
  const TriangleMesh mesh = MakeMesh(shape);
  const Matrices transitions = NoisyTransitions(mesh, shape.Positions);
  std::vector<char> isFixed(mesh.NumberOfVertices(), 0);
  isFixed[0] = isFixed[12] = 1;
  Matrices frames = Matrices::Zero(mesh.NumberOfVertices(), 9);
  MatrixAt(frames, 0) = shapes::RandomRigidMotion(1).Rotation;
  MatrixAt(frames, 12) = shapes::RandomRigidMotion(2).Rotation;
  cartan::AnchoredSystem system;
  const Matrices result = cartan::SolveFrames(mesh, transitions, isFixed, frames, system);

  const Eigen::MatrixXd equations = FrameEquations(mesh, transitions);
  std::vector<char> isFixedUnknown(3 * mesh.NumberOfVertices());
  Eigen::MatrixXd values(3 * mesh.NumberOfVertices(), 3);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    std::fill_n(isFixedUnknown.begin() + 3 * v, 3, isFixed[v]);
    values.middleRows<3>(3 * v) = MatrixAt(frames, v).transpose();
  }
  const Eigen::MatrixXd expected =
    LeastSquares(equations, Eigen::MatrixXd::Zero(equations.rows(), 3), isFixedUnknown, values);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    EXPECT_LT((MatrixAt(result, v).transpose() - expected.middleRows<3>(3 * v)).norm(), 1e-12);
  }
}

TEST(ReconstructFrames, SolvesTheSameSystemByStepsOrAFactorization)
{
  // Ones that fit together, nearly, hardly, and not at all.
  const Shape shape = shapes::RealMesh("elephant");
  const TriangleMesh mesh = MakeMesh(shape);
  std::vector<char> isFixed(mesh.NumberOfVertices(), 0);
  isFixed[0] = isFixed[1200] = 1;
  const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
  Matrices given = Matrices::Zero(mesh.NumberOfVertices(), 9);
  for (const int v : { 0, 1200 })
  {
    MatrixAt(given, v) = shapes::RandomRigidMotion(1).Rotation * MatrixAt(frames, v);
  }
  const cartan::AnchoredSystem laplacian = cartan::ReconstructionSystem(mesh, isFixed);
  for (const double angle : { 0.0, 1e-4, 1e-3, 0.01, 0.3, 3.0 })
  {
    const Matrices transitions = NoisyTransitions(mesh, shape.Positions, angle);
    cartan::AnchoredSystem system;
    const Matrices expected = cartan::SolveFrames(mesh, transitions, isFixed, given, system);
    const Matrices solved = cartan::ReconstructFrames(mesh, transitions, isFixed, given, laplacian);
    EXPECT_LT((solved - expected).cwiseAbs().maxCoeff(), 1e-8) << angle;
  }
}

TEST(SolvePositions, IsTheLeastSquaresSolutionOfEq5)
{
  // Frames and edges that do not belong together.
  const Shape shape = shapes::Noisy(shapes::Plane(4), 0.1);
  const TriangleMesh mesh = MakeMesh(shape);
  shapes::Random random(3);
  const Matrices frames =
    Matrices::NullaryExpr(mesh.NumberOfVertices(), 9, [&random]() { return random(); });
  const Points ring =
    Points::NullaryExpr(mesh.NumberOfDirectedEdges(), 3, [&random]() { return random(); });
  std::vector<char> isFixed(mesh.NumberOfVertices(), 0);
  isFixed[3] = isFixed[20] = 1;
  const Points result = cartan::SolvePositions(
    mesh, frames, ring, isFixed, shape.Positions, cartan::ReconstructionSystem(mesh, isFixed));

  Eigen::MatrixXd equations =
    Eigen::MatrixXd::Zero(mesh.NumberOfDirectedEdges(), mesh.NumberOfVertices());
  Eigen::MatrixXd right(mesh.NumberOfDirectedEdges(), 3);
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    equations(d, mesh.Neighbor(d)) = 1.0;
    equations(d, mesh.Origin(d)) = -1.0;
    right.row(d) = (MatrixAt(frames, mesh.Origin(d)) * ring.row(d).transpose()).transpose();
  }
  EXPECT_LT((result - LeastSquares(equations, right, isFixed, shape.Positions)).norm(), 1e-12);
}

//------------------------------------------------------------------------------
TEST(Reconstruction, FromTheFormsAloneReturnsTheSurface)
{
  for (const TransitionMethod method :
    { TransitionMethod::Procrustes, TransitionMethod::OrientationBits })
  {
    for (const char* name : { "camel", "lion-head", "elephant" })
    {
      const Shape shape = shapes::RealMesh(name);
      if (MakeMesh(shape).NumberOfComponents() > 1)
      {
        continue;
      }
      const double error = ReconstructionError(shape, method);
      shapes::ShowFigure(std::string(name) +
          (method == TransitionMethod::Procrustes ? ", reconstruction, Procrustes"
                                                  : ", reconstruction, Theorem 3.1"),
        error);
      EXPECT_LT(error, 1e-9);
    }
    for (const Shape& shape : { shapes::Icosphere(2), shapes::Saddle(7, 1.0, 0.2),
           shapes::OpenCylinder(8, 4), shapes::Plane(1), shapes::Bar(2, 2, 5, { 1, 1, 4 }) })
    {
      EXPECT_LT(ReconstructionError(shape, method), 1e-12);
    }
  }
}

TEST(Reconstruction, ReturnsTheFramesToo)
{
  const Shape shape = shapes::RealMesh("elephant");
  const TriangleMesh mesh = MakeMesh(shape);
  const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
  const DiscreteForms forms = cartan::ComputeDiscreteForms(mesh, shape.Positions, frames);
  const Reconstruction result =
    Reconstruct(mesh, forms, 0, MatrixAt(frames, 0), shape.Positions.row(0));
  double worst = 0.0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.Component(v) == mesh.Component(0))
    {
      worst = std::max(worst, (MatrixAt(result.Frames, v) - MatrixAt(frames, v)).norm());
    }
  }
  EXPECT_LT(worst, 1e-9);
}

TEST(Reconstruction, DoesNotDependOnTheUnitNorOnWhereTheSeedIs)
{
  for (const double unit : { 1e-9, 1.0, 1e6 })
  {
    Shape shape = shapes::Noisy(shapes::Icosphere(3), 0.02);
    shape.Positions *= unit;
    EXPECT_LT(ReconstructionError(shape, TransitionMethod::Procrustes, unit), 1e-12);
    // A double has 1e-10 of the size left when it is a million sizes away.
    EXPECT_LT(ReconstructionError(shape, TransitionMethod::Procrustes, 1e6 * unit), 1e-9);
  }
}

TEST(Reconstruction, OfASurfaceWithADegenerateTriangleWorks)
{
  // A point in the middle of an edge: one of the triangles is a needle.
  Shape shape = shapes::Noisy(shapes::Plane(4), 0.05);
  const int added = shape.NumberOfVertices();
  const int a = shape.Faces(9, 0);
  const int b = shape.Faces(9, 1);
  const int c = shape.Faces(9, 2);
  shape.Positions.conservativeResize(added + 1, 3);
  shape.Positions.row(added) = 0.5 * (shape.Positions.row(a) + shape.Positions.row(b));
  shape.Faces.row(9) << a, added, c;
  shape.Faces.conservativeResize(shape.Faces.rows() + 2, 3);
  shape.Faces.bottomRows(2) << added, b, c, a, b, added;
  for (const TransitionMethod method :
    { TransitionMethod::Procrustes, TransitionMethod::OrientationBits })
  {
    EXPECT_LT(ReconstructionError(shape, method), 1e-9);
  }
}

TEST(Reconstruction, RefusesAComponentThatNothingHolds)
{
  const Shape shape = shapes::Union(shapes::Icosphere(0), shapes::Icosphere(0));
  const TriangleMesh mesh = MakeMesh(shape);
  const DiscreteForms forms = cartan::ComputeDiscreteForms(
    mesh, shape.Positions, cartan::VertexFrames(mesh, shape.Positions));
  try
  {
    Reconstruct(mesh, forms, 3, Matrix3d::Identity(), Vector3d::Zero());
    FAIL() << "accepted";
  }
  catch (const cartan::Error& error)
  {
    EXPECT_EQ(error.GetCode(), cartan::ErrorCode::SingularSystem);
    // Vertices are counted, not unknowns.
    EXPECT_NE(
      std::string(error.what()).find("12 points (ids 12, 13, 14, 15, 16, ...)"), std::string::npos)
      << error.what();
  }
}

TEST(Reconstruction, LeavesUnusedVerticesAlone)
{
  Shape shape = shapes::Icosphere(1);
  shape.Positions.conservativeResize(44, 3);
  shape.Positions.bottomRows(2).setConstant(7.0);
  const TriangleMesh mesh = MakeMesh(shape);
  const Matrices frames = cartan::VertexFrames(mesh, shape.Positions);
  const DiscreteForms forms = cartan::ComputeDiscreteForms(mesh, shape.Positions, frames);
  std::vector<char> isFixed(44, 0);
  isFixed[0] = 1;
  const Points result = cartan::SolvePositions(mesh, frames, cartan::RingCoordinates(mesh, forms),
    isFixed, shape.Positions, cartan::ReconstructionSystem(mesh, isFixed));
  EXPECT_EQ(result.bottomRows(2), shape.Positions.bottomRows(2));
  EXPECT_LT((result - shape.Positions).norm(), 1e-13);
}
