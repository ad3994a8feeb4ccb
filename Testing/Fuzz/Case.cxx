// SPDX-License-Identifier: BSD-3-Clause
#include "Case.h"

#include "Copies.h"
#include "Defects.h"
#include "Deformed.h"
#include "MoreCases.h"
#include "Settings.h"
#include "Shapes.h"
#include "SteeringCases.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace fuzz
{
namespace
{
Array IdArray(const Mesh& mesh)
{
  Array ids;
  ids.Name = "PointId";
  ids.IsInteger = true;
  ids.Values = Eigen::VectorXd::LinSpaced(mesh.NumberOfPoints(), 0.0,
    static_cast<double>(std::max<vtkIdType>(0, mesh.NumberOfPoints() - 1)));
  return ids;
}

/// One to three balls of points in every component. A few cases have a component
/// without one.
Array RandomHandles(const Mesh& mesh, Random& random)
{
  Array handles;
  handles.Name = "Handle";
  handles.IsInteger = true;
  handles.Values = Eigen::VectorXd::Zero(mesh.NumberOfPoints());
  std::map<vtkIdType, std::vector<vtkIdType>> members;
  const std::vector<vtkIdType> components = Components(mesh);
  for (std::size_t i = 0; i < components.size(); ++i)
  {
    members[components[i]].push_back(static_cast<vtkIdType>(i));
  }
  const bool mayLeaveOut = random.Chance(0.1);
  for (const auto& component : members)
  {
    const std::vector<vtkIdType>& ids = component.second;
    if (ids.size() < 3 || (mayLeaveOut && random.Chance(0.3)))
    {
      continue;
    }
    std::vector<Eigen::Vector3d> points;
    for (const vtkIdType id : ids)
    {
      points.push_back(mesh.Points[static_cast<std::size_t>(id)]);
    }
    const int count = random.Chance(0.1) ? 1 : random.Integer(2, 4);
    for (int i = 0; i < count; ++i)
    {
      const double radius = random.Chance(0.1) ? 0.0 : Size(points) * random.Real(0.05, 0.3);
      const Eigen::Vector3d center = random.Pick(points);
      const int id = random.Integer(1, 4);
      for (std::size_t k = 0; k < ids.size(); ++k)
      {
        if ((points[k] - center).norm() <= radius)
        {
          handles.Values(ids[k], 0) = id;
        }
      }
    }
  }
  return handles;
}

/// One per point of each handle without a motion, or of any.
void AddConstraintArrays(Mesh& mesh, Random& random)
{
  const double size = Size(mesh.Points);
  const auto add = [&](const char* name, int columns, Kind type, double power, const auto& value)
  {
    Array array;
    array.Name = name;
    array.Type = type;
    array.Power = power;
    array.Values.resize(mesh.NumberOfPoints(), columns);
    for (Eigen::Index i = 0; i < array.Values.rows(); ++i)
    {
      array.Values.row(i) = value(i);
    }
    mesh.Arrays.push_back(array);
  };
  const Eigen::Vector3d shift = 0.2 * size * random.Vector();
  const Eigen::Vector3d turn = 2.0 * random.Vector();
  if (random.Chance(0.15))
  {
    add("TargetPosition", 3, Kind::Point, 1.0,
      [&](Eigen::Index i) -> Eigen::RowVectorXd
      { return (mesh.Points[static_cast<std::size_t>(i)] + shift).transpose(); });
  }
  if (random.Chance(0.1))
  {
    add("RotationVector", 3, Kind::Vector, 0.0,
      [&](Eigen::Index) -> Eigen::RowVectorXd { return turn.transpose(); });
  }
  else if (random.Chance(0.1))
  {
    const Eigen::Matrix3d transform =
      Eigen::Matrix3d::Identity() + 0.3 * Eigen::Matrix3d(turn * random.Vector().transpose());
    add("Transform", 9, Kind::Transform, 0.0,
      [&](Eigen::Index) -> Eigen::RowVectorXd
      {
        const Eigen::Matrix3d rows = transform.transpose();
        return Eigen::Map<const Eigen::RowVectorXd>(rows.data(), 9);
      });
  }
  if (random.Chance(0.15))
  {
    const double weight = random.Log(1e-2, 1e3);
    add("ConstraintWeight", 1, Kind::Scalar, 0.0,
      [&](Eigen::Index) -> Eigen::RowVectorXd
      {
        const double w = random.Chance(0.2) ? std::numeric_limits<double>::infinity() : weight;
        return Eigen::RowVectorXd::Constant(1, w);
      });
  }
}

/// Normals of length one, which need not fit.
void AddNormals(Mesh& mesh, Random& random)
{
  Array normals;
  normals.Name = "Normals";
  normals.Type = Kind::Vector;
  normals.Values.resize(mesh.NumberOfPoints(), 3);
  for (Eigen::Index i = 0; i < normals.Values.rows(); ++i)
  {
    normals.Values.row(i) = random.Direction().transpose();
  }
  mesh.Arrays.push_back(normals);
}

HandleMotion RandomMotion(int id, const Mesh& mesh, Random& random)
{
  const double size = Size(mesh.Points);
  HandleMotion motion;
  motion.Id = id;
  motion.Axis = random.Log(1e-3, 1e3) * random.Direction();
  motion.Angle = random.Chance(0.8) ? random.Real(-120.0, 120.0) : random.Real(-800.0, 800.0);
  if (random.Chance(0.2))
  {
    motion.Angle = random.Pick<double>({ 0.0, 90.0, 180.0, 360.0 });
  }
  motion.Center = random.Pick(mesh.Points);
  if (!motion.Center.allFinite())
  {
    motion.Center.setZero();
  }
  motion.Translation = (random.Chance(0.3) ? 0.0 : 0.3) * size * random.Vector();
  const double kind = random.Unit();
  if (kind < 0.15)
  {
    motion.Scale = random.Log(0.3, 3.0);
  }
  else if (kind < 0.25)
  {
    motion.IsMatrix = true;
    const Eigen::Matrix3d shear = 0.5 * random.Vector() * random.Vector().transpose();
    motion.Matrix.topLeftCorner<3, 3>() = random.Rotation() * (Eigen::Matrix3d::Identity() + shear);
    // The center stays, but for the translation.
    motion.Matrix.topRightCorner<3, 1>() =
      motion.Center - motion.Matrix.topLeftCorner<3, 3>() * motion.Center + motion.Translation;
  }
  else if (kind < 0.29)
  {
    motion.Scale = random.Pick<double>({ 0.0, -1.0, 1e6, 1e-6 });
  }
  else if (kind < 0.31)
  {
    motion.Translation *= random.Pick<double>({ 1e9, 1e30, 1e200, std::nan("") });
  }
  return motion;
}

std::vector<HandleMotion> RandomMotions(const Mesh& mesh, Random& random)
{
  const Array* handles = mesh.Find("Handle");
  std::set<int> ids;
  for (Eigen::Index i = 0; i < handles->Values.rows(); ++i)
  {
    ids.insert(static_cast<int>(handles->Values(i, 0)));
  }
  ids.erase(0);
  std::vector<HandleMotion> motions;
  for (const int id : ids)
  {
    if (random.Chance(0.65) || (motions.empty() && id == *ids.rbegin()))
    {
      motions.push_back(RandomMotion(id, mesh, random));
    }
  }
  if (random.Chance(0.02))
  {
    motions.push_back(RandomMotion(9, mesh, random)); // of no point
  }
  return motions;
}

/// Most surfaces have a size near 1 and are near to the origin.
void Place(Mesh& mesh, Random& random)
{
  if (random.Chance(0.8))
  {
    Move(mesh, { 1.0, random.Rotation(), random.Vector() });
  }
  if (random.Chance(0.25))
  {
    Move(mesh, { random.Log(1e-9, 1e9), Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero() });
  }
  if (random.Chance(0.2))
  {
    const double distance = Size(mesh.Points) * random.Log(1.0, 1e3);
    Move(mesh, { 1.0, Eigen::Matrix3d::Identity(), distance * random.Direction() });
  }
}

/// The most points of the surfaces of filters that iterate or fill the inside; others take
/// what comes.
std::size_t MostPoints(const std::string& filter)
{
  static const std::map<std::string, std::size_t> most = { { "CoatingTransfer", 100 },
    { "ExampleBasedDeformation", 200 }, { "VolumetricDeformation", 200 } };
  const auto found = most.find(filter);
  return found == most.end() ? 1000000 : found->second;
}

/// With `ofJoint` something hangs on a point of it.
Mesh RandomMesh(Random& random, std::size_t mostPoints, Random* ofJoint)
{
  Mesh mesh = MakeShape(random);
  for (int i = 0; i < 10 && mesh.Points.size() > mostPoints; ++i)
  {
    mesh = MakeShape(random);
  }
  if (random.Chance(0.5))
  {
    AddDefects(mesh, random);
  }
  const Ids copies = ofJoint ? HangOnPoint(mesh, *ofJoint) : Ids();
  if (random.Chance(0.25))
  {
    MixCells(mesh, random);
  }
  Place(mesh, random);
  mesh.IsFloat = random.Chance(0.4);
  if (mesh.IsFloat)
  {
    RoundToFloat(mesh.Points);
  }
  mesh.Arrays.push_back(IdArray(mesh));
  if (!copies.empty())
  {
    mesh.Arrays.push_back(JoinedPoints(mesh, copies));
  }
  mesh.Arrays.push_back(RandomHandles(mesh, random));
  for (const vtkIdType copy : copies)
  {
    mesh.Arrays.back().Values.row(copy) = mesh.Arrays.back().Values.row(copies[0]).eval();
  }
  if (random.Chance(0.15))
  {
    AddNormals(mesh, random);
  }
  return mesh;
}

int NumberOfOthers(const std::string& filter, Random& random)
{
  if (filter == "SurfaceMorph")
  {
    return random.Chance(0.8) ? 1 : random.Integer(2, 4);
  }
  if (filter == "CoatingTransfer" || filter == "ExampleBasedDeformation")
  {
    return random.Integer(1, 2);
  }
  if (filter == "CurvatureError" || filter == "DifferentialReconstruction")
  {
    return random.Integer(0, 1);
  }
  return filter == "VolumeChange" || filter == "RestoreSurface" || filter == "MeshMerge" ? 1 : 0;
}

/// Whole numbers of points, 0 but for some.
Array Numbers(const Mesh& mesh, const std::string& name, const Ids& ids)
{
  Array numbers;
  numbers.Name = name;
  numbers.IsInteger = true;
  numbers.Values = Eigen::VectorXd::Zero(mesh.NumberOfPoints());
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    numbers.Values(ids[i], 0) = static_cast<double>(i + 1);
  }
  return numbers;
}

/// Which points of two surfaces belong together, and where a coating goes.
void AddCorrespondences(Case& made, Random& random)
{
  Mesh& mesh = made.Surface;
  Ids ids;
  if (made.Filter == "MeshMerge" && random.Chance(0.5))
  {
    const Ids border = BorderPoints(mesh);
    // The loops run in opposite directions: a third one could cross.
    for (int i = 0; i < 2 && !border.empty(); ++i)
    {
      ids.push_back(random.Pick(border));
    }
    mesh.Arrays.push_back(Numbers(mesh, "BoundaryKey", ids));
  }
  if (made.Filter == "CoatingTransfer")
  {
    for (int i = 0; i < 5; ++i)
    {
      ids.push_back(random.Integer(0, static_cast<int>(mesh.NumberOfPoints()) - 1));
    }
    mesh.Arrays.push_back(Numbers(mesh, "CorrespondenceKey", ids));
    if (random.Chance(0.3))
    {
      Array region = *mesh.Find("Handle");
      region.Name = "Region";
      mesh.Arrays.push_back(region);
    }
  }
}
}

