// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <set>
#include <string>

namespace fuzz
{
/// The command line.
struct Options
{
  std::uint64_t FirstSeed = 0;
  std::uint64_t EndSeed = UINT64_MAX; ///< one after the last
  double Seconds = 0.0;               ///< 0: until EndSeed
  std::string Filter;                 ///< one only; empty: any
  std::set<std::string> Only;         ///< invariants; empty: all
  std::set<std::string> Skip;
  std::string Folder; ///< for scripts
  int Limit = 100000; ///< of findings, after which to stop
  bool IsVerbose = false;
};

/// Throws std::invalid_argument.
Options ReadOptions(int argc, char** argv);

extern const char* const Usage;
}
