// SPDX-License-Identifier: BSD-3-Clause
//
// What a drag costs: set-up, motions and memory of rotation-invariant editing,
// next to one iteration of CGAL's as-rigid-as-possible deformation on the same
// surface with the same handles in the same run. Ends with a table of what was
// asked and what was measured.
//
// Names of the benchmarks: what/surface/handles/backend/threads.
//   ends   static below 5 % of the height, handle above 95 %: nearly all free
//   thirds static below 30 %, handle above 80 %
// Google Benchmark's own options apply, for example --benchmark_filter=104K.
#include "BenchmarkTools.h"
#include "PeerDeformation.h"

#include "Kernel/Base/Constants.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "vtkHandleMotion.h"
#include "vtkRotationInvariantDeformation.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkShapePreservingDeformation.h"

#include <benchmark/benchmark.h>

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

using namespace benchmarks;
using cartan::FrameProjection;
using cartan::SolverBackend;

namespace
{
constexpr double Degrees = cartan::Pi / 180.0;

/// The armadillo, subdivided `times` times.
Mesh Armadillo(int times)
{
  Mesh mesh = ReadMesh("armadillo");
  for (int i = 0; i < times; ++i)
  {
    mesh = Subdivide(mesh);
  }
  return mesh;
}

/// What is measured. Everything that a benchmark's name says.
struct Case
{
  int Subdivisions = 1;
  bool IsEnds = true;
  SolverBackend Backend = SolverBackend::Automatic;
  bool IsThreaded = true;

  std::string Surface() const
  {
    const char* names[] = { "26K", "104K", "416K", "1.66M" };
    return names[this->Subdivisions];
  }
  std::string Handles() const { return this->IsEnds ? "ends" : "thirds"; }
  double Low() const { return this->IsEnds ? 0.05 : 0.3; }
  double High() const { return this->IsEnds ? 0.95 : 0.8; }
  std::string SolverName() const
  {
    return this->Backend == SolverBackend::Eigen ? "Eigen" : "CHOLMOD";
  }
  std::string Name() const
  {
    return this->Surface() + "/" + this->Handles() + "/" + this->SolverName() + "/" +
      (this->IsThreaded ? "threads" : "sequential");
  }
  bool operator==(const Case& other) const { return this->Name() == other.Name(); }
};

/// A new motion each time it is asked: turns about x, back and forth.
cartan::HandleMotion NextMotion()
{
  static int step = 0;
  step = (step + 1) % 60;
  cartan::HandleMotion motion;
  motion.RotationVector = Eigen::Vector3d(Degrees * (15 + step), 0.0, 0.0);
  motion.Linear =
    Eigen::AngleAxisd(motion.RotationVector.norm(), Eigen::Vector3d::UnitX()).toRotationMatrix();
  motion.Translation = Eigen::Vector3d(0.0, 0.01 * step, 0.0);
  return motion;
}

class Clock
{
public:
  /// Seconds since the last call.
  double Lap()
  {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - this->Last).count();
    this->Last = now;
    return seconds;
  }

private:
  std::chrono::steady_clock::time_point Last = std::chrono::steady_clock::now();
};

/// The surface of the last case, so that it is built once for all its
/// benchmarks and not held afterwards.
const Mesh& CachedMesh(int subdivisions)
{
  static int cached = -1;
  static Mesh mesh;
  if (cached != subdivisions)
  {
    mesh = Armadillo(subdivisions);
    cached = subdivisions;
  }
  return mesh;
}

