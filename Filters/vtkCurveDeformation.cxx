// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCurveDeformation.h"

#include "Bridge/CarryingMethod.h"
#include "Bridge/CurveReader.h"
#include "Bridge/FilterRun.h"
#include "Bridge/HandleArrays.h"
#include "Bridge/MarkedPoints.h"
#include "Bridge/PointArrays.h"
#include "Bridge/PreparedSurface.h"
#include "Bridge/SurfaceWriter.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Base/Constants.h"
#include "Kernel/Deformation/CurveDeltas.h"
#include "Kernel/Deformation/CurveMatch.h"
#include "Kernel/Deformation/JoinedVertices.h"
#include "Kernel/Deformation/SliverRemoval.h"
#include "Kernel/Mesh/EdgePaths.h"
#include "Kernel/Mesh/GeodesicDistance.h"
#include "Kernel/Mesh/GeodesicPath.h"
#include "Kernel/Mesh/Geometry.h"

#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <limits>

vtkStandardNewMacro(vtkCurveDeformation);

using cartan::Error;
using cartan::ErrorCode;

/// The source curve, and where it goes; relative to the surface's origin.
struct vtkCurveDeformation::Curves
{
  std::vector<int> Path;   ///< points of the surface
  cartan::Points Source;   ///< #Path x 3, the points or the geodesic's places beside them
  cartan::Points Vectors;  ///< #Path x 3, the rotations from source to target
  cartan::Points Goals;    ///< #Path x 3, of the points; empty without a target
  cartan::Points Deformed; ///< #V x 3
};

namespace
{
constexpr int MostPointIds = 1000000;

/// A target farther away than so many sizes of the surface has other units or another
/// place.
constexpr double FarSizes = 10.0;

/// A curve that moves less than this part of the surface's size stays exactly.
constexpr double StillPart = 1e-13;

/// A method that is kept for one surface, curve and pinned points.
struct CurvePreparation
{
  std::unique_ptr<cartan::SurfaceDeformer> Deformer;

  std::size_t GetBytes() const { return this->Deformer->GetBytes(); }
};

cartan::Points Rows(const cartan::Points& points, const std::vector<int>& ids)
{
  cartan::Points rows(static_cast<Eigen::Index>(ids.size()), 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    rows.row(i) = points.row(ids[i]);
  }
  return rows;
}

/// The keys of a target whose points are `curve`, in the order of the target.
std::vector<cartan::CurveKey> ReadKeys(vtkPolyData* target, const std::string& name,
  const std::vector<vtkIdType>& curve, const std::vector<int>& path, bool isClosed)
{
  std::vector<cartan::CurveKey> keys;
  if (!target->GetPointData()->HasArray(name.c_str()))
  {
    return keys;
  }
  vtkDataArray* array = cartan::RequirePointArray(target, name, 1);
  for (std::size_t i = 0; i < curve.size(); ++i)
  {
    const double id = array->GetTuple1(curve[i]);
    if (id < 0.0)
    {
      continue;
    }
    const auto at = std::find(path.begin(), path.end(), id);
    if (at == path.end())
    {
      throw Error(ErrorCode::BadInput,
        "Point " + std::to_string(curve[i]) + " of the target curve has the key " +
          std::to_string(static_cast<long long>(id)) +
          ", which is no point of the source curve: give ids of its points, or -1 for none.");
    }
    const cartan::CurveKey key = { static_cast<int>(at - path.begin()), static_cast<int>(i) };
    // Ends belong together anyway.
    const bool isFirst = key.Source == 0 && key.Target == 0;
    const bool isLast = at + 1 == path.end() && i + 1 == curve.size();
    if (isClosed || (!isFirst && !isLast))
    {
      keys.push_back(key);
    }
  }
  return keys;
}
}

vtkCurveDeformation::vtkCurveDeformation()
{
  this->SetNumberOfInputPorts(2);
}

void vtkCurveDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Source: " << this->Source << "\n";
  os << indent << "PointIds: " << this->PointIds.size() << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "ViewDirection: " << this->ViewDirection[0] << " " << this->ViewDirection[1]
     << " " << this->ViewDirection[2] << "\n";
  os << indent << "ClosedCurve: " << this->ClosedCurve << "\n";
  os << indent << "ReverseTarget: " << this->ReverseTarget << "\n";
  os << indent << "KeyArrayName: " << this->KeyArrayName << "\n";
  os << indent << "HandleArrayName: " << this->HandleArrayName << "\n";
  os << indent << "Reach: " << this->Reach << "\n";
  os << indent << "Fidelity: " << this->Fidelity << "\n";
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "CurveRotations: " << this->CurveRotations << "\n";
  os << indent << "RidgeHeight: " << this->RidgeHeight << "\n";
  os << indent << "RidgeWidth: " << this->RidgeWidth << "\n";
  os << indent << "RidgeScale: " << this->RidgeScale << "\n";
  os << indent << "RidgeTurn: " << this->RidgeTurn << "\n";
  os << indent << "SharpRidge: " << this->SharpRidge << "\n";
  os << indent << "NumberOfCurvePoints: " << this->NumberOfCurvePoints << "\n";
  os << indent << "LargestDistance: " << this->LargestDistance << "\n";
}

