// SPDX-License-Identifier: BSD-3-Clause
#include "PeerMerge.h"

#include "Kernel/Base/Constants.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/fair.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <stdexcept>
#include <vector>

namespace
{
namespace Processing = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using SeamEdges = Mesh::Property_map<Mesh::Edge_index, bool>;

Mesh ClosedMesh(const cartan::Points& points, const cartan::Triangles& triangles)
{
  Mesh mesh;
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    mesh.add_vertex(Kernel::Point_3(points(v, 0), points(v, 1), points(v, 2)));
  }
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    mesh.add_face(Mesh::Vertex_index(triangles(t, 0)), Mesh::Vertex_index(triangles(t, 1)),
      Mesh::Vertex_index(triangles(t, 2)));
  }
  std::vector<Mesh::Halfedge_index> holes;
  Processing::extract_boundary_cycles(mesh, std::back_inserter(holes));
  for (const Mesh::Halfedge_index hole : holes)
  {
    std::vector<Mesh::Face_index> patch;
    Processing::triangulate_hole(mesh, hole, std::back_inserter(patch));
  }
  return mesh;
}

/// Mean and largest angle, in degrees, between the triangles at both sides of the seam.
void MeasureSeam(const Mesh& mesh, const SeamEdges& isSeam, double& mean, double& maximum)
{
  mean = maximum = 0.0;
  int count = 0;
  for (const Mesh::Edge_index e : mesh.edges())
  {
    if (isSeam[e])
    {
      const Mesh::Halfedge_index h = mesh.halfedge(e);
      const auto a = Processing::compute_face_normal(mesh.face(h), mesh);
      const auto b = Processing::compute_face_normal(mesh.face(mesh.opposite(h)), mesh);
      const double sine = std::sqrt(CGAL::cross_product(a, b).squared_length());
      const double angle = std::atan2(sine, a * b) * 180.0 / cartan::Pi;
      mean += angle;
      maximum = std::max(maximum, angle);
      ++count;
    }
  }
  mean /= std::max(count, 1);
}

/// The vertices of the seam and `rings` rings around it.
std::set<Mesh::Vertex_index> SeamRegion(const Mesh& mesh, const SeamEdges& isSeam, int rings)
{
  std::set<Mesh::Vertex_index> region;
  for (const Mesh::Edge_index e : mesh.edges())
  {
    if (isSeam[e])
    {
      region.insert(mesh.vertex(e, 0));
      region.insert(mesh.vertex(e, 1));
    }
  }
  for (int ring = 0; ring < rings; ++ring)
  {
    const std::set<Mesh::Vertex_index> before = region;
    for (const Mesh::Vertex_index v : before)
    {
      for (const Mesh::Vertex_index w : mesh.vertices_around_target(mesh.halfedge(v)))
      {
        region.insert(w);
      }
    }
  }
  return region;
}
}

PeerSeam MergeByPeer(const cartan::Points& target, const cartan::Triangles& targetTriangles,
  const cartan::Points& source, const cartan::Triangles& sourceTriangles, int rings)
{
  Mesh first = ClosedMesh(target, targetTriangles);
  Mesh second = ClosedMesh(source, sourceTriangles);
  Mesh joined;
  SeamEdges isSeam = joined.add_property_map<Mesh::Edge_index, bool>("e:seam", false).first;
  if (!Processing::corefine_and_compute_union(first, second, joined,
        CGAL::parameters::default_values(), CGAL::parameters::default_values(),
        CGAL::parameters::edge_is_constrained_map(isSeam)))
  {
    throw std::runtime_error("CGAL's union is no manifold.");
  }
  PeerSeam seam;
  for (const Mesh::Edge_index e : joined.edges())
  {
    seam.NumberOfEdges += isSeam[e] ? 1 : 0;
  }
  MeasureSeam(joined, isSeam, seam.Mean, seam.Maximum);
  if (!Processing::fair(joined, SeamRegion(joined, isSeam, rings)))
  {
    throw std::runtime_error("CGAL's fairing failed.");
  }
  MeasureSeam(joined, isSeam, seam.FairedMean, seam.FairedMaximum);
  return seam;
}