bool Case::NumbersAnew() const
{
  return this->Filter == "PrepareSurface" || this->Filter == "BoundaryLoops" ||
    this->Filter == "MeshMerge";
}

bool Case::IsDeformation() const
{
  if (this->Filter == "CurveDeformation")
  {
    return false; // it has no motions
  }
  const std::string end = "Deformation";
  return this->Filter.size() > end.size() &&
    this->Filter.compare(this->Filter.size() - end.size(), end.size(), end) == 0;
}

double Case::Get(const std::string& setting, double otherwise) const
{
  for (const Setting& one : this->Settings)
  {
    if (one.Name == setting)
    {
      return one.Values[0];
    }
  }
  return otherwise;
}

void Move(Case& changed, const Motion& motion)
{
  Move(changed.Surface, motion);
  for (std::vector<Eigen::Vector3d>& points : changed.Others)
  {
    std::transform(points.begin(), points.end(), points.begin(), motion);
  }
  for (std::vector<Eigen::Vector3d>& points : changed.Clouds)
  {
    std::transform(points.begin(), points.end(), points.begin(), motion);
  }
  for (Setting& setting : changed.Settings)
  {
    const Eigen::RowVectorXd values = Eigen::Map<const Eigen::RowVectorXd>(
      setting.Values.data(), static_cast<Eigen::Index>(setting.Values.size()));
    const Eigen::RowVectorXd moved = Moved(values, setting.Type, setting.Power, motion);
    setting.Values.assign(moved.data(), moved.data() + moved.size());
  }
  Eigen::Matrix4d map = Eigen::Matrix4d::Identity();
  map.topLeftCorner<3, 3>() = motion.Scale * motion.Rotation;
  map.topRightCorner<3, 1>() = motion.Translation;
  for (HandleMotion& handle : changed.Motions)
  {
    handle.Axis = motion.Rotation * handle.Axis;
    handle.Center = motion(handle.Center);
    handle.Translation = motion.Scale * (motion.Rotation * handle.Translation);
    handle.Matrix = map * handle.Matrix * map.inverse();
    handle.Matrix.row(3) << 0.0, 0.0, 0.0, 1.0;
  }
}

