// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDeformation.h"

#include "Kernel/Algebra/ConstrainedSolver.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/HandleCurve.h"
#include "Kernel/Deformation/HandleProblem.h"
#include "Kernel/Deformation/SurfaceDeformer.h"
#include "KernelBridge.h"
#include "vtkHandleMotion.h"

#include "vtkBoundingBox.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTimerLog.h"

#include <algorithm>
#include <cmath>
#include <list>
#include <map>
#include <set>

using cartan::Error;
using cartan::ErrorCode;

namespace
{
/// Composite inputs with more blocks than this read some of them anew with each
/// motion; fewer would do so sooner, more would hold more memory.
constexpr std::size_t MaximumNumberOfSessions = 32;

/// The motions of one update, by handle id.
using MotionsById = std::map<int, vtkHandleMotion*>;

/// What is kept of one surface between motions.
struct Session
{
  std::shared_ptr<const cartan::Surface> Surface;
  cartan::HandleProblem Problem;
  cartan::SolverBackend Backend = cartan::SolverBackend::Automatic;
  std::unique_ptr<cartan::SurfaceDeformer> Deformer;
  cartan::DeformedSurface Result;
};

/// The handle of each point; 0 for points in no triangle, which never move.
std::vector<int> ReadHandles(
  vtkPolyData* input, const cartan::TriangleMesh& mesh, const std::string& name)
{
  if (!input->GetPointData()->HasArray(name.c_str()))
  {
    throw Error(ErrorCode::BadInput,
      "The input has no point array \"" + name +
        "\" that says which points are handles: mark some with vtkMarkHandle (Mark Handle), or "
        "set HandleArrayName.");
  }
  vtkDataArray* array = cartan::RequirePointArray(input, name, 1);
  std::vector<int> handles(mesh.NumberOfVertices(), 0);
  cartan::IdSample bad;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const double value = array->GetTuple1(v);
    if (!(value >= 0.0 && value <= VTK_INT_MAX && value == std::floor(value)))
    {
      bad.Add(v);
    }
    else if (mesh.IsUsed(v))
    {
      handles[v] = static_cast<int>(value);
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The point array \"" + name + "\" has " + bad.Describe("value", "values") +
        " that are no whole numbers >= 0: 0 is free, k >= 1 belongs to handle k.");
  }
  return handles;
}

/// A point array as a field, required to be finite at the handles' points.
cartan::Field ReadHandleValues(
  vtkPolyData* input, const std::string& name, int components, const std::vector<int>& handles)
{
  vtkDataArray* array = cartan::RequirePointArray(input, name, components);
  cartan::Field values(static_cast<Eigen::Index>(handles.size()), components);
  cartan::IdSample bad;
  for (std::size_t v = 0; v < handles.size(); ++v)
  {
    array->GetTuple(static_cast<vtkIdType>(v), values.row(v).data());
    if (handles[v] > 0 && !values.row(v).allFinite())
    {
      bad.Add(static_cast<long long>(v));
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The point array \"" + name + "\" has " + bad.Describe("handle point", "handle points") +
        " with a NaN or infinite value.");
  }
  return values;
}

Eigen::VectorXd ReadSoftWeights(
  vtkPolyData* input, const std::string& name, const std::vector<int>& handles)
{
  vtkDataArray* array = cartan::RequirePointArray(input, name, 1);
  Eigen::VectorXd weights(static_cast<Eigen::Index>(handles.size()));
  cartan::IdSample bad;
  for (std::size_t v = 0; v < handles.size(); ++v)
  {
    // Those of free points mean nothing: they must not look like a change.
    weights[v] = handles[v] > 0 ? array->GetTuple1(static_cast<vtkIdType>(v)) : 0.0;
    if (!(weights[v] >= 0.0))
    {
      bad.Add(static_cast<long long>(v));
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The point array \"" + name + "\" has " + bad.Describe("handle point", "handle points") +
        " with a weight that is negative or NaN: 0 does not hold, infinity holds exactly.");
  }
  return weights;
}

std::string ListIds(const std::set<int>& ids)
{
  std::string text;
  for (const int id : ids)
  {
    text += (text.empty() ? "" : ", ") + std::to_string(id);
  }
  return text;
}

