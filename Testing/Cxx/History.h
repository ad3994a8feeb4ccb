// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "VtkTestHelpers.h"

#include "vtkSurfaceFilter.h"

#include "vtkInformation.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>

/// Everything about a filter that can change, for laws over its history.
namespace history
{
using Surfaces = std::vector<vtkSmartPointer<vtkPolyData>>;

/// One thing that can change: how many values it has, and how the filter gets one.
/// The inputs are there because some values are edits of them.
struct Choice
{
  int Count;
  std::function<void(vtkAlgorithm*, int, Surfaces&)> Apply;
};

struct Subject
{
  std::string Name;
  std::function<vtkSmartPointer<vtkAlgorithm>()> New;
  std::vector<Choice> Choices;
};

inline void PrintTo(const Subject& subject, std::ostream* stream)
{
  *stream << subject.Name;
}

/// A choice of the filter alone; `apply` is a setter or calls some.
template <typename Filter, typename Apply>
Choice Of(int count, const Apply& apply)
{
  return { count, [apply](vtkAlgorithm* filter, int value, Surfaces&) {
            apply(static_cast<Filter*>(filter), value);
          } };
}

template <typename Filter>
Choice Switch(void (Filter::*set)(bool))
{
  return Of<Filter>(2, [set](Filter* filter, int value) { (filter->*set)(value != 0); });
}

template <typename Filter>
Choice Enumeration(int count, void (Filter::*set)(int))
{
  return Of<Filter>(count, [set](Filter* filter, int value) { (filter->*set)(value); });
}

template <typename Filter>
Choice Number(void (Filter::*set)(double), const std::vector<double>& values)
{
  return Of<Filter>(static_cast<int>(values.size()),
    [set, values](Filter* filter, int value) { (filter->*set)(values[value]); });
}

template <typename Filter>
Choice Name(void (Filter::*set)(const std::string&), const std::vector<std::string>& names)
{
  return Of<Filter>(static_cast<int>(names.size()),
    [set, names](Filter* filter, int value) { (filter->*set)(names[value]); });
}

template <typename Filter>
Subject Make(const std::string& name, std::vector<Choice> choices)
{
  choices.push_back(Of<Filter>(3,
    [](Filter* filter, int value) { filter->SetKeptMemoryLimit(value == 1 ? 0 : 2000 >> value); }));
  choices.push_back(
    Of<Filter>(2, [](Filter* filter, int value) { filter->SetPrepareInput(value == 1); }));
  return { name, [] { return vtkSmartPointer<Filter>::New(); }, std::move(choices) };
}

/// Bends and shifts the points where they are, and tells of it by the data set's
/// time only, as a script does that writes into the array of a numpy view.
inline void EditInPlace(vtkPolyData* surface, int value)
{
  vtkDataArray* points = surface->GetPoints()->GetData();
  for (vtkIdType v = 0; v < points->GetNumberOfTuples(); ++v)
  {
    const double z = points->GetComponent(v, 2);
    points->SetComponent(v, 0, points->GetComponent(v, 0) + 0.01 * (value + 1) * z * z);
  }
  surface->Modified();
}

/// Moves the border of handle 2, in the array, and tells of it as above.
inline void EditHandles(vtkPolyData* surface, int value)
{
  auto* handles = vtkIntArray::SafeDownCast(surface->GetPointData()->GetArray("Handle"));
  for (vtkIdType v = 0; v < handles->GetNumberOfTuples(); ++v)
  {
    const double z = surface->GetPoint(v)[2];
    handles->SetValue(v, z < 0.6 ? 1 : z > 3.0 + 0.3 * value ? 2 : 0);
  }
  surface->Modified();
}

/// The same surface with each pair of triangles as one quad.
inline vtkSmartPointer<vtkPolyData> AsQuads(const shapes::Shape& shape)
{
  auto surface = vtktest::MakePolyData(shape);
  vtkNew<vtkCellArray> quads;
  for (Eigen::Index t = 0; t + 1 < shape.Faces.rows(); t += 2)
  {
    const Eigen::Vector3i other = shape.Faces.row(t + 1).transpose();
    const auto isShared = [&other](int v) { return (other.array() == v).any(); };
    Eigen::Vector3i corners = shape.Faces.row(t).transpose();
    while (isShared(corners[0])) // the corner across from the other triangle first
    {
      std::rotate(corners.data(), corners.data() + 1, corners.data() + 3);
    }
    const vtkIdType across = other.sum() - corners[1] - corners[2];
    quads->InsertNextCell({ corners[0], corners[1], across, corners[2] });
  }
  surface->SetPolys(quads);
  return surface;
}

/// The arrays that deformations and morphs can read.
inline void AddArrays(vtkPolyData* surface)
{
  vtktest::AddHandles(
    surface, [](const Eigen::Vector3d& p) { return p.z() < 0.6 ? 1
                                              : p.z() > 3.4    ? 2
                                                               : 0; });
  vtktest::AddArray(surface, "Other", 1,
    [surface](vtkIdType v, double* handle) {
      *handle = surface->GetPoint(v)[2] < 1.1 ? 2.0 : surface->GetPoint(v)[2] > 3.1 ? 1.0 : 0.0;
    });
  vtktest::AddArray(surface, "Target", 3,
    [surface](vtkIdType v, double* target)
    {
      surface->GetPoint(v, target);
      target[1] += target[2] > 3.0 ? 0.5 : 0.0;
    });
  vtktest::AddArray(surface, "Part", 1,
    [surface](vtkIdType v, double* part) { *part = 0.25 * surface->GetPoint(v)[2]; });
  vtktest::AddArray(surface, "Turn", 3,
    [surface](vtkIdType v, double* turn)
    {
      std::fill_n(turn, 3, 0.0);
      turn[0] = surface->GetPoint(v)[2] > 3.0 ? 0.7 : 0.0;
    });
  vtktest::AddArray(surface, "Transform", 9,
    [surface](vtkIdType v, double* transform)
    {
      std::fill_n(transform, 9, 0.0);
      transform[0] = transform[4] = 1.0;
      transform[8] = surface->GetPoint(v)[2] > 3.0 ? 1.2 : 1.0;
    });
  vtktest::AddArray(
    surface, "Weight", 1, [](vtkIdType v, double* weight) { *weight = 1.0 + v % 3; });
}

/// Bars: 0, 2 and 3 have the same connectivity, 3 in single precision, 4 is made
/// of quads.
inline Surfaces MakeSurfaces()
{
  const auto bar = [](int size) { return shapes::Bar(2, 2, size, { 1.0, 1.0, 4.0 }); };
  Surfaces surfaces = { vtktest::MakePolyData(bar(8)), vtktest::MakePolyData(bar(10)),
    vtktest::MakePolyData(bar(8)), vtktest::MakePolyData(bar(8), VTK_FLOAT), AsQuads(bar(8)) };
  for (std::size_t i = 0; i < surfaces.size(); ++i)
  {
    EditInPlace(surfaces[i], static_cast<int>(i));
    AddArrays(surfaces[i]);
  }
  return surfaces;
}
constexpr int NumberOfSurfaces = 5;

/// One of the surfaces at an input port.
inline Choice InputChoice(int port = 0)
{
  return { NumberOfSurfaces, [port](vtkAlgorithm* filter, int value, Surfaces& surfaces) {
            filter->SetInputDataObject(port, surfaces[value]);
          } };
}

/// The surfaces as time steps of one source.
class TimeSteps : public vtkPolyDataAlgorithm
{
public:
  static TimeSteps* New() { VTK_STANDARD_NEW_BODY(TimeSteps); }
  vtkTypeMacro(TimeSteps, vtkPolyDataAlgorithm);

  Surfaces Steps;

  vtkMTimeType GetMTime() override
  {
    vtkMTimeType time = this->Superclass::GetMTime();
    for (const auto& step : this->Steps)
    {
      time = std::max(time, step->GetMTime());
    }
    return time;
  }

protected:
  using Pipeline = vtkStreamingDemandDrivenPipeline;

  TimeSteps() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    std::vector<double> times(this->Steps.size());
    for (std::size_t i = 0; i < times.size(); ++i)
    {
      times[i] = 10.0 + static_cast<double>(i);
    }
    const double range[2] = { times.front(), times.back() };
    vtkInformation* info = outputs->GetInformationObject(0);
    info->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
    info->Set(Pipeline::TIME_RANGE(), range, 2);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkInformation* info = outputs->GetInformationObject(0);
    const double time =
      info->Has(Pipeline::UPDATE_TIME_STEP()) ? info->Get(Pipeline::UPDATE_TIME_STEP()) : 10.0;
    const auto step =
      std::clamp(static_cast<int>(time - 9.5), 0, static_cast<int>(this->Steps.size()) - 1);
    auto* output = vtkPolyData::GetData(outputs);
    output->DeepCopy(this->Steps[step]);
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), 10.0 + step);
    return 1;
  }
};
}
