// SPDX-License-Identifier: BSD-3-Clause
//
// What a motion costs the methods of differential coordinates: Laplacian,
// multiresolution and Poisson editing, and the iterated rotation field of
// shape-preserving editing, on a scan of 104K points that is nearly all free; and
// where 236 of 48,841 points are free, which must cost what those cost. In one
// thread, by the processor's time, which others disturb least (set OMP_NUM_THREADS=1
// for CHOLMOD's), the best of several motions. Ends each part with a table of what
// was asked and what was measured. An argument limits it to the rows that begin with
// it: Laplacian, Multiresolution, Poisson or Shape.
#include "BenchmarkTools.h"

#include "Kernel/Deformation/LaplacianDeformer.h"
#include "Kernel/Deformation/MultiresolutionDeformer.h"
#include "Kernel/Deformation/PoissonDeformer.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace benchmarks;
using cartan::HandleProblem;
using cartan::LaplacianRotations;
using cartan::SurfaceDeformer;

namespace
{
using Maker = std::function<std::unique_ptr<SurfaceDeformer>(const HandleProblem&)>;

template <typename Deformer, typename Option>
Maker Make(Option option)
{
  return [option](const HandleProblem& problem)
  { return std::make_unique<Deformer>(problem, option, cartan::SolverBackend::Automatic); };
}

/// Shape-preserving editing with so many iterates of the rotation field.
Maker MakeIterated(int iterations)
{
  return [iterations](const HandleProblem& problem)
  {
    auto deformer = std::make_unique<cartan::ShapePreservingDeformer>(problem);
    deformer->SetIteration(iterations, 0.0);
    return deformer;
  };
}

/// Prints the time of a set-up and of a motion. `asked` are milliseconds for a
/// motion, 0 where nothing is asked.
void Measure(const std::string& name, const HandleProblem& problem,
  const std::vector<cartan::HandleTargets>& motions, const Maker& make, double asked)
{
  double start = ProcessorTime();
  const auto deformer = make(problem);
  const double setUp = ProcessorTime() - start;
  cartan::DeformedSurface result;
  deformer->Deform(motions[0], false, result, {}); // what is made once
  double best = 1e300;
  for (const cartan::HandleTargets& targets : motions)
  {
    start = ProcessorTime();
    deformer->Deform(targets, false, result, {});
    best = std::min(best, ProcessorTime() - start);
  }
  PrintRow(name + ", set-up", "", 1e3 * setUp, "ms");
  PrintRow(name + ", motion", asked > 0.0 ? "<= 3 ms" : "", 1e3 * best, "ms",
    asked == 0.0 || 1e3 * best <= asked);
}

struct Row
{
  std::string Name;
  Maker Make;
  double Asked; // milliseconds for a motion of 236 free points, 0 where nothing is
  // Implicit rotations solve for three times as many unknowns, which takes minutes.
  bool IsForLarge = true;
};

/// Turns of the upper handle about x, and with `isMiddle` of the middle one about y.
std::vector<cartan::HandleTargets> Turns(int count, bool isMiddle)
{
  std::vector<cartan::HandleTargets> turns;
  for (int i = 0; i < count; ++i)
  {
    turns.push_back(Turn(20.0 + 5.0 * i));
    if (isMiddle)
    {
      cartan::HandleMotion middle;
      const double angle = 0.3 + 0.05 * i;
      middle.RotationVector = { 0.0, angle, 0.0 };
      middle.Linear = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
      turns.back().Motions.push_back(middle);
    }
  }
  return turns;
}

/// A wavy square of 221 x 221 points, of which a disk of 253 moves, the 236 around
/// it are free and all others are pinned.
HandleProblem SmallRegion()
{
  constexpr int side = 221;
  cartan::Points points(side * side, 3);
  cartan::Triangles triangles(2 * (side - 1) * (side - 1), 3);
  HandleProblem problem;
  std::vector<std::pair<int, int>> order; // the squared distance from the middle
  for (int j = 0; j < side; ++j)
  {
    for (int i = 0; i < side; ++i)
    {
      const int v = side * j + i;
      points.row(v) << i, j, std::sin(0.3 * i) * std::cos(0.2 * j);
      const int x = i - side / 2;
      const int y = j - side / 2;
      order.emplace_back(x * x + y * y, v);
      if (i + 1 < side && j + 1 < side)
      {
        const int t = 2 * ((side - 1) * j + i);
        triangles.row(t) << v, v + 1, v + side + 1;
        triangles.row(t + 1) << v, v + side + 1, v + side;
      }
    }
  }
  std::sort(order.begin(), order.end());
  problem.Handle.assign(side * side, 1);
  for (int k = 0; k < 253 + 236; ++k)
  {
    problem.Handle[order[k].second] = k < 253 ? 2 : 0;
  }
  points.rowwise() -= points.colwise().mean().eval();
  problem.Mesh = std::make_shared<const cartan::TriangleMesh>(side * side, triangles);
  problem.Rest = std::make_shared<const cartan::Points>(points);
  problem.Moving = { 2 };
  return problem;
}
}

int main(int argc, char** argv)
{
  try
  {
    const std::string only = argc > 1 ? argv[1] : "";
    const std::vector<Row> rows = {
      { "Laplacian, none", Make<cartan::LaplacianDeformer>(LaplacianRotations::None), 3.0 },
      { "Laplacian, estimated", Make<cartan::LaplacianDeformer>(LaplacianRotations::Estimated),
        3.0 },
      { "Laplacian, implicit", Make<cartan::LaplacianDeformer>(LaplacianRotations::Implicit), 3.0,
        false },
      { "Multiresolution, order 2", Make<cartan::MultiresolutionDeformer>(2), 3.0 },
      { "Poisson, harmonic", Make<cartan::PoissonDeformer>(cartan::Propagation::Harmonic), 0.0 },
    };
    const HandleProblem small = SmallRegion();
    std::printf("Wavy square, %d points, 236 free\n", small.Mesh->NumberOfVertices());
    for (const Row& row : rows)
    {
      if (row.Name.rfind(only, 0) == 0)
      {
        Measure(row.Name, small, Turns(30, false), row.Make, row.Asked);
      }
    }
    HandleProblem large = MakeProblem(Subdivide(ReadMesh("armadillo")), 0.05, 0.95);
    std::printf("Armadillo, %d points, ends held\n", large.Mesh->NumberOfVertices());
    for (const Row& row : rows)
    {
      if (row.Name.rfind(only, 0) == 0 && row.IsForLarge)
      {
        Measure(row.Name, large, Turns(5, false), row.Make, 0.0);
      }
    }
    // A third handle at half of the height, with an axis of its own.
    const std::vector<int> below = MarkEnds({ *large.Rest, large.Mesh->GetTriangles() }, 0.5, 0.52);
    for (std::size_t v = 0; v < below.size(); ++v)
    {
      large.Handle[v] = below[v] == 0 ? 3 : large.Handle[v];
    }
    large.Moving = { 2, 3 };
    for (const int iterates : { 1, 4 })
    {
      const std::string name = "Shape preserving, two axes, iterates: " + std::to_string(iterates);
      if (name.rfind(only, 0) == 0)
      {
        Measure(name, large, Turns(3, true), MakeIterated(iterates), 0.0);
      }
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
