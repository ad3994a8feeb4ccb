// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFrameReconstruction.h"

#include "Bridge/FilterRun.h"
#include "Bridge/JoinedCopies.h"
#include "Bridge/PointArrays.h"
#include "Bridge/SurfaceWriter.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Differential/FrameReconstruction.h"

#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkFrameReconstruction);

using cartan::Error;
using cartan::ErrorCode;

namespace
{
vtkDataArray* RequireColumn(vtkTable* table, const char* name)
{
  auto* column = vtkDataArray::SafeDownCast(table->GetColumnByName(name));
  if (!column || column->GetNumberOfComponents() != 1)
  {
    throw Error(ErrorCode::BadInput,
      std::string("The forms table has no numeric column \"") + name +
        "\" of one component: give the table of vtkDiscreteForms (Discrete Forms).");
  }
  if (column->GetNumberOfTuples() != table->GetNumberOfRows())
  {
    throw Error(ErrorCode::BadInput,
      std::string("The column \"") + name + "\" of the forms table has " +
        std::to_string(column->GetNumberOfTuples()) + " values for " +
        std::to_string(table->GetNumberOfRows()) +
        " rows: give the table of vtkDiscreteForms (Discrete Forms) as it came.");
  }
  return column;
}

bool IsVertex(double id, const cartan::TriangleMesh& mesh)
{
  return id >= 0.0 && id < mesh.NumberOfVertices() && id == std::floor(id);
}

/// The rows of each vertex: #V. Those whose ids are no vertices are foreign.
std::vector<std::vector<vtkIdType>> RowsByVertex(const cartan::TriangleMesh& mesh,
  vtkDataArray* vertices, vtkDataArray* neighbors, cartan::IdSample& foreign)
{
  std::vector<std::vector<vtkIdType>> rows(mesh.NumberOfVertices());
  for (vtkIdType row = 0; row < vertices->GetNumberOfTuples(); ++row)
  {
    const double vertex = vertices->GetTuple1(row);
    if (IsVertex(vertex, mesh) && IsVertex(neighbors->GetTuple1(row), mesh))
    {
      rows[static_cast<int>(vertex)].push_back(row);
    }
    else
    {
      foreign.Add(row);
    }
  }
  return rows;
}

/// The table's row for each directed edge of the mesh. Throws unless rows and
/// directed edges correspond one to one.
std::vector<vtkIdType> MatchRows(const cartan::TriangleMesh& mesh, vtkTable* table)
{
  vtkDataArray* vertices = RequireColumn(table, "Vertex");
  vtkDataArray* neighbors = RequireColumn(table, "Neighbor");
  const vtkIdType numberOfRows = table->GetNumberOfRows();
  if (numberOfRows != mesh.NumberOfDirectedEdges())
  {
    throw Error(ErrorCode::BadInput,
      "The forms table has " + std::to_string(numberOfRows) + " rows, but the connectivity has " +
        std::to_string(mesh.NumberOfDirectedEdges()) +
        " directed edges: they belong to different surfaces.");
  }
  cartan::IdSample foreign;
  const std::vector<std::vector<vtkIdType>> rowsOfVertex =
    RowsByVertex(mesh, vertices, neighbors, foreign);
  // A vertex's directed edges by neighbor, in a scratch array.
  std::vector<vtkIdType> rowOfEdge(mesh.NumberOfDirectedEdges(), -1);
  std::vector<int> edgeTo(mesh.NumberOfVertices(), -1);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      edgeTo[mesh.Neighbor(d)] = d;
    }
    for (const vtkIdType row : rowsOfVertex[v])
    {
      int& edge = edgeTo[static_cast<int>(neighbors->GetTuple1(row))];
      if (edge >= 0)
      {
        rowOfEdge[edge] = row;
        edge = -1; // a second row for the same edge is foreign
      }
      else
      {
        foreign.Add(row);
      }
    }
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      edgeTo[mesh.Neighbor(d)] = -1;
    }
  }
  if (!foreign.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The forms table has " + foreign.Describe("row", "rows") +
        " whose Vertex and Neighbor are not an edge of the connectivity, or repeat one: "
        "they belong to different surfaces.");
  }
  return rowOfEdge;
}

