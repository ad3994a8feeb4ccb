// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// Reads the scanned meshes that the tests use. They are in the OFF format,
/// for which VTK has no reader.
namespace offreader
{
struct Mesh
{
  std::vector<double> Points; ///< x0 y0 z0 x1 y1 z1 ...
  std::vector<int> Triangles; ///< Three point ids each; larger faces become fans.
};

/// Where the mesh called `name` lies, for example "armadillo".
inline std::string MeshPath(const std::string& name)
{
  return CARTAN_MESH_DIR "/" + name + ".off";
}

/// Reads OFF, COFF, NOFF and CNOFF; normals, colors and comments are skipped.
/// Throws std::runtime_error when there is no such file or it makes no sense.
inline Mesh Read(const std::string& path)
{
  std::ifstream file(path);
  const auto fail = [&path](const std::string& what) -> void
  { throw std::runtime_error(path + ": " + what); };
  if (!file)
  {
    fail("cannot be opened");
  }

  // A record is a line: the optional values that follow a vertex or a face are
  // as many as the writer pleased.
  std::istringstream record;
  const auto nextRecord = [&]()
  {
    std::string line;
    while (std::getline(file, line))
    {
      line.erase(std::min(line.find('#'), line.size()));
      if (line.find_first_not_of(" \t\r") != std::string::npos)
      {
        record = std::istringstream(line);
        return;
      }
    }
    fail("ends too early");
  };

  std::string header;
  nextRecord();
  record >> header;
  if (header.size() < 3 || header.substr(header.size() - 3) != "OFF")
  {
    fail("is not an OFF file");
  }
  std::size_t numberOfPoints = 0;
  std::size_t numberOfFaces = 0;
  if (!(record >> numberOfPoints)) // the counts may stand on the header's line
  {
    nextRecord();
    record >> numberOfPoints;
  }
  if (!(record >> numberOfFaces))
  {
    fail("has no counts");
  }

  Mesh mesh;
  mesh.Points.resize(3 * numberOfPoints);
  for (std::size_t point = 0; point < numberOfPoints; ++point)
  {
    nextRecord();
    double* x = &mesh.Points[3 * point];
    if (!(record >> x[0] >> x[1] >> x[2]))
    {
      fail("has a malformed vertex");
    }
  }

  mesh.Triangles.reserve(3 * numberOfFaces);
  for (std::size_t face = 0; face < numberOfFaces; ++face)
  {
    nextRecord();
    int size = 0;
    record >> size;
    std::vector<int> corners(size > 0 ? static_cast<std::size_t>(size) : 0);
    for (int& corner : corners)
    {
      if (!(record >> corner) || corner < 0 || static_cast<std::size_t>(corner) >= numberOfPoints)
      {
        fail("has a malformed face");
      }
    }
    for (std::size_t c = 2; c < corners.size(); ++c)
    {
      mesh.Triangles.insert(mesh.Triangles.end(), { corners[0], corners[c - 1], corners[c] });
    }
  }
  return mesh;
}
}
