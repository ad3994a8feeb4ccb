// SPDX-License-Identifier: BSD-3-Clause
#include "Tally.h"

#include <sys/mman.h>

#include <cstdio>
#include <cstring>
#include <map>
#include <stdexcept>

namespace fuzz
{
namespace
{
constexpr std::size_t Rows = 1024;
constexpr std::size_t TextLength = 64;

void Copy(char (&to)[TextLength], const std::string& from)
{
  std::snprintf(to, TextLength, "%s", from.c_str());
}
}

struct Tally::Row
{
  char Filter[TextLength];
  char Text[TextLength];
  long long Count;
};

struct Tally::Data
{
  std::uint64_t Seed;
  char Stage[TextLength];
  int Findings;
  Row Cases[Rows];
  Row Kinds[Rows];
};

Tally::Tally()
{
  void* memory =
    mmap(nullptr, sizeof(Data), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
  {
    throw std::runtime_error("no shared memory");
  }
  this->Shared = static_cast<Data*>(memory);
}

Tally::~Tally()
{
  munmap(this->Shared, sizeof(Data));
}

/// Findings beyond the last row are counted there.
void Tally::Count(Row* rows, const std::string& filter, const std::string& text)
{
  std::size_t i = 0;
  while (i + 1 < Rows && rows[i].Count > 0 &&
    (filter.compare(0, TextLength - 1, rows[i].Filter) != 0 ||
      text.compare(0, TextLength - 1, rows[i].Text) != 0))
  {
    ++i;
  }
  Copy(rows[i].Filter, filter);
  Copy(rows[i].Text, text);
  ++rows[i].Count;
}

void Tally::AddCase(const std::string& filter, const char* result)
{
  this->Count(this->Shared->Cases, filter, result);
}

void Tally::AddFinding(const std::string& filter, const std::string& kind)
{
  ++this->Shared->Findings;
  this->Count(this->Shared->Kinds, filter, kind);
}

int Tally::GetNumberOfFindings() const
{
  return this->Shared->Findings;
}

void Tally::SetSeed(std::uint64_t seed)
{
  this->Shared->Seed = seed;
}

std::uint64_t Tally::GetSeed() const
{
  return this->Shared->Seed;
}

void Tally::SetStage(const std::string& stage)
{
  Copy(this->Shared->Stage, stage);
}

std::string Tally::GetStage() const
{
  return this->Shared->Stage;
}

void Tally::Print() const
{
  std::map<std::string, std::map<std::string, long long>> cases;
  for (const Row& row : this->Shared->Cases)
  {
    if (row.Count > 0)
    {
      cases[row.Filter][row.Text] += row.Count;
    }
  }
  std::printf("\n%-32s %9s %9s %9s\n", "filter", "quiet", "warned", "refused");
  long long total = 0;
  for (auto& row : cases)
  {
    std::printf("%-32s %9lld %9lld %9lld\n", row.first.c_str(), row.second["quiet"],
      row.second["warned"], row.second["refused"]);
    total += row.second["quiet"] + row.second["warned"] + row.second["refused"];
  }
  std::printf("%lld cases, %d failures\n", total, this->Shared->Findings);
  for (const Row& row : this->Shared->Kinds)
  {
    if (row.Count > 0)
    {
      std::printf("%8lld  %-32s %s\n", row.Count, row.Filter, row.Text);
    }
  }
}
}
