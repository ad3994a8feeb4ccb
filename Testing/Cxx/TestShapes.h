// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Base/Constants.h"
#include "Kernel/Base/Types.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <utility>
#include <vector>

/// Surfaces with known properties for the tests. All are oriented outward (or
/// to +z where there is no inside), and the same on every machine: a jitter
/// comes from a fixed seed and a generator whose sequence the standard fixes.
namespace shapes
{
using cartan::Pi;

struct Shape
{
  cartan::Points Positions;
  cartan::Triangles Faces;

  int NumberOfVertices() const { return static_cast<int>(this->Positions.rows()); }
};

/// Uniform numbers in [-1, 1). The distributions of <random> differ between
/// standard libraries, the engines do not.
class Random
{
public:
  explicit Random(unsigned int seed)
    : Engine(seed)
  {
  }
  double operator()() { return static_cast<double>(this->Engine()) / 2147483648.0 - 1.0; }

private:
  std::mt19937 Engine;
};

inline cartan::Triangles ToTriangles(const std::vector<Eigen::Vector3i>& faces)
{
  cartan::Triangles triangles(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t t = 0; t < faces.size(); ++t)
  {
    triangles.row(static_cast<Eigen::Index>(t)) = faces[t].transpose();
  }
  return triangles;
}

inline cartan::Points ToPoints(const std::vector<Eigen::Vector3d>& positions)
{
  cartan::Points points(static_cast<Eigen::Index>(positions.size()), 3);
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    points.row(static_cast<Eigen::Index>(i)) = positions[i].transpose();
  }
  return points;
}

/// What Patch makes of its parameter rectangle.
struct PatchOptions
{
  int CountU = 10; ///< quads in each direction, every one split in two
  int CountV = 10;
  bool PeriodicU = false;
  bool PeriodicV = false;
  /// Displaces the parameters of interior points by up to this part of a quad
  /// and chooses diagonals at random; boundary points slide along their side.
  /// 0 is a regular grid; up to about 0.3 keeps every triangle's orientation.
  double Jitter = 0.0;
  unsigned int Seed = 1;
};

/// The image of the unit square under `map`, oriented by d/du x d/dv. Vertex
/// (i, j) has the id j * columns + i with columns = CountU + 1, or CountU when
/// periodic. `map` gets parameters in [0, 1], a little outside when periodic.
inline Shape Patch(
  const PatchOptions& options, const std::function<Eigen::Vector3d(double u, double v)>& map)
{
  const int columns = options.CountU + (options.PeriodicU ? 0 : 1);
  const int rows = options.CountV + (options.PeriodicV ? 0 : 1);
  Random random(options.Seed);
  Shape shape;
  shape.Positions.resize(columns * rows, 3);
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      const bool freeU = options.PeriodicU || (i > 0 && i < columns - 1);
      const bool freeV = options.PeriodicV || (j > 0 && j < rows - 1);
      const double du = freeU ? options.Jitter * random() : 0.0;
      const double dv = freeV ? options.Jitter * random() : 0.0;
      shape.Positions.row(j * columns + i) =
        map((i + du) / options.CountU, (j + dv) / options.CountV).transpose();
    }
  }
  std::vector<Eigen::Vector3i> faces;
  for (int j = 0; j < options.CountV; ++j)
  {
    for (int i = 0; i < options.CountU; ++i)
    {
      const int right = (i + 1) % columns;
      const int up = (j + 1) % rows;
      const int a = j * columns + i;
      const int b = j * columns + right;
      const int c = up * columns + right;
      const int d = up * columns + i;
      if (options.Jitter > 0.0 && random() < 0.0)
      {
        faces.emplace_back(a, b, d);
        faces.emplace_back(b, c, d);
      }
      else
      {
        faces.emplace_back(a, b, c);
        faces.emplace_back(a, c, d);
      }
    }
  }
  shape.Faces = ToTriangles(faces);
  return shape;
}

/// The graph z = height(x, y) over [-size/2, size/2]^2, normals to +z.
inline Shape Graph(int count, double size, const std::function<double(double x, double y)>& height,
  double jitter = 0.0, unsigned int seed = 1)
{
  PatchOptions options;
  options.CountU = options.CountV = count;
  options.Jitter = jitter;
  options.Seed = seed;
  return Patch(options,
    [&](double u, double v)
    {
      const double x = size * (u - 0.5);
      const double y = size * (v - 0.5);
      return Eigen::Vector3d(x, y, height(x, y));
    });
}

/// A square in the plane z = 0.
inline Shape Plane(int count, double size = 1.0, double jitter = 0.0, unsigned int seed = 1)
{
  return Graph(
    count, size, [](double, double) { return 0.0; }, jitter, seed);
}

/// z = (x^2 - y^2) / 2: curvatures +-1 at the origin.
inline Shape Saddle(int count, double size = 1.0, double jitter = 0.0, unsigned int seed = 1)
{
  return Graph(
    count, size, [](double x, double y) { return 0.5 * (x * x - y * y); }, jitter, seed);
}