/// Seconds of the steps that RotationInvariantDeformer goes through, and of the
/// whole, which ends with the fields of the first raw motion.
void SetUp(benchmark::State& state, const Case& which)
{
  const Mesh& mesh = CachedMesh(which.Subdivisions);
  const cartan::ExecutionContext context = Threads(which.IsThreaded);
  double steps[4] = {};
  double fields = 0.0;
  int free = 0;
  for (auto _ : state)
  {
    {
      Clock clock;
      const cartan::HandleProblem problem = MakeProblem(mesh, which.Low(), which.High());
      steps[0] += clock.Lap();
      const Eigen::VectorXd directed =
        cartan::EdgeWeights(*problem.Mesh, *problem.Rest, problem.Weights, context);
      const auto weights =
        std::make_shared<const Eigen::VectorXd>(cartan::SymmetricPart(*problem.Mesh, directed));
      steps[1] += clock.Lap();
      const cartan::HandleLaplacian laplacian(
        problem, weights, cartan::Hold::AllHandles, which.Backend, context);
      steps[2] += clock.Lap();
      benchmark::DoNotOptimize(laplacian.HarmonicFields());
      steps[3] += clock.Lap();
    }
    Clock clock;
    cartan::RotationInvariantDeformer deformer(
      MakeProblem(mesh, which.Low(), which.High()), which.Backend, context);
    deformer.SetFrameProjection(FrameProjection::None);
    cartan::DeformedSurface result;
    cartan::HandleTargets targets;
    targets.Motions = { NextMotion() };
    const double before = clock.Lap();
    deformer.Deform(targets, false, result, context);
    const double first = clock.Lap();
    fields += first;
    state.SetIterationTime(before + first);
    free = deformer.GetNumberOfFreeVertices();
  }
  using benchmark::Counter;
  state.counters["free"] = free;
  state.counters["mesh"] = Counter(steps[0], Counter::kAvgIterations);
  state.counters["weights"] = Counter(steps[1], Counter::kAvgIterations);
  state.counters["factorize"] = Counter(steps[2], Counter::kAvgIterations);
  state.counters["harmonic"] = Counter(steps[3], Counter::kAvgIterations);
  state.counters["first_motion"] = Counter(fields, Counter::kAvgIterations);
}

/// A motion in the kernel.
void KernelMotion(benchmark::State& state, const Case& which, FrameProjection projection)
{
  const cartan::ExecutionContext context = Threads(which.IsThreaded);
  // Kept from one repetition, and one projection, to the next.
  static std::optional<Case> cached;
  static std::unique_ptr<cartan::RotationInvariantDeformer> deformer;
  if (!cached || !(*cached == which))
  {
    deformer.reset();
    deformer = std::make_unique<cartan::RotationInvariantDeformer>(
      MakeProblem(CachedMesh(which.Subdivisions), which.Low(), which.High()), which.Backend,
      context);
    cached = which;
  }
  deformer->SetFrameProjection(projection);
  cartan::DeformedSurface result;
  cartan::HandleTargets targets;
  targets.Motions = { NextMotion() };
  deformer->Deform(targets, false, result, context);
  for (auto _ : state)
  {
    targets.Motions = { NextMotion() };
    deformer->Deform(targets, false, result, context);
  }
}

vtkSmartPointer<vtkPolyData> MarkedSurface(const Mesh& mesh, const Case& which)
{
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetNumberOfTuples(mesh.Points.rows());
  std::copy_n(mesh.Points.data(), mesh.Points.size(), coordinates->GetPointer(0));
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(mesh.Triangles.rows(), mesh.Triangles.size());
  for (Eigen::Index t = 0; t < mesh.Triangles.rows(); ++t)
  {
    const vtkIdType ids[3] = { mesh.Triangles(t, 0), mesh.Triangles(t, 1), mesh.Triangles(t, 2) };
    cells->InsertNextCell(3, ids);
  }
  vtkNew<vtkIntArray> handle;
  handle->SetName("Handle");
  handle->SetNumberOfValues(mesh.Points.rows());
  const std::vector<int> handles = MarkEnds(mesh, which.Low(), which.High());
  std::copy(handles.begin(), handles.end(), handle->GetPointer(0));
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(cells);
  surface->GetPointData()->AddArray(handle);
  return surface;
}

void Configure(
  vtkRotationInvariantDeformation* filter, const Case& which, FrameProjection projection)
{
  filter->SetFrameProjection(projection == FrameProjection::None
      ? vtkRotationInvariantDeformation::NONE
      : vtkRotationInvariantDeformation::AUTOMATIC);
  filter->SetSolver(which.Backend == SolverBackend::Eigen ? vtkSurfaceDeformation::EIGEN
                                                          : vtkSurfaceDeformation::CHOLMOD);
}

