// SPDX-License-Identifier: BSD-3-Clause
#include "pqHandleMotions.h"

#include "pqApplicationCore.h"
#include "pqProxy.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkHandleMotion.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyListDomain.h"
#include "vtkSMTrace.h"
#include "vtkSMUncheckedPropertyHelper.h"
#include "vtkSmartPointer.h"
#include "vtkTransform.h"

#include <QCoreApplication>
#include <QPointer>
#include <QTimer>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

namespace
{
constexpr int BoxLength = 7; // of a handle in HandleBounds: id and bounds

/// How far the columns of a matrix may be from a rotation with scales along the axes.
constexpr double ShearTolerance = 1e-12;

using Row = std::array<double, MotionRowLength>;

/// Where the parts of a row begin.
enum Part
{
  Id = 0,
  Scale = 1,
  Angle = 4,
  Axis = 5,
  Center = 8,
  Translation = 11
};

Row RestRow(int id)
{
  Row row{};
  row[Id] = id;
  std::fill_n(row.begin() + Scale, 3, 1.0);
  row[Axis + 2] = 1.0;
  return row;
}

bool IsAtRest(const Row& row)
{
  const auto isAll = [&](int part, int count, double value)
  {
    return std::all_of(row.begin() + part, row.begin() + part + count,
      [value](double element) { return element == value; });
  };
  return isAll(Scale, 3, 1.0) && isAll(Angle, 1, 0.0) && isAll(Translation, 3, 0.0);
}

/// What the panel shows, applied or not.
void Read(vtkSMProxy* motion, const char* name, double* values, unsigned int count)
{
  vtkSMUncheckedPropertyHelper(motion, name).Get(values, count);
}

void Write(vtkSMProxy* motion, const char* name, const double* values, unsigned int count)
{
  motion->GetProperty(name)->ClearUncheckedElements();
  vtkSMPropertyHelper(motion, name).Set(values, count);
}

void SetRotation(vtkHandleMotion* motion, Row& row)
{
  motion->GetRotationVector(&row[Axis]);
  row[Angle] = vtkMath::DegreesFromRadians(vtkMath::Norm(&row[Axis]));
  if (vtkMath::Normalize(&row[Axis]) == 0.0)
  {
    row[Axis + 2] = 1.0;
  }
}

Row RowOfBox(vtkSMProxy* box, int id)
{
  Row row = RestRow(id);
  double rotation[3];
  Read(box, "Position", &row[Translation], 3);
  Read(box, "Rotation", rotation, 3);
  Read(box, "Scale", &row[Scale], 3);
  vtkNew<vtkHandleMotion> motion;
  motion->SetModeToBox();
  motion->SetBoxRotation(rotation);
  SetRotation(motion, row);
  return row;
}

/// Nothing for a matrix with shear along the axes: M = T R S in no way.
std::optional<Row> RowOfMatrix(vtkSMProxy* matrix, int id)
{
  Row row = RestRow(id);
  double elements[16];
  Read(matrix, "Matrix", elements, 16);
  for (int column = 0; column < 3; ++column)
  {
    double* scale = &row[Scale + column];
    *scale = std::sqrt(elements[column] * elements[column] +
      elements[4 + column] * elements[4 + column] + elements[8 + column] * elements[8 + column]);
    *scale *= column == 2 && vtkMatrix4x4::Determinant(elements) < 0.0 ? -1.0 : 1.0;
    row[Translation + column] = elements[4 * column + 3];
    elements[4 * column + 3] = 0.0;
    for (int line = 0; line < 3; ++line)
    {
      elements[4 * line + column] /= *scale;
    }
  }
  for (int a = 0; a < 3; ++a)
  {
    const int b = (a + 1) % 3;
    const double product = elements[a] * elements[b] + elements[4 + a] * elements[4 + b] +
      elements[8 + a] * elements[8 + b];
    if (!(std::abs(product) <= ShearTolerance))
    {
      return {};
    }
  }
  vtkNew<vtkHandleMotion> motion;
  motion->SetModeToMatrix();
  motion->SetMatrixElements(elements);
  SetRotation(motion, row);
  return row;
}

/// The motion of the active handle as a row; nothing if no row can hold it.
std::optional<Row> ReadMotion(vtkSMProxy* motion, int id)
{
  const char* kind = motion ? motion->GetXMLName() : "None";
  if (std::strcmp(kind, "Box") == 0)
  {
    return RowOfBox(motion, id);
  }
  if (std::strcmp(kind, "Matrix") == 0)
  {
    return RowOfMatrix(motion, id);
  }
  Row row = RestRow(id);
  if (std::strcmp(kind, "Axis and Angle") == 0)
  {
    Read(motion, "Scale", &row[Scale], 3);
    Read(motion, "Angle", &row[Angle], 1);
    Read(motion, "Axis", &row[Axis], 3);
    Read(motion, "Center", &row[Center], 3);
    Read(motion, "Translation", &row[Translation], 3);
  }
  return row;
}

/// A rotation vector says nothing of full turns where a box has been dragged: it takes
/// the one nearest to the rotation of another row.
void ChooseTurn(Row& row, const std::vector<double>& rows)
{
  for (std::size_t i = 0; i + MotionRowLength <= rows.size(); i += MotionRowLength)
  {
    const double along = rows[i + Angle] * vtkMath::Dot(&row[Axis], &rows[i + Axis]) /
      std::max(vtkMath::Norm(&rows[i + Axis]), VTK_DBL_MIN);
    row[Angle] += 360.0 * std::round((along - row[Angle]) / 360.0);
  }
}

void WriteAxisAndAngle(vtkSMProxy* motion, const Row& row)
{
  Write(motion, "Scale", &row[Scale], 3);
  Write(motion, "Angle", &row[Angle], 1);
  Write(motion, "Axis", &row[Axis], 3);
  Write(motion, "Center", &row[Center], 3);
  Write(motion, "Translation", &row[Translation], 3);
  motion->UpdateVTKObjects();
}

/// x' = Center + R S (x - Center) + Translation.
vtkSmartPointer<vtkMatrix4x4> MapOf(const Row& row)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetScale(&row[Scale]);
  motion->SetAngle(row[Angle]);
  motion->SetAxis(&row[Axis]);
  motion->SetCenter(&row[Center]);
  motion->SetTranslation(&row[Translation]);
  auto map = vtkSmartPointer<vtkMatrix4x4>::New();
  motion->GetTransform(map);
  return map;
}

