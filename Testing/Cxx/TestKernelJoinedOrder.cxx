// SPDX-License-Identifier: BSD-3-Clause
#include "JoinedShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/AsRigidAsPossibleDeformer.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"

#include <gtest/gtest.h>

/// Of vertices that are held together, none is more than another.
namespace
{
using cartan::HandleProblem;
using cartan::Points;
using shapes::Joint;

/// One end turns by half a radian.
Points Bent(cartan::SurfaceDeformer& deformer)
{
  cartan::HandleTargets targets;
  targets.Motions.resize(1);
  targets.Motions[0].RotationVector = { 0.1, 0.5, 0.0 };
  targets.Motions[0].Linear = cartan::RotationFromVector(targets.Motions[0].RotationVector);
  targets.Motions[0].Translation = { 0.3, 0.1, -0.2 };
  cartan::DeformedSurface result;
  deformer.Deform(targets, true, result, {});
  return result.Positions;
}

/// The same with the last vertex first.
Joint Backwards(Joint joint)
{
  const int last = joint.Surface.NumberOfVertices() - 1;
  joint.Surface.Positions = joint.Surface.Positions.colwise().reverse().eval();
  joint.Surface.Faces = last - joint.Surface.Faces.array();
  joint.Ids = joint.Ids.reverse().eval();
  return joint;
}

TEST(JoinedVertices, OrderOfBodiesDoesNotMatter)
{
  using cartan::VolumeCorrection;
  for (const Joint& joint : shapes::Joints())
  {
    const Joint turned = Backwards(joint);
    for (const VolumeCorrection correction :
      { VolumeCorrection::NeutralOffset, VolumeCorrection::FrameScaling })
    {
      std::vector<Points> results;
      for (const Joint* one : { &joint, &turned })
      {
        const HandleProblem problem = shapes::JoinedProblem(*one, shapes::EndsOfBody);
        cartan::ShapePreservingDeformer deformer(problem, cartan::SolverBackend::Automatic, {});
        deformer.SetVolumeModel(std::make_shared<const cartan::VolumeModel>(
          shapes::VolumeModelOf(*problem.GetParted(), *problem.Rest)));
        deformer.SetVolumeCorrection(correction);
        deformer.SetCloseVolume(true);
        results.push_back(Bent(deformer));
      }
      EXPECT_LT((results[0] - results[1].colwise().reverse()).cwiseAbs().maxCoeff(), 1e-8)
        << joint.Name << " " << static_cast<int>(correction);
    }
  }
}

/// A model that encloses nothing has no values.
TEST(JoinedVertices, MeetBetweenTheirValues)
{
  Points values(3, 3);
  values << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 3.0, 0.0, 5.0;
  cartan::MeetHalfway({ 0, 1, 0 }, values);
  EXPECT_EQ(values.row(0), Eigen::RowVector3d(2.0, 1.0, 4.0));
  EXPECT_EQ(values.row(1), Eigen::RowVector3d(4.0, 5.0, 6.0));
  EXPECT_EQ(values.row(2), values.row(0));
  Points none(0, 3);
  cartan::MeetHalfway({ 0, 1, 0 }, none);
  EXPECT_EQ(none.rows(), 0);
  for (const Joint& joint : shapes::Joints())
  {
    const HandleProblem problem = shapes::JoinedProblem(joint, shapes::EndsOfBody);
    cartan::ShapePreservingDeformer deformer(problem, cartan::SolverBackend::Automatic, {});
    const Points plain = Bent(deformer);
    deformer.SetVolumeModel(std::make_shared<const cartan::VolumeModel>());
    deformer.SetVolumeCorrection(cartan::VolumeCorrection::NeutralOffset);
    deformer.SetCloseVolume(true);
    EXPECT_EQ(Bent(deformer), plain) << joint.Name;
  }
}

TEST(JoinedVertices, ShareTheEnergyOfTheirTerms)
{
  for (const Joint& joint : shapes::Joints())
  {
    const HandleProblem problem = shapes::JoinedProblem(joint, shapes::EndsOfBody);
    cartan::AsRigidAsPossibleDeformer deformer(problem, cartan::RigidityEnergy::Spokes);
    Bent(deformer);
    const Eigen::VectorXd energies = deformer.GetVertexEnergies();
    EXPECT_NEAR(energies.sum(), deformer.GetEnergies().back(), 1e-12 * energies.sum());
    for (std::size_t v = 0; v < problem.JoinedWith.size(); ++v)
    {
      EXPECT_EQ(energies[static_cast<Eigen::Index>(v)], energies[problem.JoinedWith[v]]);
    }
    EXPECT_GT(energies[joint.AtJoint], 0.0) << joint.Name;
  }
}
}
