// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCoatingTransfer.h"

#include "Bridge/FilterRun.h"
#include "Bridge/HandleArrays.h"
#include "Bridge/MatchedSurfaces.h"
#include "Bridge/PointArrays.h"
#include "Bridge/PointKeys.h"
#include "Bridge/SurfacePlaces.h"
#include "Bridge/SurfaceWriter.h"
#include "Kernel/Algebra/SimilarityFit.h"
#include "Kernel/Merging/ClosestAlignment.h"
#include "Kernel/Merging/SmoothStep.h"
#include "Kernel/Mesh/GeodesicDistance.h"
#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Mesh/UsedVertices.h"

#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <map>

vtkStandardNewMacro(vtkCoatingTransfer);

using cartan::Error;
using cartan::ErrorCode;

/// The inputs as the kernel sees them; the base is in the source's coordinates.
struct vtkCoatingTransfer::Sides
{
  vtkPolyData* TargetData;
  vtkPolyData* SourceData;
  std::shared_ptr<const cartan::Surface> Target;
  std::shared_ptr<const cartan::TriangleMesh> Mesh; ///< the source's
  std::shared_ptr<const cartan::Points> Detailed;
  Eigen::Vector3d SourceOrigin;
  cartan::Points Base;
  cartan::FoundPlaces Found; ///< of the target's points on the base
  Eigen::VectorXd Strengths; ///< #V of the target, what the coating is multiplied by
};

namespace
{
/// What is farther off than this part of the source's size on average is not a place.
constexpr double FarPart = 0.1;

/// A coating below this part of the source's size is rounding.
constexpr double RoundingPart = 1e-9;

vtkDataArray* RequireTextureCoordinates(vtkPolyData* input, const std::string& role)
{
  vtkDataArray* coordinates = input->GetPointData()->GetTCoords();
  if (!coordinates || coordinates->GetNumberOfComponents() < 2)
  {
    throw Error(ErrorCode::BadInput,
      "The " + role +
        " has no texture coordinates of two components: make some, or choose another "
        "Correspondence.");
  }
  return coordinates;
}

/// (u, v, 0): #V x 3.
cartan::Points TexturePoints(
  vtkPolyData* input, const cartan::TriangleMesh& mesh, const std::string& role)
{
  vtkDataArray* coordinates = RequireTextureCoordinates(input, role);
  cartan::Points points = cartan::Points::Zero(mesh.NumberOfVertices(), 3);
  for (const int v : cartan::UsedVertices(mesh))
  {
    points(v, 0) = coordinates->GetComponent(v, 0);
    points(v, 1) = coordinates->GetComponent(v, 1);
  }
  return points;
}

/// Each point at the point of its id.
cartan::FoundPlaces PlacesById(
  const cartan::TriangleMesh& target, const cartan::TriangleMesh& source)
{
  if (target.NumberOfVertices() != source.NumberOfVertices())
  {
    throw Error(ErrorCode::BadInput,
      "POINT_ID needs as many points in the target (" + std::to_string(target.NumberOfVertices()) +
        ") as in the source (" + std::to_string(source.NumberOfVertices()) +
        "): choose CLOSEST_POINT or KEYS.");
  }
  cartan::FoundPlaces found;
  found.Distances = Eigen::VectorXd::Zero(target.NumberOfVertices());
  for (int v = 0; v < target.NumberOfVertices(); ++v)
  {
    found.Places.push_back(cartan::SurfacePlace::AtVertex(v));
  }
  return found;
}

void RequireSameTriangles(
  int correspondence, const cartan::TriangleMesh& target, const cartan::TriangleMesh& source)
{
  if (correspondence != vtkCoatingTransfer::POINT_ID ||
    target.NumberOfTriangles() != source.NumberOfTriangles() ||
    target.GetTriangles() != source.GetTriangles())
  {
    throw Error(ErrorCode::BadInput,
      "LAPLACIANS belong to triangles: they need POINT_ID, and the source's triangles on the "
      "target. Choose DISPLACEMENTS.");
  }
}

/// Over the points that are in a triangle.
double RootMeanSquare(const cartan::TriangleMesh& mesh, const cartan::Points& vectors)
{
  const std::vector<int> used = cartan::UsedVertices(mesh);
  double sum = 0.0;
  for (const int v : used)
  {
    sum += vectors.row(v).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(used.size()));
}

/// The source's numeric point arrays at the places.
void WriteArrays(vtkPolyData* source, const std::vector<cartan::SurfacePlace>& places,
  const cartan::Matrices& rotations, const std::vector<int>& used, vtkPolyData* output)
{
  vtkPointData* arrays = source->GetPointData();
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = arrays->GetArray(i);
    if (!array || !array->GetName() || array == arrays->GetNormals() ||
      array == arrays->GetTCoords() || output->GetPointData()->HasArray(array->GetName()))
    {
      continue;
    }
    cartan::Field values(array->GetNumberOfTuples(), array->GetNumberOfComponents());
    for (Eigen::Index v = 0; v < values.rows(); ++v)
    {
      array->GetTuple(v, values.row(v).data());
    }
    const cartan::Field there = cartan::AtPlaces(values, places);
    cartan::Field results = cartan::Field::Zero(there.rows(), there.cols());
    for (const int v : used)
    {
      results.row(v) = there.row(v);
      if (there.cols() == 3)
      {
        results.row(v) = there.row(v) * cartan::MatrixAt(rotations, v).transpose();
      }
    }
    cartan::AddArray(output->GetPointData(), array->GetName(), results);
  }
}
}