void vtkCurveDeformation::SetTargetData(vtkPolyData* curve)
{
  this->SetInputData(1, curve);
}

void vtkCurveDeformation::SetNumberOfPointIds(int count)
{
  if (count < 0 || count > MostPointIds)
  {
    vtkErrorMacro("There are 0 to " << MostPointIds << " PointIds; got " << count << ".");
    return;
  }
  if (count != this->GetNumberOfPointIds())
  {
    this->PointIds.resize(count, 0);
    this->Modified();
  }
}

void vtkCurveDeformation::SetPointId(int index, vtkIdType id)
{
  if (index < 0 || index >= MostPointIds)
  {
    vtkErrorMacro(
      "PointIds are numbered from 0 to " << MostPointIds - 1 << "; got " << index << ".");
    return;
  }
  this->SetNumberOfPointIds(std::max(index + 1, this->GetNumberOfPointIds()));
  this->SetMember(this->PointIds[index], id);
}

vtkIdType vtkCurveDeformation::GetPointId(int index) const
{
  return index >= 0 && index < this->GetNumberOfPointIds() ? this->PointIds[index] : -1;
}

int vtkCurveDeformation::FillInputPortInformation(int port, vtkInformation* info)
{
  return port == 1 ? SetPortType(info, "vtkPolyData", true)
                   : this->Superclass::FillInputPortInformation(port, info);
}

void vtkCurveDeformation::ForgetResults()
{
  this->NumberOfCurvePoints = 0;
  this->LargestDistance = 0.0;
}

void vtkCurveDeformation::UsePreparedInput(cartan::FilterRun&) const
{
  this->RefusePrepareInput();
}

cartan::CurveAcross vtkCurveDeformation::FindPath(const cartan::Surface& surface) const
{
  const cartan::TriangleMesh& mesh = *surface.Mesh;
  const cartan::Points& points = *surface.Positions;
  cartan::RequirePointIds(this->PointIds, mesh.NumberOfVertices());
  const std::vector<int> picks(this->PointIds.begin(), this->PointIds.end());
  const bool isRingThroughOne = this->ClosedCurve && picks.size() == 1 &&
    (this->Source == FEATURE_EDGES || this->Source == SILHOUETTE);
  if (picks.size() < 2 && !isRingThroughOne)
  {
    throw Error(ErrorCode::BadInput,
      "The source curve needs two PointIds or more, but there are " + std::to_string(picks.size()) +
        (this->ClosedCurve ? ": add points around it, three or more."
                           : ": add the points that it starts and ends at."));
  }
  const auto through = [&points](std::vector<int> path) -> cartan::CurveAcross
  {
    const cartan::Points places = Rows(points, path);
    return { std::move(path), places };
  };
  if (this->Source == SELECTED_POINTS)
  {
    return through(cartan::ChainVertices(mesh, picks, this->ClosedCurve));
  }
  if (this->Source == GEODESIC)
  {
    return cartan::GeodesicThrough(mesh, points, picks, this->ClosedCurve);
  }
  cartan::EdgeMask allowed;
  if (this->Source == FEATURE_EDGES)
  {
    allowed = cartan::FeatureEdges(mesh, points, this->FeatureAngle * cartan::Pi / 180.0);
  }
  if (this->Source == SILHOUETTE)
  {
    allowed = cartan::SilhouetteEdges(mesh, points, Eigen::Vector3d(this->ViewDirection));
  }
  return through(isRingThroughOne
      ? cartan::RingThrough(mesh, points, picks[0], allowed)
      : cartan::PathThrough(mesh, points, picks, allowed, this->ClosedCurve));
}

