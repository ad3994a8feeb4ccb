// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCurvatureError.h"

#include "Bridge/FilterRun.h"
#include "Bridge/PointArrays.h"
#include "Bridge/SurfacePair.h"
#include "Kernel/Differential/Curvature.h"
#include "Kernel/Mesh/Geometry.h"

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
#include <vector>

vtkStandardNewMacro(vtkCurvatureError);

namespace
{
/// What the errors are measured against.
struct ReferenceCurvatures
{
  Eigen::VectorXd Mean;
  Eigen::VectorXd Gaussian;
  Eigen::VectorXd Areas;
  std::string Warning;

  std::size_t GetBytes() const { return 3 * this->Areas.size() * sizeof(double); }
};

void AddCurvatures(vtkPolyData* output, const cartan::Curvatures& curvatures, bool withDirections)
{
  cartan::AddPointArray(output, "MeanCurvature", curvatures.Mean);
  cartan::AddPointArray(output, "GaussianCurvature", curvatures.Gaussian);
  cartan::AddPointArray(output, "MaximumCurvature", curvatures.Maximum);
  cartan::AddPointArray(output, "MinimumCurvature", curvatures.Minimum);
  if (withDirections)
  {
    cartan::AddPointArray(output, "MaximumCurvatureDirection", curvatures.MaximumDirections);
    cartan::AddPointArray(output, "MinimumCurvatureDirection", curvatures.MinimumDirections);
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
std::string DescribeUndetermined(const std::vector<char>& isDetermined, const std::string& which)
{
  cartan::IdSample undetermined;
  for (std::size_t v = 0; v < isDetermined.size(); ++v)
  {
    if (!isDetermined[v])
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

/// Adds the array `name`Error with its summary as field data, and returns the
/// root mean square and the maximum.
std::pair<double, double> AddError(vtkPolyData* output, const std::string& name,
  const Eigen::VectorXd& error, const Eigen::VectorXd& areas)
{
  cartan::AddPointArray(output, name + "Error", error);
  const double area = areas.sum();
  const double meanSquare = area > 0.0 ? areas.dot(error.cwiseAbs2()) / area : 0.0;
  return { cartan::AddFieldValue(output, name + "ErrorRMS", std::sqrt(meanSquare)),
    cartan::AddFieldValue(output, name + "ErrorMax", error.cwiseAbs().maxCoeff()) };
}
}

void vtkCurvatureError::ForgetResults()
{
  this->MeanCurvatureErrorRMS = std::numeric_limits<double>::quiet_NaN();
  this->MeanCurvatureErrorMax = std::numeric_limits<double>::quiet_NaN();
  this->GaussianCurvatureErrorRMS = std::numeric_limits<double>::quiet_NaN();
  this->GaussianCurvatureErrorMax = std::numeric_limits<double>::quiet_NaN();
}

void vtkCurvatureError::Measure(cartan::FilterRun& run)
{
  const auto surface = run.ReadSurface();
  const cartan::Curvatures curvatures =
    cartan::FitCurvatures(*surface->Mesh, *surface->Positions, run.Context().Part(0.1, 1.0));
  run.Warn(DescribeUndetermined(curvatures.IsDetermined, "input"));
  AddCurvatures(run.Output(), curvatures, this->ComputeDirections);
  run.Output()->GetPointData()->SetActiveScalars("MeanCurvature");
}

void vtkCurvatureError::Compare(const cartan::SurfacePair& pair, cartan::FilterRun& run)
{
  const auto before = run.Keep<ReferenceCurvatures>(pair.ReferenceKey,
    [&]
    {
      const cartan::Curvatures fitted =
        cartan::FitCurvatures(*pair.Mesh, *pair.Reference, run.Context().Part(0.1, 0.45));
      auto kept = std::make_unique<ReferenceCurvatures>();
      kept->Mean = fitted.Mean;
      kept->Gaussian = fitted.Gaussian;
      kept->Warning = DescribeUndetermined(fitted.IsDetermined, "reference");
      kept->Areas =
        cartan::MixedVoronoiAreas(*pair.Mesh, *pair.Reference, run.Context().Part(0.45, 0.5));
      return kept;
    });
  const cartan::Curvatures now =
    cartan::FitCurvatures(*pair.Mesh, *pair.Current, run.Context().Part(0.5, 1.0));
  run.Warn(before->Warning);
  run.Warn(DescribeUndetermined(now.IsDetermined, "input"));

  vtkPolyData* output = run.Output();
  AddCurvatures(output, now, this->ComputeDirections);
  std::tie(this->MeanCurvatureErrorRMS, this->MeanCurvatureErrorMax) =
    AddError(output, "MeanCurvature", now.Mean - before->Mean, before->Areas);
  std::tie(this->GaussianCurvatureErrorRMS, this->GaussianCurvatureErrorMax) =
    AddError(output, "GaussianCurvature", now.Gaussian - before->Gaussian, before->Areas);
  output->GetPointData()->SetActiveScalars("MeanCurvatureError");
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
