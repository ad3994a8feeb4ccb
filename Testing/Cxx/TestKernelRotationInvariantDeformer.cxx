// SPDX-License-Identifier: BSD-3-Clause
#include "Ids.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"

#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Differential/DiscreteForms.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <thread>

using cartan::DeformedSurface;
using cartan::ErrorCode;
using cartan::FrameProjection;
using cartan::HandleMotion;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::LaplacianWeights;
using cartan::Matrices;
using cartan::MatrixAt;
using cartan::Points;
using cartan::RotationFromVector;
using cartan::RotationInvariantDeformer;
using cartan::SolverBackend;
using cartan::SparseMatrix;
using cartan::TriangleMesh;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using shapes::MakeMesh;
using shapes::ManyThreads;
using shapes::Shape;
using shapes::Volume;

namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

constexpr LaplacianWeights AllWeights[] = { LaplacianWeights::Uniform, LaplacianWeights::Cotangent,
  LaplacianWeights::MeanValue };

/// Handles 1, 2, 3 at the ends of the extent along `axis` and beside its middle;
/// handles 2 and 3 move.
HandleProblem MakeProblem(const Shape& shape, int axis, double share = 0.15)
{
  const shapes::HandleOf end = shapes::EndsAlong(shape, axis, share);
  const auto other = shape.Positions.col((axis + 1) % 3);
  const double otherEnd = other.maxCoeff() - 0.05 * (other.maxCoeff() - other.minCoeff());
  return shapes::ProblemOf(shape,
    [&](const Vector3d& x)
    {
      const int handle = end(x);
      return handle > 0 ? handle : x[(axis + 1) % 3] > otherEnd ? 3 : 0;
    },
    { 2, 3 });
}

/// For frames and positions.
void SetWeights(HandleProblem& problem, LaplacianWeights weights)
{
  problem.Weights = weights;
  problem.PositionWeights = weights;
}

/// A motion about `center`.
HandleMotion Motion(
  const Matrix3d& linear, const Vector3d& center, const Vector3d& shift = Vector3d::Zero())
{
  HandleMotion motion;
  motion.Linear = linear;
  motion.Translation = center - linear * center + shift;
  return motion;
}

Matrix3d Turn(double x, double y, double z)
{
  return RotationFromVector(Vector3d(x, y, z));
}

Matrix3d ScaleAndShear()
{
  Matrix3d linear;
  linear << 1.5, 0.3, 0.0, 0.0, 0.8, -0.2, 0.1, 0.0, 2.0;
  return linear;
}

DeformedSurface Deform(RotationInvariantDeformer& deformer, const HandleTargets& targets,
  FrameProjection projection = FrameProjection::Automatic)
{
  DeformedSurface result;
  deformer.SetFrameProjection(projection);
  deformer.Deform(targets, true, result, {});
  return result;
}

DeformedSurface Deform(const HandleProblem& problem, const std::vector<HandleMotion>& motions,
  FrameProjection projection = FrameProjection::Automatic)
{
  RotationInvariantDeformer deformer(problem);
  HandleTargets targets;
  targets.Motions = motions;
  return Deform(deformer, targets, projection);
}

double Distance(const Points& a, const Points& b)
{
  return (a - b).rowwise().norm().maxCoeff() / cartan::BoundingDiagonal(a);
}

/// The paper's editing, literally: the rectangular systems of Eq. 1 and Eq. 5
/// over both directions of each edge, with the transitions of the surface's
/// frames, constraints put into the right-hand side, normal equations.
class LiteralPaper
{
public:
  /// `frameWeights` and `positionWeights`: 0 free, infinity hard, else a soft row.
  LiteralPaper(const Shape& shape, Eigen::VectorXd frameWeights, Eigen::VectorXd positionWeights)
    : Mesh(MakeMesh(shape))
    , Frames(cartan::VertexFrames(Mesh, shape.Positions))
    , Ring(
        cartan::RingCoordinates(Mesh, cartan::ComputeDiscreteForms(Mesh, shape.Positions, Frames)))
    , FrameSystem(FrameRows(), RepeatThrice(frameWeights))
    , PositionSystem(PositionRows(), std::move(positionWeights))
  {
  }

  /// The frames over the original ones: R_i with R_i F_i the solution, for the
  /// constraints R_i = transforms_i.
  Matrices SolveTransforms(const Matrices& transforms) const
  {
    Eigen::MatrixXd given(3 * this->Mesh.NumberOfVertices(), 3);
    for (int v = 0; v < this->Mesh.NumberOfVertices(); ++v)
    {
      given.middleRows<3>(3 * v) =
        (MatrixAt(transforms, v) * MatrixAt(this->Frames, v)).transpose();
    }
    const Eigen::MatrixXd right = Eigen::MatrixXd::Zero(3 * this->Mesh.NumberOfDirectedEdges(), 3);
    const Eigen::MatrixXd solution = this->FrameSystem.Solve(right, given);
    Matrices result(this->Mesh.NumberOfVertices(), 9);
    for (int v = 0; v < this->Mesh.NumberOfVertices(); ++v)
    {
      MatrixAt(result, v) =
        solution.middleRows<3>(3 * v).transpose() * MatrixAt(this->Frames, v).transpose();
    }
    return result;
  }

  Points SolvePositions(const Matrices& transforms, const Points& targets) const
  {
    Eigen::MatrixXd right(this->Mesh.NumberOfDirectedEdges(), 3);
    for (int d = 0; d < this->Mesh.NumberOfDirectedEdges(); ++d)
    {
      const int i = this->Mesh.Origin(d);
      right.row(d) =
        (MatrixAt(transforms, i) * MatrixAt(this->Frames, i) * this->Ring.row(d).transpose())
          .transpose();
    }
    return this->PositionSystem.Solve(right, targets);
  }

private:
  /// Minimizes |rows x - right|^2 + sum w^2 |x - given|^2, hard where w is infinite.
  class System
  {
  public:
    System(const SparseMatrix& rows, Eigen::VectorXd weights)
      : Rows(rows)
      , Weights(std::move(weights))
    {
      std::vector<Eigen::Triplet<double>> entries;
      for (int i = 0; i < this->Weights.size(); ++i)
      {
        if (std::isfinite(this->Weights[i]))
        {
          entries.emplace_back(i, static_cast<int>(entries.size()), 1.0);
        }
      }
      this->Free.resize(this->Weights.size(), static_cast<Eigen::Index>(entries.size()));
      this->Free.setFromTriplets(entries.begin(), entries.end());
      const SparseMatrix reduced = this->Rows * this->Free;
      SparseMatrix normal = reduced.transpose() * reduced;
      normal += SparseMatrix(this->Free.transpose() * this->Soft().asDiagonal() * this->Free);
      this->Cholesky.compute(normal);
      EXPECT_EQ(this->Cholesky.info(), Eigen::Success);
    }