/// A cylinder about the z axis from z = 0 to z = length, open at both ends.
inline Shape OpenCylinder(int around, int along, double radius = 1.0, double length = 2.0,
  double jitter = 0.0, unsigned int seed = 1)
{
  PatchOptions options;
  options.CountU = around;
  options.CountV = along;
  options.PeriodicU = true;
  options.Jitter = jitter;
  options.Seed = seed;
  return Patch(options,
    [&](double u, double v)
    {
      return Eigen::Vector3d(
        radius * std::cos(2 * Pi * u), radius * std::sin(2 * Pi * u), length * v);
    });
}

/// A torus about the z axis: `major` the radius of the core circle, `minor` of the tube.
inline Shape Torus(int aroundAxis, int aroundTube, double major = 2.0, double minor = 0.7,
  double jitter = 0.0, unsigned int seed = 1)
{
  PatchOptions options;
  options.CountU = aroundAxis;
  options.CountV = aroundTube;
  options.PeriodicU = options.PeriodicV = true;
  options.Jitter = jitter;
  options.Seed = seed;
  return Patch(options,
    [&](double u, double v)
    {
      const double distance = major + minor * std::cos(2 * Pi * v);
      return Eigen::Vector3d(distance * std::cos(2 * Pi * u), distance * std::sin(2 * Pi * u),
        minor * std::sin(2 * Pi * v));
    });
}

/// A sphere of meridians and parallels with both poles (ids 0 and 1), which
/// have `meridians` sliver triangles each.
inline Shape UvSphere(int meridians, int parallels, double radius = 1.0)
{
  std::vector<Eigen::Vector3d> positions = { { 0, 0, radius }, { 0, 0, -radius } };
  for (int j = 1; j <= parallels; ++j)
  {
    const double latitude = Pi * (0.5 - static_cast<double>(j) / (parallels + 1));
    for (int i = 0; i < meridians; ++i)
    {
      const double longitude = 2 * Pi * i / meridians;
      positions.emplace_back(radius * std::cos(latitude) * std::cos(longitude),
        radius * std::cos(latitude) * std::sin(longitude), radius * std::sin(latitude));
    }
  }
  std::vector<Eigen::Vector3i> faces;
  const auto id = [&](int j, int i) { return 2 + j * meridians + i % meridians; };
  for (int i = 0; i < meridians; ++i)
  {
    faces.emplace_back(0, id(0, i), id(0, i + 1));
    for (int j = 0; j + 1 < parallels; ++j)
    {
      faces.emplace_back(id(j, i), id(j + 1, i), id(j + 1, i + 1));
      faces.emplace_back(id(j, i), id(j + 1, i + 1), id(j, i + 1));
    }
    faces.emplace_back(1, id(parallels - 1, i + 1), id(parallels - 1, i));
  }
  return { ToPoints(positions), ToTriangles(faces) };
}

/// A subdivided icosahedron with all points on the sphere: 10 * 4^level + 2 points.
inline Shape Icosphere(int level, double radius = 1.0)
{
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<Eigen::Vector3d> positions = { { -1, g, 0 }, { 1, g, 0 }, { -1, -g, 0 }, { 1, -g, 0 },
    { 0, -1, g }, { 0, 1, g }, { 0, -1, -g }, { 0, 1, -g }, { g, 0, -1 }, { g, 0, 1 },
    { -g, 0, -1 }, { -g, 0, 1 } };
  std::vector<Eigen::Vector3i> faces = { { 0, 11, 5 }, { 0, 5, 1 }, { 0, 1, 7 }, { 0, 7, 10 },
    { 0, 10, 11 }, { 1, 5, 9 }, { 5, 11, 4 }, { 11, 10, 2 }, { 10, 7, 6 }, { 7, 1, 8 }, { 3, 9, 4 },
    { 3, 4, 2 }, { 3, 2, 6 }, { 3, 6, 8 }, { 3, 8, 9 }, { 4, 9, 5 }, { 2, 4, 11 }, { 6, 2, 10 },
    { 8, 6, 7 }, { 9, 8, 1 } };
  for (int step = 0; step < level; ++step)
  {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b)
    {
      const auto key = std::minmax(a, b);
      const auto found = middles.find(key);
      if (found != middles.end())
      {
        return found->second;
      }
      const int id = static_cast<int>(positions.size());
      positions.push_back((positions[a].normalized() + positions[b].normalized()).normalized());
      middles.emplace(key, id);
      return id;
    };
    std::vector<Eigen::Vector3i> finer;
    for (const Eigen::Vector3i& face : faces)
    {
      const int ab = middle(face[0], face[1]);
      const int bc = middle(face[1], face[2]);
      const int ca = middle(face[2], face[0]);
      finer.emplace_back(face[0], ab, ca);
      finer.emplace_back(face[1], bc, ab);
      finer.emplace_back(face[2], ca, bc);
      finer.emplace_back(ab, bc, ca);
    }
    faces.swap(finer);
  }
  for (Eigen::Vector3d& position : positions)
  {
    position *= radius / position.norm();
  }
  return { ToPoints(positions), ToTriangles(faces) };
}

