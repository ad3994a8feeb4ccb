// SPDX-License-Identifier: BSD-3-Clause
#include "AllDeformers.h"
#include "HandleShapes.h"
#include "Ids.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Mesh/RayTree.h"
#include "Kernel/Morph/DiscreteFormsMorph.h"
#include "Kernel/Morph/IsometricMorph.h"
#include "Kernel/Morph/LinearMorph.h"
#include "Kernel/Morph/PyramidCoordinatesMorph.h"
#include "Kernel/Morph/TriangleGradientMorph.h"
#include "MorphShapes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

/// Progress of every method lies in [0, 1] and never runs back.
namespace
{
using cartan::ExecutionContext;

struct Recorder
{
  std::vector<double> Fractions;

  ExecutionContext Context()
  {
    this->Fractions.clear();
    return { {},
      [this](double fraction)
      {
        this->Fractions.push_back(fraction);
        return true;
      } };
  }

  void Expect(const std::string& name) const
  {
    ASSERT_FALSE(this->Fractions.empty()) << name;
    double last = 0.0;
    for (const double fraction : this->Fractions)
    {
      // Ends of steps may differ by rounding.
      EXPECT_GE(fraction, last - 1e-12) << name;
      last = std::max(last, fraction);
    }
    EXPECT_LE(last, 1.0 + 1e-12) << name;
  }
};

cartan::HandleProblem BarProblem(bool constrainPositions)
{
  const shapes::Shape shape = shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 }, true);
  cartan::HandleProblem problem = shapes::ProblemOf(
    shape, [](const Eigen::Vector3d& x) { return x[2] < 0.5 ? 1
                                            : x[2] > 3.5    ? 2
                                                            : 0; });
  problem.ConstrainPositions = constrainPositions;
  return problem;
}

cartan::HandleTargets Targets(const cartan::HandleProblem& problem, bool perVertex)
{
  cartan::HandleMotion motion;
  motion.RotationVector = { 0.4, 0.2, 0.3 };
  motion.Linear = cartan::RotationFromVector(motion.RotationVector);
  cartan::HandleTargets targets;
  targets.Motions = { motion };
  if (perVertex)
  {
    const Eigen::Index count = problem.Rest->rows();
    targets.Vertices = shapes::Ids(count);
    targets.Positions = *problem.Rest;
    targets.Transforms = cartan::Identities(count);
    targets.RotationVectors = cartan::Points::Zero(count, 3);
    for (Eigen::Index v = 0; v < count; ++v)
    {
      // Different axes, so that rotation fields are iterated.
      targets.RotationVectors.row(v) << 0.3, 0.1 * std::sin(static_cast<double>(v)), 0.2;
      cartan::MatrixAt(targets.Transforms, v) =
        cartan::RotationFromVector(targets.RotationVectors.row(v).transpose());
    }
  }
  return targets;
}

TEST(Progress, OfDeformersNeverRunsBack)
{
  Recorder recorder;
  for (const bool constrainPositions : { true, false })
  {
    const cartan::HandleProblem problem = BarProblem(constrainPositions);
    for (const auto& [name, make] : deformers::All())
    {
      const bool needsPositions = name.rfind("Laplacian", 0) == 0 ||
        name.rfind("Multiresolution", 0) == 0 || name == "Pyramid" ||
        name == "SimilarityOfPositions";
      if (!constrainPositions && needsPositions)
      {
        continue;
      }
      const auto deformer = make(problem, recorder.Context());
      recorder.Expect(name + ", set-up");
      EXPECT_DOUBLE_EQ(recorder.Fractions.back(), 1.0) << name;
      if (auto* iterated = dynamic_cast<cartan::ShapePreservingDeformer*>(deformer.get()))
      {
        iterated->SetIteration(20, 1e-12);
      }
      for (const bool perVertex : { false, true, false })
      {
        if (perVertex && name.rfind("Poisson", 0) == 0)
        {
          continue;
        }
        cartan::DeformedSurface result;
        deformer->Deform(Targets(problem, perVertex), perVertex, result, recorder.Context());
        recorder.Expect(name + ", motion");
        EXPECT_DOUBLE_EQ(recorder.Fractions.back(), 1.0) << name;
        EXPECT_EQ(result.FrameScale.size(), problem.Rest->rows()) << name;
      }
    }
  }
}