/// A motion as a user of the filter sees it: checks of the input, the kernel,
/// the output's points.
void FilterMotion(benchmark::State& state, const Case& which, FrameProjection projection)
{
  vtkSMPTools::SetBackend(which.IsThreaded ? "STDThread" : "Sequential");
  static std::optional<Case> cached;
  static vtkSmartPointer<vtkRotationInvariantDeformation> filter;
  static vtkSmartPointer<vtkHandleMotion> motion;
  if (!cached || !(*cached == which))
  {
    filter = vtkSmartPointer<vtkRotationInvariantDeformation>::New();
    motion = vtkSmartPointer<vtkHandleMotion>::New();
    motion->SetAxis(1.0, 0.0, 0.0);
    filter->SetInputData(MarkedSurface(CachedMesh(which.Subdivisions), which));
    filter->SetHandleMotion(2, motion);
    cached = which;
  }
  Configure(filter, which, projection);
  motion->SetAngle(10.0);
  filter->Update();
  for (auto _ : state)
  {
    motion->SetAngle(NextMotion().RotationVector[0] / Degrees);
    filter->Update();
  }
  state.counters["factorizations"] = filter->GetNumberOfFactorizations();
}

/// What the filter does before a motion in which only the motion of a handle
/// changed, and the motion, in milliseconds: the best of several updates.
void BeforeMotion(benchmark::State& state, const Case& which)
{
  vtkSMPTools::SetBackend(which.IsThreaded ? "STDThread" : "Sequential");
  vtkNew<vtkRotationInvariantDeformation> filter;
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(1.0, 0.0, 0.0);
  filter->SetInputData(MarkedSurface(CachedMesh(which.Subdivisions), which));
  filter->SetHandleMotion(2, motion);
  Configure(filter, which, FrameProjection::None);
  filter->Update();
  double before = 1e300;
  double itself = 1e300;
  for (auto _ : state)
  {
    motion->SetAngle(NextMotion().RotationVector[0] / Degrees);
    filter->Update();
    before = std::min(before, filter->GetSetupTime());
    itself = std::min(itself, filter->GetMotionTime());
  }
  state.counters["before"] = 1e3 * before;
  state.counters["motion"] = 1e3 * itself;
}

/// What the preservation of volume adds to a shape-preserving motion.
struct Preservation
{
  const char* Name;
  int Correction;
  bool Close;
};

const std::array<Preservation, 4> Preservations = { {
  { "shape", vtkFrameDeformation::NO_CORRECTION, false },
  { "shape, neutral offset", vtkFrameDeformation::NEUTRAL_OFFSET, false },
  { "shape, neutral offset and close", vtkFrameDeformation::NEUTRAL_OFFSET, true },
  { "shape, frame scaling", vtkFrameDeformation::FRAME_SCALING, false },
} };

/// A motion about one axis through the shape-preserving filter; the depth of the
/// body is measured before.
void ShapeMotion(benchmark::State& state, const Case& which, const Preservation& preservation)
{
  vtkSMPTools::SetBackend(which.IsThreaded ? "STDThread" : "Sequential");
  static std::optional<Case> cached;
  static vtkSmartPointer<vtkShapePreservingDeformation> filter;
  static vtkSmartPointer<vtkHandleMotion> motion;
  if (!cached || !(*cached == which))
  {
    filter = vtkSmartPointer<vtkShapePreservingDeformation>::New();
    motion = vtkSmartPointer<vtkHandleMotion>::New();
    motion->SetAxis(1.0, 0.0, 0.0);
    filter->SetInputData(MarkedSurface(CachedMesh(which.Subdivisions), which));
    filter->SetHandleMotion(2, motion);
    cached = which;
  }
  filter->SetVolumeCorrection(preservation.Correction);
  filter->SetCloseVolume(preservation.Close);
  motion->SetAngle(10.0);
  filter->Update();
  for (auto _ : state)
  {
    motion->SetAngle(NextMotion().RotationVector[0] / Degrees);
    filter->Update();
  }
  state.counters["factorizations"] = filter->GetNumberOfFactorizations();
}

void PeerIteration(benchmark::State& state, const Case& which)
{
  static std::optional<Case> cached;
  static std::unique_ptr<PeerDeformation> peer;
  if (!cached || !(*cached == which))
  {
    const Mesh& mesh = CachedMesh(which.Subdivisions);
    peer.reset();
    peer = std::make_unique<PeerDeformation>(
      mesh.Points, mesh.Triangles, MarkEnds(mesh, which.Low(), which.High()));
    cached = which;
  }
  for (auto _ : state)
  {
    state.PauseTiming();
    const cartan::HandleMotion motion = NextMotion();
    peer->MoveHandle(motion.Linear, motion.Translation);
    state.ResumeTiming();
    peer->Iterate();
  }
}