    Eigen::MatrixXd Solve(const Eigen::MatrixXd& right, const Eigen::MatrixXd& given) const
    {
      Eigen::MatrixXd hard = given;
      for (Eigen::Index i = 0; i < hard.rows(); ++i)
      {
        hard.row(i) *= std::isfinite(this->Weights[i]) ? 0.0 : 1.0;
      }
      const Eigen::MatrixXd residual = right - this->Rows * hard;
      const Eigen::MatrixXd soft = this->Soft().asDiagonal() * given;
      return hard +
        this->Free *
        Eigen::MatrixXd(this->Cholesky.solve(
          this->Free.transpose() * (this->Rows.transpose() * residual + soft)));
    }

  private:
    Eigen::VectorXd Soft() const
    {
      return this->Weights.unaryExpr([](double w) { return std::isfinite(w) ? w * w : 0.0; });
    }

    SparseMatrix Rows;
    Eigen::VectorXd Weights;
    SparseMatrix Free;
    Eigen::SimplicialLDLT<SparseMatrix> Cholesky;
  };

  static Eigen::VectorXd RepeatThrice(const Eigen::VectorXd& weights)
  {
    Eigen::VectorXd repeated(3 * weights.size());
    for (Eigen::Index i = 0; i < repeated.size(); ++i)
    {
      repeated[i] = weights[i / 3];
    }
    return repeated;
  }

  SparseMatrix FrameRows() const
  {
    const Matrices transitions = cartan::TransitionsFromFrames(this->Mesh, this->Frames);
    std::vector<Eigen::Triplet<double>> entries;
    for (int d = 0; d < this->Mesh.NumberOfDirectedEdges(); ++d)
    {
      for (int row = 0; row < 3; ++row)
      {
        entries.emplace_back(3 * d + row, 3 * this->Mesh.Neighbor(d) + row, 1.0);
        for (int column = 0; column < 3; ++column)
        {
          entries.emplace_back(
            3 * d + row, 3 * this->Mesh.Origin(d) + column, -MatrixAt(transitions, d)(column, row));
        }
      }
    }
    SparseMatrix rows(3 * this->Mesh.NumberOfDirectedEdges(), 3 * this->Mesh.NumberOfVertices());
    rows.setFromTriplets(entries.begin(), entries.end());
    return rows;
  }

  SparseMatrix PositionRows() const
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (int d = 0; d < this->Mesh.NumberOfDirectedEdges(); ++d)
    {
      entries.emplace_back(d, this->Mesh.Neighbor(d), 1.0);
      entries.emplace_back(d, this->Mesh.Origin(d), -1.0);
    }
    SparseMatrix rows(this->Mesh.NumberOfDirectedEdges(), this->Mesh.NumberOfVertices());
    rows.setFromTriplets(entries.begin(), entries.end());
    return rows;
  }

  TriangleMesh Mesh;
  Matrices Frames;
  Points Ring;
  System FrameSystem;
  System PositionSystem;
};

/// What the motions ask of each vertex; the identity where there is none.
struct VertexTargets
{
  Matrices Transforms;
  Points Positions;
};

VertexTargets TargetsOfMotions(
  const HandleProblem& problem, const std::vector<HandleMotion>& motions)
{
  VertexTargets targets;
  targets.Positions = *problem.Rest;
  targets.Transforms.resize(problem.Rest->rows(), 9);
  for (Eigen::Index v = 0; v < problem.Rest->rows(); ++v)
  {
    MatrixAt(targets.Transforms, v).setIdentity();
    for (std::size_t k = 0; k < motions.size(); ++k)
    {
      if (problem.Handle[v] == problem.Moving[k])
      {
        MatrixAt(targets.Transforms, v) = motions[k].Linear;
        targets.Positions.row(v) =
          (motions[k].Linear * problem.Rest->row(v).transpose() + motions[k].Translation)
            .transpose();
      }
    }
  }
  return targets;
}

/// Infinity at the handles for which `isHeld`, 0 elsewhere.
Eigen::VectorXd HardWeights(const HandleProblem& problem, const std::set<int>& held)
{
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(problem.Rest->rows());
  for (Eigen::Index v = 0; v < weights.size(); ++v)
  {
    weights[v] = held.count(problem.Handle[v]) ? Infinity : 0.0;
  }
  return weights;
}

double LargestDifference(const Matrices& a, const Matrices& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}

/// The closest rotation by singular values, for matrices of positive determinant.
Matrix3d PolarFactor(const Matrix3d& a)
{
  const Eigen::JacobiSVD<Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

std::vector<HandleMotion> TwoMotions(const Shape& shape, bool rigid)
{
  const Vector3d center = shape.Positions.colwise().mean();
  const double size = cartan::BoundingDiagonal(shape.Positions);
  if (rigid)
  {
    return { Motion(Turn(0.9, -0.4, 1.1), center, size * Vector3d(0.1, 0.0, -0.05)),
      Motion(Turn(-0.5, 0.8, 0.3), center) };
  }
  return { Motion(ScaleAndShear(), center),
    Motion(1.7 * Turn(0.2, 0.1, -1.0), center, size * Vector3d(0.0, 0.2, 0.1)) };
}

}

