// SPDX-License-Identifier: BSD-3-Clause
#include "PeerDeformation.h"

#include "BenchmarkTools.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_deformation.h>

#include <algorithm>
#include <stdexcept>

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Deformation =
  CGAL::Surface_mesh_deformation<Mesh, CGAL::Default, CGAL::Default, CGAL::ORIGINAL_ARAP>;

class PeerDeformation::Internals
{
public:
  Mesh Surface;
  std::unique_ptr<Deformation> Deformer;
  std::vector<Mesh::Vertex_index> Moving;
  std::vector<Eigen::Vector3d> Rest;
  double PreprocessTime = 0.0;
};

PeerDeformation::PeerDeformation(
  const cartan::Points& points, const cartan::Triangles& triangles, const std::vector<int>& handles)
  : State(std::make_unique<Internals>())
{
  Mesh& mesh = this->State->Surface;
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    mesh.add_vertex(Kernel::Point_3(points(v, 0), points(v, 1), points(v, 2)));
  }
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    mesh.add_face(Mesh::Vertex_index(triangles(t, 0)), Mesh::Vertex_index(triangles(t, 1)),
      Mesh::Vertex_index(triangles(t, 2)));
  }
  this->State->Deformer = std::make_unique<Deformation>(mesh);
  const int moving = *std::max_element(handles.begin(), handles.end());
  for (const Mesh::Vertex_index v : mesh.vertices())
  {
    const int handle = handles[v];
    if (handle != 0 && handle != moving)
    {
      continue; // outside the region of interest: static
    }
    this->State->Deformer->insert_roi_vertex(v);
    if (handle == moving)
    {
      this->State->Deformer->insert_control_vertex(v);
      this->State->Moving.push_back(v);
      this->State->Rest.push_back(points.row(static_cast<Eigen::Index>(v.idx())).transpose());
    }
  }
  const double start = benchmarks::WallTime();
  if (!this->State->Deformer->preprocess())
  {
    throw std::runtime_error("CGAL's preprocess() failed.");
  }
  this->State->PreprocessTime = benchmarks::WallTime() - start;
}

PeerDeformation::~PeerDeformation() = default;

double PeerDeformation::GetPreprocessTime() const
{
  return this->State->PreprocessTime;
}

void PeerDeformation::MoveHandle(const Eigen::Matrix3d& linear, const Eigen::Vector3d& translation)
{
  for (std::size_t i = 0; i < this->State->Moving.size(); ++i)
  {
    const Eigen::Vector3d target = linear * this->State->Rest[i] + translation;
    this->State->Deformer->set_target_position(
      this->State->Moving[i], Kernel::Point_3(target[0], target[1], target[2]));
  }
}

void PeerDeformation::Iterate()
{
  this->State->Deformer->deform(1, 0.0);
}

cartan::Points PeerDeformation::GetPositions() const
{
  const Mesh& mesh = this->State->Surface;
  cartan::Points points(static_cast<Eigen::Index>(mesh.number_of_vertices()), 3);
  for (const Mesh::Vertex_index v : mesh.vertices())
  {
    const Kernel::Point_3& point = mesh.point(v);
    points.row(static_cast<Eigen::Index>(v.idx())) << point.x(), point.y(), point.z();
  }
  return points;
}