/// A line of /proc/self/status in bytes, such as VmRSS and its peak VmHWM.
double ProcessMemory(const std::string& key)
{
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word)
  {
    if (word == key + ":")
    {
      double kilobytes = 0.0;
      status >> kilobytes;
      return 1024.0 * kilobytes;
    }
  }
  return 0.0;
}

/// The growth of the peak memory over set-up, a raw and a projected motion, in
/// bytes per vertex; of the kernel or the filter. Runs in a process of its own.
double MeasureMemory(const Case& which, bool isFilter)
{
  const Mesh mesh = Armadillo(which.Subdivisions);
  const vtkSmartPointer<vtkPolyData> surface = isFilter ? MarkedSurface(mesh, which) : nullptr;
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5; // the peak starts anew
  const double before = ProcessMemory("VmRSS");
  if (isFilter)
  {
    vtkNew<vtkHandleMotion> motion;
    vtkNew<vtkRotationInvariantDeformation> filter;
    filter->SetInputData(surface);
    filter->SetHandleMotion(2, motion);
    for (const FrameProjection projection : { FrameProjection::None, FrameProjection::Automatic })
    {
      Configure(filter, which, projection);
      motion->SetAngle(motion->GetAngle() + 30.0);
      filter->Update();
    }
  }
  else
  {
    cartan::RotationInvariantDeformer deformer(
      MakeProblem(mesh, which.Low(), which.High()), which.Backend);
    cartan::DeformedSurface result;
    for (const FrameProjection projection : { FrameProjection::None, FrameProjection::Automatic })
    {
      deformer.SetFrameProjection(projection);
      cartan::HandleTargets targets;
      targets.Motions = { NextMotion() };
      deformer.Deform(targets, false, result, {});
    }
  }
  return (ProcessMemory("VmHWM") - before) / static_cast<double>(mesh.Points.rows());
}

/// The same as a benchmark, whose result is a counter.
void Memory(benchmark::State& state, const Case& which, bool isFilter)
{
  double bytes = 0.0;
  for (auto _ : state)
  {
    std::ostringstream command;
    command << "/proc/" << getpid() << "/exe --measure-memory " << which.Subdivisions << ' '
            << which.IsEnds << ' ' << static_cast<int>(which.Backend) << ' ' << isFilter;
    FILE* child = popen(command.str().c_str(), "r");
    if (!child || std::fscanf(child, "%lf", &bytes) != 1)
    {
      state.SkipWithError("The child process failed.");
    }
    if (child)
    {
      pclose(child);
    }
  }
  state.counters["bytes_per_vertex"] = bytes;
}

/// Prints as usual and keeps the best repetition of each benchmark: what is
/// slower than that is other processes. Sequential cases are compared by the
/// processor's time, which others disturb least, threaded ones by the clock.
class Collector : public benchmark::ConsoleReporter
{
public:
  Collector()
    : ConsoleReporter(OO_None)
  {
  }

  void ReportRuns(const std::vector<Run>& runs) override
  {
    this->ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs)
    {
      if (run.run_type != Run::RT_Iteration || run.error_occurred)
      {
        continue;
      }
      const std::string& name = run.run_name.function_name;
      const auto iterations = static_cast<double>(run.iterations);
      const double wall = run.real_accumulated_time / iterations;
      const double cpu = run.cpu_accumulated_time / iterations;
      const auto [found, isFirst] = this->Best.emplace(name, Result());
      Result& best = found->second;
      best.Cpu = isFirst ? cpu : std::min(best.Cpu, cpu);
      if (isFirst || wall < best.Wall)
      {
        best.Wall = wall;
        for (const auto& [key, counter] : run.counters)
        {
          best.Counters[key] = counter.value;
        }
      }
    }
  }

  bool Has(const std::string& name) const { return this->Best.count(name) > 0; }
  double Wall(const std::string& name) const { return this->Best.at(name).Wall; }
  double Seconds(const std::string& name, bool isThreaded) const
  {
    return isThreaded ? this->Wall(name) : this->Best.at(name).Cpu;
  }
  double Value(const std::string& name, const std::string& counter) const
  {
    return this->Best.at(name).Counters.at(counter);
  }