//------------------------------------------------------------------------------
TEST(RotationInvariantDeformer, SolvesThePapersSystemsWithHardHandles)
{
  for (const std::string name : { "camel", "armadillo" })
  {
    const Shape shape = shapes::RealMesh(name);
    HandleProblem problem = MakeProblem(shape, 1);
    SetWeights(problem, LaplacianWeights::Uniform);
    ASSERT_GT(shape.NumberOfVertices(), 5000);
    ASSERT_EQ(problem.Mesh->NumberOfComponents(), 1);
    const Eigen::VectorXd hard = HardWeights(problem, { 1, 2, 3 });
    const LiteralPaper paper(shape, hard, hard);
    RotationInvariantDeformer deformer(problem);
    for (const bool rigid : { true, false })
    {
      HandleTargets targets;
      targets.Motions = TwoMotions(shape, rigid);
      const VertexTargets vertexTargets = TargetsOfMotions(problem, targets.Motions);
      const Matrices transforms = paper.SolveTransforms(vertexTargets.Transforms);
      const Points positions = paper.SolvePositions(transforms, vertexTargets.Positions);
      const DeformedSurface raw = Deform(deformer, targets, FrameProjection::None);
      const std::string title = name + (rigid ? ", rigid handles" : ", scale and shear");
      shapes::ShowFigure(
        title + ", frames - paper's", LargestDifference(raw.Transforms, transforms));
      shapes::ShowFigure(
        title + ", positions - paper's, relative", Distance(raw.Positions, positions));
      EXPECT_LT(LargestDifference(raw.Transforms, transforms), 1e-9);
      EXPECT_LT(Distance(raw.Positions, positions), 1e-9);
      EXPECT_GT(Distance(raw.Positions, shape.Positions), 0.1); // something happened

      // With projection, Eq. 5 is solved for the closest rotations.
      if (rigid)
      {
        Matrices rotations = transforms;
        for (Eigen::Index v = 0; v < rotations.rows(); ++v)
        {
          ASSERT_GT(MatrixAt(rotations, v).determinant(), 0.0);
          MatrixAt(rotations, v) = PolarFactor(MatrixAt(rotations, v));
        }
        const Points expected = paper.SolvePositions(rotations, vertexTargets.Positions);
        const DeformedSurface projected = Deform(deformer, targets, FrameProjection::Rotation);
        EXPECT_LT(LargestDifference(projected.Transforms, rotations), 1e-9);
        EXPECT_LT(Distance(projected.Positions, expected), 1e-9);
      }
    }
    EXPECT_EQ(deformer.GetNumberOfFactorizations(), 1);
  }
}

TEST(RotationInvariantDeformer, ProjectsRotationsAboutOneAxisAsAnyOthers)
{
  // Turns about parallel axes, in both directions and by more than half a turn,
  // and a handle that is only shifted.
  const Shape shape = shapes::RealMesh("elephant");
  HandleProblem problem = MakeProblem(shape, 0);
  SetWeights(problem, LaplacianWeights::Uniform);
  const Eigen::VectorXd hard = HardWeights(problem, { 1, 2, 3 });
  const LiteralPaper paper(shape, hard, hard);
  RotationInvariantDeformer deformer(problem);
  const Vector3d axis = Vector3d(1, 2, -2) / 3.0;
  const Vector3d center = shape.Positions.colwise().mean();
  for (const auto& [first, second] : std::vector<std::pair<double, double>>{ { 1.0, 2.0 },
         { 1.5, -1.0 }, { 4.0, 0.3 }, { 3.14159265, -3.0 }, { 0.7, 0.0 }, { 1e-9, 2e-9 } })
  {
    HandleTargets targets;
    targets.Motions = { Motion(RotationFromVector(first * axis), center, { 0.1, 0, 0 }),
      Motion(RotationFromVector(second * axis), center, { 0, 0.1, 0 }) };
    const VertexTargets vertexTargets = TargetsOfMotions(problem, targets.Motions);
    Matrices rotations = paper.SolveTransforms(vertexTargets.Transforms);
    for (Eigen::Index v = 0; v < rotations.rows(); ++v)
    {
      MatrixAt(rotations, v) = PolarFactor(MatrixAt(rotations, v));
    }
    const Points expected = paper.SolvePositions(rotations, vertexTargets.Positions);
    const DeformedSurface projected = Deform(deformer, targets, FrameProjection::Rotation);
    EXPECT_LT(LargestDifference(projected.Transforms, rotations), 1e-9) << first << " " << second;
    EXPECT_LT(Distance(projected.Positions, expected), 1e-9) << first << " " << second;
  }
}

TEST(RotationInvariantDeformer, SolvesThePapersSystemsWithSoftHandles)
{
  const Shape shape = shapes::RealMesh("camel");
  HandleProblem problem = MakeProblem(shape, 1);
  SetWeights(problem, LaplacianWeights::Uniform);
  shapes::Random random(3);
  problem.SoftWeights = Eigen::VectorXd::Zero(shape.NumberOfVertices());
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    const double choice = random(); // a third each: hard, soft, free
    problem.SoftWeights[v] = choice > 0.33 ? Infinity : choice > -0.33 ? 1.0 + random() : 0.0;
  }
  Eigen::VectorXd weights = problem.SoftWeights;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    weights[v] = problem.Handle[v] > 0 ? weights[v] : 0.0;
  }
  const LiteralPaper paper(shape, weights, weights);
  RotationInvariantDeformer deformer(problem);
  for (const bool rigid : { true, false })
  {
    const std::vector<HandleMotion> motions = TwoMotions(shape, rigid);
    const VertexTargets vertexTargets = TargetsOfMotions(problem, motions);
    const Matrices transforms = paper.SolveTransforms(vertexTargets.Transforms);
    const Points positions = paper.SolvePositions(transforms, vertexTargets.Positions);
    HandleTargets targets;
    targets.Motions = motions;
    const DeformedSurface raw = Deform(deformer, targets, FrameProjection::None);
    shapes::ShowFigure(
      "camel, soft handles, frames - paper's", LargestDifference(raw.Transforms, transforms));
    shapes::ShowFigure("  positions - paper's, relative", Distance(raw.Positions, positions));
    EXPECT_LT(LargestDifference(raw.Transforms, transforms), 1e-9);
    EXPECT_LT(Distance(raw.Positions, positions), 1e-9);
  }
}

