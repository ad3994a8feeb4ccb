// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "AdviceWords.h"
#include "TestShapes.h"
#include "VtkTestHelpers.h"

#include "vtkHandleMotion.h"
#include "vtkMatrix4x4.h"
#include "vtkPrepareSurface.h"

#include <cstdlib>

/// What the tests of advice share. Each makes the smallest input that gives a
/// message, does literally what it says, and finds the filter quiet and its result
/// right.
namespace vtktest
{
using shapes::Advice;

/// The number after `words` in a message, such as a tolerance that it proposes.
inline double NumberAfter(const std::string& message, const std::string& words)
{
  const std::size_t place = message.find(words);
  EXPECT_NE(place, std::string::npos) << "expected: " << words << "\nfound: " << message;
  return place == std::string::npos ? 0.0
                                    : std::strtod(message.c_str() + place + words.size(), nullptr);
}

/// The first few ids that a message names, as in "2 points (ids 7, 9)".
inline std::vector<vtkIdType> IdsAfter(const std::string& message, const std::string& words)
{
  std::vector<vtkIdType> ids;
  const std::size_t place = message.find(words);
  EXPECT_NE(place, std::string::npos) << "expected: " << words << "\nfound: " << message;
  std::size_t at = message.find_first_of("0123456789", place + words.size());
  while (place != std::string::npos && at < message.find(')', place))
  {
    std::size_t length = 0;
    ids.push_back(std::stoll(message.substr(at), &length));
    at = message.find_first_of("0123456789", at + length);
  }
  return ids;
}

/// A filter and what it says at each update.
template <typename Filter>
class Advised
{
public:
  Advised()
    : Log(Observe(this->Object))
  {
  }
  Filter* operator->() const { return this->Object; }
  Filter* Get() const { return this->Object; }

  /// Gives one error of these parts and nothing else. Returns it.
  std::string Refuses(const std::vector<std::string>& parts)
  {
    this->Update();
    ExpectMessage(this->Log->Errors, parts);
    EXPECT_EQ(this->Object->GetOutput()->GetNumberOfPoints(), 0);
    return this->Log->Errors.empty() ? "" : this->Log->Errors[0];
  }

  /// Gives a result, and one warning of these parts. Returns it.
  std::string Warns(const std::vector<std::string>& parts)
  {
    this->Update();
    EXPECT_TRUE(this->Log->Errors.empty()) << this->Log->Errors[0];
    ExpectMessage(this->Log->Warnings, parts);
    EXPECT_GT(this->Object->GetOutput()->GetNumberOfPoints(), 0);
    return this->Log->Warnings.empty() ? "" : this->Log->Warnings[0];
  }

  /// Gives a result without a word. Returns a copy of it.
  vtkSmartPointer<vtkPolyData> Works()
  {
    this->Update();
    ExpectQuiet(*this->Log);
    EXPECT_GT(this->Object->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(PointsOf(this->Object->GetOutput()).allFinite());
    return CopyOf(this->Object->GetOutput());
  }

private:
  void Update()
  {
    this->Log->Clear();
    this->Object->Modified();
    this->Object->Update();
  }

  vtkNew<Filter> Object;
  vtkSmartPointer<vtktest::Log> Log;
};

/// What vtkPrepareSurface makes of a surface with these settings.
inline vtkSmartPointer<vtkPolyData> Prepared(
  vtkPolyData* surface, const std::function<void(vtkPrepareSurface*)>& set = {})
{
  Advised<vtkPrepareSurface> prepare;
  prepare->SetInputData(surface);
  if (set)
  {
    set(prepare.Get());
  }
  return prepare.Works();
}

/// The volume that the polygons enclose if they close.
inline double SignedVolume(vtkPolyData* surface)
{
  double volume = 0.0;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    surface->GetCellPoints(cell, ids);
    const auto x = [&](vtkIdType i) { return Eigen::Vector3d(surface->GetPoint(ids->GetId(i))); };
    for (vtkIdType i = 2; i < ids->GetNumberOfIds(); ++i)
    {
      volume += x(0).dot(x(i - 1).cross(x(i))) / 6.0;
    }
  }
  return volume;
}

/// The handle 1 at the lower, and 2 at the upper end of a bar along z.
inline void MarkEnds(vtkPolyData* surface, double below, double above)
{
  AddHandles(
    surface, [=](const Eigen::Vector3d& x) { return x.z() < below ? 1
                                               : x.z() > above    ? 2
                                                                  : 0; });
}

/// A closed bar of length 4 along z with its ends as handles.
inline vtkSmartPointer<vtkPolyData> MarkedBar()
{
  auto bar = MakePolyData(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  MarkEnds(bar, 0.6, 3.4);
  return bar;
}

/// A turn about the x axis through the middle of that bar, or another axis.
inline vtkSmartPointer<vtkHandleMotion> Turn(
  double degrees, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitX())
{
  auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  motion->SetAxis(axis.x(), axis.y(), axis.z());
  motion->SetCenter(0.0, 0.0, 2.0);
  motion->SetAngle(degrees);
  return motion;
}

/// Where a motion puts a point.
inline Eigen::Vector3d MovedBy(vtkHandleMotion* motion, const double point[3])
{
  vtkNew<vtkMatrix4x4> matrix;
  motion->GetTransform(matrix);
  const double from[4] = { point[0], point[1], point[2], 1.0 };
  double to[4];
  matrix->MultiplyPoint(from, to);
  return { to[0], to[1], to[2] };
}

/// The points of handle `id` are where its motion puts them, or, without one, where
/// they were.
inline void ExpectHandle(vtkPolyData* result, vtkPolyData* rest, int id,
  vtkHandleMotion* motion = nullptr, double tolerance = 1e-9)
{
  vtkDataArray* handles = rest->GetPointData()->GetArray("Handle");
  for (vtkIdType v = 0; v < rest->GetNumberOfPoints(); ++v)
  {
    if (handles->GetTuple1(v) == id)
    {
      const Eigen::Vector3d expected =
        motion ? MovedBy(motion, rest->GetPoint(v)) : Eigen::Vector3d(rest->GetPoint(v));
      EXPECT_LT((Eigen::Vector3d(result->GetPoint(v)) - expected).norm(), tolerance) << v;
    }
  }
}

/// Handle 2 is where its motion puts it, handle 1 where it was.
inline void ExpectEnds(
  vtkPolyData* result, vtkPolyData* rest, vtkHandleMotion* motion, double tolerance = 1e-9)
{
  ExpectHandle(result, rest, 1, nullptr, tolerance);
  ExpectHandle(result, rest, 2, motion, tolerance);
}
}
