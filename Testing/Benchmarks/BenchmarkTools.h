// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Deformation/HandleProblem.h"

#include <string>
#include <vector>

/// What the benchmarks share: surfaces, handles, motions, clocks and the table
/// of what was asked and what was measured.
namespace benchmarks
{
struct Mesh
{
  cartan::Points Points;
  cartan::Triangles Triangles;
};

/// A scanned mesh by its name, centered on the origin.
Mesh ReadMesh(const std::string& name);

/// Each triangle into four, by the edges' midpoints.
Mesh Subdivide(const Mesh& mesh);

/// Handle 1, static, up to the part `low` of the height (y); handle 2, which
/// moves, from `high` on; 0 between.
std::vector<int> MarkEnds(const Mesh& mesh, double low, double high);

/// With the handles of MarkEnds. Throws std::runtime_error when the mesh is not
/// usable.
cartan::HandleProblem MakeProblem(const Mesh& mesh, double low, double high);

/// Handle 2 turned about the x axis.
cartan::HandleTargets Turn(double degrees);

/// Splits loops evenly over the machine's threads; or everything in one thread.
cartan::ExecutionContext Threads(bool isThreaded = true);

/// Seconds since an arbitrary moment, as users wait for them.
double WallTime();

/// Seconds of this process: others' load does not count.
double ProcessorTime();

double Median(std::vector<double> values);

/// A row of the table: `asked` is empty where nothing is.
void PrintRow(const std::string& what, const std::string& asked, double value,
  const std::string& unit, bool isMet = true);
}
