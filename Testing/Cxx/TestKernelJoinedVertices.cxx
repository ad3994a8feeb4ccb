// SPDX-License-Identifier: BSD-3-Clause
#include "AllDeformers.h"
#include "HandleShapes.h"
#include "Ids.h"
#include "JoinedShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Base/Constants.h"
#include "Kernel/Deformation/JoinedVertices.h"
#include "Kernel/Deformation/SliverRemoval.h"
#include "Kernel/Differential/Laplacian.h"
#include "Kernel/Measure/ComponentVolumes.h"

#include <gtest/gtest.h>

#include <cmath>

/// Vertices that are held together as one: what hangs on them follows.
namespace
{
using cartan::DeformedSurface;
using cartan::HandleMotion;
using cartan::HandleProblem;
using cartan::MatrixAt;
using cartan::Points;
using cartan::TriangleMesh;
using shapes::Joint;

DeformedSurface Deform(cartan::SurfaceDeformer& deformer, const std::vector<HandleMotion>& motions)
{
  cartan::HandleTargets targets;
  targets.Motions = motions;
  DeformedSurface result;
  deformer.Deform(targets, true, result, {});
  return result;
}

HandleMotion Turn(const Eigen::Vector3d& vector, const Eigen::Vector3d& shift = { 0.0, 0.0, 0.0 })
{
  HandleMotion motion;
  motion.RotationVector = vector;
  motion.Linear = cartan::RotationFromVector(vector);
  motion.Translation = shift;
  return motion;
}

/// The bend of the tests: one end turns by half a radian.
HandleMotion Bend()
{
  return Turn({ 0.1, 0.5, 0.0 }, { 0.3, 0.1, -0.2 });
}

void ExpectSameRings(const TriangleMesh& a, const TriangleMesh& b)
{
  ASSERT_EQ(a.NumberOfVertices(), b.NumberOfVertices());
  ASSERT_EQ(a.NumberOfDirectedEdges(), b.NumberOfDirectedEdges());
  ASSERT_EQ(a.NumberOfComponents(), b.NumberOfComponents());
  EXPECT_EQ(a.GetTriangles(), b.GetTriangles());
  for (int v = 0; v < a.NumberOfVertices(); ++v)
  {
    ASSERT_EQ(a.RingEnd(v), b.RingEnd(v));
    ASSERT_EQ(a.Component(v), b.Component(v));
    ASSERT_EQ(a.IsBoundary(v), b.IsBoundary(v));
  }
  for (int d = 0; d < a.NumberOfDirectedEdges(); ++d)
  {
    ASSERT_EQ(a.Neighbor(d), b.Neighbor(d));
    ASSERT_EQ(a.Twin(d), b.Twin(d));
    ASSERT_EQ(a.LeftTriangle(d), b.LeftTriangle(d));
    ASSERT_EQ(a.Next(d), b.Next(d));
  }
}

/// What every mesh is, with fans that meet too.
void ExpectConsistent(const TriangleMesh& mesh)
{
  int corners = 0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      ASSERT_EQ(mesh.Origin(d), v);
      ASSERT_EQ(mesh.Twin(mesh.Twin(d)), d);
      ASSERT_EQ(mesh.Component(mesh.Neighbor(d)), mesh.Component(v));
      const int t = mesh.LeftTriangle(d);
      ASSERT_EQ(mesh.Next(d) < 0, t < 0);
      if (t < 0)
      {
        ASSERT_TRUE(mesh.IsBoundary(v));
        ASSERT_GE(mesh.LeftTriangle(mesh.Twin(d)), 0);
        continue;
      }
      ++corners;
      ASSERT_EQ(mesh.Origin(mesh.Next(d)), v);
      const std::array<int, 3> found = { v, mesh.Neighbor(d), mesh.Opposite(d) };
      const auto triangle = mesh.GetTriangles().row(t);
      const auto begin = std::find(triangle.begin(), triangle.end(), v) - triangle.begin();
      for (int c = 0; c < 3; ++c)
      {
        ASSERT_EQ(triangle[(begin + c) % 3], found[c]);
      }
    }
  }
  EXPECT_EQ(corners, 3 * mesh.NumberOfTriangles());
}

