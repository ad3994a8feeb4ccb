// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace fuzz
{
/// Counts in memory that the watching and the working process share, so that they
/// survive a crash. One process writes at a time.
class Tally
{
public:
  Tally();
  Tally(const Tally&) = delete;
  Tally& operator=(const Tally&) = delete;
  ~Tally();

  void AddCase(const std::string& filter, const char* result);
  void AddFinding(const std::string& filter, const std::string& kind);
  int GetNumberOfFindings() const;
  /// What is being done: the seed to go on from after a crash.
  void SetSeed(std::uint64_t seed);
  std::uint64_t GetSeed() const;
  void SetStage(const std::string& stage);
  std::string GetStage() const;
  /// A table of cases, and one of findings.
  void Print() const;

private:
  struct Row;
  struct Data;
  void Count(Row* rows, const std::string& filter, const std::string& text);

  Data* Shared;
};
}
