// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Invariants.h"

#include <string>

namespace fuzz
{
/// Writes the surfaces of a finding as .vtp and a script for pvpython that runs the
/// filter on them and prints messages and differences. Returns the script's name.
std::string WriteScript(const Finding& finding, const std::string& folder);
}