Case MakeCase(std::uint64_t seed, const std::string& filter)
{
  Random random(seed * 0x632be59bd9b4e019u + 1);
  Case made;
  made.Seed = seed;
  made.Filter = random.Pick(Filters());
  if (!filter.empty())
  {
    made.Filter = filter;
  }
  Random ofJoint(seed * 0x9fb21c651e98df25u + 7);
  const bool hasJoint = made.IsDeformation() && ofJoint.Chance(0.15);
  made.Surface = RandomMesh(random, MostPoints(made.Filter), hasJoint ? &ofJoint : nullptr);
  if (made.IsDeformation())
  {
    made.Motions = RandomMotions(made.Surface, random);
    if (made.Filter != "VolumetricDeformation")
    {
      AddConstraintArrays(made.Surface, random);
    }
  }
  AddCorrespondences(made, random);
  const int others = NumberOfOthers(made.Filter, random);
  for (int i = 0; i < others; ++i)
  {
    made.Others.push_back(Deformed(made.Surface.Points, random));
    if (made.Surface.IsFloat)
    {
      RoundToFloat(made.Others.back());
    }
  }
  made.Settings = RandomSettings(made.Filter, made.Surface, random);
  AddSteering(made, random);
  Random ofChoices(seed * 0xd1b54a32d192ed03u + 11);
  AddChoices(made, ofChoices);
  return made;
}
}
