// SPDX-License-Identifier: BSD-3-Clause
//
// What 100 modes of the graph Laplacian cost on a scan of 26K points and on the same
// subdivided to 104K, against ARPACK on the same factorization and SciPy's eigsh, which
// factorizes by SuperLU. One thread each, by the processor's time, which others disturb
// least. SciPy runs in a process of its own (/usr/bin/python3); a row says so where it
// is not installed. An argument limits it to surfaces whose name begins with it.
#include "BenchmarkTools.h"

#include "Kernel/Algebra/ConstrainedSolver.h"
#include "Kernel/Differential/Laplacian.h"
#include "Kernel/Spectral/LaplacianSpectrum.h"

#include <arpack/arpack.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

using namespace benchmarks;

namespace
{
constexpr int Count = 100;

double PeakMegabytes()
{
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1e3;
}

cartan::SparseMatrix GraphLaplacian(const cartan::TriangleMesh& mesh, const Mesh& surface)
{
  return cartan::Laplacian(
    mesh, cartan::EdgeWeights(mesh, surface.Points, cartan::LaplacianWeights::Uniform));
}

/// The largest of the smallest eigenvalues, by ARPACK's shift-and-invert mode with twice as
/// many Lanczos vectors as modes.
double ArpackEigenvalue(const cartan::SparseMatrix& matrix)
{
  const auto size = static_cast<a_int>(matrix.rows());
  const double sigma = -1e-8 * matrix.diagonal().mean();
  cartan::ConstrainedSolver solver;
  solver.Factorize(matrix, std::vector<char>(size, 0), Eigen::VectorXd::Constant(size, -sigma));
  const a_int vectors = 2 * Count + 1;
  std::vector<double> residual(size);
  std::vector<double> basis(static_cast<std::size_t>(size) * vectors);
  std::vector<double> work(3 * static_cast<std::size_t>(size));
  std::vector<double> small(static_cast<std::size_t>(vectors) * (vectors + 8));
  const auto smallSize = static_cast<a_int>(small.size());
  a_int parameters[11] = { 1, 0, 1000, 1, 0, 0, 3 };
  a_int places[14] = {};
  a_int state = 0;
  a_int info = 0;
  const auto step = [&]
  {
    arpack::saupd(state, arpack::bmat::identity, size, arpack::which::largest_magnitude, Count, 0.0,
      residual.data(), vectors, basis.data(), size, parameters, places, work.data(), small.data(),
      smallSize, info);
    return state == 1 || state == -1;
  };
  while (step())
  {
    const Eigen::Map<const Eigen::MatrixXd> in(&work[places[0] - 1], size, 1);
    Eigen::Map<Eigen::MatrixXd>(&work[places[1] - 1], size, 1) = solver.SolveFree(in);
  }
  std::vector<a_int> select(vectors);
  Eigen::VectorXd values(Count);
  Eigen::MatrixXd modes(size, Count);
  arpack::seupd(1, arpack::howmny::ritz_vectors, select.data(), values.data(), modes.data(), size,
    sigma, arpack::bmat::identity, size, arpack::which::largest_magnitude, Count, 0.0,
    residual.data(), vectors, basis.data(), size, parameters, places, work.data(), small.data(),
    smallSize, info);
  return values.maxCoeff();
}

/// Seconds of SciPy's eigsh on this matrix; negative where there is no SciPy.
double ScipySeconds(const cartan::SparseMatrix& matrix)
{
  const std::string folder = std::getenv("TMPDIR") ? std::getenv("TMPDIR") : "/tmp";
  const std::string file = folder + "/cartan-spectrum-benchmark.txt";
  {
    std::ofstream out(file);
    for (int column = 0; column < matrix.outerSize(); ++column)
    {
      for (cartan::SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
      {
        out << entry.row() << ' ' << column << ' ' << entry.value() << '\n';
      }
    }
  }
  const std::string program = "OMP_NUM_THREADS=1 /usr/bin/python3 -c \"\n"
                              "import sys, time, numpy, scipy.sparse, scipy.sparse.linalg\n"
                              "i, j, v = numpy.loadtxt('" +
    file +
    "').T\n"
    "a = scipy.sparse.csc_matrix((v, (i.astype(int), j.astype(int))))\n"
    "start = time.process_time()\n"
    "scipy.sparse.linalg.eigsh(a, k=" +
    std::to_string(Count) +
    ", sigma=-1e-8 * a.diagonal().mean())\n"
    "print(time.process_time() - start)\" 2>/dev/null";
  double seconds = -1.0;
  if (std::FILE* pipe = popen(program.c_str(), "r"))
  {
    if (std::fscanf(pipe, "%lf", &seconds) != 1)
    {
      seconds = -1.0;
    }
    pclose(pipe);
  }
  std::remove(file.c_str());
  return seconds;
}

void Measure(const std::string& name, const Mesh& surface)
{
  const cartan::TriangleMesh mesh(static_cast<int>(surface.Points.rows()), surface.Triangles);
  const cartan::SparseMatrix matrix = GraphLaplacian(mesh, surface);
  double start = ProcessorTime();
  const cartan::LaplacianSpectrum spectrum = cartan::ComputeSpectrum(
    mesh, surface.Points, cartan::SpectrumOperator::Graph, Count, 4000000000U);
  const double own = ProcessorTime() - start;
  const double memory = PeakMegabytes();
  start = ProcessorTime();
  const double value = ArpackEigenvalue(matrix);
  const double arpack = ProcessorTime() - start;
  const double scipy = ScipySeconds(matrix);
  PrintRow(name + ", ARPACK on the same factorization", "", arpack, "s");
  PrintRow(name + (scipy < 0.0 ? ", SciPy (not installed)" : ", SciPy's eigsh"), "", scipy, "s");
  const double peer = scipy < 0.0 ? arpack : std::min(arpack, scipy);
  PrintRow(name + ", Cartan", "<= peers and 30 s", own, "s", own <= std::min(peer, 30.0));
  PrintRow(name + ", memory at the peak", "<= 2000 MB", memory, "MB", memory <= 2000.0);
  const double difference = std::abs(value / spectrum.Eigenvalues[Count - 1] - 1.0);
  PrintRow(
    name + ", last eigenvalue against ARPACK", "<= 1e-8", difference, "", difference <= 1e-8);
}
}

int main(int argc, char** argv)
{
  try
  {
    const std::string only = argc > 1 ? argv[1] : "";
    const Mesh armadillo = ReadMesh("armadillo");
    if (std::string("26K").rfind(only, 0) == 0)
    {
      Measure("26K, 100 modes", armadillo);
    }
    if (std::string("104K").rfind(only, 0) == 0)
    {
      Measure("104K, 100 modes", Subdivide(armadillo));
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