/// An icosphere stretched to the half axes.
inline Shape Ellipsoid(int level, const Eigen::Vector3d& halfAxes)
{
  Shape shape = Icosphere(level);
  shape.Positions = shape.Positions * halfAxes.asDiagonal();
  return shape;
}

/// A closed bar of lengths `size` with its bottom in the plane z = 0, centered
/// about the z axis, of nx x ny x nz quads, each split in two. Corners and
/// edges are shared, so the surface is one closed component. The quads'
/// diagonals are parallel, or alternate like the fields of a chessboard: a bar
/// that does not prefer a sense of turning.
inline Shape Bar(
  int nx, int ny, int nz, const Eigen::Vector3d& size, bool alternatesDiagonals = false)
{
  const Eigen::Vector3i count(nx, ny, nz);
  std::vector<int> ids(static_cast<std::size_t>(nx + 1) * (ny + 1) * (nz + 1), -1);
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3i> faces;
  const auto id = [&](const Eigen::Vector3i& lattice)
  {
    int& known =
      ids[(static_cast<std::size_t>(lattice[2]) * (ny + 1) + lattice[1]) * (nx + 1) + lattice[0]];
    if (known < 0)
    {
      known = static_cast<int>(positions.size());
      positions.emplace_back(size[0] * (static_cast<double>(lattice[0]) / nx - 0.5),
        size[1] * (static_cast<double>(lattice[1]) / ny - 0.5),
        size[2] * lattice[2] / static_cast<double>(nz));
    }
    return known;
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const bool far : { false, true })
    {
      for (int j = 0; j < count[v]; ++j)
      {
        for (int i = 0; i < count[u]; ++i)
        {
          const auto corner = [&](int di, int dj)
          {
            Eigen::Vector3i lattice;
            lattice[axis] = far ? count[axis] : 0;
            lattice[u] = i + di;
            lattice[v] = j + dj;
            return id(lattice);
          };
          const int a = corner(0, 0);
          const int b = far ? corner(1, 0) : corner(0, 1);
          const int c = corner(1, 1);
          const int d = far ? corner(0, 1) : corner(1, 0);
          const bool isOther = alternatesDiagonals && (i + j) % 2 == 1;
          faces.emplace_back(a, b, isOther ? d : c);
          faces.emplace_back(isOther ? b : a, c, d);
        }
      }
    }
  }
  return { ToPoints(positions), ToTriangles(faces) };
}

/// Both shapes in one, as separate components; the second's ids follow the first's.
inline Shape Union(const Shape& first, const Shape& second)
{
  Shape both;
  both.Positions.resize(first.Positions.rows() + second.Positions.rows(), 3);
  both.Positions << first.Positions, second.Positions;
  both.Faces.resize(first.Faces.rows() + second.Faces.rows(), 3);
  both.Faces << first.Faces, second.Faces.array() + first.NumberOfVertices();
  return both;
}

/// The same surface with the inside out.
inline Shape Inverted(Shape shape)
{
  shape.Faces.col(1).swap(shape.Faces.col(2));
  return shape;
}

/// The area, and the volume that is enclosed if the triangles close.
inline double Area(const cartan::Points& points, const cartan::Triangles& faces)
{
  double area = 0.0;
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    const Eigen::Vector3d a = points.row(faces(t, 0));
    const Eigen::Vector3d b = points.row(faces(t, 1));
    const Eigen::Vector3d c = points.row(faces(t, 2));
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}
inline double Volume(const cartan::Points& points, const cartan::Triangles& faces)
{
  double volume = 0.0;
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    const Eigen::Vector3d a = points.row(faces(t, 0));
    const Eigen::Vector3d b = points.row(faces(t, 1));
    const Eigen::Vector3d c = points.row(faces(t, 2));
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

/// Moves every point by up to `amplitude` in every coordinate.
inline Shape Noisy(Shape shape, double amplitude, unsigned int seed = 1)
{
  Random random(seed);
  for (Eigen::Index i = 0; i < shape.Positions.size(); ++i)
  {
    shape.Positions.data()[i] += amplitude * random();
  }
  return shape;
}

/// x -> Rotation x + Translation.
struct RigidMotion
{
  Eigen::Matrix3d Rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d Translation = Eigen::Vector3d::Zero();

  cartan::Points operator()(const cartan::Points& points) const
  {
    return (points * this->Rotation.transpose()).rowwise() + this->Translation.transpose();
  }
  Shape operator()(Shape shape) const
  {
    shape.Positions = (*this)(shape.Positions);
    return shape;
  }
};

/// A rotation of any angle about any axis, and a translation of up to `distance`.
inline RigidMotion RandomRigidMotion(unsigned int seed, double distance = 1.0)
{
  Random random(seed);
  // Braces: their elements are evaluated in order, a call's arguments are not.
  Eigen::Quaterniond quaternion{ random(), random(), random(), random() };
  quaternion.normalize();
  RigidMotion motion;
  motion.Rotation = quaternion.toRotationMatrix();
  motion.Translation = distance * Eigen::Vector3d{ random(), random(), random() };
  return motion;
}
}
