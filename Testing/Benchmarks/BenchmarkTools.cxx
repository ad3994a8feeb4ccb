// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkTools.h"

#include "OffReader.h"

#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Base/Constants.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <stdexcept>
#include <thread>
#include <unordered_map>

namespace benchmarks
{
Mesh ReadMesh(const std::string& name)
{
  const offreader::Mesh file = offreader::Read(offreader::MeshPath(name));
  Mesh mesh;
  mesh.Points = Eigen::Map<const cartan::Points>(
    file.Points.data(), static_cast<Eigen::Index>(file.Points.size() / 3), 3);
  mesh.Triangles = Eigen::Map<const cartan::Triangles>(
    file.Triangles.data(), static_cast<Eigen::Index>(file.Triangles.size() / 3), 3);
  const Eigen::RowVector3d center =
    0.5 * (mesh.Points.colwise().minCoeff() + mesh.Points.colwise().maxCoeff());
  mesh.Points.rowwise() -= center;
  return mesh;
}

Mesh Subdivide(const Mesh& mesh)
{
  std::unordered_map<long long, int> midpoints;
  std::vector<Eigen::RowVector3d> added;
  const int count = static_cast<int>(mesh.Points.rows());
  const auto midpoint = [&](int a, int b)
  {
    const long long key = static_cast<long long>(std::min(a, b)) * count + std::max(a, b);
    const auto [found, isNew] = midpoints.emplace(key, count + static_cast<int>(added.size()));
    if (isNew)
    {
      added.push_back(0.5 * (mesh.Points.row(a) + mesh.Points.row(b)));
    }
    return found->second;
  };
  Mesh result;
  result.Triangles.resize(4 * mesh.Triangles.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.Triangles.rows(); ++t)
  {
    const int a = mesh.Triangles(t, 0), b = mesh.Triangles(t, 1), c = mesh.Triangles(t, 2);
    const int ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
    result.Triangles.row(4 * t) << a, ab, ca;
    result.Triangles.row(4 * t + 1) << b, bc, ab;
    result.Triangles.row(4 * t + 2) << c, ca, bc;
    result.Triangles.row(4 * t + 3) << ab, bc, ca;
  }
  result.Points.resize(count + static_cast<int>(added.size()), 3);
  result.Points.topRows(count) = mesh.Points;
  for (std::size_t i = 0; i < added.size(); ++i)
  {
    result.Points.row(count + static_cast<int>(i)) = added[i];
  }
  return result;
}

std::vector<int> MarkEnds(const Mesh& mesh, double low, double high)
{
  const double bottom = mesh.Points.col(1).minCoeff();
  const double height = mesh.Points.col(1).maxCoeff() - bottom;
  std::vector<int> handles(mesh.Points.rows());
  for (Eigen::Index v = 0; v < mesh.Points.rows(); ++v)
  {
    const double y = (mesh.Points(v, 1) - bottom) / height;
    handles[v] = y <= low ? 1 : y >= high ? 2 : 0;
  }
  return handles;
}

cartan::HandleProblem MakeProblem(const Mesh& mesh, double low, double high)
{
  if (!cartan::TriangleMesh::Check(mesh.Points, mesh.Triangles).IsUsable())
  {
    throw std::runtime_error("The mesh is not usable.");
  }
  cartan::HandleProblem problem;
  problem.Mesh = std::make_shared<const cartan::TriangleMesh>(
    static_cast<int>(mesh.Points.rows()), mesh.Triangles);
  problem.Rest = std::make_shared<const cartan::Points>(mesh.Points);
  problem.Handle = MarkEnds(mesh, low, high);
  problem.Moving = { 2 };
  return problem;
}

cartan::HandleTargets Turn(double degrees)
{
  cartan::HandleMotion motion;
  motion.RotationVector = Eigen::Vector3d(degrees * cartan::Pi / 180.0, 0.0, 0.0);
  motion.Linear = cartan::RotationFromVector(motion.RotationVector);
  cartan::HandleTargets targets;
  targets.Motions = { motion };
  return targets;
}

cartan::ExecutionContext Threads(bool isThreaded)
{
  if (!isThreaded)
  {
    return {};
  }
  return { [](int n, const cartan::ExecutionContext::Range& body)
    {
      const int count = std::max(1u, std::thread::hardware_concurrency());
      std::vector<std::thread> threads;
      const auto bound = [=](int i)
      { return static_cast<int>(static_cast<long long>(n) * i / count); };
      for (int i = 1; i < count; ++i)
      {
        threads.emplace_back([&body, from = bound(i), to = bound(i + 1)]() { body(from, to); });
      }
      body(0, bound(1));
      for (std::thread& thread : threads)
      {
        thread.join();
      }
    },
    nullptr };
}

double WallTime()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double ProcessorTime()
{
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double Median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void PrintRow(const std::string& what, const std::string& asked, double value,
  const std::string& unit, bool isMet)
{
  std::printf("  %-58s %-10s %10.4g %-3s %s\n", what.c_str(), asked.c_str(), value, unit.c_str(),
    asked.empty() ? ""
      : isMet     ? "met"
                  : "MISSED");
}
}
