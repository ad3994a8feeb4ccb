// SPDX-License-Identifier: BSD-3-Clause
#include "Shapes.h"

#include "TestShapes.h"

#include "vtkCellArray.h"
#include "vtkContourFilter.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <cmath>
#include <functional>

namespace fuzz
{
namespace
{
Mesh FromShape(const shapes::Shape& shape)
{
  Mesh mesh;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    mesh.AddPoint(shape.Positions.row(v).transpose());
  }
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    mesh.Polys.push_back({ shape.Faces(t, 0), shape.Faces(t, 1), shape.Faces(t, 2) });
  }
  return mesh;
}

/// sum of waves of random direction, length and phase.
std::function<double(const Eigen::Vector3d&)> RandomField(Random& random)
{
  std::vector<Eigen::Vector4d> waves;
  const int count = random.Integer(2, 5);
  for (int i = 0; i < count; ++i)
  {
    const Eigen::Vector3d direction = random.Real(1.0, 5.0) * random.Direction();
    waves.emplace_back(direction.x(), direction.y(), direction.z(), random.Real(0.0, 6.3));
  }
  return [waves](const Eigen::Vector3d& x)
  {
    double sum = 0.0;
    for (const Eigen::Vector4d& wave : waves)
    {
      sum += std::sin(wave.head<3>().dot(x) + wave[3]);
    }
    return sum;
  };
}

/// The zero set of a random field: open where it leaves the box, closed with
/// `isClosed`, which lets the field fall off towards the box.
Mesh Isosurface(Random& random, bool isClosed)
{
  const int count = random.Integer(6, 14);
  const auto field = RandomField(random);
  vtkNew<vtkImageData> image;
  image->SetDimensions(count, count, count);
  image->SetOrigin(-1.0, -1.0, -1.0);
  const double step = 2.0 / (count - 1);
  image->SetSpacing(step, step, step);
  vtkNew<vtkDoubleArray> values;
  values->SetName("Field");
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    const Eigen::Vector3d x(image->GetPoint(i));
    values->InsertNextValue(isClosed ? 1.2 - 2.0 * x.squaredNorm() + 0.4 * field(x) : field(x));
  }
  image->GetPointData()->SetScalars(values);
  vtkNew<vtkContourFilter> contour;
  contour->SetInputData(image);
  contour->SetValue(0, random.Real(-0.2, 0.2));
  contour->Update();
  Mesh mesh;
  vtkPolyData* output = contour->GetOutput();
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    mesh.AddPoint(Eigen::Vector3d(output->GetPoint(i)));
  }
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < output->GetNumberOfPolys(); ++cell)
  {
    output->GetPolys()->GetCellAtId(cell, ids);
    mesh.Polys.emplace_back(ids->begin(), ids->end());
  }
  return mesh;
}

/// Triangles between random points: nothing that a filter would accept, mostly.
Mesh RandomSoup(Random& random)
{
  Mesh mesh;
  const int points = random.Integer(3, 60);
  for (int i = 0; i < points; ++i)
  {
    mesh.AddPoint(random.Vector());
  }
  const int cells = random.Integer(1, 80);
  for (int i = 0; i < cells; ++i)
  {
    Ids ids;
    const int corners = random.Chance(0.9) ? 3 : random.Integer(1, 6);
    for (int c = 0; c < corners; ++c)
    {
      ids.push_back(random.Integer(0, points - 1));
    }
    mesh.Polys.push_back(std::move(ids));
  }
  return mesh;
}

/// A closed surface inside another one, as a body of its own or as a cavity.
Mesh NestedShells(Random& random)
{
  shapes::Shape inner = shapes::Icosphere(random.Integer(1, 2), random.Real(0.2, 0.7));
  if (random.Chance(0.6))
  {
    inner = shapes::Inverted(inner);
  }
  return FromShape(shapes::Union(shapes::Icosphere(2), inner));
}

/// Two to a dozen triangles around a point, or a tetrahedron.
Mesh Small(Random& random)
{
  Mesh mesh;
  const int count = random.Integer(1, 12);
  const bool isClosed = count > 2 && random.Chance(0.6);
  mesh.AddPoint({ 0, 0, random.Real(0.0, 0.5) });
  for (int i = 0; i <= count; ++i)
  {
    const double angle = 2.0 * shapes::Pi * i / (count + 1);
    mesh.AddPoint({ std::cos(angle), std::sin(angle), random.Real(0.0, 0.2) });
  }
  for (int i = 0; i < count + (isClosed ? 1 : 0); ++i)
  {
    mesh.Polys.push_back({ 0, 1 + i, 1 + (i + 1) % (count + 1) });
  }
  if (isClosed && count == 2)
  {
    mesh.Polys.push_back({ 3, 2, 1 });
  }
  return mesh;
}