vtkCurveDeformation::Curves vtkCurveDeformation::ReadCurves(
  cartan::FilterRun& run, const cartan::Surface& surface) const
{
  Curves curves;
  cartan::CurveAcross source = this->FindPath(surface);
  curves.Path = std::move(source.Vertices);
  curves.Source = std::move(source.Places);
  vtkPolyData* target = run.Input(1);
  if (!target)
  {
    return curves;
  }
  std::vector<vtkIdType> ids = cartan::ReadCurve(target, this->ClosedCurve);
  if (this->ReverseTarget && !this->ClosedCurve)
  {
    std::reverse(ids.begin(), ids.end());
  }
  cartan::Points line(static_cast<Eigen::Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    line.row(static_cast<Eigen::Index>(i)) =
      Eigen::Vector3d(target->GetPoint(ids[i])).transpose() - surface.Origin.transpose();
  }
  cartan::RequireSimpleCurve(line, "target curve", this->ClosedCurve);
  const double size = cartan::BoundingDiagonal(*surface.Positions, surface.Mesh->GetTriangles());
  const double distance = line.rowwise().norm().maxCoeff();
  if (!(distance <= FarSizes * size))
  {
    throw Error(ErrorCode::BadInput,
      "The target curve is up to " + std::to_string(distance / size) +
        " times the surface's size away from it: move or scale it to the surface (Transform).");
  }
  if (this->Source == SELECTED_POINTS && !this->ClosedCurve &&
    (curves.Source.row(0) - line.row(0)).norm() >
      (curves.Source.row(curves.Source.rows() - 1) - line.row(0)).norm())
  {
    std::reverse(curves.Path.begin(), curves.Path.end());
    curves.Source = Rows(*surface.Positions, curves.Path);
  }
  const std::vector<cartan::CurveKey> keys =
    ReadKeys(target, this->KeyArrayName, ids, curves.Path, this->ClosedCurve);
  curves.Goals = this->ClosedCurve
    ? cartan::MatchClosedCurves(curves.Source, line, keys, this->ReverseTarget)
    : cartan::MatchCurves(curves.Source, line, keys);
  curves.Vectors = cartan::CurveRotations(curves.Source, curves.Goals, this->ClosedCurve);
  // Points beside the curve stay beside it.
  const cartan::Points rest = Rows(*surface.Positions, curves.Path);
  for (Eigen::Index i = 0; i < rest.rows(); ++i)
  {
    const Eigen::Vector3d beside = (rest.row(i) - curves.Source.row(i)).transpose();
    curves.Goals.row(i) +=
      (cartan::RotationFromVector(curves.Vectors.row(i).transpose()) * beside).transpose();
  }
  if ((curves.Goals - rest).rowwise().norm().maxCoeff() <= StillPart * size)
  {
    curves.Goals = rest;
    curves.Vectors.setZero();
  }
  return curves;
}

cartan::HandleProblem vtkCurveDeformation::MakeProblem(
  cartan::FilterRun& run, const cartan::Surface& surface, const std::vector<int>& path) const
{
  vtkPolyData* input = run.Input();
  const int size = surface.Mesh->NumberOfVertices();
  cartan::HandleProblem problem;
  problem.Mesh = surface.Mesh;
  problem.Rest = surface.Positions;
  problem.Handle.assign(size, 0);
  if (input->GetPointData()->HasArray(this->HandleArrayName.c_str()))
  {
    problem.Handle = cartan::ReadHandles(input, *surface.Mesh, this->HandleArrayName).OfVertex;
  }
  constexpr int PinnedHandle = 2;
  constexpr int CurveHandle = 1;
  for (int& handle : problem.Handle)
  {
    handle = handle > 0 ? PinnedHandle : 0;
  }
  if (this->Reach > 0.0)
  {
    const Eigen::VectorXd distances =
      cartan::GeodesicDistance(*surface.Mesh, *surface.Positions, path, this->Reach);
    for (int v = 0; v < size; ++v)
    {
      if (surface.Mesh->IsUsed(v) && !(distances[v] <= this->Reach))
      {
        problem.Handle[v] = PinnedHandle;
      }
    }
  }
  for (const int v : path)
  {
    problem.Handle[v] = CurveHandle;
  }
  problem.Moving = { CurveHandle };
  if (this->Fidelity < 1.0)
  {
    problem.SoftWeights = Eigen::VectorXd::Zero(size);
    for (int v = 0; v < size; ++v)
    {
      problem.SoftWeights[v] = problem.Handle[v] == PinnedHandle
        ? std::numeric_limits<double>::infinity()
        : problem.Handle[v] == CurveHandle ? this->Fidelity / (1.0 - this->Fidelity)
                                           : 0.0;
    }
  }
  cartan::HoldTogether(cartan::ReadJoinedPoints(input), problem);
  return problem;
}

