// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFrameDeformation.h"

#include "Bridge/DeformationMethod.h"

#include "Bridge/PieceVolume.h"
#include "Bridge/PointArrays.h"
#include "Kernel/Base/Constants.h"
#include "Kernel/Deformation/FrameDeformer.h"
#include "Kernel/Deformation/SliverRemoval.h"
#include "Kernel/Measure/LocalVolumes.h"
#include "Kernel/Measure/ShapeDistance.h"
#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Mesh/RayTree.h"

#include "vtkPolyData.h"

#include <limits>

namespace
{
std::unique_ptr<cartan::VolumeModel> NewModel(
  const cartan::HandleProblem& problem, const cartan::ExecutionContext& context)
{
  const cartan::TriangleMesh& mesh = *problem.GetParted();
  const cartan::RayTree tree(mesh.GetTriangles(), *problem.Rest, context.Part(0.0, 0.3));
  return std::make_unique<cartan::VolumeModel>(cartan::MeasureVolumeModel(
    mesh, *problem.Rest,
    [&tree](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
    { return tree.FirstHit(from, direction); },
    context.Part(0.3, 1.0), cartan::ComponentsInWhole(problem)));
}

/// Of the mesh without slivers: which slivers it is without depends on the handles.
/// Points that are moved to see what rounding decides have another first one.
cartan::ContentKey KeyOfModel(const cartan::HandleProblem& problem, cartan::ContentKey surface)
{
  const cartan::Triangles& triangles = problem.GetParted()->GetTriangles();
  surface.AddBytes(problem.Rest->data(), 3 * sizeof(double));
  return problem.Whole
    ? surface.AddBytes(triangles.data(), static_cast<std::size_t>(triangles.size()) * sizeof(int))
    : surface;
}

std::shared_ptr<const cartan::VolumeModel> KeepModel(const cartan::HandleProblem& problem,
  cartan::FilterRun& run, const cartan::ExecutionContext& context)
{
  return run.Keep<cartan::VolumeModel>(
    KeyOfModel(problem, run.SurfaceKey()), [&] { return NewModel(problem, context); });
}

double DiagonalOf(const cartan::HandleProblem& problem, cartan::FilterRun& run)
{
  return run.Pieces() ? run.GetDiagonal()
                      : cartan::BoundingDiagonal(*problem.Rest, problem.Mesh->GetTriangles());
}

/// The part of the volume under each vertex; NaN where none is enclosed.
Eigen::VectorXd LocalVolumesOf(const cartan::HandleProblem& problem,
  const cartan::VolumeModel& model, const cartan::LocalVolumes& volumes,
  const cartan::Points& positions, cartan::FilterRun& run)
{
  // A part that has gone with its slivers encloses nothing.
  std::vector<char> enclosesVolume(problem.GetWhole()->NumberOfComponents(), 0);
  for (std::size_t c = 0; c < model.Names.size(); ++c)
  {
    enclosesVolume[model.Names[c]] = model.EnclosesVolume[c];
  }
  cartan::MeasuredVolumes volumesNow = volumes.Measure(positions, run.Context().Part(0.97, 0.98));
  if (!(volumesNow.Rounding <= cartan::LargestVolumeRounding))
  {
    run.Warn(
      "The coordinates have no digits for LocalVolume: the surface is stretched too much for "
      "its volume. Use smaller motions, or switch GenerateVolumeArrays off.");
  }
  Eigen::VectorXd& measured = volumesNow.Values;
  for (Eigen::Index v = 0; v < positions.rows(); ++v)
  {
    const int component = problem.GetWhole()->Component(static_cast<int>(v));
    if (component >= 0 && !enclosesVolume[component])
    {
      measured[v] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return measured;
}
}

void vtkFrameDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "VolumeCorrection: " << this->VolumeCorrection << "\n";
  os << indent << "CloseVolume: " << this->CloseVolume << "\n";
  os << indent << "PositionWeights: " << this->PositionWeights << "\n";
  os << indent << "GenerateVolumeArrays: " << this->GenerateVolumeArrays << "\n";
  os << indent << "GenerateShapeDistance: " << this->GenerateShapeDistance << "\n";
  os << indent << "TabulateTurns: " << this->TabulateTurns << "\n";
  os << indent << "TurnRange: " << this->TurnRange << "\n";
  os << indent << "TurnTolerance: " << this->TurnTolerance << "\n";
  os << indent << "TabulatedRange: " << this->TabulatedRange << "\n";
  os << indent << "TabulationError: " << this->TabulationError << "\n";
}

void vtkFrameDeformation::ForgetResults()
{
  this->Superclass::ForgetResults();
  this->TabulatedRange = 0.0;
  this->TabulationError = 0.0;
}

void vtkFrameDeformation::AddSettings(cartan::ContentKey& settings) const
{
  this->Superclass::AddSettings(settings);
  settings.Add(static_cast<std::uint64_t>(this->PositionWeights));
}

cartan::DeformationMethod vtkFrameDeformation::NewMethod(const cartan::HandleProblem& problem,
  cartan::SolverBackend backend, const cartan::ExecutionContext& context)
{
  if (this->PositionWeights == LIKE_FRAMES)
  {
    return this->NewFrameMethod(problem, backend, context);
  }
  cartan::HandleProblem complete = problem;
  complete.PositionWeights =
    static_cast<cartan::LaplacianWeights>(this->PositionWeights - UNIFORM_POSITIONS);
  return this->NewFrameMethod(complete, backend, context);
}

cartan::DeformationMethod vtkFrameDeformation::FrameMethod(
  std::unique_ptr<cartan::FrameDeformer> deformer)
{
  auto* frames = deformer.get();
  cartan::DeformationMethod method;
  method.Deformer = std::move(deformer);
  method.Configure = [this, frames](cartan::FilterRun& run, const cartan::ExecutionContext& context)
  {
    this->CorrectVolume(*frames, run, context);
    this->ConfigureTable(*frames, DiagonalOf(frames->GetProblem(), run));
  };
  method.Decorate = [this, frames](const cartan::DeformedSurface& result, cartan::FilterRun& run)
  {
    if (const cartan::TurnTable* table = frames->GetUsedTable())
    {
      this->TabulatedRange = table->GetRange() / cartan::Pi * 180.0;
      this->TabulationError = table->GetError() / DiagonalOf(frames->GetProblem(), run);
    }
    this->AddVolumeArrays(*frames, result, run);
  };
  return method;
}

void vtkFrameDeformation::CorrectVolume(
  cartan::FrameDeformer& deformer, cartan::FilterRun& run, const cartan::ExecutionContext& context)
{
  static_assert(static_cast<int>(cartan::VolumeCorrection::None) == NO_CORRECTION &&
      static_cast<int>(cartan::VolumeCorrection::FrameScaling) == FRAME_SCALING &&
      static_cast<int>(cartan::VolumeCorrection::NeutralOffset) == NEUTRAL_OFFSET,
    "the enumerations agree");
  deformer.SetVolumeCorrection(static_cast<cartan::VolumeCorrection>(this->VolumeCorrection));
  deformer.SetCloseVolume(this->CloseVolume);
  if (this->UsesVolumeModel())
  {
    deformer.SetVolumeModel(run.Pieces() ? this->KeepPieceModel(run, context)
                                         : KeepModel(deformer.GetProblem(), run, context));
  }
}

std::shared_ptr<const cartan::VolumeModel> vtkFrameDeformation::KeepPieceModel(
  cartan::FilterRun& run, const cartan::ExecutionContext& context)
{
  vtkPolyData* input = run.Input();
  return run.Keep<cartan::VolumeModel>(cartan::KeyOfPiece(input),
    [&]
    {
      const auto piece = run.ReadPiece();
      if (piece->TotalNumberOfPoints > this->GetGatherLimit())
      {
        throw cartan::Error(cartan::ErrorCode::BadInput,
          "The surface has " + std::to_string(piece->TotalNumberOfPoints) +
            " points in pieces, more than GatherLimit (" + std::to_string(this->GetGatherLimit()) +
            ") lets each rank gather for VolumeCorrection, whose rays go through the whole: set "
            "VolumeCorrection to None, or raise the limit if all ranks have the memory.");
      }
      return cartan::MeasurePieceVolume(*piece, context);
    });
}

void vtkFrameDeformation::ConfigureTable(cartan::FrameDeformer& deformer, double diagonal) const
{
  deformer.SetTurnTable(this->TabulateTurns
      ? cartan::TurnTable::Options{ this->TurnRange / 180.0 * cartan::Pi,
          this->TurnTolerance * diagonal }
      : cartan::TurnTable::Options{});
}

bool vtkFrameDeformation::UsesVolumeModel() const
{
  return this->VolumeCorrection != NO_CORRECTION || this->CloseVolume || this->GenerateVolumeArrays;
}

void vtkFrameDeformation::AddVolumeArrays(const cartan::FrameDeformer& deformer,
  const cartan::DeformedSurface& result, cartan::FilterRun& run)
{
  const cartan::HandleProblem& problem = deformer.GetProblem();
  const Eigen::Index size = problem.Rest->rows();
  vtkPolyData* output = run.Output();
  if (this->UsesVolumeModel())
  {
    run.Warn(deformer.GetVolumeModel()->Warning);
  }
  if (this->GenerateVolumeArrays)
  {
    const cartan::VolumeModel& model = *deformer.GetVolumeModel();
    Eigen::VectorXd depth = Eigen::VectorXd::Zero(size);
    Eigen::VectorXd volume =
      Eigen::VectorXd::Constant(size, std::numeric_limits<double>::quiet_NaN());
    if (!model.IsEmpty())
    {
      depth = model.LocalDepth;
      cartan::MeansForRiders(problem.Riders, depth);
      const auto volumes = run.Keep<cartan::LocalVolumes>(run.SurfaceKey(),
        [&]
        {
          return std::make_unique<cartan::LocalVolumes>(
            problem.GetWhole(), *problem.Rest, run.Context().Part(0.95, 0.97));
        });
      volume = LocalVolumesOf(problem, model, *volumes, result.Positions, run);
    }
    cartan::AddPointArray(output, "LocalDepth", depth);
    cartan::AddPointArray(output, "LocalVolume", volume);
    cartan::AddPointArray(output, "VolumeScale", result.FrameScale);
  }
  if (this->GenerateShapeDistance)
  {
    const cartan::ShapeDistance distance = cartan::ShapeDistanceOfRotations(
      *problem.GetWhole(), *problem.Rest, result.Transforms, run.Context().Part(0.98, 1.0));
    cartan::AddPointArray(output, "ShapeDistanceDensity", distance.Density);
    cartan::AddFieldValue(output, "ShapeDistance", distance.Total);
  }
}
