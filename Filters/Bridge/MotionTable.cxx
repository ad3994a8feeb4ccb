// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/MotionTable.h"

#include "vtkHandleMotion.h"

#include <algorithm>

namespace cartan
{
void MotionTable::Row::SetMotion(double angle, const Eigen::Vector3d& scale,
  const Eigen::Vector3d& axis, const Eigen::Vector3d& center,
  const Eigen::Vector3d& translation) const
{
  this->Motion->SetScale(scale[0], scale[1], scale[2]);
  this->Motion->SetAngle(angle);
  this->Motion->SetAxis(axis[0], axis[1], axis[2]);
  this->Motion->SetCenter(center[0], center[1], center[2]);
  this->Motion->SetTranslation(translation[0], translation[1], translation[2]);
}

void MotionTable::ResizeRows(int count)
{
  this->Rows.resize(count);
  for (Row& row : this->Rows)
  {
    if (!row.Motion)
    {
      row.Motion = vtkSmartPointer<vtkHandleMotion>::New();
    }
  }
}

MotionsById MotionTable::Collect(int activeHandle) const
{
  MotionsById motions;
  for (const auto& [id, motion] : this->ById)
  {
    motions[id] = motion;
  }
  if (this->Active)
  {
    motions[activeHandle] = this->Active;
  }
  for (const Row& row : this->Rows)
  {
    const bool isId = row.Id >= 1.0 && row.Id <= VTK_INT_MAX;
    const int id = isId ? static_cast<int>(row.Id) : 0;
    if (!isId || id != row.Id)
    {
      throw Error(ErrorCode::BadInput,
        "A row of the motions' table names handle " + std::to_string(row.Id) +
          ": ids are whole numbers >= 1.");
    }
    if (!motions.emplace(id, row.Motion).second)
    {
      throw Error(ErrorCode::BadInput,
        "Handle " + std::to_string(id) +
          " has two motions: remove one, or its row from the motions' table.");
    }
  }
  return motions;
}

vtkMTimeType MotionTable::GetMTime() const
{
  vtkMTimeType time = this->Active ? this->Active->GetMTime() : 0;
  for (const auto& entry : this->ById)
  {
    time = std::max(time, entry.second->GetMTime());
  }
  for (const Row& row : this->Rows)
  {
    time = std::max(time, row.Motion->GetMTime());
  }
  return time;
}
}