TEST(JoinedMesh, GivesBackWhatWasSplit)
{
  const shapes::Shape bar = shapes::Noisy(shapes::Bar(3, 3, 6, { 1.0, 1.0, 2.0 }, true), 0.05);
  const shapes::Shape plane = shapes::Plane(10, 1.0, 0.2);
  for (const shapes::Shape& whole : { bar, plane })
  {
    const Joint split = shapes::Split(whole);
    ASSERT_GT(split.Surface.NumberOfVertices(), whole.NumberOfVertices() + 3);
    const TriangleMesh cut(split.Surface.NumberOfVertices(), split.Surface.Faces);
    ExpectSameRings(
      cut.Joined(split.JoinedWith), TriangleMesh(split.Surface.NumberOfVertices(), whole.Faces));
  }
}

TEST(JoinedMesh, GivesBackWhatWasASoup)
{
  const shapes::Shape whole = shapes::Noisy(shapes::Icosphere(2), 0.02);
  const int corners = static_cast<int>(whole.Faces.size());
  cartan::Triangles soup(whole.Faces.rows(), 3);
  std::vector<int> first(whole.NumberOfVertices(), -1);
  std::vector<int> joinedWith;
  cartan::Triangles joined(whole.Faces.rows(), 3);
  for (int corner = 0; corner < corners; ++corner)
  {
    soup.data()[corner] = corner;
    int& representative = first[whole.Faces.data()[corner]];
    representative = representative < 0 ? corner : representative;
    joinedWith.push_back(representative);
    joined.data()[corner] = representative;
  }
  ExpectSameRings(TriangleMesh(corners, soup).Joined(joinedWith), TriangleMesh(corners, joined));
}

TEST(JoinedMesh, HoldsFansAtAPointAndPagesAtAnEdge)
{
  for (const Joint& joint : shapes::Joints())
  {
    SCOPED_TRACE(joint.Name);
    const TriangleMesh cut(joint.Surface.NumberOfVertices(), joint.Surface.Faces);
    ASSERT_GT(cut.NumberOfComponents(), 1);
    const TriangleMesh mesh = cut.Joined(joint.JoinedWith);
    ExpectConsistent(cut);
    ExpectConsistent(mesh);
    EXPECT_EQ(mesh.NumberOfComponents(), 1);
    EXPECT_EQ(mesh.NumberOfDirectedEdges(), cut.NumberOfDirectedEdges());
  }
}

/// L of the joined mesh against the product P^T L P.
TEST(JoinedMesh, HasTheLaplacianOfTheProduct)
{
  for (const Joint& joint : shapes::Joints())
  {
    const int n = joint.Surface.NumberOfVertices();
    const TriangleMesh cut(n, joint.Surface.Faces);
    const TriangleMesh mesh = cut.Joined(joint.JoinedWith);
    Eigen::MatrixXd p = Eigen::MatrixXd::Zero(n, n);
    for (int v = 0; v < n; ++v)
    {
      p(v, joint.JoinedWith[v]) = 1.0;
    }
    for (const auto weights : { cartan::LaplacianWeights::Uniform,
           cartan::LaplacianWeights::Cotangent, cartan::LaplacianWeights::MeanValue })
    {
      const auto laplacian = [&](const TriangleMesh& of)
      {
        return Eigen::MatrixXd(cartan::Laplacian(of,
          cartan::SymmetricPart(of, cartan::EdgeWeights(of, joint.Surface.Positions, weights))));
      };
      const Eigen::MatrixXd expected = p.transpose() * laplacian(cut) * p;
      EXPECT_LT((laplacian(mesh) - expected).cwiseAbs().maxCoeff(), 1e-12) << joint.Name;
    }
  }
}

