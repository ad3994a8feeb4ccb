// SPDX-License-Identifier: BSD-3-Clause
/// The motions of a deformation filter's handles, as its panel edits them: that of the
/// active handle in the property Motion, those of others in the rows of MotionRows.
#pragma once

#include "vtkBoundingBox.h"

#include <QString>

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <vector>

class vtkSMProxy;

/// The number of elements of a row of MotionRows: handle id; scale x, y, z; angle in
/// degrees; axis x, y, z; center x, y, z; translation x, y, z.
constexpr int MotionRowLength = 14;

/// One of the proxies that a property offers, by the name that it has in XML.
vtkSMProxy* OfferedProxy(vtkSMProxy* filter, const char* property, const char* name);

/// The ids of the handles in a deformation filter's input, increasing.
std::vector<int> HandlesOf(vtkSMProxy* filter);

/// The box around a handle in the input; not valid if no point belongs to it.
vtkBoundingBox HandleBox(vtkSMProxy* filter, int id);

/// The centers of these boxes where the motions of the panel, applied or not, take them: by the
/// ids of their handles, the first ones if there are more than `most`.
std::map<int, std::array<double, 3>> HandlePlaces(vtkSMProxy* filter, std::size_t most);

/// A row that moves nothing yet, about the center of a handle: the first that is neither
/// active nor in one of the rows.
std::vector<double> NewMotionRow(vtkSMProxy* filter, const std::vector<double>& rows);

/// Makes a handle the active one. The motion of the one before moves to the rows, and
/// that of the new one from its row to Motion, so that the surface stays as it is.
/// Returns why that is not possible, in a sentence, or nothing.
QString ActivateHandle(vtkSMProxy* filter, int id);

/// Removes all rows and sets Motion to rest.
void PutAllHandlesBack(vtkSMProxy* filter);

/// Makes changes that take effect at once, without Apply: one step to undo, recorded in a
/// trace; views are drawn if the filter has been applied.
void ChangeAtOnce(vtkSMProxy* filter, const QString& text, const std::function<void()>& change);
