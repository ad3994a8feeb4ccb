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
  explicit ReferenceCurvatures(
    const cartan::SurfacePair& pair, const cartan::ExecutionContext& context)
    : Fits(pair.Mesh, *pair.Reference, context.Part(0.0, 0.5))
    , Areas(cartan::MixedVoronoiAreas(*pair.Mesh, *pair.Reference, context))
  {
    cartan::Curvatures fitted = this->Fits.Measure(*pair.Reference, context.Part(0.5, 1.0));
    this->Mean = std::move(fitted.Mean);
    this->Gaussian = std::move(fitted.Gaussian);
    this->States = std::move(fitted.States);
  }

  cartan::CurvatureFits Fits;
  Eigen::VectorXd Areas;
  Eigen::VectorXd Mean;
  Eigen::VectorXd Gaussian;
  std::vector<cartan::CurvatureState> States;

  std::size_t GetBytes() const
  {
    return this->Fits.GetBytes() +
      cartan::TotalBytes(this->Areas, this->Mean, this->Gaussian, this->States);
  }
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
  isDetermined->SetNumberOfValues(static_cast<vtkIdType>(curvatures.States.size()));
  std::transform(curvatures.States.begin(), curvatures.States.end(), isDetermined->GetPointer(0),
    [](cartan::CurvatureState state)
    { return state == cartan::CurvatureState::Determined ? 1 : 0; });
  output->GetPointData()->AddArray(isDetermined);
}

/// Where the curvatures are of this state.
cartan::IdSample PointsOf(
  const std::vector<cartan::CurvatureState>& states, cartan::CurvatureState state)
{
  cartan::IdSample points;
  for (std::size_t v = 0; v < states.size(); ++v)
  {
    if (states[v] == state)
    {
      points.Add(static_cast<long long>(v));
    }
  }
  return points;
}

/// Empty where every point's curvature is determined. `which` is the input, the
/// reference, or both.
std::string DescribeUndetermined(
  const std::vector<cartan::CurvatureState>& states, const std::string& which)
{
  std::string text;
  const cartan::IdSample open = PointsOf(states, cartan::CurvatureState::Open);
  if (!open.IsEmpty())
  {
    text = "The curvature of the " + which + " is not determined at " +
      open.Describe("point", "points") +
      ": the points around lie in fewer than three rows in some direction. There it is "
      "estimated from the normals of the triangles, with edges that join two rows taken as "
      "straight. For reliable values use at least three evenly spaced rows of points in every "
      "direction.";
  }
  const cartan::IdSample split = PointsOf(states, cartan::CurvatureState::Split);
  if (!split.IsEmpty())
  {
    text += (text.empty() ? "" : " ") + std::string("The curvature of the ") + which +
      " may be off by more than 5 % at " + split.Describe("point", "points") +
      " of flat parts that meet in straight edges, as where larger triangles are split into "
      "coplanar ones: more of them change nothing. Where the surface should be smooth, use it "
      "before it is split, split it by vtkLoopSubdivisionFilter instead of "
      "vtkLinearSubdivisionFilter, or give tubes more sides.";
  }
  const cartan::IdSample coarse = PointsOf(states, cartan::CurvatureState::Coarse);
  if (!coarse.IsEmpty())
  {
    text += (text.empty() ? "" : " ") + std::string("The curvature of the ") + which +
      " may be off by more than 5 % at " + coarse.Describe("point", "points") +
      ": the triangles there are large for how the surface bends, or the points are noisy or "
      "at a sharp edge. For reliable values use smaller triangles where the surface bends, and "
      "smooth noise.";
  }
  return text;
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
  run.Warn(DescribeUndetermined(curvatures.States, "input"));
  AddCurvatures(run.Output(), curvatures, this->ComputeDirections);
  run.Output()->GetPointData()->SetActiveScalars("MeanCurvature");
}

void vtkCurvatureError::Compare(const cartan::SurfacePair& pair, cartan::FilterRun& run)
{
  const auto before = run.Keep<ReferenceCurvatures>(pair.ReferenceKey,
    [&] { return std::make_unique<ReferenceCurvatures>(pair, run.Context().Part(0.1, 0.5)); });
  const cartan::Curvatures now = before->Fits.Measure(*pair.Current, run.Context().Part(0.5, 1.0));
  if (now.States == before->States)
  {
    run.Warn(DescribeUndetermined(now.States, "input and of the reference"));
  }
  else
  {
    run.Warn(DescribeUndetermined(before->States, "reference"));
    run.Warn(DescribeUndetermined(now.States, "input"));
  }

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