/// Each method gives to the bit what it gives without the split.
TEST(JoinedVertices, OfASplitSurfaceMakeNoDifference)
{
  const shapes::Shape whole = shapes::Noisy(shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 }, true), 0.02);
  const shapes::HandleOf ends = shapes::EndsAlong(whole, 2, 0.1);
  const HandleProblem expected = shapes::ProblemOf(whole, ends);
  const Joint split = shapes::Split(whole);
  const HandleProblem problem = shapes::JoinedProblem(split, ends);
  ASSERT_EQ(problem.Mesh->NumberOfTriangles(), expected.Mesh->NumberOfTriangles());
  for (const auto& [name, make] : deformers::All())
  {
    const DeformedSurface a = Deform(*make(problem, {}), { Bend() });
    const DeformedSurface b = Deform(*make(expected, {}), { Bend() });
    EXPECT_TRUE(a.Positions.topRows(b.Positions.rows()) == b.Positions) << name;
    EXPECT_TRUE(a.Transforms.topRows(b.Transforms.rows()) == b.Transforms) << name;
  }
}

/// The same of a soup of triangles, up to the rounding of another order.
TEST(JoinedVertices, OfASoupMakeNoDifference)
{
  const shapes::Shape whole = shapes::Noisy(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }, true), 0.02);
  const shapes::HandleOf ends = shapes::EndsAlong(whole, 2, 0.15);
  Joint soup;
  soup.Surface.Faces.resize(whole.Faces.rows(), 3);
  soup.Surface.Positions.resize(whole.Faces.size(), 3);
  soup.Ids.resize(whole.Faces.size());
  for (int corner = 0; corner < whole.Faces.size(); ++corner)
  {
    soup.Surface.Faces.data()[corner] = corner;
    soup.Surface.Positions.row(corner) = whole.Positions.row(whole.Faces.data()[corner]);
    soup.Ids[corner] = whole.Faces.data()[corner];
  }
  const HandleProblem problem = shapes::JoinedProblem(soup, ends);
  const HandleProblem expected = shapes::ProblemOf(whole, ends);
  for (const auto& [name, make] : deformers::All())
  {
    const Points a = Deform(*make(problem, {}), { Bend() }).Positions;
    const Points b = Deform(*make(expected, {}), { Bend() }).Positions;
    double largest = 0.0;
    for (int corner = 0; corner < whole.Faces.size(); ++corner)
    {
      largest = std::max(largest, (a.row(corner) - b.row(whole.Faces.data()[corner])).norm());
    }
    EXPECT_LT(largest, name == "SmoothedRotations" ? 1e-5 : 1e-7) << name;
  }
}

/// A method that cannot hold a limb says so in an error.
bool MayRefuse(const std::string& name, const Joint& joint)
{
  return name == "LaplacianImplicit" && joint.IsPoint;
}

TEST(JoinedVertices, StayInOnePlaceToTheBit)
{
  for (const Joint& joint : shapes::Joints())
  {
    const HandleProblem problem = shapes::JoinedProblem(joint, shapes::EndsOfBody);
    for (const auto& [name, make] : deformers::All())
    {
      SCOPED_TRACE(joint.Name + " " + name);
      try
      {
        const DeformedSurface result = Deform(*make(problem, {}), { Bend() });
        ASSERT_TRUE(result.Positions.allFinite());
        for (int v = 0; v < problem.Mesh->NumberOfVertices(); ++v)
        {
          const int first = problem.JoinedWith[v];
          ASSERT_EQ(result.Positions.row(v), result.Positions.row(first));
          ASSERT_EQ(result.Transforms.row(v), result.Transforms.row(first));
        }
        // The joint moves, and the limb does not stay behind.
        EXPECT_GT((result.Positions - *problem.Rest).row(joint.AtJoint).norm(), 0.05);
        EXPECT_GT((result.Positions - *problem.Rest).row(joint.FarEnd).norm(), 0.05);
      }
      catch (const cartan::Error& error)
      {
        EXPECT_TRUE(MayRefuse(name, joint)) << error.what();
      }
    }
  }
}

