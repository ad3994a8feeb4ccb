// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Case.h"

namespace fuzz
{
/// Random settings for the case's filter, some a little out of their range. Most
/// settings keep their default.
std::vector<Setting> RandomSettings(const std::string& filter, const Mesh& mesh, Random& random);

/// A new filter with the settings, without inputs and motions.
vtkSmartPointer<vtkAlgorithm> NewFilter(const Case& of);
}