cartan::DiscreteForms ReadForms(const cartan::TriangleMesh& mesh, vtkTable* table)
{
  const std::vector<vtkIdType> rows = MatchRows(mesh, table);
  vtkDataArray* lengths = RequireColumn(table, "Length");
  vtkDataArray* angles = RequireColumn(table, "Angle");
  vtkDataArray* heights = RequireColumn(table, "Height");
  vtkDataArray* orientations = RequireColumn(table, "Orientation");
  cartan::DiscreteForms forms;
  forms.Length.resize(mesh.NumberOfDirectedEdges());
  forms.Angle.resize(mesh.NumberOfDirectedEdges());
  forms.Height.resize(mesh.NumberOfDirectedEdges());
  forms.Orientation.resize(mesh.NumberOfDirectedEdges());
  cartan::IdSample bad;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    forms.Length[d] = lengths->GetTuple1(rows[d]);
    forms.Angle[d] = angles->GetTuple1(rows[d]);
    forms.Height[d] = heights->GetTuple1(rows[d]);
    const double orientation = orientations->GetTuple1(rows[d]);
    forms.Orientation[d] = static_cast<signed char>((orientation > 0.0) - (orientation < 0.0));
    const bool hasAngle = mesh.LeftTriangle(d) >= 0;
    if (!(std::isfinite(forms.Length[d]) && forms.Length[d] >= 0.0 &&
          std::isfinite(forms.Height[d]) && (!hasAngle || std::isfinite(forms.Angle[d]))))
    {
      bad.Add(rows[d]);
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The forms table has " + bad.Describe("row", "rows") +
        " with a negative length, or a length, height or angle that is not finite.");
  }
  return forms;
}

bool IsFrame(const Eigen::Matrix3d& frame)
{
  return (frame.transpose() * frame - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 &&
    frame.determinant() > 0.0;
}

/// What is given of the solution.
struct Constraints
{
  std::vector<char> IsFixed;
  cartan::Matrices Frames;
  cartan::Points Positions;
};

/// The points that the array selects, with the input's positions and frames.
void AddInputConstraints(vtkPolyData* input, const cartan::TriangleMesh& mesh,
  const std::string& name, Constraints& constraints)
{
  vtkDataArray* selected = cartan::RequirePointArray(input, name, 1);
  const cartan::Matrices frames = cartan::ReadFrameArrays(input);
  cartan::IdSample bad;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (selected->GetTuple1(v) == 0.0 || !mesh.IsUsed(v))
    {
      continue;
    }
    constraints.IsFixed[v] = 1;
    constraints.Frames.row(v) = frames.row(v);
    if (!constraints.Positions.row(v).allFinite() || !IsFrame(cartan::MatrixAt(frames, v)))
    {
      bad.Add(v);
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The constraints have " + bad.Describe("point", "points") +
        " whose position is not finite or whose frame is not orthonormal and right-handed.");
  }
}

/// Fixes one point of each component that has no constraint: `seedPoint`, else
/// the first one. Returns a warning where components are piled up at one seed.
std::string AddSeeds(const cartan::TriangleMesh& mesh, vtkIdType seedPoint,
  const Eigen::RowVector3d& position, const Eigen::Matrix3d& frame, Constraints& constraints)
{
  if (seedPoint >= mesh.NumberOfVertices() ||
    (seedPoint >= 0 && !mesh.IsUsed(static_cast<int>(seedPoint))))
  {
    throw Error(ErrorCode::BadInput,
      "The seed point " + std::to_string(seedPoint) +
        " is in no triangle: choose a point of the surface, or -1 for its first one.");
  }
  if (!position.allFinite() || !IsFrame(frame))
  {
    throw Error(ErrorCode::BadInput,
      "The seed's position is not finite, or its frame is not orthonormal and right-handed to "
      "1e-6.");
  }
  std::vector<char> isSeeded(mesh.NumberOfComponents(), 0);
  int seeds = 0;
  const auto seed = [&](int v)
  {
    constraints.IsFixed[v] = 1;
    constraints.Positions.row(v) = position;
    cartan::MatrixAt(constraints.Frames, v) = frame;
    isSeeded[mesh.Component(v)] = 1;
    ++seeds;
  };
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (constraints.IsFixed[v])
    {
      isSeeded[mesh.Component(v)] = 1;
    }
  }
  if (seedPoint >= 0)
  {
    seed(static_cast<int>(seedPoint));
  }
  cartan::IdSample others;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && !isSeeded[mesh.Component(v)])
    {
      seed(v);
      if (seeds > 1)
      {
        others.Add(mesh.Component(v));
      }
    }
  }
  return others.IsEmpty()
    ? std::string()
    : "The surface has " + others.Describe("further component", "further components") +
      " without a seed of their own; they start at the same position and frame. Hold a point of "
      "each with a constraint array.";
}
}

