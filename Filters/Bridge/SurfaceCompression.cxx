// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/SurfaceCompression.h"

#include "Bridge/PointArrays.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <cstring>
#include <limits>

namespace cartan
{
namespace
{
/// The type of an array's numbers in a file; false where there is none.
bool ScalarTypeOf(vtkDataArray* array, ScalarType& type)
{
  switch (array->GetDataType())
  {
    case VTK_FLOAT:
      type = ScalarType::Float32;
      return true;
    case VTK_DOUBLE:
      type = ScalarType::Float64;
      return true;
    case VTK_BIT:
      return false;
    default:
      break;
  }
  const bool isSigned = array->GetDataTypeMin() < 0.0;
  switch (array->GetDataTypeSize())
  {
    case 1:
      type = isSigned ? ScalarType::Int8 : ScalarType::UInt8;
      return true;
    case 2:
      type = isSigned ? ScalarType::Int16 : ScalarType::UInt16;
      return true;
    case 4:
      type = isSigned ? ScalarType::Int32 : ScalarType::UInt32;
      return true;
    case 8:
      type = isSigned ? ScalarType::Int64 : ScalarType::UInt64;
      return true;
    default:
      return false;
  }
}

int VtkTypeOf(ScalarType type)
{
  switch (type)
  {
    case ScalarType::Float32:
      return VTK_FLOAT;
    case ScalarType::Float64:
      return VTK_DOUBLE;
    case ScalarType::Int8:
      return VTK_TYPE_INT8;
    case ScalarType::UInt8:
      return VTK_TYPE_UINT8;
    case ScalarType::Int16:
      return VTK_TYPE_INT16;
    case ScalarType::UInt16:
      return VTK_TYPE_UINT16;
    case ScalarType::Int32:
      return VTK_TYPE_INT32;
    case ScalarType::UInt32:
      return VTK_TYPE_UINT32;
    case ScalarType::Int64:
      return VTK_TYPE_INT64;
    case ScalarType::UInt64:
      return VTK_TYPE_UINT64;
  }
  return VTK_DOUBLE;
}

std::size_t TupleBytes(const CodedArray& array)
{
  return static_cast<std::size_t>(array.Components * SizeOf(array.Type));
}

/// The rows of an array in the order of a file.
CodedArray ReadRows(vtkDataArray* source, ScalarType type, const std::vector<int>& order)
{
  CodedArray array;
  array.Name = source->GetName() ? source->GetName() : "";
  array.Type = type;
  array.Components = source->GetNumberOfComponents();
  const std::size_t bytes = TupleBytes(array);
  array.Bytes.resize(bytes * order.size());
  const auto* from = static_cast<const unsigned char*>(source->GetVoidPointer(0));
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    std::memcpy(
      array.Bytes.data() + i * bytes, from + static_cast<std::size_t>(order[i]) * bytes, bytes);
  }
  return array;
}

/// The other way; an empty order is that of the file.
vtkSmartPointer<vtkDataArray> WriteRows(
  const CodedArray& array, const std::vector<int>& order, vtkIdType count)
{
  auto target =
    vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(VtkTypeOf(array.Type)));
  target->SetName(array.Name.c_str());
  target->SetNumberOfComponents(array.Components);
  target->SetNumberOfTuples(count);
  const std::size_t bytes = TupleBytes(array);
  auto* to = static_cast<unsigned char*>(target->GetVoidPointer(0));
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
  {
    const std::size_t row = order.empty() ? i : static_cast<std::size_t>(order[i]);
    std::memcpy(to + row * bytes, array.Bytes.data() + i * bytes, bytes);
  }
  return target;
}

double DiagonalOf(const Points& points)
{
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}
}

std::string SurfaceCompression::Add(
  std::shared_ptr<const Surface> surface, vtkPolyData* input, double time, bool withArrays)
{
  if (!this->First)
  {
    this->First = surface;
    this->Order = OrderByTraversal(*surface->Mesh);
    this->Result.Mesh =
      std::make_shared<TriangleMesh>(surface->Mesh->NumberOfVertices(), this->Order.Faces);
    this->Result.IsSinglePrecision = input->GetPoints()->GetDataType() == VTK_FLOAT;
  }
  else if (surface->Mesh != this->First->Mesh &&
    (surface->Mesh->NumberOfVertices() != this->First->Mesh->NumberOfVertices() ||
      surface->Mesh->GetTriangles() != this->First->Mesh->GetTriangles()))
  {
    throw Error(ErrorCode::BadInput,
      "The cells of time step " + std::to_string(this->Result.Steps.size()) +
        " are not those of the first: a file has one connectivity. Turn WriteAllTimeSteps off.");
  }
  CodedStep step;
  step.Time = time;
  const int used = this->Order.NumberOfUsed;
  const int free = this->Result.Mesh->NumberOfVertices() - used;
  step.FreePoints = this->Order.Reordered(ReadPoints(input)).bottomRows(free);
  this->Positions.push_back(this->Order.Reordered(*surface->Positions));
  this->Origins.push_back(surface->Origin);
  std::string leftOut;
  for (int i = 0; withArrays && i < input->GetPointData()->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = input->GetPointData()->GetArray(i);
    ScalarType type = ScalarType::Float64;
    if (array && ScalarTypeOf(array, type))
    {
      step.Arrays.push_back(ReadRows(array, type, this->Order.Vertices));
    }
    else
    {
      const char* name = input->GetPointData()->GetArrayName(i);
      leftOut += (leftOut.empty() ? "" : ", ") + std::string(name ? name : "(without a name)");
    }
  }
  this->Result.Steps.push_back(std::move(step));
  return leftOut.empty() ? ""
                         : "Point arrays that are not of whole or real numbers are not "
                           "written: " +
      leftOut + ".";
}