TEST(RotationInvariantDeformer, SolvesThePapersSystemsWithATargetPerVertex)
{
  const Shape shape = shapes::RealMesh("elephant");
  HandleProblem problem = MakeProblem(shape, 0);
  SetWeights(problem, LaplacianWeights::Uniform);
  ASSERT_EQ(problem.Mesh->NumberOfComponents(), 1);
  shapes::Random random(4);
  VertexTargets vertexTargets = TargetsOfMotions(problem, { HandleMotion(), HandleMotion() });
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    if (problem.Handle[v] > 1)
    {
      for (int i = 0; i < 9; ++i)
      {
        MatrixAt(vertexTargets.Transforms, v)(i) += 0.3 * random();
      }
      vertexTargets.Positions.row(v) += 0.05 * Eigen::RowVector3d{ random(), random(), random() };
    }
  }
  HandleTargets targets;
  targets.Motions.resize(2);
  targets.Vertices = shapes::Ids(problem.Rest->rows());
  targets.Positions = vertexTargets.Positions;
  targets.Transforms = vertexTargets.Transforms;

  for (const bool isSoft : { false, true })
  {
    Eigen::VectorXd weights = HardWeights(problem, { 1, 2, 3 });
    if (isSoft)
    {
      problem.SoftWeights = Eigen::VectorXd::Constant(shape.NumberOfVertices(), 0.7);
      weights = weights.cwiseMin(0.7);
    }
    const LiteralPaper paper(shape, weights, weights);
    RotationInvariantDeformer deformer(problem);
    const DeformedSurface raw = Deform(deformer, targets, FrameProjection::None);
    const Matrices transforms = paper.SolveTransforms(vertexTargets.Transforms);
    EXPECT_LT(LargestDifference(raw.Transforms, transforms), 1e-9);
    EXPECT_LT(
      Distance(raw.Positions, paper.SolvePositions(transforms, vertexTargets.Positions)), 1e-9);
  }
}

TEST(RotationInvariantDeformer, LetsTheSurfaceFindItsPlaceWherePositionsAreFree)
{
  const Shape shape = shapes::RealMesh("elephant");
  HandleProblem problem = MakeProblem(shape, 0);
  SetWeights(problem, LaplacianWeights::Uniform);
  problem.ConstrainPositions = false;
  const std::vector<HandleMotion> motions = TwoMotions(shape, true);
  const VertexTargets vertexTargets = TargetsOfMotions(problem, motions);
  for (const bool isSoft : { false, true })
  {
    // Frames are held at all handles, positions at the pinned one alone.
    Eigen::VectorXd frameWeights = HardWeights(problem, { 1, 2, 3 });
    Eigen::VectorXd positionWeights = HardWeights(problem, { 1 });
    if (isSoft)
    {
      problem.SoftWeights = Eigen::VectorXd::Constant(shape.NumberOfVertices(), 1.3);
      frameWeights = frameWeights.cwiseMin(1.3);
      positionWeights = positionWeights.cwiseMin(1.3);
    }
    const LiteralPaper paper(shape, frameWeights, positionWeights);
    const DeformedSurface raw = Deform(problem, motions, FrameProjection::None);
    const Matrices transforms = paper.SolveTransforms(vertexTargets.Transforms);
    EXPECT_LT(LargestDifference(raw.Transforms, transforms), 1e-9);
    EXPECT_LT(
      Distance(raw.Positions, paper.SolvePositions(transforms, vertexTargets.Positions)), 1e-9);
  }
}

//------------------------------------------------------------------------------
TEST(RotationInvariantDeformer, MovesRigidlyWhenAllHandlesDo)
{
  const Shape shape = shapes::RealMesh("camel");
  const shapes::RigidMotion rigid = shapes::RandomRigidMotion(7, 3.0);
  HandleMotion motion;
  motion.Linear = rigid.Rotation;
  motion.Translation = rigid.Translation;
  HandleProblem problem = MakeProblem(shape, 1);
  problem.Moving = { 1, 2, 3 };
  double worst = 0.0;
  for (const LaplacianWeights weights : AllWeights)
  {
    SetWeights(problem, weights);
    for (const bool isSoft : { false, true })
    {
      problem.SoftWeights =
        isSoft ? Eigen::VectorXd::Constant(shape.NumberOfVertices(), 0.5) : Eigen::VectorXd();
      for (const FrameProjection projection : { FrameProjection::None, FrameProjection::Rotation })
      {
        const DeformedSurface result = Deform(problem, { motion, motion, motion }, projection);
        worst = std::max(worst, Distance(result.Positions, rigid(shape.Positions)));
      }
    }
  }
  shapes::ShowFigure("camel, all handles rigid, distance from the rigid motion", worst);
  EXPECT_LT(worst, 1e-10);
}

TEST(RotationInvariantDeformer, MapsAffinelyWhenAllHandlesDo)
{
  const Shape shape = shapes::RealMesh("elephant");
  HandleProblem problem = MakeProblem(shape, 0);
  problem.Moving = { 1, 2, 3 };
  const HandleMotion motion = Motion(ScaleAndShear(), { 0.3, 0.2, 0.1 }, { 1, 2, 3 });
  const DeformedSurface result = Deform(problem, { motion, motion, motion });
  const Points expected =
    (shape.Positions * motion.Linear.transpose()).rowwise() + motion.Translation.transpose();
  EXPECT_LT(Distance(result.Positions, expected), 1e-10);
}

TEST(RotationInvariantDeformer, DoesNothingWithoutMotion)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleProblem problem = MakeProblem(shape, 0);
  for (const FrameProjection projection :
    { FrameProjection::Automatic, FrameProjection::None, FrameProjection::Rotation })
  {
    const DeformedSurface result = Deform(problem, { HandleMotion(), HandleMotion() }, projection);
    EXPECT_LT(Distance(result.Positions, shape.Positions), 1e-13);
    for (int v = 0; v < shape.NumberOfVertices(); ++v)
    {
      if (problem.Handle[v] > 0)
      {
        ASSERT_EQ(result.Positions.row(v), shape.Positions.row(v));
      }
    }
  }
}

