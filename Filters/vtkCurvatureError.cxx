// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCurvatureError.h"

#include "Kernel/Differential/Curvature.h"
#include "Kernel/Mesh/Geometry.h"
#include "KernelBridge.h"
#include "SurfacePair.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

vtkStandardNewMacro(vtkCurvatureError);

namespace
{
void AddScalars(vtkPolyData* output, const std::string& name, const Eigen::VectorXd& values)
{
  cartan::AddPointArray(output, name, values.data(), values.size(), 1);
}

void AddCurvatures(vtkPolyData* output, const cartan::Curvatures& curvatures, bool withDirections)
{
  AddScalars(output, "MeanCurvature", curvatures.Mean);
  AddScalars(output, "GaussianCurvature", curvatures.Gaussian);
  AddScalars(output, "MaximumCurvature", curvatures.Maximum);
  AddScalars(output, "MinimumCurvature", curvatures.Minimum);
  if (withDirections)
  {
    cartan::AddPointArray(output, "MaximumCurvatureDirection", curvatures.MaximumDirections.data(),
      curvatures.MaximumDirections.rows(), 3);
    cartan::AddPointArray(output, "MinimumCurvatureDirection", curvatures.MinimumDirections.data(),
      curvatures.MinimumDirections.rows(), 3);
  }
  vtkNew<vtkUnsignedCharArray> isDetermined;
  isDetermined->SetName("CurvatureIsDetermined");
  isDetermined->SetNumberOfValues(static_cast<vtkIdType>(curvatures.IsDetermined.size()));
  std::copy(
    curvatures.IsDetermined.begin(), curvatures.IsDetermined.end(), isDetermined->GetPointer(0));
  output->GetPointData()->AddArray(isDetermined);
}

/// Empty where every point's curvature is determined. `which` is the input or
/// the reference.
std::string DescribeUndetermined(const cartan::Curvatures& curvatures, const std::string& which)
{
  cartan::IdSample undetermined;
  for (std::size_t v = 0; v < curvatures.IsDetermined.size(); ++v)
  {
    if (!curvatures.IsDetermined[v])
    {
      undetermined.Add(static_cast<long long>(v));
    }
  }
  return undetermined.IsEmpty() ? std::string()
                                : "The curvature of the " + which + " is not determined at " +
      undetermined.Describe("point", "points") +
      ": the points around lie in fewer than three rows in some direction. There it is "
      "estimated from the normals of the triangles, with edges that join two rows taken as "
      "straight. For reliable values use at least three evenly spaced rows of points in every "
      "direction.";
}

double AddFieldValue(vtkPolyData* output, const std::string& name, double value)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  array->InsertNextValue(value);
  output->GetFieldData()->AddArray(array);
  return value;
}

/// Adds the array `name`Error with its summary as field data, and returns the
/// root mean square and the maximum.
std::pair<double, double> AddError(vtkPolyData* output, const std::string& name,
  const Eigen::VectorXd& error, const Eigen::VectorXd& areas)
{
  AddScalars(output, name + "Error", error);
  const double area = areas.sum();
  const double meanSquare = area > 0.0 ? areas.dot(error.cwiseAbs2()) / area : 0.0;
  return { AddFieldValue(output, name + "ErrorRMS", std::sqrt(meanSquare)),
    AddFieldValue(output, name + "ErrorMax", error.cwiseAbs().maxCoeff()) };
}
}

vtkCurvatureError::vtkCurvatureError()
{
  this->SetNumberOfInputPorts(2);
}

void vtkCurvatureError::SetReferenceConnection(vtkAlgorithmOutput* reference)
{
  this->SetInputConnection(1, reference);
}

void vtkCurvatureError::SetReferenceData(vtkPolyData* reference)
{
  this->SetInputData(1, reference);
}

int vtkCurvatureError::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
    return 1;
  }
  return this->Superclass::FillInputPortInformation(port, info);
}

void vtkCurvatureError::ForgetResults()
{
  this->MeanCurvatureErrorRMS = std::numeric_limits<double>::quiet_NaN();
  this->MeanCurvatureErrorMax = std::numeric_limits<double>::quiet_NaN();
  this->GaussianCurvatureErrorRMS = std::numeric_limits<double>::quiet_NaN();
  this->GaussianCurvatureErrorMax = std::numeric_limits<double>::quiet_NaN();
}

int vtkCurvatureError::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* reference = vtkPolyData::GetData(inputVector[1]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  this->ForgetResults();

  return cartan::RunGuarded(this,
    [&]
    {
      const cartan::ExecutionContext context = cartan::MakeContext(this);
      if (!reference)
      {
        const cartan::Surface surface = cartan::ReadSurface(input);
        cartan::Warn(this, surface.Warning);
        const cartan::Curvatures curvatures =
          cartan::FitCurvatures(surface.Mesh, surface.Positions, context);
        cartan::Warn(this, DescribeUndetermined(curvatures, "input"));
        output->ShallowCopy(input);
        AddCurvatures(output, curvatures, this->ComputeDirections);
        output->GetPointData()->SetActiveScalars("MeanCurvature");
        return;
      }

      const cartan::SurfacePair pair = cartan::ReadSurfacePair(input, reference);
      cartan::Warn(this, pair.Warning);
      const cartan::Curvatures before =
        cartan::FitCurvatures(pair.Mesh, pair.Reference, context.Part(0.0, 0.5));
      const cartan::Curvatures now =
        cartan::FitCurvatures(pair.Mesh, pair.Current, context.Part(0.5, 1.0));
      cartan::Warn(this, DescribeUndetermined(before, "reference"));
      cartan::Warn(this, DescribeUndetermined(now, "input"));
      const Eigen::VectorXd areas = cartan::MixedVoronoiAreas(pair.Mesh, pair.Reference, context);

      output->ShallowCopy(input);
      AddCurvatures(output, now, this->ComputeDirections);
      std::tie(this->MeanCurvatureErrorRMS, this->MeanCurvatureErrorMax) =
        AddError(output, "MeanCurvature", now.Mean - before.Mean, areas);
      std::tie(this->GaussianCurvatureErrorRMS, this->GaussianCurvatureErrorMax) =
        AddError(output, "GaussianCurvature", now.Gaussian - before.Gaussian, areas);
      output->GetPointData()->SetActiveScalars("MeanCurvatureError");
    });
}

void vtkCurvatureError::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ComputeDirections: " << this->ComputeDirections << "\n";
  os << indent << "MeanCurvatureErrorRMS: " << this->MeanCurvatureErrorRMS << "\n";
  os << indent << "MeanCurvatureErrorMax: " << this->MeanCurvatureErrorMax << "\n";
  os << indent << "GaussianCurvatureErrorRMS: " << this->GaussianCurvatureErrorRMS << "\n";
  os << indent << "GaussianCurvatureErrorMax: " << this->GaussianCurvatureErrorMax << "\n";
}
