// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDeformation.h"

#include "Bridge/DeformationInput.h"
#include "Bridge/MotionTable.h"
#include "Bridge/Preparation.h"
#include "Bridge/PreparedSurface.h"
#include "Bridge/TransformArrays.h"
#include "Kernel/Algebra/ConstrainedSolver.h"
#include "Kernel/Deformation/HandleCurve.h"
#include "Kernel/Deformation/JoinedVertices.h"
#include "Kernel/Deformation/RoundingCheck.h"
#include "Kernel/Deformation/SliverRemoval.h"
#include "vtkHandleMotion.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTimerLog.h"

#include <algorithm>

using cartan::Error;
using cartan::ErrorCode;

namespace
{
/// More boxes than anybody grasps one by one; each update sends them to the window.
constexpr vtkIdType MaximumNumberOfBounds = 1000;

/// On the mesh that is solved on.
cartan::HandleProblem Reduced(
  const cartan::HandleProblem& problem, const cartan::ExecutionContext& context)
{
  return cartan::WithJoinedVertices(cartan::WithoutSlivers(problem, context));
}
}

class vtkSurfaceDeformation::Internals
{
public:
  vtkNew<vtkDoubleArray> HandleBounds;
  cartan::MotionTable Motions;
  int Factorizations = 0;
  int FreePoints = 0;
  double SetupTime = 0.0;
  double MotionTime = 0.0;
};

vtkSurfaceDeformation::vtkSurfaceDeformation()
  : State(std::make_unique<Internals>())
{
}

vtkSurfaceDeformation::~vtkSurfaceDeformation() = default;

void vtkSurfaceDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "HandleArrayName: " << this->HandleArrayName << "\n";
  os << indent << "TargetPositionArrayName: " << this->TargetPositionArrayName << "\n";
  os << indent << "RotationVectorArrayName: " << this->RotationVectorArrayName << "\n";
  os << indent << "TransformArrayName: " << this->TransformArrayName << "\n";
  os << indent << "ConstraintWeightArrayName: " << this->ConstraintWeightArrayName << "\n";
  os << indent << "ScaleConstraintWeights: " << this->ScaleConstraintWeights << "\n";
  os << indent << "ActiveHandle: " << this->ActiveHandle << "\n";
  os << indent << "ConstrainHandlePositions: " << this->ConstrainHandlePositions << "\n";
  os << indent << "LaplacianWeights: " << this->LaplacianWeights << "\n";
  os << indent << "Solver: " << this->Solver << "\n";
  os << indent << "RoundingCheckLimit: " << this->RoundingCheckLimit << "\n";
  os << indent << "GenerateFrameChange: " << this->GenerateFrameChange << "\n";
  os << indent << "GenerateRotationVector: " << this->GenerateRotationVector << "\n";
  os << indent << "Motions: " << this->State->Motions.ById.size() << "\n";
  for (const auto& [id, motion] : this->State->Motions.ById)
  {
    os << indent << "Motion of handle " << id << ":\n";
    motion->PrintSelf(os, indent.GetNextIndent());
  }
  os << indent << "ActiveMotion: " << (this->State->Motions.Active ? "set" : "(none)") << "\n";
  os << indent << "MotionRows: " << this->State->Motions.Rows.size() << "\n";
}

void vtkSurfaceDeformation::SetHandleMotion(int id, vtkHandleMotion* motion)
{
  if (id < 1)
  {
    vtkErrorMacro("Handle ids are >= 1; got " << id << ".");
    return;
  }
  if (this->GetHandleMotion(id) == motion)
  {
    return;
  }
  if (motion)
  {
    this->State->Motions.ById[id] = motion;
  }
  else
  {
    this->State->Motions.ById.erase(id);
  }
  this->Modified();
}

vtkHandleMotion* vtkSurfaceDeformation::GetHandleMotion(int id) const
{
  const auto found = this->State->Motions.ById.find(id);
  return found == this->State->Motions.ById.end() ? nullptr : found->second.Get();
}

void vtkSurfaceDeformation::RemoveHandleMotion(int id)
{
  if (this->State->Motions.ById.erase(id))
  {
    this->Modified();
  }
}

void vtkSurfaceDeformation::RemoveAllHandleMotions()
{
  if (!this->State->Motions.ById.empty() || this->State->Motions.Active)
  {
    this->State->Motions.ById.clear();
    this->State->Motions.Active = nullptr;
    this->Modified();
  }
}