/// Throws for motions that move nothing or are no map.
void RequireMeaningfulMotions(const MotionsById& motions, const std::vector<int>& handles)
{
  std::set<int> present(handles.begin(), handles.end());
  present.erase(0);
  for (const auto& [id, motion] : motions)
  {
    if (!present.count(id))
    {
      throw Error(ErrorCode::BadInput,
        "Handle " + std::to_string(id) +
          " has a motion, but no point in a triangle belongs to it. " +
          (present.empty() ? std::string("No point belongs to any handle")
                           : "Handles with points: " + ListIds(present)) +
          ". Mark points for it or remove the motion.");
    }
    const std::string problem = motion->GetProblem();
    if (!problem.empty())
    {
      throw Error(
        ErrorCode::BadInput, "The motion of handle " + std::to_string(id) + ": " + problem);
    }
  }
}

/// The per-point arrays, empty where not used.
struct HandleArrays
{
  cartan::Field Positions;       // n x 3, relative to the surface's origin
  cartan::Field RotationVectors; // n x 3
  cartan::Field Transforms;      // n x 9, row by row
};

/// Whether the arrays leave a point as it is.
bool IsAtRest(const HandleArrays& arrays, const cartan::Points& rest, int v)
{
  return (arrays.Positions.rows() == 0 || arrays.Positions.row(v) == rest.row(v)) &&
    (arrays.RotationVectors.rows() == 0 || arrays.RotationVectors.row(v).isZero(0.0)) &&
    (arrays.Transforms.rows() == 0 ||
      Eigen::Map<const Eigen::Matrix3d>(arrays.Transforms.row(v).data()).isIdentity(0.0));
}

cartan::HandleMotion ToKernel(vtkHandleMotion* motion, const Eigen::Vector3d& origin)
{
  vtkNew<vtkMatrix4x4> transform;
  motion->GetTransformRelativeTo(origin.data(), transform);
  cartan::HandleMotion result;
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      result.Linear(row, column) = transform->GetElement(row, column);
    }
    result.Translation[row] = transform->GetElement(row, 3);
  }
  motion->GetRotationVector(result.RotationVector.data());
  return result;
}

/// Per-vertex targets where handles without a motion move by arrays.
void AddPerVertexTargets(const HandleArrays& arrays, const cartan::HandleProblem& problem,
  const MotionsById& motions, cartan::HandleTargets& targets)
{
  const cartan::Points& rest = *problem.Rest;
  targets.Positions = rest;
  targets.RotationVectors = cartan::Points::Zero(rest.rows(), 3);
  targets.Transforms.resize(rest.rows(), 9);
  for (Eigen::Index v = 0; v < rest.rows(); ++v)
  {
    auto transform = cartan::MatrixAt(targets.Transforms, v);
    transform.setIdentity();
    const auto moving =
      std::lower_bound(problem.Moving.begin(), problem.Moving.end(), problem.Handle[v]);
    if (moving == problem.Moving.end() || *moving != problem.Handle[v])
    {
      continue;
    }
    if (motions.count(*moving))
    {
      const cartan::HandleMotion& motion = targets.Motions[moving - problem.Moving.begin()];
      targets.Positions.row(v) =
        (motion.Linear * rest.row(v).transpose() + motion.Translation).transpose();
      targets.RotationVectors.row(v) = motion.RotationVector.transpose();
      transform = motion.Linear;
      continue;
    }
    if (arrays.Positions.rows())
    {
      targets.Positions.row(v) = arrays.Positions.row(v);
    }
    if (arrays.RotationVectors.rows())
    {
      targets.RotationVectors.row(v) = arrays.RotationVectors.row(v);
      transform = cartan::RotationFromVector(arrays.RotationVectors.row(v).transpose());
    }
    if (arrays.Transforms.rows())
    {
      transform = Eigen::Map<const Eigen::Matrix3d>(arrays.Transforms.row(v).data()).transpose();
      targets.RotationVectors.row(v) =
        cartan::VectorFromRotation(cartan::ProjectOnRotations(transform)).transpose();
    }
  }
}