private:
  struct Result
  {
    double Wall = 0.0;
    double Cpu = 0.0;
    std::map<std::string, double> Counters;
  };
  std::map<std::string, Result> Best;
};

constexpr const char* BeforeName = "before/416K/ends";

void PrintTable(const Collector& results, const std::vector<Case>& cases)
{
  std::printf("\n%-60s %-10s %s\n", "Asked and measured", "asked", "measured");
  if (results.Has(BeforeName))
  {
    const double before = results.Value(BeforeName, "before");
    const double motion = results.Value(BeforeName, "motion");
    std::printf("%s\n", BeforeName);
    PrintRow("before a raw motion, filter", "<= 1/10", before, "ms", before <= 0.1 * motion);
    PrintRow("raw motion, filter", "", motion, "ms");
  }
  for (const Case& which : cases)
  {
    const std::string setUp = "setup/" + which.Name();
    if (!results.Has(setUp))
    {
      continue;
    }
    const bool isTarget = which.Subdivisions == 1;
    std::printf("%s, %.0f free vertices\n", which.Name().c_str(), results.Value(setUp, "free"));
    const double seconds = results.Wall(setUp);
    PrintRow("set-up", isTarget ? "< 1 s" : "", seconds, "s", seconds < 1.0);
    const std::pair<const char*, const char*> steps[] = { { "mesh", "check and connectivity" },
      { "weights", "cotangent weights" }, { "factorize", "assembly and factorization" },
      { "harmonic", "harmonic fields" }, { "first_motion", "fields of the first raw motion" } };
    for (const auto& [counter, label] : steps)
    {
      PrintRow(std::string("  ") + label, "", results.Value(setUp, counter), "s");
    }
    const std::string peer = "cgal/" + which.Surface() + "/" + which.Handles();
    if (isTarget && results.Has(peer))
    {
      PrintRow("one iteration of CGAL ORIGINAL_ARAP", "",
        1e3 * results.Seconds(peer, which.IsThreaded), "ms");
    }
    for (const auto& [level, projection, asked] :
      { std::tuple<const char*, const char*, double>{ "kernel", "raw", 1.0 / 20.0 },
        { "kernel", "projected", 1.0 / 4.0 }, { "filter", "raw", 1.0 / 20.0 },
        { "filter", "projected", 1.0 / 4.0 } })
    {
      const std::string motion = std::string(level) + "/" + projection + "/" + which.Name();
      if (!results.Has(motion))
      {
        continue;
      }
      PrintRow(std::string(projection) + " motion, " + level, "",
        1e3 * results.Seconds(motion, which.IsThreaded), "ms");
      if (isTarget && results.Has(peer))
      {
        const double ratio =
          results.Seconds(motion, which.IsThreaded) / results.Seconds(peer, which.IsThreaded);
        char text[16];
        std::snprintf(text, sizeof(text), "<= %.2f", asked);
        PrintRow("  ratio to CGAL's iteration", text, ratio, "", ratio <= asked);
      }
    }
    const std::string shape = std::string(Preservations[0].Name) + "/" + which.Name();
    for (const Preservation& preservation : Preservations)
    {
      const std::string motion = std::string(preservation.Name) + "/" + which.Name();
      if (!results.Has(motion))
      {
        continue;
      }
      const double ofMotion = results.Seconds(motion, which.IsThreaded);
      PrintRow(std::string(preservation.Name) + " motion, filter", "", 1e3 * ofMotion, "ms");
      if (motion == shape && isTarget && results.Has(peer))
      {
        const double ratio = ofMotion / results.Seconds(peer, which.IsThreaded);
        PrintRow("  ratio to CGAL's iteration", "<= 0.33", ratio, "", ratio <= 1.0 / 3.0);
      }
      else if (motion != shape && results.Has(shape))
      {
        const double ratio = ofMotion / results.Seconds(shape, which.IsThreaded);
        PrintRow("  ratio to the motion without", "<= 4", ratio, "", ratio <= 4.0);
      }
    }
    for (const char* level : { "kernel", "filter" })
    {
      const std::string memory = std::string("memory/") + level + "/" + which.Surface() + "/" +
        which.Handles() + "/" + which.SolverName();
      if (results.Has(memory))
      {
        const double bytes = results.Value(memory, "bytes_per_vertex");
        PrintRow(
          std::string("memory per vertex, ") + level, "<= 2048 B", bytes, "B", bytes <= 2048.0);
      }
    }
  }
}
}