/// The map of the active handle's motion.
vtkSmartPointer<vtkMatrix4x4> MapOf(vtkSMProxy* motion, int id)
{
  auto map = vtkSmartPointer<vtkMatrix4x4>::New();
  if (motion && std::strcmp(motion->GetXMLName(), "Matrix") == 0)
  {
    Read(motion, "Matrix", map->GetData(), 16);
    return map;
  }
  return MapOf(*ReadMotion(motion, id));
}

/// With x' = Position + R S x.
void WriteBox(vtkSMProxy* box, const Row& row)
{
  const vtkSmartPointer<vtkMatrix4x4> map = MapOf(row);
  const double position[3] = { map->GetElement(0, 3), map->GetElement(1, 3),
    map->GetElement(2, 3) };
  vtkNew<vtkTransform> rotation;
  rotation->RotateWXYZ(row[Angle], &row[Axis]);
  Write(box, "Position", position, 3);
  Write(box, "Rotation", rotation->GetOrientation(), 3);
  Write(box, "Scale", &row[Scale], 3);
  box->UpdateVTKObjects();
}

void Choose(vtkSMProxy* filter, vtkSMProxy* motion)
{
  filter->GetProperty("Motion")->ClearUncheckedElements();
  vtkSMPropertyHelper(filter, "Motion").Set(motion);
}

void WriteRows(vtkSMProxy* filter, const std::vector<double>& rows)
{
  filter->GetProperty("MotionRows")->ClearUncheckedElements();
  vtkSMPropertyHelper helper(filter, "MotionRows");
  helper.SetNumberOfElements(static_cast<unsigned int>(rows.size()));
  if (!rows.empty())
  {
    helper.Set(rows.data(), static_cast<unsigned int>(rows.size()));
  }
}

