// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDifferentialReconstruction.h"

#include "Bridge/FilterRun.h"
#include "Bridge/HandleArrays.h"
#include "Bridge/PointArrays.h"
#include "Bridge/SurfaceWriter.h"
#include "Kernel/Differential/DifferentialCoordinates.h"
#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Mesh/UsedVertices.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <limits>

vtkStandardNewMacro(vtkDifferentialReconstruction);

using cartan::Error;
using cartan::ErrorCode;

static_assert(static_cast<int>(cartan::AnchorMode::Soft) == vtkDifferentialReconstruction::SOFT &&
    static_cast<int>(cartan::AnchorMode::Hard) == vtkDifferentialReconstruction::HARD &&
    static_cast<int>(cartan::AnchorMode::Substituted) == vtkDifferentialReconstruction::SUBSTITUTED,
  "the enumerations agree");

namespace
{
/// Points that are held, in increasing order.
struct HeldPoints
{
  std::vector<int> Points;
  Eigen::VectorXd Weights;
  cartan::Points Positions;
};

void RefuseNegative(const cartan::Field& values, const std::vector<int>& points,
  const std::string& name, const std::string& advice)
{
  cartan::IdSample negative;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (values(static_cast<Eigen::Index>(i), 0) < 0.0)
    {
      negative.Add(points[i]);
    }
  }
  if (!negative.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The point array \"" + name + "\" is negative at " + negative.Describe("point", "points") +
        ": " + advice);
  }
}

/// The handles' points, without those of weight 0.
HeldPoints ReadHeldPoints(vtkPolyData* input, const cartan::TriangleMesh& mesh,
  const std::string& handleName, const std::string& weightName)
{
  HeldPoints held;
  held.Points = cartan::ReadHandles(input, mesh, handleName).Points;
  std::sort(held.Points.begin(), held.Points.end());
  held.Weights = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(held.Points.size()));
  if (weightName.empty())
  {
    return held;
  }
  const cartan::Field weights = cartan::ReadPointArray(input, weightName, 1, held.Points, "anchor");
  RefuseNegative(weights, held.Points, weightName, "weights of anchors are at least 0.");
  HeldPoints kept;
  std::vector<double> positive;
  for (std::size_t i = 0; i < held.Points.size(); ++i)
  {
    const double weight = weights(static_cast<Eigen::Index>(i), 0);
    if (weight > 0.0)
    {
      kept.Points.push_back(held.Points[i]);
      positive.push_back(weight);
    }
  }
  kept.Weights =
    Eigen::Map<const Eigen::VectorXd>(positive.data(), static_cast<Eigen::Index>(positive.size()));
  return kept;
}

std::string DescribeOperator(int weights, int normalization)
{
  const char* const weightNames[] = { "uniform", "cotangent", "mean value" };
  const char* const normalizationNames[] = { "normalized by row", "integrated",
    "normalized by area" };
  return std::string(weightNames[weights]) + " weights, " + normalizationNames[normalization];
}

/// Compares with what vtkDifferentialCoordinates has written down, if it has.
void RequireSameOperator(vtkPolyData* input, const std::string& name,
  const cartan::DifferentialReconstruction::Settings& settings)
{
  vtkDataArray* made = input->GetFieldData()->GetArray((name + "Operator").c_str());
  if (!made || made->GetNumberOfTuples() != 2 || made->GetNumberOfComponents() != 1)
  {
    return;
  }
  const auto isIn = [](double value) { return value == 0.0 || value == 1.0 || value == 2.0; };
  const auto weights = static_cast<int>(settings.Weights);
  const auto normalization = static_cast<int>(settings.Normalization);
  const double madeWeights = made->GetTuple1(0);
  const double madeNormalization = made->GetTuple1(1);
  if (isIn(madeWeights) && isIn(madeNormalization) &&
    (madeWeights != weights || madeNormalization != normalization))
  {
    throw Error(ErrorCode::BadInput,
      "The differential coordinates \"" + name + "\" were made with " +
        DescribeOperator(static_cast<int>(madeWeights), static_cast<int>(madeNormalization)) +
        ", and are read with " + DescribeOperator(weights, normalization) +
        ": set LaplacianWeights and Normalization as they were.");
  }
}

/// The names of what the coordinates are read from.
struct CoordinateNames
{
  std::string First;
  std::string Other;
  std::string BlendWeight;
};

/// #V x 3, blended; zero at points in no triangle, whatever the arrays hold.
cartan::Points ReadCoordinates(vtkPolyData* input, const cartan::TriangleMesh& mesh,
  const CoordinateNames& names, const cartan::DifferentialReconstruction::Settings& settings)
{
  if (names.Other.empty() != names.BlendWeight.empty())
  {
    throw Error(ErrorCode::BadInput,
      "Blending needs two names: set OtherDifferentialCoordinatesArrayName and "
      "BlendWeightArrayName, or neither.");
  }
  const std::vector<int> used = cartan::UsedVertices(mesh);
  const auto read = [&](const std::string& name)
  {
    RequireSameOperator(input, name, settings);
    return cartan::ReadPointArray(input, name, 3, used, "point");
  };
  cartan::Field deltas = read(names.First);
  if (!names.Other.empty())
  {
    const cartan::Field weights =
      cartan::ReadPointArray(input, names.BlendWeight, 1, used, "point");
    const cartan::Field others = read(names.Other);
    deltas += weights.col(0).asDiagonal() * (others - deltas);
  }
  cartan::Points all = cartan::Points::Zero(mesh.NumberOfVertices(), 3);
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    all.row(used[i]) = deltas.row(static_cast<Eigen::Index>(i));
  }
  return all;
}
}