vtkFrameReconstruction::vtkFrameReconstruction()
{
  this->SetNumberOfInputPorts(2);
}

void vtkFrameReconstruction::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SeedPoint: " << this->SeedPoint << "\n";
  os << indent << "SeedPosition: " << this->SeedPosition[0] << " " << this->SeedPosition[1] << " "
     << this->SeedPosition[2] << "\n";
  os << indent << "SeedFrame:";
  for (const double value : this->SeedFrame)
  {
    os << " " << value;
  }
  os << "\n";
  os << indent << "ConstraintArrayName: " << this->ConstraintArrayName << "\n";
  os << indent << "TransitionMethod: " << this->TransitionMethod << "\n";
  os << indent << "ProjectFrames: " << this->ProjectFrames << "\n";
}

void vtkFrameReconstruction::SetFormsConnection(vtkAlgorithmOutput* table)
{
  this->SetInputConnection(1, table);
}

void vtkFrameReconstruction::SetFormsData(vtkTable* table)
{
  this->SetInputData(1, table);
}

void vtkFrameReconstruction::SetSeedFrame(const double frame[9])
{
  if (!std::equal(frame, frame + 9, this->SeedFrame))
  {
    std::copy(frame, frame + 9, this->SeedFrame);
    this->Modified();
  }
}

void vtkFrameReconstruction::SetSeedFrame(double t1x, double t1y, double t1z, double t2x,
  double t2y, double t2z, double nx, double ny, double nz)
{
  const double frame[9] = { t1x, t1y, t1z, t2x, t2y, t2z, nx, ny, nz };
  this->SetSeedFrame(frame);
}

void vtkFrameReconstruction::SetConstraintArrayName(const std::string& name)
{
  if (this->ConstraintArrayName != name)
  {
    this->ConstraintArrayName = name;
    this->Modified();
  }
}

int vtkFrameReconstruction::FillInputPortInformation(int port, vtkInformation* info)
{
  return port == 1 ? SetPortType(info, "vtkTable")
                   : this->Superclass::FillInputPortInformation(port, info);
}

void vtkFrameReconstruction::Execute(cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  vtkPolyData* input = run.Input();
  const auto surface = cartan::ReadConnectivity(input);
  const cartan::TriangleMesh& mesh = *surface->Mesh;
  run.Warn(surface->Describe("input", input));
  const cartan::DiscreteForms forms = ReadForms(mesh, run.InputTable(1));

  Constraints constraints;
  constraints.IsFixed.assign(mesh.NumberOfVertices(), 0);
  constraints.Frames = cartan::Identities(mesh.NumberOfVertices());
  constraints.Positions = cartan::ReadPoints(input, context);
  if (!this->ConstraintArrayName.empty())
  {
    AddInputConstraints(input, mesh, this->ConstraintArrayName, constraints);
  }
  const Eigen::Map<const Eigen::Matrix3d> seedFrame(this->SeedFrame);
  const Eigen::Map<const Eigen::RowVector3d> seedPosition(this->SeedPosition);
  run.Warn(AddSeeds(mesh, this->ConstraintArrayName.empty() ? this->SeedPoint : -1, seedPosition,
    seedFrame, constraints));
  context.Report(0.1);

  const cartan::Transitions transitions = cartan::TransitionsFromForms(mesh, forms,
    static_cast<cartan::TransitionMethod>(this->TransitionMethod), context.Part(0.1, 0.2));
  const cartan::AnchoredSystem system =
    cartan::ReconstructionSystem(mesh, constraints.IsFixed, context.Part(0.2, 0.4));
  cartan::Matrices frames = cartan::ReconstructFrames(mesh, transitions, constraints.IsFixed,
    std::move(constraints.Frames), system, context.Part(0.4, 0.8));
  if (this->ProjectFrames)
  {
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      cartan::MatrixAt(frames, v) = cartan::ProjectOnRotations(cartan::MatrixAt(frames, v));
    }
  }
  const cartan::Points positions =
    cartan::SolvePositions(mesh, frames, cartan::RingCoordinates(mesh, forms), constraints.IsFixed,
      std::move(constraints.Positions), system, context.Part(0.8, 0.95));
  run.Warn(cartan::DescribePartedCopies(
    input, *surface, positions, "hold one copy of each in every part with a constraint array."));
  cartan::WriteReconstruction(*surface, positions, input, run.Output(), context);
  cartan::AddFrameArrays(run.Output(), frames);
  context.Report(1.0);
}