/// Whether a deformer for `old` serves `problem` too: a handle that may move
/// need not.
bool Serves(const cartan::HandleProblem& old, const cartan::HandleProblem& problem)
{
  return old.Handle == problem.Handle && old.Weights == problem.Weights &&
    old.ConstrainPositions == problem.ConstrainPositions &&
    old.SoftWeights.size() == problem.SoftWeights.size() &&
    old.SoftWeights == problem.SoftWeights &&
    (problem.ConstrainPositions ? std::includes(old.Moving.begin(), old.Moving.end(),
                                    problem.Moving.begin(), problem.Moving.end())
                                : old.Moving == problem.Moving);
}

/// The box around the points of handle `id`; invalid if there are none.
vtkBoundingBox BoundsOfHandle(vtkPolyData* surface, const std::string& arrayName, int id)
{
  vtkBoundingBox bounds;
  vtkDataArray* handles = surface->GetPointData()->GetArray(arrayName.c_str());
  const vtkIdType count =
    handles ? std::min(handles->GetNumberOfTuples(), surface->GetNumberOfPoints()) : 0;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (handles->GetComponent(i, 0) == id)
    {
      bounds.AddPoint(surface->GetPoint(i));
    }
  }
  return bounds;
}

/// Makes no side shorter than a tenth of the longest, and the box a little larger
/// than what it holds; `length` is the longest side of a box that is a point.
void Widen(vtkBoundingBox& bounds, double length)
{
  const double longest = bounds.GetMaxLength() > 0.0 ? bounds.GetMaxLength() : length;
  double margins[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    margins[axis] = std::max(0.02 * longest, 0.5 * (0.1 * longest - bounds.GetLength(axis)));
  }
  bounds.Inflate(margins[0], margins[1], margins[2]);
}

void AddTransformArrays(
  const cartan::DeformedSurface& result, bool frameChange, bool rotationVector, vtkPolyData* output)
{
  const Eigen::Index size = result.Transforms.rows();
  if (frameChange)
  {
    Eigen::VectorXd change(size);
    for (Eigen::Index v = 0; v < size; ++v)
    {
      change[v] = (cartan::MatrixAt(result.Transforms, v) - Eigen::Matrix3d::Identity()).norm();
    }
    cartan::AddPointArray(output, "FrameChange", change.data(), size, 1);
  }
  if (rotationVector)
  {
    cartan::Points vectors(size, 3);
    for (Eigen::Index v = 0; v < size; ++v)
    {
      vectors.row(v) = cartan::VectorFromRotation(
        cartan::ProjectOnRotations(cartan::MatrixAt(result.Transforms, v)))
                         .transpose();
    }
    cartan::AddPointArray(output, "RotationVector", vectors.data(), size, 3);
  }
}
}

class vtkSurfaceDeformation::Internals
{
public:
  std::map<int, vtkSmartPointer<vtkHandleMotion>> Motions;
  struct Row
  {
    double Id = 0.0;
    vtkNew<vtkHandleMotion> Motion;
  };
  std::vector<std::unique_ptr<Row>> Rows;

  /// Most recently used first.
  std::list<Session> Sessions;

  int Factorizations = 0;
  int FreePoints = 0;
  double SetupTime = 0.0;
  double MotionTime = 0.0;

  MotionsById GetMotions() const
  {
    MotionsById motions;
    for (const auto& [id, motion] : this->Motions)
    {
      motions[id] = motion;
    }
    for (const auto& row : this->Rows)
    {
      const int id = static_cast<int>(row->Id);
      if (id < 1 || id != row->Id)
      {
        throw Error(ErrorCode::BadInput,
          "A row of the motions' table names handle " + std::to_string(row->Id) +
            ": ids are whole numbers >= 1.");
      }
      if (!motions.emplace(id, row->Motion).second)
      {
        throw Error(ErrorCode::BadInput,
          "Handle " + std::to_string(id) +
            " has two motions: remove one, or its row from the motions' table.");
      }
    }
    return motions;
  }