std::vector<double>::iterator FindRow(std::vector<double>& rows, int id)
{
  auto row = rows.begin();
  while (row != rows.end() && *row != id)
  {
    row += MotionRowLength;
  }
  return row;
}

/// Lets a trace record what a step changes in the filter and the motion that is chosen.
void Trace(vtkSMProxy* filter, const std::function<void()>& step)
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", filter);
  step();
  filter->UpdateVTKObjects();
}

void SetCenter(vtkSMProxy* filter, Row& row)
{
  const vtkBoundingBox box = HandleBox(filter, static_cast<int>(row[Id]));
  if (box.IsValid())
  {
    box.GetCenter(&row[Center]);
  }
}

/// Sets rows, the active handle and its motion. A box shows at most half a turn; the
/// motion by axis and angle is about the handle's center, should it be chosen later. One
/// step after the other: a trace records what changes in the motion that is chosen.
void WriteMotion(
  vtkSMProxy* filter, const std::vector<double>& rows, const Row& row, vtkSMProxy* last)
{
  vtkSMProxy* typed = OfferedProxy(filter, "Motion", "Axis and Angle");
  vtkSMProxy* box = OfferedProxy(filter, "Motion", "Box");
  const bool isTyped = last == typed || std::abs(row[Angle]) > 180.0;
  Trace(filter,
    [&]
    {
      WriteRows(filter, rows);
      filter->GetProperty("ActiveHandle")->ClearUncheckedElements();
      vtkSMPropertyHelper(filter, "ActiveHandle").Set(static_cast<int>(row[Id]));
      Choose(filter, typed);
    });
  Row rest = RestRow(static_cast<int>(row[Id]));
  SetCenter(filter, rest);
  Trace(filter, [&] { WriteAxisAndAngle(typed, isTyped ? row : rest); });
  if (!isTyped)
  {
    Trace(filter, [&] { Choose(filter, box); });
    Trace(filter, [&] { WriteBox(box, row); });
  }
}
}

vtkSMProxy* OfferedProxy(vtkSMProxy* filter, const char* property, const char* name)
{
  auto* offers = filter->GetProperty(property)->FindDomain<vtkSMProxyListDomain>();
  for (unsigned int i = 0; offers && i < offers->GetNumberOfProxies(); ++i)
  {
    if (std::strcmp(offers->GetProxy(i)->GetXMLName(), name) == 0)
    {
      return offers->GetProxy(i);
    }
  }
  return nullptr;
}

std::vector<int> HandlesOf(vtkSMProxy* filter)
{
  const std::vector<double> boxes = vtkSMPropertyHelper(filter, "HandleBounds").GetDoubleArray();
  std::vector<int> ids;
  for (std::size_t i = 0; i + BoxLength <= boxes.size(); i += BoxLength)
  {
    ids.push_back(static_cast<int>(boxes[i]));
  }
  return ids;
}

vtkBoundingBox HandleBox(vtkSMProxy* filter, int id)
{
  const std::vector<double> boxes = vtkSMPropertyHelper(filter, "HandleBounds").GetDoubleArray();
  for (std::size_t i = 0; i + BoxLength <= boxes.size(); i += BoxLength)
  {
    if (boxes[i] == id)
    {
      return vtkBoundingBox(&boxes[i + 1]);
    }
  }
  return {};
}