vtkCoatingTransfer::vtkCoatingTransfer()
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(2);
}

void vtkCoatingTransfer::SetSourceData(vtkPolyData* source)
{
  this->SetInputData(1, source);
}

void vtkCoatingTransfer::SetSmoothSourceData(vtkPolyData* base)
{
  this->SetInputData(2, base);
}

vtkPolyData* vtkCoatingTransfer::GetBase()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(1));
}

int vtkCoatingTransfer::FillInputPortInformation(int port, vtkInformation* info)
{
  return port == 2 ? SetPortType(info, "vtkPolyData", true)
                   : this->Superclass::FillInputPortInformation(port, info);
}

void vtkCoatingTransfer::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Correspondence: " << this->Correspondence << "\n";
  os << indent << "Representation: " << this->Representation << "\n";
  os << indent << "Alignment: " << this->Alignment << "\n";
  os << indent << "Smoothing: " << this->Smoothing << "\n";
  os << indent << "Strength: " << this->Strength << "\n";
  os << indent << "ScaleDetails: " << this->ScaleDetails << "\n";
  os << indent << "RegionArrayName: " << this->RegionArrayName << "\n";
  os << indent << "FadeWidth: " << this->FadeWidth << "\n";
  os << indent << "KeyArrayName: " << this->KeyArrayName << "\n";
  os << indent << "TransferArrays: " << this->TransferArrays << "\n";
  os << indent << "MeanDistance: " << this->MeanDistance << "\n";
  os << indent << "CoatingRMS: " << this->CoatingRMS << "\n";
}

void vtkCoatingTransfer::ForgetResults()
{
  this->MeanDistance = 0.0;
  this->CoatingRMS = 0.0;
}

vtkCoatingTransfer::Sides vtkCoatingTransfer::ReadSides(cartan::FilterRun& run) const
{
  Sides sides;
  sides.TargetData = run.Input(0);
  sides.SourceData = run.Input(1);
  sides.Target = run.ReadSurface(0, "target");
  if (vtkPolyData* smooth = run.Input(2))
  {
    const cartan::MatchedSurfaces matched =
      cartan::ReadMatchedSurfaces({ sides.SourceData, smooth }, { "source", "smooth source" },
        "Give both the same points and cells in the same order, such as the output of Smooth.",
        run.Context().Part(0.1, 0.2));
    run.Warn(matched.Warning);
    sides.Mesh = matched.Mesh;
    run.Output(1)->ShallowCopy(smooth);
    sides.Detailed = matched.Positions[0];
    sides.SourceOrigin = matched.Origins[0];
    sides.Base =
      matched.Positions[1]->rowwise() + (matched.Origins[1] - matched.Origins[0]).transpose();
    return sides;
  }
  const auto source = run.ReadSurface(1, "source");
  sides.Mesh = source->Mesh;
  sides.Detailed = source->Positions;
  sides.SourceOrigin = source->Origin;
  sides.Base = cartan::SmoothBase(
    *source->Mesh, *source->Positions, this->Smoothing, run.Context().Part(0.2, 0.45));
  cartan::WriteSurface(
    *source, sides.Base, sides.SourceData, run.Output(1), run.Context().Part(0.45, 0.5));
  return sides;
}

void vtkCoatingTransfer::FindPlaces(Sides& sides, cartan::FilterRun& run) const
{
  const cartan::ExecutionContext context = run.Context().Part(0.6, 0.8);
  const cartan::TriangleMesh& mesh = *sides.Target->Mesh;
  if (this->Correspondence == POINT_ID)
  {
    sides.Found = PlacesById(mesh, *sides.Mesh);
    return;
  }
  if (this->Correspondence == TEXTURE_COORDINATES)
  {
    const cartan::Points queries = TexturePoints(sides.TargetData, mesh, "target");
    sides.Found = cartan::ClosestPlaces(
      *sides.Mesh, TexturePoints(sides.SourceData, *sides.Mesh, "source"), queries, context);
    return;
  }
  // As it lies, in the source's coordinates.
  cartan::Points target =
    sides.Target->Positions->rowwise() + (sides.Target->Origin - sides.SourceOrigin).transpose();
  if (this->Correspondence == KEYS)
  {
    target = cartan::Moved(target,
      cartan::AlignKeys(cartan::ReadKeyPoints(sides.TargetData, mesh, this->KeyArrayName), target,
        cartan::ReadKeyPoints(sides.SourceData, *sides.Mesh, this->KeyArrayName), sides.Base));
  }
  else if (this->Alignment != AS_THEY_LIE)
  {
    const std::vector<int> used = cartan::UsedVertices(mesh);
    target = cartan::Moved(target,
      cartan::AlignToSurface(target(used, Eigen::all), *sides.Mesh, sides.Base,
        this->Alignment == SIMILARITY, run.Context().Part(0.5, 0.6)));
  }
  sides.Found = cartan::ClosestPlaces(*sides.Mesh, sides.Base, target, context);
}