TEST(RotationInvariantDeformer, LeavesWhatNoMovingHandleReachesAsItIs)
{
  // Two tori: the second has a handle that does not move; and on the first the
  // pinned handle cuts a part off.
  const Shape torus = shapes::Torus(40, 12);
  Shape shape = shapes::Union(torus, torus);
  HandleProblem problem;
  problem.Mesh = std::make_shared<const TriangleMesh>(MakeMesh(shape));
  problem.Rest = std::make_shared<const Points>(shape.Positions);
  problem.Handle.assign(shape.NumberOfVertices(), 0);
  const auto column = [](int v) { return v % 40; };
  int expectedFree = 0;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    const bool isFirst = v < torus.NumberOfVertices();
    const int c = column(v);
    problem.Handle[v] = isFirst ? (c == 0 ? 2 : c == 8 || c == 32 ? 1 : 0) : (c == 0 ? 3 : 0);
    expectedFree += isFirst && problem.Handle[v] == 0 && (c < 8 || c > 32);
  }
  problem.Moving = { 2 };
  for (const bool constrain : { true, false })
  {
    problem.ConstrainPositions = constrain;
    RotationInvariantDeformer deformer(problem);
    EXPECT_EQ(deformer.GetNumberOfFreeVertices(), expectedFree);
    HandleTargets targets;
    targets.Motions = { Motion(Turn(0.0, 0.7, 0.0), { 2, 0, 0 }, { 0.5, 0, 0.5 }) };
    const DeformedSurface result = Deform(deformer, targets);
    for (int v = 0; v < shape.NumberOfVertices(); ++v)
    {
      const int c = column(v);
      const bool isFirst = v < torus.NumberOfVertices();
      const bool isTouched = isFirst && (c < 8 || c > 32);
      const bool isSame = result.Positions.row(v) == shape.Positions.row(v) &&
        MatrixAt(result.Transforms, v).isIdentity(0.0);
      ASSERT_EQ(isSame, !isTouched) << v;
    }
  }
}

TEST(RotationInvariantDeformer, DragsByTheFormulaAsByTheFrames)
{
  // With a target per vertex the positions come from the frames; with motions
  // from four numbers per vertex and handle.
  const Shape shape = shapes::RealMesh("camel");
  for (const LaplacianWeights weights : AllWeights)
  {
    for (const bool isSoft : { false, true })
    {
      HandleProblem problem = MakeProblem(shape, 1);
      SetWeights(problem, weights);
      if (isSoft)
      {
        problem.SoftWeights = Eigen::VectorXd::Constant(shape.NumberOfVertices(), 0.4);
      }
      RotationInvariantDeformer deformer(problem);
      for (const bool rigid : { true, false })
      {
        HandleTargets targets;
        targets.Motions = TwoMotions(shape, rigid);
        const DeformedSurface byFormula = Deform(deformer, targets, FrameProjection::None);
        const VertexTargets vertexTargets = TargetsOfMotions(problem, targets.Motions);
        targets.Vertices = shapes::Ids(problem.Rest->rows());
        targets.Positions = vertexTargets.Positions;
        targets.Transforms = vertexTargets.Transforms;
        const DeformedSurface byFrames = Deform(deformer, targets, FrameProjection::None);
        EXPECT_LT(Distance(byFormula.Positions, byFrames.Positions), 1e-10);
        EXPECT_LT(LargestDifference(byFormula.Transforms, byFrames.Transforms), 1e-10);
      }
      EXPECT_EQ(deformer.GetNumberOfFactorizations(), 1);
    }
  }
}

TEST(RotationInvariantDeformer, TakesPartOfThePerVertexTargetsAlone)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleProblem problem = MakeProblem(shape, 0);
  RotationInvariantDeformer deformer(problem);
  HandleTargets motions;
  motions.Motions = TwoMotions(shape, true);
  const VertexTargets all = TargetsOfMotions(problem, motions.Motions);
  const DeformedSurface expected = Deform(deformer, motions);
  motions.Vertices = shapes::Ids(problem.Rest->rows());
  HandleTargets positions = motions;
  positions.Positions = all.Positions;
  EXPECT_LT(Distance(Deform(deformer, positions).Positions, expected.Positions), 1e-12);
  HandleTargets transforms = motions;
  transforms.Transforms = all.Transforms;
  EXPECT_LT(Distance(Deform(deformer, transforms).Positions, expected.Positions), 1e-12);
}

TEST(RotationInvariantDeformer, CommutesWithRigidMotionsOfEverything)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleProblem problem = MakeProblem(shape, 0);
  const std::vector<HandleMotion> motions = TwoMotions(shape, true);
  const shapes::RigidMotion rigid = shapes::RandomRigidMotion(9, 5.0);
  HandleProblem moved = problem;
  moved.Rest = std::make_shared<const Points>(rigid(shape.Positions));
  // The same motions of the moved surface: G M G^-1.
  std::vector<HandleMotion> conjugated = motions;
  for (HandleMotion& motion : conjugated)
  {
    const Matrix3d linear = rigid.Rotation * motion.Linear * rigid.Rotation.transpose();
    motion.Translation =
      rigid.Rotation * motion.Translation + rigid.Translation - linear * rigid.Translation;
    motion.Linear = linear;
  }
  for (const FrameProjection projection : { FrameProjection::None, FrameProjection::Rotation })
  {
    const Points expected = rigid(Deform(problem, motions, projection).Positions);
    EXPECT_LT(Distance(Deform(moved, conjugated, projection).Positions, expected), 1e-10);
  }
}

TEST(RotationInvariantDeformer, DoesNotDependOnTheUnit)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleProblem problem = MakeProblem(shape, 0);
  const std::vector<HandleMotion> motions = TwoMotions(shape, true);
  for (const LaplacianWeights weights : AllWeights)
  {
    for (const double unit : { 1e-9, 1e6 })
    {
      HandleProblem scaled = problem;
      SetWeights(scaled, weights);
      HandleProblem original = problem;
      SetWeights(original, weights);
      scaled.Rest = std::make_shared<const Points>(unit * shape.Positions);
      std::vector<HandleMotion> scaledMotions = motions;
      for (HandleMotion& motion : scaledMotions)
      {
        motion.Translation *= unit;
      }
      EXPECT_LT(Distance(Deform(scaled, scaledMotions).Positions,
                  unit * Deform(original, motions).Positions),
        1e-10);
    }
  }
}