void vtkSurfaceDeformation::SetActiveHandle(int id)
{
  if (id < 1)
  {
    vtkErrorMacro("Handle ids are >= 1; got " << id << ".");
    return;
  }
  this->SetMember(this->ActiveHandle, id);
}

void vtkSurfaceDeformation::SetActiveMotion(vtkHandleMotion* motion)
{
  this->SetMember(this->State->Motions.Active, motion);
}

vtkHandleMotion* vtkSurfaceDeformation::GetActiveMotion() const
{
  return this->State->Motions.Active;
}

void vtkSurfaceDeformation::SetNumberOfMotionRows(int count)
{
  if (count < 0 || count > cartan::MotionTable::MaximumNumberOfRows)
  {
    vtkErrorMacro("The motions' table has 0 to " << cartan::MotionTable::MaximumNumberOfRows
                                                 << " rows; got " << count << ".");
    return;
  }
  if (count == this->GetNumberOfMotionRows())
  {
    return;
  }
  this->State->Motions.ResizeRows(count);
  this->Modified();
}

int vtkSurfaceDeformation::GetNumberOfMotionRows() const
{
  return static_cast<int>(this->State->Motions.Rows.size());
}

void vtkSurfaceDeformation::SetMotionRow(int row, double id, double scaleX, double scaleY,
  double scaleZ, double angle, double axisX, double axisY, double axisZ, double centerX,
  double centerY, double centerZ, double translationX, double translationY, double translationZ)
{
  if (row < 0 || row >= cartan::MotionTable::MaximumNumberOfRows)
  {
    vtkErrorMacro("Rows are numbered from 0 to " << cartan::MotionTable::MaximumNumberOfRows - 1
                                                 << "; got " << row << ".");
    return;
  }
  this->SetNumberOfMotionRows(std::max(row + 1, this->GetNumberOfMotionRows()));
  cartan::MotionTable::Row& target = this->State->Motions.Rows[row];
  if (target.Id != id)
  {
    target.Id = id;
    this->Modified();
  }
  target.SetMotion(angle, { scaleX, scaleY, scaleZ }, { axisX, axisY, axisZ },
    { centerX, centerY, centerZ }, { translationX, translationY, translationZ });
}

int vtkSurfaceDeformation::GetNumberOfFactorizations() const
{
  return this->State->Factorizations;
}

int vtkSurfaceDeformation::GetNumberOfFreePoints() const
{
  return this->State->FreePoints;
}

double vtkSurfaceDeformation::GetSetupTime() const
{
  return this->State->SetupTime;
}

double vtkSurfaceDeformation::GetMotionTime() const
{
  return this->State->MotionTime;
}

vtkDataObject* vtkSurfaceDeformation::InputIfAny()
{
  return this->GetNumberOfInputConnections(0) ? this->GetInputDataObject(0, 0) : nullptr;
}

double* vtkSurfaceDeformation::GetActiveHandleBounds()
{
  vtkMath::UninitializeBounds(this->ActiveHandleBounds);
  const auto boxes = cartan::WidgetBoxes(this->InputIfAny(), this->HandleArrayName);
  const auto found = boxes.find(this->ActiveHandle);
  if (found != boxes.end())
  {
    found->second.GetBounds(this->ActiveHandleBounds);
  }
  return this->ActiveHandleBounds;
}

vtkDoubleArray* vtkSurfaceDeformation::GetHandleBounds()
{
  cartan::WriteBoxes(cartan::WidgetBoxes(this->InputIfAny(), this->HandleArrayName),
    MaximumNumberOfBounds, this->State->HandleBounds);
  return this->State->HandleBounds;
}

vtkMTimeType vtkSurfaceDeformation::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->State->Motions.GetMTime());
}

void vtkSurfaceDeformation::ForgetResults()
{
  this->State->FreePoints = 0;
  this->State->SetupTime = 0.0;
  this->State->MotionTime = 0.0;
}

void vtkSurfaceDeformation::AddSettings(cartan::ContentKey& settings) const
{
  settings.Add(static_cast<std::uint64_t>(this->LaplacianWeights));
  settings.Add(static_cast<std::uint64_t>(this->Solver));
  settings.Add(static_cast<std::uint64_t>(this->ConstrainHandlePositions));
  settings.Add(static_cast<std::uint64_t>(this->ScaleConstraintWeights));
}