shapes::Shape OneFormula(Random& random)
{
  const double jitter = random.Chance(0.6) ? random.Real(0.05, 0.3) : 0.0;
  const auto seed = static_cast<unsigned int>(random.Bits());
  const int n = random.Chance(0.9) ? random.Integer(3, 16) : random.Integer(16, 34);
  switch (random.Integer(0, 8))
  {
    case 0:
      return shapes::UvSphere(n + 2, n);
    case 1:
      return shapes::Icosphere(random.Integer(0, 3));
    case 2:
      return shapes::OpenCylinder(n + 2, random.Integer(2, 20), random.Real(0.2, 0.6), 2.0, jitter);
    case 3:
      return shapes::Torus(n + 3, random.Integer(4, 14), 1.0, random.Real(0.2, 0.6), jitter, seed);
    case 4:
      return shapes::Plane(n, 2.0, jitter, seed);
    case 5:
      return shapes::Saddle(n, 2.0, jitter, seed);
    case 6:
      return shapes::Bar(random.Integer(1, 12), random.Integer(1, 4), random.Integer(1, 4),
        { random.Real(0.8, 3.0), random.Real(0.2, 1.0), random.Real(0.1, 1.0) },
        random.Chance(0.5));
    case 7:
      return shapes::Ellipsoid(
        random.Integer(1, 3), { random.Real(0.3, 2.0), random.Real(0.3, 1.0), 1.0 });
    default:
    {
      const auto height = RandomField(random);
      return shapes::Graph(
        n, 2.0,
        [&](double x, double y) {
          return 0.2 * height({ x, y, 0.0 });
        },
        jitter, seed);
    }
  }
}

/// A third of all surfaces is bumpy: no normal is like its neighbor's.
Mesh Formula(Random& random)
{
  shapes::Shape shape = OneFormula(random);
  if (random.Chance(0.3))
  {
    const auto seed = static_cast<unsigned int>(random.Bits());
    shape = shapes::Noisy(shape, random.Log(1e-3, 0.05), seed);
  }
  return FromShape(shape);
}
}

Mesh MakeShape(Random& random)
{
  const double kind = random.Unit();
  if (kind < 0.03)
  {
    return RandomSoup(random);
  }
  if (kind < 0.08)
  {
    return Small(random);
  }
  if (kind < 0.14)
  {
    return NestedShells(random);
  }
  if (kind < 0.26)
  {
    Mesh mesh = Isosurface(random, random.Chance(0.7));
    return mesh.Polys.empty() ? Formula(random) : mesh;
  }
  Mesh mesh = Formula(random);
  if (kind > 0.88)
  {
    const int others = random.Integer(1, 3);
    for (int i = 0; i < others; ++i)
    {
      Mesh other = Formula(random);
      Motion away{ random.Real(0.2, 1.0), random.Rotation(), 2.5 * random.Direction() * (i + 1) };
      Move(other, away);
      Append(mesh, other);
    }
  }
  return mesh;
}

void MixCells(Mesh& mesh, Random& random)
{
  const double quads = random.Unit();
  const double strips = random.Chance(0.5) ? random.Unit() : 0.0;
  std::vector<Ids> polys;
  for (std::size_t t = 0; t < mesh.Polys.size(); ++t)
  {
    const Ids& a = mesh.Polys[t];
    const bool isPair = t + 1 < mesh.Polys.size() && a.size() == 3 &&
      mesh.Polys[t + 1].size() == 3 && mesh.Polys[t + 1][0] == a[0] && mesh.Polys[t + 1][1] == a[2];
    if (!isPair || !random.Chance(quads))
    {
      polys.push_back(a);
      continue;
    }
    const vtkIdType last = mesh.Polys[++t][2];
    if (random.Chance(strips))
    {
      mesh.Strips.push_back({ a[0], a[1], last, a[2] });
    }
    else
    {
      polys.push_back({ a[0], a[1], a[2], last });
    }
  }
  mesh.Polys = std::move(polys);
  const int extra = random.Integer(0, 3);
  for (int i = 0; i < extra; ++i)
  {
    const int last = static_cast<int>(mesh.NumberOfPoints()) - 1;
    mesh.Verts.push_back({ random.Integer(0, last) });
    mesh.Lines.push_back({ random.Integer(0, last), random.Integer(0, last) });
  }
}
}
