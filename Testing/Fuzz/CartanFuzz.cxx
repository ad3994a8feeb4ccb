// SPDX-License-Identifier: BSD-3-Clause
#include "Options.h"
#include "Reproduce.h"
#include "Tally.h"

#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"
#include "vtkSMPTools.h"

#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

namespace
{
using namespace fuzz;
using Clock = std::chrono::steady_clock;

/// Findings are the output; messages of VTK's own filters would drown them.
class Silence : public vtkOutputWindow
{
public:
  static Silence* New() { VTK_STANDARD_NEW_BODY(Silence); }
  vtkTypeMacro(Silence, vtkOutputWindow);
  void DisplayText(const char*) override {}
};

/// Processor seconds for one run of a filter; waiting for more than fifteen times as
/// long on the clock is a deadlock.
constexpr int TimeLimit = 20;

/// The process dies of it, which the watching process sees.
void LimitTime()
{
  itimerval limit{};
  limit.it_value.tv_sec = TimeLimit;
  setitimer(ITIMER_PROF, &limit, nullptr);
  alarm(15 * TimeLimit);
}

std::string KindOf(const Finding& finding)
{
  return finding.Invariant + ": " + finding.Text.substr(0, finding.Text.find(':'));
}

void Report(const Finding& finding, const Options& options, Tally& tally)
{
  tally.AddFinding(finding.Changed.Filter, KindOf(finding));
  const std::string script = WriteScript(finding, options.Folder);
  std::printf("FAILED seed %llu %s %s: %s\n    pvpython %s\n",
    static_cast<unsigned long long>(finding.Changed.Seed), finding.Changed.Filter.c_str(),
    finding.Invariant.c_str(), finding.Text.c_str(), script.c_str());
  std::fflush(stdout);
}

/// Those that the case and the command line allow.
std::vector<const Invariant*> Choose(const Case& of, const Options& options)
{
  std::vector<const Invariant*> chosen;
  for (const Invariant& one : Invariants())
  {
    const bool isWanted = options.Only.empty() || options.Only.count(one.Name) > 0;
    if (isWanted && options.Skip.count(one.Name) == 0 && one.Applies(of))
    {
      chosen.push_back(&one);
    }
  }
  return chosen;
}

void PrintIf(bool isWanted, const std::string& line)
{
  if (isWanted)
  {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  }
}

/// The result itself, and one law that relates it to others.
void CheckSeed(std::uint64_t seed, const Options& options, Tally& tally)
{
  LimitTime();
  tally.SetStage("sound");
  const Case original = MakeCase(seed, options.Filter);
  Random random(~seed);
  const std::vector<const Invariant*> chosen = Choose(original, options);
  const Invariant* invariant = chosen.empty() ? nullptr : random.Pick(chosen);
  if (options.IsVerbose)
  {
    std::printf("seed %llu %s %s\n", static_cast<unsigned long long>(seed), original.Filter.c_str(),
      invariant ? invariant->Name.c_str() : "");
    std::fflush(stdout);
  }
  const Outcome outcome = Run(original);
  tally.AddCase(original.Filter,
    outcome.Errors.empty() ? outcome.Warnings.empty() ? "quiet" : "warned" : "refused");
  for (const std::string& message : outcome.Errors)
  {
    PrintIf(options.IsVerbose, "  error: " + message);
  }
  for (const std::string& message : outcome.Warnings)
  {
    PrintIf(options.IsVerbose, "  warning: " + message);
  }
  const std::string unsound = DescribeUnsound(original, outcome);
  if (!unsound.empty())
  {
    Report({ "sound", unsound, {}, original, {} }, options, tally);
    return;
  }
  if (!invariant)
  {
    return;
  }
  LimitTime();
  tally.SetStage(invariant->Name);
  const std::optional<Finding> finding = invariant->Check(original, outcome, random);
  if (finding && options.Skip.count(finding->Invariant) == 0)
  {
    Report(*finding, options, tally);
  }
}

/// In a process of its own, from the tally's seed on.
int Work(const Options& options, Tally& tally, Clock::time_point end)
{
  vtkNew<Silence> silence;
  vtkOutputWindow::SetInstance(silence);
  vtkSMPTools::SetBackend("Sequential");
  while (tally.GetSeed() < options.EndSeed && Clock::now() < end &&
    tally.GetNumberOfFindings() < options.Limit)
  {
    CheckSeed(tally.GetSeed(), options, tally);
    tally.SetSeed(tally.GetSeed() + 1);
  }
  return 0;
}

/// Runs a function in a child and returns how the child ended.
template <typename Function>
int InChild(const Function& function)
{
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0)
  {
    const int result = function();
    std::fflush(stdout);
    _exit(result);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

void ReportDeath(int status, const Options& options, Tally& tally)
{
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  const bool isHang = signal == SIGPROF || signal == SIGALRM;
  const std::string text = isHang ? "hang: more than " + std::to_string(TimeLimit) + " s"
    : signal                      ? std::string("crash: ") + strsignal(signal)
                                  : "crash: exit code " + std::to_string(WEXITSTATUS(status));
  InChild(
    [&]
    {
      Finding finding{ tally.GetStage(), text, {}, MakeCase(tally.GetSeed(), options.Filter), {} };
      Report(finding, options, tally);
      return 0;
    });
  tally.SetSeed(tally.GetSeed() + 1);
}

int Watch(const Options& options)
{
  Tally tally;
  tally.SetSeed(options.FirstSeed);
  const double seconds = options.Seconds > 0.0 ? options.Seconds : 1e8;
  const auto end = Clock::now() +
    std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  int status = -1;
  while (status != 0)
  {
    status = InChild([&] { return Work(options, tally, end); });
    if (status != 0)
    {
      ReportDeath(status, options, tally);
    }
  }
  tally.Print();
  std::printf("seeds %llu to %llu\n", static_cast<unsigned long long>(options.FirstSeed),
    static_cast<unsigned long long>(tally.GetSeed()));
  return tally.GetNumberOfFindings() > 0 ? 1 : 0;
}
}

int main(int argc, char** argv)
{
  try
  {
    return Watch(ReadOptions(argc, argv));
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n%s", error.what(), Usage);
    return 2;
  }
}