bool vtkSurfaceDeformation::SettingsServePieces() const
{
  return (this->Solver == AUTOMATIC_SOLVER || this->Solver == CONJUGATE_GRADIENTS) &&
    !this->ScaleConstraintWeights && this->TargetPositionArrayName.empty() &&
    this->RotationVectorArrayName.empty() && this->TransformArrayName.empty();
}

cartan::HandleProblem vtkSurfaceDeformation::MakeProblem(cartan::FilterRun& run,
  const cartan::DeformationInput& read, const cartan::Handles& handles, std::vector<int> moving)
{
  static_assert(static_cast<int>(cartan::LaplacianWeights::Uniform) == UNIFORM &&
      static_cast<int>(cartan::LaplacianWeights::Cotangent) == COTANGENT &&
      static_cast<int>(cartan::LaplacianWeights::MeanValue) == MEAN_VALUE,
    "the enumerations agree");
  vtkPolyData* input = run.Input();
  cartan::HandleProblem problem;
  problem.Mesh = read.TheSurface->Mesh;
  problem.Rest = read.TheSurface->Positions;
  problem.Handle = handles.OfVertex;
  problem.Moving = std::move(moving);
  problem.Weights = static_cast<cartan::LaplacianWeights>(this->LaplacianWeights);
  problem.PositionWeights = problem.Weights;
  problem.ConstrainPositions = this->ConstrainHandlePositions;
  const std::string& weights = this->ConstraintWeightArrayName;
  if (read.Piece)
  {
    cartan::RequirePiecesServe(run, *read.Piece, this->GetGatherLimit());
    problem.Pieces = read.Piece->Rows;
    if (!weights.empty())
    {
      problem.SoftWeights =
        cartan::ReadPieceWeights(input, *read.Piece, *run.Pieces(), weights, handles);
    }
    return problem;
  }
  if (!weights.empty())
  {
    problem.SoftWeights = cartan::ReadSoftWeights(input, weights, handles);
  }
  cartan::HoldTogether(cartan::ReadJoinedPoints(input), problem);
  if (this->ScaleConstraintWeights)
  {
    cartan::ScaleSoftWeights(problem);
  }
  return problem;
}

std::shared_ptr<cartan::Preparation> vtkSurfaceDeformation::Prepare(cartan::FilterRun& run,
  const cartan::DeformationInput& read, const cartan::Handles& handles,
  const std::vector<int>& moving, cartan::ContentKey key)
{
  vtkPolyData* input = run.Input();
  key.AddBytes(moving.data(), moving.size() * sizeof(int));
  key.Add(this->ConstraintWeightArrayName);
  key.Add(cartan::KeyOfPointArray(input, this->ConstraintWeightArrayName).GetValue());
  key.Add(cartan::KeyOfPointArray(input, cartan::JoinedPoints).GetValue());
  this->AddSettings(key);
  const bool isChecked = !read.Piece && input->GetNumberOfPoints() <= this->RoundingCheckLimit;
  key.Add(static_cast<std::uint64_t>(isChecked));
  const auto make = [this](cartan::HandleProblem problem, const cartan::ExecutionContext& context)
  {
    auto fresh = std::make_unique<cartan::Preparation>();
    fresh->Problem = std::move(problem);
    fresh->Method =
      this->NewMethod(fresh->Problem, static_cast<cartan::SolverBackend>(this->Solver), context);
    return fresh;
  };
  return run.Keep<cartan::Preparation>(key,
    [&]
    {
      const double end = 0.75 * this->ProgressBeforeMotion();
      const double middle = isChecked ? 0.5 * (0.12 + end) : end;
      const cartan::HandleProblem problem = this->MakeProblem(run, read, handles, moving);
      auto fresh = make(read.Piece ? problem : Reduced(problem, run.Context().Part(0.1, 0.12)),
        run.Context().Part(0.12, middle));
      this->State->Factorizations += fresh->Method.Deformer->GetNumberOfFactorizations();
      if (isChecked)
      {
        fresh->Moved =
          make(Reduced(cartan::WithMovedPoints(problem), {}), run.Context().Part(middle, end));
      }
      return fresh;
    });
}

void vtkSurfaceDeformation::Execute(cartan::FilterRun& run)
{
  try
  {
    this->Deform(run);
  }
  catch (const Error& error)
  {
    throw Error(error.GetCode(), error.what() + this->DescribeRemedy(error.GetCode()));
  }
}