TEST(JoinedVertices, LimbsFollowCommonMotionsAndStayWhereNothingMoves)
{
  const shapes::RigidMotion frame = shapes::RandomRigidMotion(3, 2.0);
  HandleMotion motion;
  motion.Linear = frame.Rotation;
  motion.Translation = frame.Translation;
  motion.RotationVector = cartan::VectorFromRotation(frame.Rotation);
  for (const Joint& joint : shapes::Joints())
  {
    const HandleProblem problem = shapes::JoinedProblem(joint, shapes::EndsOfBody, { 1, 2 });
    for (const auto& [name, make] : deformers::All())
    {
      SCOPED_TRACE(joint.Name + " " + name);
      try
      {
        const auto deformer = make(problem, {});
        const Points moved = Deform(*deformer, { motion, motion }).Positions;
        EXPECT_LT((moved - frame(*problem.Rest)).cwiseAbs().maxCoeff(), 1e-10);
        const Points still = Deform(*deformer, { {}, {} }).Positions;
        EXPECT_EQ(still, *problem.Rest);
      }
      catch (const cartan::Error& error)
      {
        EXPECT_TRUE(MayRefuse(name, joint)) << error.what();
      }
    }
  }
}

/// A field that is harmonic on a limb without handles, and given at one vertex, is
/// constant: what hangs on one vertex is rigid, and turns as that vertex does.
TEST(JoinedVertices, ALimbOnOnePointIsRigid)
{
  const Joint joint = shapes::Joints().front();
  ASSERT_TRUE(joint.IsPoint);
  const HandleProblem problem = shapes::JoinedProblem(joint, shapes::EndsOfBody);
  const auto makers = deformers::All();
  for (const std::string name : { "RotationInvariant", "ShapePreserving", "PoissonHarmonic" })
  {
    SCOPED_TRACE(name);
    const DeformedSurface result = Deform(*makers.at(name)(problem, {}), { Bend() });
    const Eigen::Matrix3d turn = MatrixAt(result.Transforms, joint.AtJoint);
    EXPECT_GT((turn - Eigen::Matrix3d::Identity()).norm(), 0.1);
    for (const int v : joint.Limb)
    {
      const Eigen::RowVector3d arm = problem.Rest->row(v) - problem.Rest->row(joint.AtJoint);
      const Eigen::RowVector3d moved =
        result.Positions.row(v) - result.Positions.row(joint.AtJoint);
      EXPECT_LT((moved.transpose() - turn * arm.transpose()).norm(), 1e-9);
    }
  }
}

/// On an edge, a limb turns as the two ends of the edge do, which turn nearly alike.
TEST(JoinedVertices, ALimbOnAnEdgeKeepsItsOrientation)
{
  for (const Joint& joint : shapes::Joints())
  {
    if (joint.IsPoint)
    {
      continue;
    }
    const HandleProblem problem = shapes::JoinedProblem(joint, shapes::EndsOfBody);
    for (const auto& [name, make] : deformers::All())
    {
      // Does not turn; fits across the joint; has not converged; shears.
      if (name == "LaplacianNone" || name == "LaplacianEstimated" || name == "SmoothedRotations" ||
        name == "LaplacianImplicit")
      {
        continue;
      }
      SCOPED_TRACE(joint.Name + " " + name);
      const DeformedSurface result = Deform(*make(problem, {}), { Bend() });
      const Eigen::Matrix3d turn =
        cartan::ProjectOnRotations(MatrixAt(result.Transforms, joint.AtJoint));
      const Eigen::Matrix3d limb =
        cartan::ProjectOnRotations(shapes::Covariance(*problem.Rest, result.Positions, joint.Limb));
      EXPECT_LT(cartan::VectorFromRotation(turn.transpose() * limb).norm(), 0.15);
    }
  }
}

TEST(JoinedVertices, HandlesOfOneCopyHoldAll)
{
  const Joint joint = shapes::Joints().front();
  HandleProblem problem = shapes::PartedProblem(joint, [](const Eigen::Vector3d&) { return 0; });
  const int copy = joint.Limb.front();
  ASSERT_NE(joint.JoinedWith[copy], copy);
  problem.Handle[copy] = 2;
  cartan::HoldTogether(joint.Ids, problem);
  EXPECT_EQ(problem.JoinedWith[joint.JoinedWith[copy]], copy);
  EXPECT_EQ(problem.Handle[joint.JoinedWith[copy]], 2);

  problem.Handle[joint.JoinedWith[copy]] = 1;
  EXPECT_THROW(cartan::HoldTogether(joint.Ids, problem), cartan::Error);
}

