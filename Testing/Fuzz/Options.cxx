// SPDX-License-Identifier: BSD-3-Clause
#include "Options.h"

#include "Invariants.h"

#include <algorithm>
#include <stdexcept>

namespace fuzz
{
const char* const Usage =
  R"(usage: CartanFuzz [option value]...
Runs the filters of Cartan on generated surfaces and checks what must hold.
  --seeds A:B         the seeds from A to B - 1; A: without an end. Default: 0:1000
  --seconds S         stops after S seconds
  --filter Name       this filter only, such as PoissonDeformation
  --invariant Name    this invariant only; may be repeated. Each result by itself is
                      always checked
  --skip Name         all but this invariant; may be repeated. stability: differences
                      that rounding of the input alone would make, too
  --folder F          where scripts that reproduce a failure go. Default: .
  --limit N           stops after N failures
  --verbose 1         prints each case before it runs
The exit code is 1 if anything failed, 2 for a wrong command line.
)";

namespace
{
void ReadSeeds(const std::string& value, Options& options)
{
  const std::size_t colon = value.find(':');
  options.FirstSeed = std::stoull(value.substr(0, colon));
  if (colon == std::string::npos)
  {
    options.EndSeed = options.FirstSeed + 1;
  }
  else
  {
    const std::string end = value.substr(colon + 1);
    options.EndSeed = end.empty() ? UINT64_MAX : std::stoull(end);
  }
}

std::string KnownInvariant(const std::string& name)
{
  const auto& all = Invariants();
  const bool isKnown = name == "stability" ||
    std::any_of(all.begin(), all.end(), [&](const Invariant& one) { return one.Name == name; });
  if (!isKnown)
  {
    throw std::invalid_argument("there is no invariant " + name);
  }
  return name;
}

std::string KnownFilter(const std::string& name)
{
  const auto& all = Filters();
  if (std::find(all.begin(), all.end(), name) == all.end())
  {
    throw std::invalid_argument("there is no filter " + name);
  }
  return name;
}

void ReadOption(const std::string& name, const std::string& value, Options& options)
{
  if (name == "--seeds")
  {
    ReadSeeds(value, options);
  }
  else if (name == "--seconds")
  {
    options.Seconds = std::stod(value);
  }
  else if (name == "--filter")
  {
    options.Filter = KnownFilter(value);
  }
  else if (name == "--invariant")
  {
    options.Only.insert(KnownInvariant(value));
  }
  else if (name == "--skip")
  {
    options.Skip.insert(KnownInvariant(value));
  }
  else if (name == "--folder")
  {
    options.Folder = value;
  }
  else if (name == "--limit")
  {
    options.Limit = std::stoi(value);
  }
  else if (name == "--verbose")
  {
    options.IsVerbose = std::stoi(value) != 0;
  }
  else
  {
    throw std::invalid_argument("unknown option " + name);
  }
}
}

Options ReadOptions(int argc, char** argv)
{
  Options options;
  options.EndSeed = 1000;
  options.Folder = ".";
  for (int i = 1; i < argc; i += 2)
  {
    if (i + 1 == argc)
    {
      throw std::invalid_argument(std::string(argv[i]) + " needs a value");
    }
    ReadOption(argv[i], argv[i + 1], options);
  }
  return options;
}
}