  /// The session of the input's surface, at the front of the list.
  Session& FindSession(vtkAlgorithm* filter, vtkPolyData* input)
  {
    auto found = std::find_if(this->Sessions.begin(), this->Sessions.end(),
      [input](const Session& session)
      { return cartan::IsSameSurface(session.Surface->ReadFrom, input); });
    if (found == this->Sessions.end())
    {
      Session session;
      session.Surface = std::make_shared<const cartan::Surface>(cartan::ReadSurface(input));
      cartan::Warn(filter, session.Surface->Warning);
      this->Sessions.push_front(std::move(session));
      if (this->Sessions.size() > MaximumNumberOfSessions)
      {
        this->Sessions.pop_back();
      }
    }
    else
    {
      this->Sessions.splice(this->Sessions.begin(), this->Sessions, found);
    }
    return this->Sessions.front();
  }
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
  os << indent << "GenerateFrameChange: " << this->GenerateFrameChange << "\n";
  os << indent << "GenerateRotationVector: " << this->GenerateRotationVector << "\n";
  os << indent << "Motions: " << this->State->Motions.size() << "\n";
  for (const auto& [id, motion] : this->State->Motions)
  {
    os << indent << "Motion of handle " << id << ":\n";
    motion->PrintSelf(os, indent.GetNextIndent());
  }
  os << indent << "MotionRows: " << this->State->Rows.size() << "\n";
}

void vtkSurfaceDeformation::SetName(std::string& member, const std::string& name)
{
  if (member != name)
  {
    member = name;
    this->Modified();
  }
}

void vtkSurfaceDeformation::SetHandleArrayName(const std::string& name)
{
  this->SetName(this->HandleArrayName, name);
}

void vtkSurfaceDeformation::SetTargetPositionArrayName(const std::string& name)
{
  this->SetName(this->TargetPositionArrayName, name);
}

void vtkSurfaceDeformation::SetRotationVectorArrayName(const std::string& name)
{
  this->SetName(this->RotationVectorArrayName, name);
}

void vtkSurfaceDeformation::SetTransformArrayName(const std::string& name)
{
  this->SetName(this->TransformArrayName, name);
}

void vtkSurfaceDeformation::SetConstraintWeightArrayName(const std::string& name)
{
  this->SetName(this->ConstraintWeightArrayName, name);
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
    this->State->Motions[id] = motion;
  }
  else
  {
    this->State->Motions.erase(id);
  }
  this->Modified();
}

vtkHandleMotion* vtkSurfaceDeformation::GetHandleMotion(int id) const
{
  const auto found = this->State->Motions.find(id);
  return found == this->State->Motions.end() ? nullptr : found->second.Get();
}

void vtkSurfaceDeformation::RemoveHandleMotion(int id)
{
  if (this->State->Motions.erase(id))
  {
    this->Modified();
  }
}