namespace
{
/// What double precision may round off a coordinate where the surface is.
double RoundingOf(const cartan::Surface& surface)
{
  const double largest =
    surface.Origin.cwiseAbs().maxCoeff() + surface.Positions->cwiseAbs().maxCoeff();
  return std::numeric_limits<double>::epsilon() * largest;
}

/// How far points may be from where the numbers put them, in parts of the size.
constexpr double LargestUncertainty = 1e-5;

/// A sentence on the points that rounding leaves open; empty where there are none.
std::string DescribeUncertainty(
  const cartan::TriangleMesh& mesh, const cartan::Points& positions, const cartan::Points& change)
{
  const double size = cartan::BoundingDiagonal(positions, mesh.GetTriangles());
  cartan::IdSample open;
  for (Eigen::Index v = 0; v < change.rows(); ++v)
  {
    if (!(change.row(v).norm() <= LargestUncertainty * size))
    {
      open.Add(v);
    }
  }
  return open.IsEmpty() ? ""
                        : "Rounding leaves " + open.Describe("point", "points") +
      " open by more than 1e-5 of the size of the result: flip edges before the coordinates are "
      "made (Prepare Surface, Flip Edges), or hold more points.";
}
}

void vtkDifferentialReconstruction::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "HandleArrayName: " << this->HandleArrayName << "\n";
  os << indent << "AnchorPositionArrayName: " << this->AnchorPositionArrayName << "\n";
  os << indent << "AnchorMode: " << this->AnchorMode << "\n";
  os << indent << "ConstraintWeight: " << this->ConstraintWeight << "\n";
  os << indent << "ConstraintWeightArrayName: " << this->ConstraintWeightArrayName << "\n";
  os << indent
     << "OtherDifferentialCoordinatesArrayName: " << this->OtherDifferentialCoordinatesArrayName
     << "\n";
  os << indent << "BlendWeightArrayName: " << this->BlendWeightArrayName << "\n";
  os << indent << "NumberOfFactorizations: " << this->NumberOfFactorizations << "\n";
}

void vtkDifferentialReconstruction::Execute(cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  vtkPolyData* input = run.Input();
  const auto surface = run.ReadSurface();
  cartan::DifferentialReconstruction::Settings settings;
  settings.Weights = static_cast<cartan::LaplacianWeights>(this->LaplacianWeights);
  settings.Normalization = static_cast<cartan::DeltaNormalization>(this->Normalization);
  settings.Mode = static_cast<cartan::AnchorMode>(this->AnchorMode);
  settings.Rounding = RoundingOf(*surface);
  const cartan::Points deltas = ReadCoordinates(input, *surface->Mesh,
    { this->DifferentialCoordinatesArrayName, this->OtherDifferentialCoordinatesArrayName,
      this->BlendWeightArrayName },
    settings);
  HeldPoints held =
    ReadHeldPoints(input, *surface->Mesh, this->HandleArrayName, this->ConstraintWeightArrayName);
  if (this->AnchorPositionArrayName.empty())
  {
    held.Positions = (*surface->Positions)(held.Points, Eigen::all);
  }
  else
  {
    held.Positions =
      cartan::ReadPointArray(input, this->AnchorPositionArrayName, 3, held.Points, "anchor");
    held.Positions.rowwise() -= surface->Origin.transpose();
  }

  const Eigen::VectorXd weights = this->ConstraintWeight * held.Weights;
  cartan::ContentKey key = surface->Key;
  key.Add(static_cast<std::uint64_t>(this->LaplacianWeights));
  key.Add(static_cast<std::uint64_t>(this->Normalization));
  key.Add(static_cast<std::uint64_t>(this->AnchorMode));
  key.AddBytes(held.Points.data(), held.Points.size() * sizeof(int));
  key.AddBytes(weights.data(), static_cast<std::size_t>(weights.size()) * sizeof(double));
  const auto reconstruction = run.Keep<cartan::DifferentialReconstruction>(key,
    [&]
    {
      this->NumberOfFactorizations = 1;
      return std::make_unique<cartan::DifferentialReconstruction>(
        surface->Mesh, surface->Positions, held.Points, weights, settings, context.Part(0.1, 0.7));
    });
  cartan::Points uncertainty;
  const cartan::Points positions =
    reconstruction->Reconstruct(deltas, held.Positions, context.Part(0.7, 0.9), &uncertainty);
  run.Warn(DescribeUncertainty(*surface->Mesh, positions, uncertainty));
  run.Warn(cartan::WriteSurface(*surface, positions, input, run.Output(), context.Part(0.9, 1.0)));
  context.Report(1.0);
}