void vtkCurveDeformation::Deform(
  cartan::FilterRun& run, const std::shared_ptr<const cartan::Surface>& surface, Curves& curves)
{
  const cartan::HandleProblem problem = this->MakeProblem(run, *surface, curves.Path);
  cartan::ContentKey key = surface->Key;
  key.AddBytes(problem.Handle.data(), problem.Handle.size() * sizeof(int));
  key.AddBytes(
    problem.SoftWeights.data(), static_cast<std::size_t>(problem.SoftWeights.size()) * 8);
  key.AddBytes(problem.JoinedWith.data(), problem.JoinedWith.size() * sizeof(int));
  key.Add(static_cast<std::uint64_t>(this->Method));
  key.Add(static_cast<std::uint64_t>(this->CurveRotations));
  const auto prepared = run.Keep<CurvePreparation>(key,
    [&]
    {
      auto fresh = std::make_unique<CurvePreparation>();
      fresh->Deformer = cartan::NewCarryingDeformer(
        static_cast<cartan::CarryingMethod>(this->Method), this->CurveRotations,
        cartan::WithJoinedVertices(cartan::WithoutSlivers(problem, run.Context().Part(0.2, 0.25))),
        cartan::SolverBackend::Automatic, run.Context().Part(0.25, 0.7));
      return fresh;
    });
  const cartan::HandleTargets targets = cartan::CurveTargets(curves.Path, curves.Goals,
    this->CurveRotations ? curves.Vectors : cartan::Points::Zero(curves.Goals.rows(), 3));
  cartan::DeformedSurface result;
  prepared->Deformer->Deform(targets, false, result, run.Context().Part(0.7, 0.8));
  run.Warn(prepared->Deformer->GetWarning());
  curves.Deformed = std::move(result.Positions);
  this->LargestDistance =
    (Rows(curves.Deformed, curves.Path) - curves.Goals).rowwise().norm().maxCoeff();
}

bool vtkCurveDeformation::HasRidge() const
{
  return this->RidgeHeight != 0.0 || this->RidgeScale != 1.0 || this->RidgeTurn != 0.0;
}

/// Deltas, then x += h p(d / w) n for the distance d from the curve at rest.
void vtkCurveDeformation::RaiseRidge(
  cartan::FilterRun& run, const cartan::Surface& surface, Curves& curves) const
{
  const Eigen::VectorXd lengths = cartan::ArcLengths(curves.Source);
  const double width = this->RidgeWidth > 0.0
    ? this->RidgeWidth
    : 5.0 * lengths[lengths.size() - 1] / static_cast<double>(lengths.size() - 1);
  const Eigen::VectorXd distances = cartan::DistanceFromCurve(
    *surface.Mesh, *surface.Positions, { curves.Path, curves.Source }, this->ClosedCurve, width);
  if (this->RidgeScale != 1.0 || this->RidgeTurn != 0.0)
  {
    const cartan::CurveDeltas deltas = { this->RidgeScale, this->RidgeTurn * cartan::Pi / 180.0,
      width, this->SharpRidge };
    curves.Deformed = cartan::DeformByCurveDeltas(*surface.Mesh, curves.Deformed, curves.Path,
      this->ClosedCurve, distances, deltas, run.Context().Part(0.8, 0.9));
  }
  if (this->RidgeHeight == 0.0)
  {
    return;
  }
  const cartan::Points normals = cartan::VertexNormals(*surface.Mesh, curves.Deformed);
  for (Eigen::Index v = 0; v < distances.size(); ++v)
  {
    const double t = distances[v] / width;
    if (t < 1.0)
    {
      const double part = this->SharpRidge ? 1.0 - t : std::pow(1.0 - t * t, 2);
      curves.Deformed.row(v) += this->RidgeHeight * part * normals.row(v);
    }
  }
}

void vtkCurveDeformation::Execute(cartan::FilterRun& run)
{
  const auto surface = run.ReadSurface();
  Curves curves = this->ReadCurves(run, *surface);
  if (curves.Goals.rows() == 0 && !this->HasRidge())
  {
    throw Error(ErrorCode::BadInput,
      "There is no target curve and no ridge: connect a line to port 1, or set RidgeHeight.");
  }
  curves.Deformed = *surface->Positions;
  if (curves.Goals.rows() > 0)
  {
    this->Deform(run, surface, curves);
  }
  if (this->HasRidge())
  {
    this->RaiseRidge(run, *surface, curves);
  }
  this->NumberOfCurvePoints = static_cast<int>(curves.Path.size());
  run.Warn(cartan::WriteSurface(
    *surface, curves.Deformed, run.Input(), run.Output(), run.Context().Part(0.9, 1.0)));
}