/// Encodes all steps in one scale.
void SurfaceCompression::Encode(HighPassQuality quality, const ExecutionContext& context)
{
  if (!this->Coder || this->CoderAnchors != quality.Anchors)
  {
    this->Coder = std::make_unique<HighPassCoder>(this->Result.Mesh, this->Positions.front(),
      quality.Anchors, SolverBackend::Automatic, context);
    this->CoderAnchors = quality.Anchors;
  }
  HighPassScale scale = this->Coder->ScaleOf(this->Positions.front());
  for (const Points& positions : this->Positions)
  {
    scale = scale.Joined(this->Coder->ScaleOf(positions));
  }
  for (std::size_t i = 0; i < this->Positions.size(); ++i)
  {
    this->Result.Steps[i].Code = this->Coder->Encode(this->Positions[i], quality.Bits, scale);
  }
  this->Used = { quality.Bits, this->Coder->NumberOfAnchors() };
}

/// The largest root mean square of a step, in parts of its diagonal.
double SurfaceCompression::VisualErrorOf(double alpha, const ExecutionContext& context) const
{
  double largest = 0.0;
  for (std::size_t i = 0; i < this->Positions.size(); ++i)
  {
    const Points& points = this->Positions[i];
    const Points decoded = this->Coder->Decode(this->Result.Steps[i].Code, context);
    const Eigen::VectorXd errors = VisualError(*this->Result.Mesh, points, decoded, alpha, context);
    const double rms = errors.norm() / std::sqrt(this->Order.NumberOfUsed);
    largest = std::max(largest, rms / DiagonalOf(points.topRows(this->Order.NumberOfUsed)));
  }
  return largest;
}

std::vector<unsigned char> SurfaceCompression::Finish(
  const CompressionSettings& settings, const ExecutionContext& context)
{
  if (settings.MaximumError > 0.0)
  {
    QualityLimits limits;
    limits.Anchors = settings.Quality.Anchors;
    limits.LeastAnchors = this->Result.Mesh->NumberOfComponents();
    limits.Points = this->Order.NumberOfUsed;
    // How many qualities are tried is not known before: progress waits.
    const ExecutionContext waiting = context.Part(0.5, 0.5);
    const HighPassQuality best = FewestBitsAndAnchors(
      [&](HighPassQuality quality)
      {
        this->Encode(quality, waiting);
        return this->VisualErrorOf(settings.VisualErrorAlpha, waiting);
      },
      settings.MaximumError, limits);
    this->Encode(best, waiting);
  }
  else
  {
    this->Encode(settings.Quality, context);
  }
  for (std::size_t i = 0; i < this->Origins.size(); ++i)
  {
    this->Result.Steps[i].Code.Corner += this->Origins[i];
  }
  this->Result.OldNumbers = settings.KeepPointOrder ? this->Order.Vertices : std::vector<int>();
  return Compress(this->Result);
}

void WriteDecodedStep(const CompressedSurface& surface, const CodedStep& step,
  const HighPassCoder& coder, vtkPolyData* output, const ExecutionContext& context)
{
  Points decoded = coder.Decode(step.Code, context);
  decoded.bottomRows(step.FreePoints.rows()) = step.FreePoints;
  const double largest = surface.IsSinglePrecision ? std::numeric_limits<float>::max()
                                                   : std::numeric_limits<double>::max();
  const Eigen::Index used = decoded.rows() - step.FreePoints.rows();
  if (!(decoded.topRows(used).cwiseAbs().maxCoeff() <= largest))
  {
    throw Error(ErrorCode::BadInput, "its points are not finite");
  }
  const std::vector<int>& order = surface.OldNumbers;
  const auto idOf = [&order](int v) { return order.empty() ? v : order[v]; };
  vtkNew<vtkPoints> points;
  points->SetDataType(surface.IsSinglePrecision ? VTK_FLOAT : VTK_DOUBLE);
  points->SetNumberOfPoints(decoded.rows());
  for (int v = 0; v < decoded.rows(); ++v)
  {
    points->SetPoint(idOf(v), decoded.row(v).data());
  }
  const Triangles& faces = surface.Mesh->GetTriangles();
  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(faces.rows(), 3 * faces.rows());
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    const vtkIdType corners[3] = { idOf(faces(t, 0)), idOf(faces(t, 1)), idOf(faces(t, 2)) };
    cells->InsertNextCell(3, corners);
  }
  output->SetPoints(points);
  output->SetPolys(cells);
  for (const CodedArray& array : step.Arrays)
  {
    output->GetPointData()->AddArray(WriteRows(array, order, decoded.rows()));
  }
}
}