void vtkSurfaceDeformation::RemoveAllHandleMotions()
{
  if (!this->State->Motions.empty())
  {
    this->State->Motions.clear();
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
  if (id != this->ActiveHandle)
  {
    // The active motion goes with the active handle.
    vtkSmartPointer<vtkHandleMotion> motion = this->GetActiveMotion();
    this->RemoveHandleMotion(this->ActiveHandle);
    this->ActiveHandle = id;
    if (motion)
    {
      this->State->Motions[id] = motion;
    }
    this->Modified();
  }
}

void vtkSurfaceDeformation::SetActiveMotion(vtkHandleMotion* motion)
{
  this->SetHandleMotion(this->ActiveHandle, motion);
}

vtkHandleMotion* vtkSurfaceDeformation::GetActiveMotion() const
{
  return this->GetHandleMotion(this->ActiveHandle);
}

void vtkSurfaceDeformation::SetNumberOfMotionRows(int count)
{
  if (count < 0 || count == this->GetNumberOfMotionRows())
  {
    return;
  }
  this->State->Rows.resize(count);
  for (auto& row : this->State->Rows)
  {
    if (!row)
    {
      row = std::make_unique<Internals::Row>();
    }
  }
  this->Modified();
}

int vtkSurfaceDeformation::GetNumberOfMotionRows() const
{
  return static_cast<int>(this->State->Rows.size());
}

void vtkSurfaceDeformation::SetMotionRow(int row, double id, double scaleX, double scaleY,
  double scaleZ, double angle, double axisX, double axisY, double axisZ, double centerX,
  double centerY, double centerZ, double translationX, double translationY, double translationZ)
{
  if (row < 0)
  {
    vtkErrorMacro("Rows are numbered from 0; got " << row << ".");
    return;
  }
  this->SetNumberOfMotionRows(std::max(row + 1, this->GetNumberOfMotionRows()));
  Internals::Row& target = *this->State->Rows[row];
  if (target.Id != id)
  {
    target.Id = id;
    this->Modified();
  }
  target.Motion->SetScale(scaleX, scaleY, scaleZ);
  target.Motion->SetAngle(angle);
  target.Motion->SetAxis(axisX, axisY, axisZ);
  target.Motion->SetCenter(centerX, centerY, centerZ);
  target.Motion->SetTranslation(translationX, translationY, translationZ);
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

double* vtkSurfaceDeformation::GetActiveHandleBounds()
{
  vtkBoundingBox handle;
  vtkBoundingBox all;
  const auto add = [&](vtkPolyData* surface)
  {
    if (surface && surface->GetNumberOfPoints() > 0)
    {
      handle.AddBox(BoundsOfHandle(surface, this->HandleArrayName, this->ActiveHandle));
      all.AddBounds(surface->GetBounds());
    }
  };
  vtkDataObject* input =
    this->GetNumberOfInputConnections(0) ? this->GetInputDataObject(0, 0) : nullptr;
  add(vtkPolyData::SafeDownCast(input));
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(input))
  {
    auto blocks = vtk::TakeSmartPointer(composite->NewIterator());
    for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
    {
      add(vtkPolyData::SafeDownCast(blocks->GetCurrentDataObject()));
    }
  }
  vtkBoundingBox bounds(0.0, 1.0, 0.0, 1.0, 0.0, 1.0);
  if (all.IsValid())
  {
    bounds = handle.IsValid() ? handle : all;
    Widen(bounds, all.GetMaxLength());
  }
  bounds.GetBounds(this->ActiveHandleBounds);
  return this->ActiveHandleBounds;
}

vtkMTimeType vtkSurfaceDeformation::GetMTime()
{
  vtkMTimeType time = this->Superclass::GetMTime();
  for (const auto& entry : this->State->Motions)
  {
    time = std::max(time, entry.second->GetMTime());
  }
  for (const auto& row : this->State->Rows)
  {
    time = std::max(time, row->Motion->GetMTime());
  }
  return time;
}

void vtkSurfaceDeformation::DecorateOutput(const cartan::HandleProblem&, cartan::SurfaceDeformer&,
  const cartan::DeformedSurface&, vtkPolyData*, const cartan::ExecutionContext&)
{
}

void vtkSurfaceDeformation::ForgetDeformers()
{
  for (Session& session : this->State->Sessions)
  {
    session.Deformer.reset();
  }
}

int vtkSurfaceDeformation::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  return cartan::RunGuarded(this,
    [this, input, output]()
    {
      const double start = vtkTimerLog::GetUniversalTime();
      const cartan::ExecutionContext context = cartan::MakeContext(this);
      Session& session = this->State->FindSession(this, input);
      const auto surface = session.Surface;

      cartan::HandleProblem problem;
      problem.Mesh = { surface, &surface->Mesh };
      problem.Rest = { surface, &surface->Positions };
      problem.Handle = ReadHandles(input, surface->Mesh, this->HandleArrayName);
      if (!this->ConstraintWeightArrayName.empty())
      {
        problem.SoftWeights =
          ReadSoftWeights(input, this->ConstraintWeightArrayName, problem.Handle);
        if (this->ScaleConstraintWeights)
        {
          const Eigen::ArrayXd shares =
            cartan::HandleCurveShares(surface->Mesh, surface->Positions, problem.Handle);
          const Eigen::ArrayXd weights = problem.SoftWeights;
          problem.SoftWeights = weights.isInf().select(weights, weights * shares.sqrt());
        }
      }
      static_assert(static_cast<int>(cartan::LaplacianWeights::Uniform) == UNIFORM &&
          static_cast<int>(cartan::LaplacianWeights::Cotangent) == COTANGENT &&
          static_cast<int>(cartan::LaplacianWeights::MeanValue) == MEAN_VALUE &&
          static_cast<int>(cartan::SolverBackend::Automatic) == AUTOMATIC_SOLVER &&
          static_cast<int>(cartan::SolverBackend::Eigen) == EIGEN &&
          static_cast<int>(cartan::SolverBackend::Cholmod) == CHOLMOD,
        "the enumerations agree");
      problem.Weights = static_cast<cartan::LaplacianWeights>(this->LaplacianWeights);
      problem.PositionWeights = problem.Weights;
      problem.ConstrainPositions = this->ConstrainHandlePositions;

      const MotionsById motions = this->State->GetMotions();
      RequireMeaningfulMotions(motions, problem.Handle);
      std::set<int> moving;
      for (const auto& entry : motions)
      {
        moving.insert(entry.first);
      }
      HandleArrays arrays;
      if (!this->TargetPositionArrayName.empty())
      {
        arrays.Positions =
          ReadHandleValues(input, this->TargetPositionArrayName, 3, problem.Handle);
        arrays.Positions.rowwise() -= surface->Origin.transpose();
      }
      if (!this->RotationVectorArrayName.empty())
      {
        arrays.RotationVectors =
          ReadHandleValues(input, this->RotationVectorArrayName, 3, problem.Handle);
      }
      if (!this->TransformArrayName.empty())
      {
        arrays.Transforms = ReadHandleValues(input, this->TransformArrayName, 9, problem.Handle);
      }
      if (arrays.RotationVectors.rows() && arrays.Transforms.rows())
      {
        throw Error(ErrorCode::BadInput,
          "Both a rotation vector array and a transform array are set: choose one.");
      }
      bool isPerVertex = false;
      for (int v = 0; v < surface->Mesh.NumberOfVertices(); ++v)
      {
        const int handle = problem.Handle[v];
        if (handle > 0 && !motions.count(handle) && !IsAtRest(arrays, surface->Positions, v))
        {
          moving.insert(handle);
          isPerVertex = true;
        }
      }
      problem.Moving.assign(moving.begin(), moving.end());

      const auto backend = static_cast<cartan::SolverBackend>(this->Solver);
      if (!session.Deformer || session.Backend != backend || !Serves(session.Problem, problem))
      {
        session.Deformer.reset();
        session.Problem = problem;
        session.Backend = backend;
        session.Deformer = this->NewDeformer(problem, backend, context.Part(0.0, 0.5));
        this->State->Factorizations += session.Deformer->GetNumberOfFactorizations();
      }

      cartan::HandleTargets targets;
      for (const int id : session.Problem.Moving)
      {
        const auto motion = motions.find(id);
        targets.Motions.push_back(motion == motions.end()
            ? cartan::HandleMotion()
            : ToKernel(motion->second, surface->Origin));
      }
      if (isPerVertex)
      {
        AddPerVertexTargets(arrays, session.Problem, motions, targets);
      }
      this->ConfigureDeformer(*session.Deformer, context.Part(0.5, 0.8));
      const double ready = vtkTimerLog::GetUniversalTime();
      const int factorizations = session.Deformer->GetNumberOfFactorizations();
      session.Deformer->Deform(targets,
        this->GenerateFrameChange || this->GenerateRotationVector || this->NeedsTransforms(),
        session.Result, context.Part(0.8, 0.95));
      this->State->Factorizations += session.Deformer->GetNumberOfFactorizations() - factorizations;
      cartan::Warn(this, session.Deformer->GetWarning());

      cartan::WriteSurface(*surface, session.Result.Positions, input, output, context);
      AddTransformArrays(
        session.Result, this->GenerateFrameChange, this->GenerateRotationVector, output);
      this->DecorateOutput(
        session.Problem, *session.Deformer, session.Result, output, context.Part(0.95, 1.0));
      this->State->FreePoints = session.Deformer->GetNumberOfFreeVertices();
      this->State->SetupTime = ready - start;
      this->State->MotionTime = vtkTimerLog::GetUniversalTime() - ready;
    });
}