TEST(JoinedVertices, ArePartedInOtherPlacesAndWithoutId)
{
  const Joint joint = shapes::Joints().front();
  const HandleProblem apart = shapes::PartedProblem(joint, shapes::EndsOfBody);
  HandleProblem problem = apart;
  cartan::HoldTogether(Eigen::VectorXd::Constant(joint.Ids.size(), -1.0), problem);
  EXPECT_TRUE(problem.JoinedWith.empty());
  problem = apart;
  Points moved = *apart.Rest;
  moved.row(joint.Limb.front()) *= 1.0 + 1e-9;
  problem.Rest = std::make_shared<const Points>(moved);
  cartan::HoldTogether(joint.Ids, problem);
  EXPECT_TRUE(problem.JoinedWith.empty());
  // One id for all joins what is in one place alone.
  problem = apart;
  cartan::HoldTogether(Eigen::VectorXd::Ones(joint.Ids.size()), problem);
  EXPECT_EQ(problem.JoinedWith, joint.JoinedWith);
}

/// Each body that hangs on another keeps its own volume, and a sheet on a body does
/// not open it.
TEST(JoinedVertices, KeepTheVolumeOfEachBody)
{
  for (const Joint& joint : shapes::Joints())
  {
    const HandleProblem problem = shapes::JoinedProblem(joint, shapes::EndsOfBody);
    const TriangleMesh& cut = *problem.GetParted();
    const auto model =
      std::make_shared<const cartan::VolumeModel>(shapes::VolumeModelOf(cut, *problem.Rest));
    const bool isSlit = joint.Name == "sheet on edges"; // edges of three triangles
    ASSERT_EQ(model->EnclosesVolume[0] != 0, !isSlit);
    cartan::ShapePreservingDeformer deformer(problem, cartan::SolverBackend::Automatic, {});
    deformer.SetVolumeModel(model);
    deformer.SetVolumeCorrection(cartan::VolumeCorrection::NeutralOffset);
    deformer.SetCloseVolume(true);
    const Points positions = Deform(deformer, { Bend() }).Positions;
    EXPECT_EQ(deformer.GetWarning(), "");
    for (int c = 0; c < cut.NumberOfComponents(); ++c)
    {
      if (model->EnclosesVolume[c])
      {
        EXPECT_NEAR(cartan::MeasureComponents(cut, positions)[c].Volume, model->Volumes[c],
          1e-9 * model->Volumes[c])
          << joint.Name << " " << c;
      }
    }
    deformer.SetVolumeCorrection(cartan::VolumeCorrection::FrameScaling);
    EXPECT_TRUE(Deform(deformer, { Bend() }).Positions.allFinite());
  }
}

/// A cap beside a joint goes, the joint stays.
TEST(JoinedVertices, StayWhereSliversGo)
{
  const Joint joint = shapes::WithCapAtJoint(shapes::Joints().front());
  HandleProblem problem = shapes::PartedProblem(joint, shapes::EndsOfBody);
  cartan::HoldTogether(joint.Ids, problem);
  problem = cartan::WithJoinedVertices(cartan::WithoutSlivers(std::move(problem)));
  ASSERT_TRUE(problem.Whole);
  EXPECT_FALSE(problem.Riders.empty());
  EXPECT_TRUE(problem.Mesh->IsUsed(problem.JoinedWith[joint.AtJoint]));
  EXPECT_EQ(problem.Mesh->NumberOfComponents(), 1);
  const HandleProblem plain = shapes::JoinedProblem(shapes::Joints().front(), shapes::EndsOfBody);
  const Points with =
    Deform(*deformers::All().at("ShapePreserving")(problem, {}), { Bend() }).Positions;
  const Points without =
    Deform(*deformers::All().at("ShapePreserving")(plain, {}), { Bend() }).Positions;
  EXPECT_LT((with.topRows(without.rows()) - without).cwiseAbs().maxCoeff(), 1e-9);
}
}