std::string vtkSurfaceDeformation::DescribeRemedy(cartan::ErrorCode code) const
{
  // What is held next to nothing leaves a matrix that is nearly singular, and so do
  // differences of high order between handles that are far from each other.
  if (code == ErrorCode::NotPositiveDefinite)
  {
    return this->ConstraintWeightArrayName.empty()
      ? " Hold more points, or use a method of order 1, such as Rotation Invariant Deformation."
      : " Raise constraint weights near 0.";
  }
  return code == ErrorCode::SolverFailed ? " Choose another Solver." : "";
}

void vtkSurfaceDeformation::Deform(cartan::FilterRun& run)
{
  static_assert(static_cast<int>(cartan::SolverBackend::Automatic) == AUTOMATIC_SOLVER &&
      static_cast<int>(cartan::SolverBackend::Eigen) == EIGEN &&
      static_cast<int>(cartan::SolverBackend::Cholmod) == CHOLMOD &&
      static_cast<int>(cartan::SolverBackend::ConjugateGradients) == CONJUGATE_GRADIENTS,
    "the enumerations agree");
  const double start = vtkTimerLog::GetUniversalTime();
  vtkPolyData* input = run.Input();
  const cartan::DeformationInput read = cartan::ReadDeformationInput(run);
  const cartan::Surface& surface = *read.TheSurface;
  cartan::ContentKey key = surface.Key;
  key.Add(this->HandleArrayName);
  key.Add(cartan::KeyOfPointArray(input, this->HandleArrayName).GetValue());
  const auto handles = cartan::KeepHandles(run, read, this->HandleArrayName, key);
  const cartan::MotionsById motions = this->State->Motions.Collect(this->ActiveHandle);
  cartan::RequireMeaningfulMotions(motions, *handles);
  const auto arrays = this->KeepHandleArrays(run, surface, *handles, key);
  const std::vector<int> moving = cartan::MovingHandles(*arrays, motions);
  const cartan::HandleTargets targets =
    cartan::MakeTargets(surface, moving, motions, *handles, *arrays);
  this->RequireTargets(targets);
  const auto prepared = this->Prepare(run, read, *handles, moving, key);
  cartan::SurfaceDeformer& deformer = *prepared->Method.Deformer;
  const int factorizations = deformer.GetNumberOfFactorizations();
  const double motion = this->ProgressBeforeMotion();
  cartan::Configure(*prepared, run, run.Context().Part(0.75 * motion, motion));
  const double ready = vtkTimerLog::GetUniversalTime();
  cartan::ComparedFields fields;
  fields.Transforms =
    this->GenerateFrameChange || this->GenerateRotationVector || this->NeedsTransforms();
  fields.Rotations = this->GenerateRotationVector;
  fields.Normals = input->GetPointData()->GetNormals() || input->GetCellData()->GetNormals();
  const auto move = [&]
  {
    cartan::DeformAndWrite(*prepared, targets, fields, this->NeedsPositions(), surface, run,
      run.Context().Part(motion, 0.95));
  };
  if (read.Piece && deformer.IsLocal(targets))
  {
    run.Alone(move);
  }
  else
  {
    run.Together(move);
  }
  this->State->Factorizations += deformer.GetNumberOfFactorizations() - factorizations;

  run.Warn(cartan::AddTransformArrays(
    prepared->Result, this->GenerateFrameChange, this->GenerateRotationVector, run.Output()));
  prepared->Method.Decorate(prepared->Result, run);
  this->State->FreePoints = deformer.GetNumberOfFreeVertices();
  this->State->SetupTime = ready - start;
  this->State->MotionTime = vtkTimerLog::GetUniversalTime() - ready;
}

std::shared_ptr<cartan::HandleArrays> vtkSurfaceDeformation::KeepHandleArrays(
  cartan::FilterRun& run, const cartan::Surface& surface, const cartan::Handles& handles,
  cartan::ContentKey key) const
{
  const cartan::HandleArrayNames names{ this->TargetPositionArrayName,
    this->RotationVectorArrayName, this->TransformArrayName };
  if (names.AreEmpty())
  {
    return std::make_shared<cartan::HandleArrays>();
  }
  for (const std::string& name : { names.Positions, names.RotationVectors, names.Transforms })
  {
    key.Add(name);
    key.Add(cartan::KeyOfPointArray(run.Input(), name).GetValue());
  }
  return run.Keep<cartan::HandleArrays>(key,
    [&]
    {
      return std::make_unique<cartan::HandleArrays>(
        cartan::ReadHandleArrays(run.Input(), surface, handles, names));
    });
}
