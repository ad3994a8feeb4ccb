// SPDX-License-Identifier: BSD-3-Clause
//
// Drags by example poses (MeshIK) next to iterations of as-rigid-as-possible deformation on the
// same surface with the same handles, in turns, in one thread. Ends with a table of what was asked
// and what was measured.
#include "BenchmarkTools.h"

#include "Kernel/Deformation/AsRigidAsPossibleDeformer.h"
#include "Kernel/Deformation/ExampleBasedDeformer.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"

#include <cmath>
#include <cstdio>
#include <exception>

using namespace benchmarks;

namespace
{
constexpr int Drags = 25;

/// Handle 2 turned about an axis, by two and more for several motions.
cartan::HandleTargets Turned(const Eigen::Vector3d& vector)
{
  cartan::HandleTargets targets = Turn(0.0);
  targets.Motions[0].RotationVector = vector;
  targets.Motions[0].Linear = vector.norm() > 0.0
    ? Eigen::AngleAxisd(vector.norm(), vector.normalized()).toRotationMatrix()
    : Eigen::Matrix3d::Identity();
  return targets;
}

/// Poses that bend and twist the surface, as a user would make them.
std::vector<cartan::Points> Poses(const cartan::HandleProblem& problem)
{
  cartan::ShapePreservingDeformer deformer(problem);
  std::vector<cartan::Points> poses;
  for (const Eigen::Vector3d& vector : { Eigen::Vector3d(0.9, 0.0, 0.0),
         Eigen::Vector3d(-0.9, 0.0, 0.0), Eigen::Vector3d(0.0, 1.2, 0.0),
         Eigen::Vector3d(0.0, 0.0, 0.8), Eigen::Vector3d(0.0, 0.0, -0.8) })
  {
    cartan::DeformedSurface result;
    deformer.Deform(Turned(vector), false, result, {});
    poses.push_back(result.Positions);
  }
  return poses;
}

/// Of an iteration, the difference between many and few.
double IterationTime(
  cartan::AsRigidAsPossibleDeformer& deformer, const cartan::HandleTargets& targets)
{
  constexpr int Few = 3;
  constexpr int Many = 13;
  cartan::DeformedSurface result;
  double seconds[2];
  for (const int part : { 0, 1 })
  {
    deformer.SetIteration(part ? Many : Few, 0.0);
    const double start = ProcessorTime();
    deformer.Deform(targets, false, result, {});
    seconds[part] = ProcessorTime() - start;
  }
  return (seconds[1] - seconds[0]) / (Many - Few);
}

void Measure()
{
  const Mesh mesh = ReadMesh("armadillo");
  const cartan::HandleProblem problem = MakeProblem(mesh, 0.05, 0.95);
  const std::vector<cartan::Points> poses = Poses(problem);
  cartan::ExampleBasedDeformer byExamples(problem, poses);
  byExamples.SetWarmStart(true);
  cartan::AsRigidAsPossibleDeformer rigid(problem);
  cartan::DeformedSurface result;
  byExamples.Deform(Turned({ 0.2, 0.1, 0.05 }), false, result, {});
  std::vector<double> drags;
  std::vector<double> steps;
  std::vector<double> iterations;
  for (int i = 1; i <= Drags; ++i)
  {
    // A mouse moves a handle by a degree or two from one picture to the next.
    const double t = 0.03 * i;
    const cartan::HandleTargets targets =
      Turned({ 0.2 + t, 0.1 + 0.4 * std::sin(t), 0.05 + 0.2 * t });
    const double start = ProcessorTime();
    byExamples.Deform(targets, false, result, {});
    drags.push_back(ProcessorTime() - start);
    steps.push_back(byExamples.GetNumberOfIterations());
    if (i % 5 == 0)
    {
      iterations.push_back(IterationTime(rigid, targets));
    }
  }
  std::printf("Armadillo, %d points, %d free, %d examples, one thread\n",
    static_cast<int>(mesh.Points.rows()), byExamples.GetNumberOfFreeVertices(),
    static_cast<int>(poses.size()));
  PrintRow("a warm drag by examples", "", 1e3 * Median(drags), "ms");
  PrintRow("  its steps", "", Median(steps), "");
  PrintRow("an iteration of as-rigid-as-possible, spokes", "", 1e3 * Median(iterations), "ms");
  const double ratio = Median(drags) / Median(iterations);
  PrintRow("  ratio of a drag to it", "<= 10", ratio, "", ratio <= 10.0);
}
}

int main()
{
  try
  {
    Measure();
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
