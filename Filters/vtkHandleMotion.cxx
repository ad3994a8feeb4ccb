// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandleMotion.h"

#include "Kernel/Algebra/Rotation.h"

#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkHandleMotion);

namespace
{
// Above rounding in a product of a few rotations, below any scale or shear that
// could be seen.
constexpr double RigidTolerance = 1e-9;

using Vector = Eigen::Vector3d;

Vector ToVector(const double v[3])
{
  return Vector(v[0], v[1], v[2]);
}

bool Equals(const double v[3], double x, double y, double z)
{
  return v[0] == x && v[1] == y && v[2] == z;
}

// x' = Linear (x - Center) + Center + Translation.
struct AffineMap
{
  Eigen::Matrix3d Linear = Eigen::Matrix3d::Identity();
  Vector Center = Vector::Zero();
  Vector Translation = Vector::Zero();
};

// Axis times angle in radians; the axis is scaled by its largest component
// first, so that axes as short as 1e-200 have a direction.
Vector UnwrappedRotation(const double axis[3], double angle)
{
  const Vector direction = ToVector(axis);
  const double size = direction.cwiseAbs().maxCoeff();
  if (angle == 0.0 || size == 0.0)
  {
    return Vector::Zero();
  }
  return (direction / size).normalized() * vtkMath::RadiansFromDegrees(angle);
}

// Rz Rx Ry of angles about (x, y, z) in degrees.
Eigen::Matrix3d EulerRotation(const double degrees[3])
{
  const auto rotation = [degrees](int axis)
  {
    return Eigen::AngleAxisd(vtkMath::RadiansFromDegrees(degrees[axis]), Vector::Unit(axis))
      .toRotationMatrix();
  };
  return rotation(2) * rotation(0) * rotation(1);
}

AffineMap ReadMatrix(vtkMatrix4x4* matrix)
{
  AffineMap map;
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      map.Linear(row, column) = matrix->GetElement(row, column);
    }
    map.Translation[row] = matrix->GetElement(row, 3);
  }
  return map;
}

// The map that the valid parameters of `motion` describe.
AffineMap ReadMotion(vtkHandleMotion* motion)
{
  AffineMap map;
  switch (motion->GetMode())
  {
    case vtkHandleMotion::BOX:
      map.Linear =
        EulerRotation(motion->GetBoxRotation()) * ToVector(motion->GetBoxScale()).asDiagonal();
      map.Translation = ToVector(motion->GetBoxPosition());
      break;
    case vtkHandleMotion::MATRIX:
      map = ReadMatrix(motion->GetMatrix());
      break;
    default:
      map.Linear =
        cartan::RotationFromVector(UnwrappedRotation(motion->GetAxis(), motion->GetAngle())) *
        ToVector(motion->GetScale()).asDiagonal();
      map.Center = ToVector(motion->GetCenter());
      map.Translation = ToVector(motion->GetTranslation());
  }
  return map;
}
}

//------------------------------------------------------------------------------
vtkHandleMotion::vtkHandleMotion() = default;

//------------------------------------------------------------------------------
vtkHandleMotion::~vtkHandleMotion() = default;

//------------------------------------------------------------------------------
const char* vtkHandleMotion::GetModeAsString()
{
  switch (this->Mode)
  {
    case BOX:
      return "Box";
    case MATRIX:
      return "Matrix";
    default:
      return "AxisAngle";
  }
}

//------------------------------------------------------------------------------
void vtkHandleMotion::SetBoxReferenceBounds(
  double xmin, double xmax, double ymin, double ymax, double zmin, double zmax)
{
  const double bounds[6] = { xmin, xmax, ymin, ymax, zmin, zmax };
  this->SetBoxReferenceBounds(bounds);
}

//------------------------------------------------------------------------------
void vtkHandleMotion::SetBoxReferenceBounds(const double bounds[6])
{
  // No Modified(): what a widget shows does not change where the handle goes.
  std::copy(bounds, bounds + 6, this->BoxReferenceBounds);
}

//------------------------------------------------------------------------------
void vtkHandleMotion::SetMatrix(vtkMatrix4x4* matrix)
{
  if (this->Matrix != matrix)
  {
    this->Matrix = matrix;
    this->Modified();
  }
  if (matrix)
  {
    this->SetMode(MATRIX);
  }
  else if (this->Mode == MATRIX)
  {
    this->SetMode(AXIS_ANGLE);
  }
}

//------------------------------------------------------------------------------
vtkMatrix4x4* vtkHandleMotion::GetMatrix()
{
  return this->Matrix;
}

//------------------------------------------------------------------------------
void vtkHandleMotion::SetMatrixElements(const double elements[16])
{
  if (this->Matrix && std::equal(elements, elements + 16, this->Matrix->GetData()))
  {
    return;
  }
  this->Matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  this->Matrix->DeepCopy(elements);
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkHandleMotion::GetTransform(vtkMatrix4x4* transform)
{
  const double origin[3] = { 0.0, 0.0, 0.0 };
  this->GetTransformRelativeTo(origin, transform);
}

//------------------------------------------------------------------------------
void vtkHandleMotion::GetTransformRelativeTo(const double origin[3], vtkMatrix4x4* transform)
{
  transform->Identity();
  if (!this->GetProblem().empty())
  {
    return;
  }

  // The image of the origin, relative to the origin: L (o - c) - (o - c) + t.
  const AffineMap map = ReadMotion(this);
  const Vector fromCenter = ToVector(origin) - map.Center;
  const Vector shift = (map.Linear - Eigen::Matrix3d::Identity()) * fromCenter + map.Translation;
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      transform->SetElement(row, column, map.Linear(row, column));
    }
    transform->SetElement(row, 3, shift[row]);
  }
}