TEST(Progress, OfSimilarityNeverRunsBackWhereTheMotionFactorizes)
{
  Recorder recorder;
  const cartan::HandleProblem problem = BarProblem(true);
  cartan::SimilarityDeformer deformer(problem, {});
  deformer.SetReconstruction(cartan::SimilarityReconstruction::LeastSquares);
  deformer.SetRefits(3);
  cartan::DeformedSurface result;
  deformer.Deform(Targets(problem, false), true, result, recorder.Context());
  recorder.Expect("Similarity");
}

TEST(Progress, OfATreeOfManyTrianglesNeverRunsBack)
{
  const shapes::Shape shape = shapes::Bar(150, 150, 150, { 1.0, 2.0, 3.0 }, true);
  Recorder recorder;
  const cartan::RayTree tree(shape.Faces, shape.Positions, recorder.Context());
  EXPECT_GT(recorder.Fractions.size(), 4U);
  recorder.Expect("ray tree");
}

TEST(Progress, OfMorphsNeverRunsBack)
{
  const shapes::Shape bar = shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 }, true);
  const cartan::KeyFrames keys = morphshapes::Keys(bar,
    { bar.Positions, morphshapes::Bend(bar, 60.0, -1.0, 1.0),
      morphshapes::Twist(bar, 120.0, -1.5, 1.5) });
  using Forms = cartan::DiscreteFormsMorph;
  using MakeMorph =
    std::function<std::unique_ptr<cartan::SurfaceMorph>(const ExecutionContext& context)>;
  std::map<std::string, MakeMorph> makers;
  makers["Linear"] = [&](const ExecutionContext&)
  { return std::make_unique<cartan::LinearMorph>(keys); };
  makers["TriangleGradient"] = [&](const ExecutionContext& context)
  { return std::make_unique<cartan::TriangleGradientMorph>(keys, context); };
  makers["Pyramid"] = [&](const ExecutionContext& context)
  { return std::make_unique<cartan::PyramidCoordinatesMorph>(keys, context); };
  for (const auto transitions : { Forms::Transitions::Rotations, Forms::Transitions::Forms })
  {
    for (const auto solver : { Forms::FrameSolver::RotationAveraging,
           Forms::FrameSolver::ConjugateGradients, Forms::FrameSolver::Direct })
    {
      makers["DiscreteForms" + std::to_string(static_cast<int>(transitions)) +
        std::to_string(static_cast<int>(solver))] =
        [&keys, transitions, solver](const ExecutionContext& context)
      { return std::make_unique<Forms>(keys, transitions, solver, context); };
    }
  }
  for (const auto type : { cartan::IsometricMorphOptions::Method::Automatic,
         cartan::IsometricMorphOptions::Method::TreeStitched,
         cartan::IsometricMorphOptions::Method::TreeAverage })
  {
    makers["Isometric" + std::to_string(static_cast<int>(type))] =
      [&keys, type](const ExecutionContext& context)
    {
      cartan::IsometricMorphOptions options;
      options.Type = type;
      options.LengthPolish = 2;
      return std::make_unique<cartan::IsometricMorph>(keys, options, context);
    };
  }
  Recorder recorder;
  for (const auto& [name, make] : makers)
  {
    const auto morph = make(recorder.Context());
    if (name != "Linear")
    {
      recorder.Expect(name + ", set-up");
      EXPECT_GT(morph->GetBytes(), 24 * keys.Positions[0].rows()) << name;
    }
    for (const double t : { 0.25, 0.9 })
    {
      morph->Evaluate(t, recorder.Context());
      if (name != "Linear")
      {
        recorder.Expect(name + " at " + std::to_string(t));
      }
    }
  }
}
}