TEST(RotationInvariantDeformer, DoesNotDependOnThreads)
{
  const Shape shape = shapes::RealMesh("camel");
  for (const bool constrain : { true, false })
  {
    HandleProblem problem = MakeProblem(shape, 1);
    problem.ConstrainPositions = constrain;
    HandleTargets targets;
    targets.Motions = TwoMotions(shape, true);
    RotationInvariantDeformer alone(problem);
    RotationInvariantDeformer together(problem, SolverBackend::Automatic, ManyThreads(7));
    for (const FrameProjection projection : { FrameProjection::None, FrameProjection::Rotation })
    {
      const DeformedSurface expected = Deform(alone, targets, projection);
      DeformedSurface result;
      together.SetFrameProjection(projection);
      together.Deform(targets, true, result, ManyThreads(5));
      // To the bit: each number is computed by one thread from the same numbers.
      EXPECT_EQ(result.Positions, expected.Positions);
      EXPECT_EQ(result.Transforms, expected.Transforms);
    }
  }
}

TEST(RotationInvariantDeformer, DoesNotDependOnTheNumbersOfHandles)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleProblem problem = MakeProblem(shape, 0);
  HandleProblem renumbered = problem;
  for (int& handle : renumbered.Handle)
  {
    handle = handle == 1 ? 1000000 : handle == 2 ? 9 : handle == 3 ? 4 : 0;
  }
  renumbered.Moving = { 4, 9 };
  const std::vector<HandleMotion> motions = TwoMotions(shape, true);
  for (const FrameProjection projection : { FrameProjection::None, FrameProjection::Rotation })
  {
    EXPECT_LT(Distance(Deform(problem, motions, projection).Positions,
                Deform(renumbered, { motions[1], motions[0] }, projection).Positions),
      1e-12);
  }
}

TEST(RotationInvariantDeformer, DoesNotDependOnTheSolver)
{
  if (!cartan::HasCholmod())
  {
    GTEST_SKIP() << "built without CHOLMOD";
  }
  const Shape shape = shapes::RealMesh("camel");
  const HandleProblem problem = MakeProblem(shape, 1);
  HandleTargets targets;
  targets.Motions = TwoMotions(shape, true);
  RotationInvariantDeformer byEigen(problem, SolverBackend::Eigen);
  RotationInvariantDeformer byCholmod(problem, SolverBackend::Cholmod);
  EXPECT_LT(
    Distance(Deform(byEigen, targets).Positions, Deform(byCholmod, targets).Positions), 1e-11);
}

//------------------------------------------------------------------------------
TEST(RotationInvariantDeformer, ProjectsAutomaticallyWhenEveryMotionIsRigid)
{
  const Shape shape = shapes::RealMesh("elephant");
  RotationInvariantDeformer deformer(MakeProblem(shape, 0));
  HandleTargets targets;
  const auto expectSame = [&](FrameProjection expected)
  {
    EXPECT_EQ(Deform(deformer, targets, FrameProjection::Automatic).Positions,
      Deform(deformer, targets, expected).Positions);
  };
  targets.Motions = TwoMotions(shape, true);
  expectSame(FrameProjection::Rotation);
  targets.Motions = TwoMotions(shape, false);
  expectSame(FrameProjection::None);
  targets.Motions = { TwoMotions(shape, true)[0], TwoMotions(shape, false)[1] };
  expectSame(FrameProjection::None);
  HandleMotion reflection;
  reflection.Linear = -Matrix3d::Identity();
  targets.Motions = { TwoMotions(shape, true)[0], reflection };
  expectSame(FrameProjection::None);
}

TEST(RotationInvariantDeformer, ProjectedFramesAreRotationsAndRawOnesBlend)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleProblem problem = MakeProblem(shape, 0);
  const std::vector<HandleMotion> motions = TwoMotions(shape, true);
  const DeformedSurface raw = Deform(problem, motions, FrameProjection::None);
  const DeformedSurface projected = Deform(problem, motions, FrameProjection::Rotation);
  double shrinking = 1.0;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    const Matrix3d rotation = MatrixAt(projected.Transforms, v);
    ASSERT_LT((rotation.transpose() * rotation - Matrix3d::Identity()).norm(), 1e-13);
    ASSERT_GT(rotation.determinant(), 0.0);
    shrinking = std::min(shrinking, MatrixAt(raw.Transforms, v).determinant());
    if (problem.Handle[v] > 0)
    {
      const Matrix3d expected =
        problem.Handle[v] == 1 ? Matrix3d::Identity() : motions[problem.Handle[v] - 2].Linear;
      ASSERT_LT((rotation - expected).norm(), 1e-14);
      ASSERT_LT((MatrixAt(raw.Transforms, v) - expected).norm(), 1e-14);
    }
  }
  EXPECT_LT(shrinking, 0.9);
}

TEST(RotationInvariantDeformer, BendsABarWithThePublishedLossOfVolume)
{
  // A bar of 1 x 1 x 6, half a unit held at each end, cotangent weights, the
  // upper end turned and free to find its place.
  const Shape bar = shapes::Bar(8, 8, 48, { 1, 1, 6 });
  HandleProblem problem = shapes::ProblemOf(
    bar, [](const Vector3d& x) { return x[2] < 0.5 + 1e-9 ? 1
                                   : x[2] > 5.5 - 1e-9    ? 2
                                                          : 0; });
  problem.ConstrainPositions = false;
  RotationInvariantDeformer deformer(problem);
  struct Case
  {
    double Degrees;
    FrameProjection Projection;
    double VolumeRatio;
  };
  for (const Case& expected :
    { Case{ 90, FrameProjection::None, 0.713 }, Case{ 90, FrameProjection::Rotation, 0.971 },
      Case{ 170, FrameProjection::None, 0.431 }, Case{ 170, FrameProjection::Rotation, 0.832 } })
  {
    HandleTargets targets;
    targets.Motions.resize(1);
    targets.Motions[0].Linear = Turn(expected.Degrees * shapes::Pi / 180.0, 0, 0);
    const DeformedSurface result = Deform(deformer, targets, expected.Projection);
    const double ratio = Volume(result.Positions, bar.Faces) / Volume(bar.Positions, bar.Faces);
    shapes::ShowFigure("bar bent by " + std::to_string(static_cast<int>(expected.Degrees)) +
        (expected.Projection == FrameProjection::None ? " degrees, raw" : " degrees, projected"),
      ratio);
    EXPECT_NEAR(ratio, expected.VolumeRatio, 0.02 * expected.VolumeRatio);
  }
}

