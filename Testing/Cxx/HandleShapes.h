// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Deformation/HandleProblem.h"
#include "TestShapes.h"

#include <functional>
#include <memory>
#include <thread>
#include <vector>

/// Shapes with handles, and threads that find what depends on their order.
namespace shapes
{
/// The handle of a place: 0 is free.
using HandleOf = std::function<int(const Eigen::Vector3d& position)>;

/// Handles where coordinate `axis` is in the lowest (1) and highest (2) `share` of
/// its extent.
inline HandleOf EndsAlong(const Shape& shape, int axis, double share)
{
  const double low = shape.Positions.col(axis).minCoeff();
  const double extent = shape.Positions.col(axis).maxCoeff() - low;
  return [low, extent, axis, share](const Eigen::Vector3d& x)
  {
    const double part = (x[axis] - low) / extent;
    return part < share ? 1 : part > 1.0 - share ? 2 : 0;
  };
}

inline cartan::HandleProblem ProblemOf(
  const Shape& shape, const HandleOf& handleOf, const std::vector<int>& moving = { 2 })
{
  cartan::HandleProblem problem;
  problem.Mesh =
    std::make_shared<const cartan::TriangleMesh>(shape.NumberOfVertices(), shape.Faces);
  problem.Rest = std::make_shared<const cartan::Points>(shape.Positions);
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    problem.Handle.push_back(handleOf(shape.Positions.row(v).transpose()));
  }
  problem.Moving = moving;
  return problem;
}

/// Chunks of `count` from the last to the first, each in a thread of its own.
inline cartan::ExecutionContext ManyThreads(int count)
{
  return cartan::ExecutionContext(
    [count](int n, const cartan::ExecutionContext::Range& body)
    {
      std::vector<std::thread> threads;
      for (int chunk = count - 1; chunk >= 0; --chunk)
      {
        const int begin = static_cast<int>(static_cast<long long>(n) * chunk / count);
        const int end = static_cast<int>(static_cast<long long>(n) * (chunk + 1) / count);
        threads.emplace_back([&body, begin, end]() { body(begin, end); });
      }
      for (std::thread& thread : threads)
      {
        thread.join();
      }
    },
    {});
}
}
