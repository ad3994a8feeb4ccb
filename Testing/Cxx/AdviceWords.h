// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace shapes
{
/// The words of a message that say what to do, in a test that does it.
/// Utilities/check_advice.py finds in these calls which advice the tests follow.
inline std::string Advice(const char* words)
{
  return words;
}
}