int main(int argc, char** argv)
{
  if (argc == 6 && std::string(argv[1]) == "--measure-memory")
  {
    const Case which{ std::atoi(argv[2]), argv[3][0] == '1',
      static_cast<SolverBackend>(std::atoi(argv[4])), false };
    std::printf("%f\n", MeasureMemory(which, argv[5][0] == '1'));
    return 0;
  }

  std::vector<SolverBackend> backends;
  if (cartan::HasCholmod())
  {
    backends.push_back(SolverBackend::Cholmod);
  }
  backends.push_back(SolverBackend::Eigen);
  std::vector<Case> cases;
  for (const bool isEnds : { true, false })
  {
    for (const SolverBackend backend : backends)
    {
      cases.push_back({ 1, isEnds, backend, true });
      cases.push_back({ 1, isEnds, backend, false });
    }
  }
  cases.push_back({ 3, true, backends.front(), true });

  using benchmark::RegisterBenchmark;
  for (const Case& which : cases)
  {
    const bool isLarge = which.Subdivisions > 1;
    const int repetitions = isLarge ? 1 : 3;
    const std::string name = which.Name();
    RegisterBenchmark(("setup/" + name).c_str(), [=](auto& state) { SetUp(state, which); })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1)
      ->Repetitions(repetitions);
    for (const FrameProjection projection : { FrameProjection::None, FrameProjection::Rotation })
    {
      const std::string motion =
        std::string(projection == FrameProjection::None ? "raw/" : "projected/") + name;
      RegisterBenchmark(
        ("kernel/" + motion).c_str(), [=](auto& state) { KernelMotion(state, which, projection); })
        ->UseRealTime()
        ->MeasureProcessCPUTime()
        ->Unit(benchmark::kMillisecond)
        ->MinTime(0.3)
        ->Repetitions(repetitions);
      RegisterBenchmark(
        ("filter/" + motion).c_str(), [=](auto& state) { FilterMotion(state, which, projection); })
        ->UseRealTime()
        ->MeasureProcessCPUTime()
        ->Unit(benchmark::kMillisecond)
        ->MinTime(0.3)
        ->Repetitions(repetitions);
    }
    for (const Preservation& preservation : Preservations)
    {
      if (!isLarge && which.Backend == backends.front())
      {
        RegisterBenchmark((std::string(preservation.Name) + "/" + name).c_str(),
          [=](auto& state) { ShapeMotion(state, which, preservation); })
          ->UseRealTime()
          ->MeasureProcessCPUTime()
          ->Unit(benchmark::kMillisecond)
          ->MinTime(0.3)
          ->Repetitions(repetitions);
      }
    }
    if (!isLarge && which.IsThreaded && which.Backend == backends.front())
    {
      RegisterBenchmark(("cgal/" + which.Surface() + "/" + which.Handles()).c_str(),
        [=](auto& state) { PeerIteration(state, which); })
        ->UseRealTime()
        ->MeasureProcessCPUTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(5)
        ->Repetitions(repetitions);
    }
    if (which.IsThreaded)
    {
      for (const bool isFilter : { false, true })
      {
        RegisterBenchmark((std::string("memory/") + (isFilter ? "filter/" : "kernel/") +
                            which.Surface() + "/" + which.Handles() + "/" + which.SolverName())
                            .c_str(),
          [=](auto& state) { Memory(state, which, isFilter); })
          ->Unit(benchmark::kMillisecond)
          ->Iterations(1);
      }
    }
  }

  RegisterBenchmark(BeforeName,
    [=](auto& state) {
      BeforeMotion(state, { 2, true, backends.front(), true });
    })
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(20);

  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv))
  {
    return 1;
  }
  Collector results;
  benchmark::RunSpecifiedBenchmarks(&results);
  PrintTable(results, cases);
  return 0;
}
