// SPDX-License-Identifier: BSD-3-Clause
//
// What the set-up of a deformation is made of: weights and matrix, order of the unknowns,
// factorization, fields; with CHOLMOD's minimum degree (AMD) and nested dissection (METIS) side
// by side, beside the preprocessing of CGAL's as-rigid-as-possible deformation on the same surface
// with the same handles in the same run. Then what keeping the volume adds to Shape Preserving
// Deformation. Ends with a table of what was asked and what was measured.
// Arguments: how often the armadillo is subdivided, by default 2, and 1 for the volume.
#include "BenchmarkTools.h"
#include "PeerDeformation.h"

#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Differential/Laplacian.h"
#include "Kernel/Measure/VolumeModel.h"
#include "Kernel/Mesh/RayTree.h"

#ifdef CARTAN_HAVE_CHOLMOD
#include <cholmod.h>
#endif

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

using namespace benchmarks;
using namespace cartan;

namespace
{
constexpr double Low = 0.05;
constexpr double High = 0.95;

Mesh Armadillo(int subdivisions)
{
  Mesh mesh = ReadMesh("armadillo");
  for (int i = 0; i < subdivisions; ++i)
  {
    mesh = Subdivide(mesh);
  }
  return mesh;
}

/// Wall seconds of a step, printed with its processor seconds.
template <typename Step>
double Time(const char* name, const Step& step)
{
  const double processor = ProcessorTime();
  const double wall = WallTime();
  step();
  const double seconds = WallTime() - wall;
  std::printf(
    "  %-58s %8.3f s processor %8.3f s wall\n", name, ProcessorTime() - processor, seconds);
  return seconds;
}

/// The lower triangle between the free vertices.
SparseMatrix LowerBlock(const SparseMatrix& laplacian, const std::vector<int>& handles)
{
  std::vector<int> index(handles.size(), -1);
  int count = 0;
  for (std::size_t v = 0; v < handles.size(); ++v)
  {
    index[v] = handles[v] == 0 ? count++ : -1;
  }
  SparseMatrix block(count, count);
  block.reserve(laplacian.nonZeros() / 2 + count);
  for (Eigen::Index column = 0; column < laplacian.cols(); ++column)
  {
    if (index[column] < 0)
    {
      continue;
    }
    block.startVec(index[column]);
    for (SparseMatrix::InnerIterator entry(laplacian, column); entry; ++entry)
    {
      if (entry.index() >= column && index[entry.index()] >= 0)
      {
        block.insertBack(index[entry.index()], index[column]) = entry.value();
      }
    }
  }
  block.finalize();
  return block;
}

#ifdef CARTAN_HAVE_CHOLMOD
/// Orders, factorizes, and solves for three right-hand sides as motions do.
void TryOrdering(const char* name, int ordering, SparseMatrix& lower)
{
  cholmod_common common;
  cholmod_start(&common);
  common.nmethods = 1;
  common.method[0].ordering = ordering;
  common.final_asis = 0;
  common.final_ll = 1;
  cholmod_sparse view = {};
  view.nrow = view.ncol = static_cast<std::size_t>(lower.rows());
  view.nzmax = static_cast<std::size_t>(lower.nonZeros());
  view.p = lower.outerIndexPtr();
  view.i = lower.innerIndexPtr();
  view.x = lower.valuePtr();
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  cholmod_factor* factor = nullptr;
  std::printf("  %s\n", name);
  Time("  order and pattern", [&] { factor = cholmod_analyze(&view, &common); });
  const double entries = common.lnz;
  const double operations = common.fl;
  Time("  factorization", [&] { cholmod_factorize(&view, factor, &common); });
  cholmod_dense* right = cholmod_ones(view.nrow, 3, CHOLMOD_REAL, &common);
  cholmod_dense* solution = nullptr;
  Time("  solution of three columns",
    [&] { solution = cholmod_solve(CHOLMOD_A, factor, right, &common); });
  std::printf("  %-58s %.3g entries, %.3g operations\n", "  factor", entries, operations);
  cholmod_free_dense(&solution, &common);
  cholmod_free_dense(&right, &common);
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
}
#endif

void MeasureSteps(int subdivisions)
{
  const Mesh mesh = Armadillo(subdivisions);
  std::printf("Armadillo, %ld points\n", static_cast<long>(mesh.Points.rows()));
  const ExecutionContext context = Threads();
  const HandleProblem problem = MakeProblem(mesh, Low, High);
  SparseMatrix laplacian;
  Eigen::VectorXd weights;
  Time("weights",
    [&]
    {
      weights = SymmetricPart(*problem.Mesh,
        EdgeWeights(*problem.Mesh, *problem.Rest, LaplacianWeights::Cotangent, context));
    });
  Time("matrix", [&] { laplacian = Laplacian(*problem.Mesh, weights); });
  SparseMatrix lower;
  Time("block of the free points", [&] { lower = LowerBlock(laplacian, problem.Handle); });
#ifdef CARTAN_HAVE_CHOLMOD
  TryOrdering("minimum degree (AMD)", CHOLMOD_AMD, lower);
  TryOrdering("nested dissection (METIS)", CHOLMOD_METIS, lower);
#endif
  std::unique_ptr<RotationInvariantDeformer> deformer;
  double all = Time("all of it, with harmonic fields, in Rotation Invariant",
    [&]
    {
      deformer =
        std::make_unique<RotationInvariantDeformer>(problem, SolverBackend::Automatic, context);
    });
  deformer->SetFrameProjection(FrameProjection::None);
  DeformedSurface result;
  all += Time("fields of a raw motion, and one",
    [&] { deformer->Deform(Turn(20.0), false, result, context); });
  deformer.reset();
  const PeerDeformation peer(mesh.Points, mesh.Triangles, problem.Handle);
  PrintRow("set-up with the first motion", "", all, "s");
  PrintRow("CGAL's preprocess()", "", peer.GetPreprocessTime(), "s");
  PrintRow("  ratio of the set-up to it", "<= 0.333", all / peer.GetPreprocessTime(), "",
    3.0 * all <= peer.GetPreprocessTime());
}

void MeasureVolume(int subdivisions)
{
  const ExecutionContext context = Threads();
  const HandleProblem problem = MakeProblem(Armadillo(subdivisions), Low, High);
  std::printf(
    "Armadillo, %ld points: what the volume takes\n", static_cast<long>(problem.Rest->rows()));
  const TriangleMesh& mesh = *problem.Mesh;
  std::unique_ptr<RayTree> tree;
  double all = Time("tree of triangles",
    [&] { tree = std::make_unique<RayTree>(mesh.GetTriangles(), *problem.Rest, context); });
  all += Time("depths by rays, and offsets",
    [&]
    {
      MeasureVolumeModel(
        mesh, *problem.Rest,
        [&tree](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
        { return tree->FirstHit(from, direction); },
        context);
    });
  PrintRow("set-up of Shape Preserving with its volume, more by", "<= 1", all, "s", all <= 1.0);
}
}

int main(int argc, char** argv)
{
  try
  {
    MeasureSteps(argc > 1 ? std::atoi(argv[1]) : 2);
    MeasureVolume(argc > 2 ? std::atoi(argv[2]) : 1);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