std::map<int, std::array<double, 3>> HandlePlaces(vtkSMProxy* filter, std::size_t most)
{
  const std::vector<double> boxes = vtkSMPropertyHelper(filter, "HandleBounds").GetDoubleArray();
  std::vector<double> rows = vtkSMUncheckedPropertyHelper(filter, "MotionRows").GetDoubleArray();
  const int active = vtkSMUncheckedPropertyHelper(filter, "ActiveHandle").GetAsInt();
  std::map<int, std::array<double, 3>> places;
  for (std::size_t i = 0; i + BoxLength <= boxes.size() && places.size() < most; i += BoxLength)
  {
    const int id = static_cast<int>(boxes[i]);
    Row row = RestRow(id);
    const auto found = FindRow(rows, id);
    if (found != rows.end())
    {
      std::copy_n(found, MotionRowLength, row.begin());
    }
    vtkSMProxy* motion = vtkSMUncheckedPropertyHelper(filter, "Motion").GetAsProxy();
    std::array<double, 4> place{ 0.0, 0.0, 0.0, 1.0 };
    vtkBoundingBox(&boxes[i + 1]).GetCenter(place.data());
    (id == active ? MapOf(motion, id) : MapOf(row))->MultiplyPoint(place.data(), place.data());
    places[id] = { place[0], place[1], place[2] };
  }
  return places;
}

std::vector<double> NewMotionRow(vtkSMProxy* filter, const std::vector<double>& rows)
{
  std::vector<int> taken{ vtkSMUncheckedPropertyHelper(filter, "ActiveHandle").GetAsInt() };
  for (std::size_t i = 0; i + MotionRowLength <= rows.size(); i += MotionRowLength)
  {
    taken.push_back(static_cast<int>(rows[i]));
  }
  const std::vector<int> ids = HandlesOf(filter);
  const auto isFree = [&](int id)
  { return std::find(taken.begin(), taken.end(), id) == taken.end(); };
  const auto found = std::find_if(ids.begin(), ids.end(), isFree);
  Row row =
    RestRow(found == ids.end() ? *std::max_element(taken.begin(), taken.end()) + 1 : *found);
  SetCenter(filter, row);
  return { row.begin(), row.end() };
}

QString ActivateHandle(vtkSMProxy* filter, int id)
{
  const int last = vtkSMPropertyHelper(filter, "ActiveHandle").GetAsInt();
  vtkSMProxy* motion = vtkSMUncheckedPropertyHelper(filter, "Motion").GetAsProxy();
  std::optional<Row> kept = ReadMotion(motion, last);
  if (!kept)
  {
    return QCoreApplication::translate("pqHandleMotions",
      "The matrix of handle %1 has shear, which Motion Rows cannot hold. Add another "
      "deformation for handle %2, or choose another Motion first.")
      .arg(last)
      .arg(id);
  }
  std::vector<double> rows = vtkSMUncheckedPropertyHelper(filter, "MotionRows").GetDoubleArray();
  Row next = RestRow(id);
  SetCenter(filter, next);
  const auto row = FindRow(rows, id);
  if (row != rows.end())
  {
    std::copy_n(row, MotionRowLength, next.begin());
    rows.erase(row, row + MotionRowLength);
  }
  if (!IsAtRest(*kept))
  {
    if (std::strcmp(motion->GetXMLName(), "Axis and Angle") != 0)
    {
      ChooseTurn(*kept, rows);
    }
    rows.insert(rows.end(), kept->begin(), kept->end());
  }
  WriteMotion(filter, rows, next, motion);
  return {};
}

void PutAllHandlesBack(vtkSMProxy* filter)
{
  Row rest = RestRow(vtkSMPropertyHelper(filter, "ActiveHandle").GetAsInt());
  SetCenter(filter, rest);
  WriteMotion(filter, {}, rest, vtkSMPropertyHelper(filter, "Motion").GetAsProxy());
}

void ChangeAtOnce(vtkSMProxy* filter, const QString& text, const std::function<void()>& change)
{
  auto* core = pqApplicationCore::instance();
  QPointer<pqProxy> source = core->getServerManagerModel()->findItem<pqProxy*>(filter);
  const bool isCurrent = source && source->modifiedState() == pqProxy::UNMODIFIED;
  BEGIN_UNDO_SET(text);
  change();
  END_UNDO_SET();
  if (isCurrent)
  {
    core->render();
    // Nothing is left to apply, but the panel takes note of a change.
    QTimer::singleShot(0, source,
      [source]
      {
        if (source)
        {
          source->setModifiedState(pqProxy::UNMODIFIED);
        }
      });
  }
}