TEST(RotationInvariantDeformer, PlacesTheRotationByLengthWithCotangentWeightsOnly)
{
  // A tube whose rows get four times as wide from one end to the other. Every
  // vertex has as many edges up as down, so uniform weights share the angle out
  // by rows, cotangent ones by length.
  constexpr int Rows = 60;
  constexpr double Angle = 1.0;
  Shape tube = shapes::OpenCylinder(16, Rows, 1.0, 1.0);
  for (int v = 0; v < tube.NumberOfVertices(); ++v)
  {
    tube.Positions(v, 2) = 10.0 * (std::pow(4.0, tube.Positions(v, 2)) - 1.0) / 3.0;
  }
  HandleProblem problem;
  problem.Mesh = std::make_shared<const TriangleMesh>(MakeMesh(tube));
  problem.Rest = std::make_shared<const Points>(tube.Positions);
  problem.Handle.assign(tube.NumberOfVertices(), 0);
  problem.Moving = { 2 };
  int lowRow = 0;
  int highRow = Rows;
  const auto height = [&](int row) { return tube.Positions(16 * row, 2); };
  for (int v = 0; v < tube.NumberOfVertices(); ++v)
  {
    const double z = tube.Positions(v, 2);
    problem.Handle[v] = z < 10.0 / 6.0 ? 1 : z > 50.0 / 6.0 ? 2 : 0;
    lowRow = problem.Handle[v] == 1 ? std::max(lowRow, v / 16) : lowRow;
    highRow = problem.Handle[v] == 2 ? std::min(highRow, v / 16) : highRow;
  }
  HandleMotion motion;
  motion.Linear = Turn(0, 0, Angle);
  double misplaced = 0.0;
  for (const LaplacianWeights weights : { LaplacianWeights::Uniform, LaplacianWeights::Cotangent })
  {
    SetWeights(problem, weights);
    // The blend (1 - h) I + h R turns by the angle of (1 - h) + h e^(i Angle).
    const DeformedSurface result = Deform(problem, { motion }, FrameProjection::None);
    for (int v = 0; v < tube.NumberOfVertices(); ++v)
    {
      const int row = std::min(std::max(v / 16, lowRow), highRow);
      const double byRow = static_cast<double>(row - lowRow) / (highRow - lowRow);
      const double byLength = (height(row) - height(lowRow)) / (height(highRow) - height(lowRow));
      const double share = MatrixAt(result.Transforms, v)(1, 0) / std::sin(Angle);
      const bool isUniform = weights == LaplacianWeights::Uniform;
      ASSERT_NEAR(share, isUniform ? byRow : byLength, 1e-10);
      misplaced = isUniform ? std::max(misplaced, std::abs(share - byLength)) : misplaced;
    }
  }
  shapes::ShowFigure("4:1 graded tube, uniform weights, misplaced part of the angle", misplaced);
  EXPECT_NEAR(misplaced, 0.105, 0.005);
}

//------------------------------------------------------------------------------
TEST(RotationInvariantDeformer, FactorizesOnceHoweverOftenItMoves)
{
  const Shape shape = shapes::RealMesh("elephant");
  for (const bool constrain : { true, false })
  {
    HandleProblem problem = MakeProblem(shape, 0);
    problem.ConstrainPositions = constrain;
    RotationInvariantDeformer deformer(problem);
    for (int step = 0; step < 10; ++step)
    {
      HandleTargets targets;
      targets.Motions = { Motion(Turn(0.1 * step, 0, 0.2), { 0, 0, 0 }), HandleMotion() };
      Deform(deformer, targets);
      Deform(deformer, targets, FrameProjection::None);
    }
    // One system for frames and positions; another where positions are free.
    EXPECT_EQ(deformer.GetNumberOfFactorizations(), constrain ? 1 : 2);
  }
}

TEST(RotationInvariantDeformer, MayWeighFramesAndPositionsDifferently)
{
  const Shape shape = shapes::RealMesh("elephant");
  HandleProblem problem = MakeProblem(shape, 0);
  SetWeights(problem, LaplacianWeights::Uniform);
  const std::vector<HandleMotion> motions = TwoMotions(shape, true);
  const DeformedSurface same = Deform(problem, motions);
  problem.PositionWeights = LaplacianWeights::Cotangent;
  RotationInvariantDeformer deformer(problem);
  EXPECT_EQ(deformer.GetNumberOfFactorizations(), 2);
  HandleTargets targets;
  targets.Motions = motions;
  for (const FrameProjection projection : { FrameProjection::None, FrameProjection::Rotation })
  {
    const DeformedSurface mixed = Deform(deformer, targets, projection);
    const double distance = Distance(mixed.Positions, same.Positions);
    EXPECT_GT(distance, 1e-4);
    EXPECT_LT(distance, 0.2);
    if (projection == FrameProjection::Rotation)
    {
      EXPECT_LT(LargestDifference(mixed.Transforms, same.Transforms), 1e-12);
    }
  }
}

TEST(RotationInvariantDeformer, RemembersNothingOfEarlierMotions)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleProblem problem = MakeProblem(shape, 0);
  RotationInvariantDeformer deformer(problem);
  HandleTargets first;
  first.Motions = TwoMotions(shape, false);
  Deform(deformer, first);
  const VertexTargets all = TargetsOfMotions(problem, first.Motions);
  first.Vertices = shapes::Ids(problem.Rest->rows());
  first.Transforms = all.Transforms;
  first.Positions = all.Positions;
  Deform(deformer, first, FrameProjection::Rotation);
  HandleTargets second;
  second.Motions = TwoMotions(shape, true);
  const DeformedSurface fresh = Deform(problem, second.Motions);
  const DeformedSurface used = Deform(deformer, second);
  EXPECT_EQ(used.Positions, fresh.Positions);
  EXPECT_EQ(used.Transforms, fresh.Transforms);
}

