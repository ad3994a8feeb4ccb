// SPDX-License-Identifier: BSD-3-Clause
// Advice in messages that no input of a filter gives, or none that a test can have.
#include "AdviceWords.h"
#include "AllDeformers.h"
#include "HandleShapes.h"
#include "TestShapes.h"

#include "Kernel/Algebra/ConstrainedSolver.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Algebra/SparseProduct.h"
#include "Kernel/Differential/FrameReconstruction.h"
#include "Kernel/Differential/Laplacian.h"
#include "Kernel/Differential/RingGradients.h"
#include "Kernel/Morph/KeyInterpolation.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{
using cartan::Points;
using cartan::TriangleMesh;
using shapes::Advice;

TriangleMesh MeshOf(const shapes::Shape& shape)
{
  return { shape.NumberOfVertices(), shape.Faces };
}

template <typename Action>
void ExpectError(const std::vector<std::string>& parts, const Action& action)
{
  try
  {
    action();
    ADD_FAILURE() << "no error";
  }
  catch (const cartan::Error& error)
  {
    for (const std::string& part : parts)
    {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
        << "expected: " << part << "\nfound: " << error.what();
    }
  }
}
}

TEST(KernelAdvice, SystemsWithTooManyEntriesHaveFewerPointsFreeOrACoarserSurface)
{
  const auto prepare = [](int rings, double share)
  {
    const shapes::Shape bar = shapes::Bar(3, 3, rings, { 1.0, 1.0, 4.0 });
    deformers::All().at("LaplacianNone")(
      shapes::ProblemOf(bar, shapes::EndsAlong(bar, 2, share)), {});
  };
  const cartan::LowerEntryLimit limit(2000);
  ExpectError(
    { "The system of order 2", Advice("Leave fewer points free, or decimate the surface.") },
    [&] { prepare(20, 0.1); });
  EXPECT_NO_THROW(prepare(20, 0.4));
  EXPECT_NO_THROW(prepare(6, 0.1));
}

TEST(KernelAdvice, FactorsThatDoNotFitHaveFewerPointsFreeOrACoarserSurface)
{
  cartan::FactorLimits limits;
  limits.Entries = 1500;
  for (const auto backend : { cartan::SolverBackend::Eigen, cartan::SolverBackend::Automatic })
  {
    const auto factorize = [&](int level, int fixed)
    {
      const TriangleMesh mesh = MeshOf(shapes::Icosphere(level));
      std::vector<char> isFixed(mesh.NumberOfVertices(), 0);
      std::fill_n(isFixed.begin(), fixed, 1);
      cartan::ConstrainedSolver(backend, limits)
        .Factorize(
          cartan::Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges())), isFixed);
    };
    ExpectError({ "The system of 161 unknowns does not fit into memory",
                  Advice("Leave fewer points free, decimate the surface, or free memory.") },
      [&] { factorize(2, 1); });
    EXPECT_NO_THROW(factorize(2, 100));
    EXPECT_NO_THROW(factorize(1, 1));
  }
}

TEST(KernelAdvice, FramesThatGradientsDoNotFindAreFoundByTheDirectSolver)
{
  const shapes::Shape sphere = shapes::Icosphere(2);
  const TriangleMesh mesh = MeshOf(sphere);
  const cartan::Matrices frames = cartan::VertexFrames(mesh, sphere.Positions);
  auto transitions = cartan::TransitionsFromFrames(mesh, frames);
  shapes::Random random(6);
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const Eigen::Vector3d turn{ random(), random(), random() };
    cartan::MatrixAt(transitions, d) =
      (cartan::MatrixAt(transitions, d) * cartan::RotationFromVector(0.3 * turn)).eval();
  }
  std::vector<char> isFixed(mesh.NumberOfVertices(), 0);
  isFixed[0] = 1;
  cartan::AnchoredSystem laplacian;
  laplacian.Factorize(cartan::Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges())),
    cartan::Anchors::Hard(isFixed));
  int steps = 0;
  const auto byGradients = [&](int most)
  {
    return cartan::SolveFramesFrom(
      mesh, transitions, isFixed, frames, laplacian, &steps, {}, {}, most);
  };
  ExpectError({ "were not found after 3 steps",
                Advice("choose Direct or RotationAveraging as FrameSolver.") },
    [&] { byGradients(3); });
  cartan::AnchoredSystem system;
  const cartan::Matrices direct = cartan::SolveFrames(mesh, transitions, isFixed, frames, system);
  EXPECT_LT((direct - byGradients(1000)).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(KernelAdvice, GradientsAreDefinedAfterARepairOrWhereAHandleHoldsThem)
{
  // Each corner of a lone triangle has two neighbors only.
  shapes::Shape triangle = shapes::Plane(1);
  triangle.Positions.conservativeResize(3, 3);
  triangle.Faces.resize(1, 3);
  triangle.Faces << 0, 1, 2;
  const auto gradients = [](const shapes::Shape& shape, std::vector<char> isGiven)
  {
    cartan::GradientConstraints constraints;
    constraints.IsUnknown.assign(shape.NumberOfVertices(), 1);
    constraints.IsGiven = std::move(isGiven);
    return cartan::RingGradients(MeshOf(shape), shape.Positions, constraints, 1, {});
  };
  ExpectError({ "No deformation gradient is defined at 3 points (ids 0, 1, 2)",
                Advice("Repair them, mark them as part of a handle, or hold the handles' "
                       "transforms.") },
    [&] {
      gradients(triangle, { 0, 0, 0 });
    });
  EXPECT_NO_THROW(gradients(triangle, { 1, 0, 0 })); // held by a handle
  EXPECT_NO_THROW(gradients(shapes::Plane(1), { 0, 0, 0, 0 }));
}

TEST(KernelAdvice, KeyFramesHaveAParameterEach)
{
  const std::vector<double> parameters = { 0.0, 1.0 };
  ExpectError({ "not a number", Advice("set one, such as 0.5.") },
    [&] { cartan::PlaceBetweenKeys(std::numeric_limits<double>::quiet_NaN(), parameters); });
  EXPECT_EQ(cartan::PlaceBetweenKeys(0.5, parameters).Part, 0.5);

  const cartan::Field values = cartan::Field::Random(4, 3);
  ExpectError({ "There are 2 key parameters for 3 key frames", Advice("give each its own.") },
    [&] { cartan::KeyInterpolation(parameters, values); });
  const cartan::KeyInterpolation keys({ 0.0, 0.5, 1.0 }, values);
  EXPECT_EQ(Eigen::VectorXd(keys.Evaluate(0.5)), Eigen::VectorXd(values.col(1)));
}