void vtkCoatingTransfer::FindStrengths(Sides& sides, cartan::FilterRun& run) const
{
  const cartan::TriangleMesh& mesh = *sides.Target->Mesh;
  Eigen::VectorXd& strengths = sides.Strengths;
  strengths = Eigen::VectorXd::Constant(mesh.NumberOfVertices(), this->Strength);
  if (this->RegionArrayName.empty())
  {
    return;
  }
  const cartan::Handles region = cartan::ReadHandles(sides.TargetData, mesh, this->RegionArrayName);
  std::vector<int> outside;
  for (const int v : cartan::UsedVertices(mesh))
  {
    if (region.OfVertex[v] == 0)
    {
      outside.push_back(v);
      strengths[v] = 0.0;
    }
  }
  if (this->FadeWidth > 0.0 && !outside.empty())
  {
    const Eigen::VectorXd distances = cartan::GeodesicDistance(
      mesh, *sides.Target->Positions, outside, this->FadeWidth, run.Context().Part(0.85, 0.9));
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      strengths[v] *= cartan::SmoothStep(distances[v] / this->FadeWidth);
    }
  }
}

void vtkCoatingTransfer::WarnOfOddities(const Sides& sides, cartan::FilterRun& run) const
{
  const double size = cartan::BoundingDiagonal(sides.Base, sides.Mesh->GetTriangles());
  if (!(this->CoatingRMS > RoundingPart * size))
  {
    run.Warn("The source has no detail, so the target stays as it is: raise Smoothing, or connect "
             "another smooth source.");
  }
  if (this->Correspondence != TEXTURE_COORDINATES && this->MeanDistance > FarPart * size)
  {
    run.Warn("The places on the source are " + std::to_string(100.0 * this->MeanDistance / size) +
      " % of its size away from the aligned target on average, so they may not belong together: "
      "choose KEYS with three points or more.");
  }
}

void vtkCoatingTransfer::Execute(cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  Sides sides = this->ReadSides(run);
  this->FindPlaces(sides, run);
  this->FindStrengths(sides, run);
  const cartan::TriangleMesh& mesh = *sides.Target->Mesh;
  const cartan::Points& rest = *sides.Target->Positions;
  const cartan::PlaceFrames frames =
    cartan::FramesAtPlaces(mesh, rest, sides.Base, sides.Found.Places, context.Part(0.9, 0.93));
  const std::vector<int> used = cartan::UsedVertices(mesh);
  cartan::Points all = cartan::CoatingDisplacements(
    sides.Base, *sides.Detailed, sides.Found.Places, frames, this->ScaleDetails, sides.Strengths);
  if (this->Representation == LAPLACIANS)
  {
    RequireSameTriangles(this->Correspondence, mesh, *sides.Mesh);
    all = cartan::CoatingByLaplacians(mesh, sides.Base, *sides.Detailed, frames, this->ScaleDetails,
      sides.Strengths, all, context.Part(0.93, 0.95));
  }
  cartan::Points displacements = cartan::Points::Zero(mesh.NumberOfVertices(), 3);
  Eigen::VectorXd distances = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  for (const int v : used)
  {
    displacements.row(v) = all.row(v);
    distances[v] = sides.Found.Distances[v];
  }
  this->MeanDistance = distances.sum() / static_cast<double>(used.size());
  this->CoatingRMS = RootMeanSquare(*sides.Mesh, *sides.Detailed - sides.Base);
  this->WarnOfOddities(sides, run);
  run.Warn(cartan::WriteSurface(
    *sides.Target, rest + displacements, sides.TargetData, run.Output(), context.Part(0.95, 1.0)));
  cartan::AddPointArray(run.Output(), "Coating", displacements);
  cartan::AddPointArray(run.Output(), "CorrespondenceDistance", distances);
  if (this->TransferArrays)
  {
    WriteArrays(sides.SourceData, sides.Found.Places, frames.Rotations, used, run.Output());
  }
  context.Report(1.0);
}