TEST(RotationInvariantDeformer, MovesHandlesWhereNothingIsFree)
{
  const Shape shape = shapes::Icosphere(1);
  HandleProblem problem = MakeProblem(shape, 2, 0.51);
  for (int& handle : problem.Handle)
  {
    handle = std::max(handle, 1);
  }
  problem.Moving = { 2 };
  const HandleMotion motion = Motion(Turn(0, 0, 1), { 0, 0, 0 }, { 0, 0, 1 });
  const DeformedSurface result = Deform(problem, { motion });
  const VertexTargets expected = TargetsOfMotions(problem, { motion });
  EXPECT_EQ(result.Positions, expected.Positions);
}

TEST(RotationInvariantDeformer, RefusesPartsThatNothingHolds)
{
  const Shape shape = shapes::Icosphere(2);
  HandleProblem problem = MakeProblem(shape, 2);
  const auto expectSingular = [&problem]()
  {
    try
    {
      RotationInvariantDeformer deformer(problem);
      FAIL() << "accepted";
    }
    catch (const cartan::Error& error)
    {
      EXPECT_EQ(error.GetCode(), ErrorCode::SingularSystem);
      EXPECT_NE(std::string(error.what()).find("have no constraint"), std::string::npos);
    }
  };
  // Positions are free, and no handle is pinned.
  problem.ConstrainPositions = false;
  problem.Moving = { 1, 2, 3 };
  expectSingular();
  // Handles that do not hold.
  problem.ConstrainPositions = true;
  problem.SoftWeights = Eigen::VectorXd::Zero(shape.NumberOfVertices());
  expectSingular();
}

TEST(RotationInvariantDeformer, StaysFiniteOnDegenerateTriangles)
{
  Shape shape = shapes::Plane(8);
  // Points on top of each other and in line with their neighbors.
  shape.Positions.row(30) = shape.Positions.row(31);
  shape.Positions.row(50) = 0.5 * (shape.Positions.row(49) + shape.Positions.row(40));
  for (const LaplacianWeights weights : AllWeights)
  {
    HandleProblem problem = MakeProblem(shape, 0, 0.1);
    SetWeights(problem, weights);
    for (int& handle : problem.Handle)
    {
      handle = handle == 3 ? 0 : handle;
    }
    problem.Moving = { 2 };
    const DeformedSurface result = Deform(problem, { Motion(Turn(0, 1, 0), { 0, 0, 0 }) });
    EXPECT_TRUE(result.Positions.allFinite());
    EXPECT_TRUE(result.Transforms.allFinite());
    EXPECT_LT(cartan::BoundingDiagonal(result.Positions), 3.0);
  }
}

TEST(RotationInvariantDeformer, ProjectsTheTargetsOfSoftPointsLikeThoseOfHeldOnes)
{
  const Shape shape = shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 });
  HandleProblem problem = MakeProblem(shape, 2);
  for (const double weight : { 3.0, Infinity })
  {
    problem.SoftWeights.setConstant(shape.NumberOfVertices(), Infinity);
    for (int v = 0; v < shape.NumberOfVertices(); ++v)
    {
      problem.SoftWeights[v] = problem.Handle[v] == 2 ? weight : Infinity;
    }
    // Where frames are projected on rotations, the size of a target does not
    // matter.
    Points positions[2];
    Matrices transforms[2];
    for (int k = 0; k < 2; ++k)
    {
      HandleTargets targets;
      targets.Motions.resize(2);
      targets.Vertices = shapes::Ids(shape.NumberOfVertices());
      targets.Positions = shape.Positions;
      targets.Transforms.resize(shape.NumberOfVertices(), 9);
      for (int v = 0; v < shape.NumberOfVertices(); ++v)
      {
        const double size = k == 0 ? 1.0 : 2.5;
        MatrixAt(targets.Transforms, v) = size * Turn(0.3, 0.2, 0.1 * shape.Positions(v, 0));
      }
      RotationInvariantDeformer deformer(problem);
      const DeformedSurface result = Deform(deformer, targets, FrameProjection::Rotation);
      positions[k] = result.Positions;
      transforms[k] = result.Transforms;
    }
    EXPECT_LT((transforms[0] - transforms[1]).cwiseAbs().maxCoeff(), 1e-9) << weight;
    EXPECT_LT((positions[0] - positions[1]).cwiseAbs().maxCoeff(), 1e-9) << weight;
  }
}

TEST(RotationInvariantDeformer, StopsOnRequestAndReportsProgressThatNeverFalls)
{
  const Shape shape = shapes::RealMesh("elephant");
  for (const bool constrain : { true, false })
  {
    HandleProblem problem = MakeProblem(shape, 0);
    problem.ConstrainPositions = constrain;
    std::vector<double> reports;
    const cartan::ExecutionContext context({},
      [&reports](double fraction)
      {
        reports.push_back(fraction);
        return true;
      });
    RotationInvariantDeformer deformer(problem, SolverBackend::Automatic, context);
    EXPECT_GT(reports.size(), 3u);
    EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
    EXPECT_GE(reports.front(), 0.0);
    EXPECT_EQ(reports.back(), 1.0);
    reports.clear();
    HandleTargets targets;
    targets.Motions = TwoMotions(shape, true);
    DeformedSurface result;
    deformer.Deform(targets, true, result, context);
    EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
    EXPECT_EQ(reports.back(), 1.0);

    const cartan::ExecutionContext stop({}, [](double) { return false; });
    EXPECT_THROW(RotationInvariantDeformer(problem, SolverBackend::Automatic, stop), cartan::Error);
    EXPECT_THROW(deformer.Deform(targets, true, result, stop), cartan::Error);
    // And it goes on afterwards.
    EXPECT_EQ(Deform(deformer, targets).Positions, Deform(problem, targets.Motions).Positions);
  }
}