//------------------------------------------------------------------------------
void vtkHandleMotion::GetRotationVector(double vector[3])
{
  Vector rotation = Vector::Zero();
  if (this->GetProblem().empty())
  {
    switch (this->Mode)
    {
      case BOX:
        rotation = cartan::VectorFromRotation(EulerRotation(this->BoxRotation));
        break;
      case MATRIX:
        rotation =
          cartan::VectorFromRotation(cartan::ProjectOnRotations(ReadMatrix(this->Matrix).Linear));
        break;
      default:
        rotation = UnwrappedRotation(this->Axis, this->Angle);
    }
  }
  std::copy(rotation.data(), rotation.data() + 3, vector);
}

//------------------------------------------------------------------------------
bool vtkHandleMotion::IsRigid()
{
  if (!this->GetProblem().empty())
  {
    return true;
  }
  const Eigen::Matrix3d linear = ReadMotion(this).Linear;
  const Eigen::Matrix3d defect = linear.transpose() * linear - Eigen::Matrix3d::Identity();
  return defect.norm() <= RigidTolerance && linear.determinant() > 0.0;
}

//------------------------------------------------------------------------------
bool vtkHandleMotion::IsIdentity()
{
  if (!this->GetProblem().empty())
  {
    return true;
  }
  switch (this->Mode)
  {
    case BOX:
      return Equals(this->BoxPosition, 0.0, 0.0, 0.0) && Equals(this->BoxRotation, 0.0, 0.0, 0.0) &&
        Equals(this->BoxScale, 1.0, 1.0, 1.0);
    case MATRIX:
      return this->Matrix->IsIdentity();
    default:
      return Equals(this->Scale, 1.0, 1.0, 1.0) && this->Angle == 0.0 &&
        Equals(this->Translation, 0.0, 0.0, 0.0);
  }
}

//------------------------------------------------------------------------------
std::string vtkHandleMotion::GetProblem()
{
  std::string notFinite;
  const auto check = [&notFinite](const char* name, const double* values, int count)
  {
    if (notFinite.empty() &&
      !std::all_of(values, values + count, [](double value) { return std::isfinite(value); }))
    {
      notFinite = std::string(name) + " has a number that is NaN or infinite.";
    }
  };
  switch (this->Mode)
  {
    case BOX:
      check("BoxPosition", this->BoxPosition, 3);
      check("BoxRotation", this->BoxRotation, 3);
      check("BoxScale", this->BoxScale, 3);
      break;
    case MATRIX:
      if (!this->Matrix)
      {
        return "Mode is Matrix, but there is no matrix; call SetMatrix.";
      }
      check("Matrix", this->Matrix->GetData(), 16);
      break;
    default:
      check("Center", this->Center, 3);
      check("Scale", this->Scale, 3);
      check("Axis", this->Axis, 3);
      check("Angle", &this->Angle, 1);
      check("Translation", this->Translation, 3);
  }
  if (!notFinite.empty())
  {
    return notFinite;
  }

  if (this->Mode == AXIS_ANGLE && this->Angle != 0.0 && Equals(this->Axis, 0.0, 0.0, 0.0))
  {
    return "Axis has length zero, so there is no direction to rotate about; give it a length or "
           "set Angle to 0.";
  }
  if (this->Mode == MATRIX)
  {
    const double* lastRow = this->Matrix->GetData() + 12;
    if (!Equals(lastRow, 0.0, 0.0, 0.0) || lastRow[3] != 1.0)
    {
      return "The last row of Matrix is not 0 0 0 1, so it is not an affine map.";
    }
  }
  return {};
}

//------------------------------------------------------------------------------
vtkMTimeType vtkHandleMotion::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Matrix ? std::max(own, this->Matrix->GetMTime()) : own;
}

//------------------------------------------------------------------------------
void vtkHandleMotion::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto print = [&os, indent](const char* name, const double v[3])
  { os << indent << name << ": (" << v[0] << ", " << v[1] << ", " << v[2] << ")\n"; };

  os << indent << "Mode: " << this->GetModeAsString() << "\n";
  print("Center", this->Center);
  print("Scale", this->Scale);
  print("Axis", this->Axis);
  os << indent << "Angle: " << this->Angle << "\n";
  print("Translation", this->Translation);
  print("BoxPosition", this->BoxPosition);
  print("BoxRotation", this->BoxRotation);
  print("BoxScale", this->BoxScale);
  os << indent << "BoxReferenceBounds: (" << this->BoxReferenceBounds[0];
  for (int i = 1; i < 6; ++i)
  {
    os << ", " << this->BoxReferenceBounds[i];
  }
  os << ")\n";
  os << indent << "Matrix: ";
  if (this->Matrix)
  {
    os << "\n";
    this->Matrix->PrintSelf(os, indent.GetNextIndent());
  }
  else
  {
    os << "(none)\n";
  }
}
