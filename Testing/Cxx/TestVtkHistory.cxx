// SPDX-License-Identifier: BSD-3-Clause
// Laws of every filter. After any history of inputs, parameters and edits it gives
// what a fresh one gives, to the last bit, with the same messages; and its progress
// never runs back.
#include "HistoryOfDeformations.h"
#include "HistoryOfTools.h"

#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <random>
#include <set>
#include <sstream>

namespace
{
using history::Subject;
using history::Surfaces;

std::vector<Subject> Subjects()
{
  std::vector<Subject> subjects = history::DeformationSubjects();
  for (Subject& tool : history::ToolSubjects())
  {
    subjects.push_back(std::move(tool));
  }
  return subjects;
}

void ExpectSameTable(vtkTable* actual, vtkTable* expected)
{
  ASSERT_EQ(actual->GetNumberOfRows(), expected->GetNumberOfRows());
  ASSERT_EQ(actual->GetNumberOfColumns(), expected->GetNumberOfColumns());
  for (vtkIdType c = 0; c < expected->GetNumberOfColumns(); ++c)
  {
    EXPECT_TRUE(vtktest::SameArray(actual->GetColumn(c), expected->GetColumn(c))) << c;
  }
}

void ExpectSameGrid(vtkUnstructuredGrid* actual, vtkUnstructuredGrid* expected)
{
  ASSERT_EQ(actual->GetNumberOfPoints(), expected->GetNumberOfPoints());
  ASSERT_EQ(actual->GetNumberOfCells(), expected->GetNumberOfCells());
  if (expected->GetNumberOfPoints() > 0)
  {
    EXPECT_TRUE(
      vtktest::SameArray(actual->GetPoints()->GetData(), expected->GetPoints()->GetData()));
  }
  vtktest::ExpectArrays(actual->GetPointData(), expected->GetPointData());
  vtktest::ExpectArrays(actual->GetCellData(), expected->GetCellData());
}

void ExpectSameOutputs(vtkAlgorithm* actual, vtkAlgorithm* expected)
{
  for (int port = 0; port < expected->GetNumberOfOutputPorts(); ++port)
  {
    vtkDataObject* a = actual->GetOutputDataObject(port);
    vtkDataObject* b = expected->GetOutputDataObject(port);
    if (auto* table = vtkTable::SafeDownCast(b))
    {
      ExpectSameTable(vtkTable::SafeDownCast(a), table);
    }
    else if (auto* grid = vtkUnstructuredGrid::SafeDownCast(b))
    {
      ExpectSameGrid(vtkUnstructuredGrid::SafeDownCast(a), grid);
    }
    else
    {
      vtktest::ExpectSameSurface(vtkPolyData::SafeDownCast(a), vtkPolyData::SafeDownCast(b));
    }
  }
}

/// What a message says, without the address of the object that says it.
std::vector<std::string> Texts(const std::vector<std::string>& messages)
{
  std::vector<std::string> texts;
  for (const std::string& message : messages)
  {
    const std::size_t start = message.find("): ");
    texts.push_back(start == std::string::npos ? message : message.substr(start));
  }
  return texts;
}

/// A filter with all that it reports.
struct Observed
{
  explicit Observed(const Subject& subject)
    : Filter(subject.New())
    , Log(vtktest::Observe(this->Filter))
  {
    this->Filter->AddObserver(vtkCommand::ProgressEvent, this->Progress);
  }

  void Update()
  {
    this->Log->Clear();
    this->Progress->Fractions.clear();
    this->Filter->Update();
  }

  bool HasRun() const { return !this->Progress->Fractions.empty(); }

  void ExpectProgress() const
  {
    const std::vector<double>& fractions = this->Progress->Fractions;
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()))
      << testing::PrintToString(fractions);
    EXPECT_TRUE(fractions.empty() || (fractions.front() >= 0.0 && fractions.back() <= 1.0));
  }

  vtkSmartPointer<vtkAlgorithm> Filter;
  vtkSmartPointer<vtktest::Log> Log;
  vtkNew<vtktest::ProgressLog> Progress;
};

/// The values that all choices of a subject have, and the surfaces.
class Walk
{
public:
  explicit Walk(const Subject& subject)
    : TheSubject(subject)
    , Inputs(history::MakeSurfaces())
    , State(subject.Choices.size(), 0)
  {
  }

  /// Gives a filter all values.
  void Apply(vtkAlgorithm* filter, Surfaces& surfaces) const
  {
    for (std::size_t c = 0; c < this->State.size(); ++c)
    {
      this->TheSubject.Choices[c].Apply(filter, this->State[c], surfaces);
    }
  }

  /// Changes one value, or edits one surface.
  void Step(vtkAlgorithm* filter)
  {
    const auto count = static_cast<int>(this->State.size());
    const int change = this->Draw(count + 2);
    if (change < count)
    {
      this->State[change] = this->Draw(this->TheSubject.Choices[change].Count);
      this->TheSubject.Choices[change].Apply(filter, this->State[change], this->Inputs);
    }
    else if (change == count)
    {
      history::EditInPlace(this->Inputs[this->Draw(history::NumberOfSurfaces)], this->Draw(5) - 3);
    }
    else
    {
      history::EditHandles(this->Inputs[this->Draw(history::NumberOfSurfaces)], this->Draw(3));
    }
  }

  Surfaces& GetInputs() { return this->Inputs; }

  Surfaces CopyInputs() const
  {
    Surfaces copies;
    for (const auto& surface : this->Inputs)
    {
      copies.push_back(vtktest::CopyOf(surface));
    }
    return copies;
  }

  std::string Describe() const { return testing::PrintToString(this->State); }

private:
  int Draw(int count) { return static_cast<int>(this->Random() % count); }

  const Subject& TheSubject;
  Surfaces Inputs;
  std::vector<int> State;
  std::mt19937 Random{ 20261125u };
};

class History : public testing::TestWithParam<Subject>
{
};

TEST_P(History, DoesNotMatter)
{
  Walk walk(GetParam());
  Observed used(GetParam());
  walk.Apply(used.Filter, walk.GetInputs());
  int successes = 0;
  for (int step = 0; step < 300 && !HasFailure(); ++step)
  {
    walk.Step(used.Filter);
    used.Update();
    Observed fresh(GetParam());
    Surfaces copies = walk.CopyInputs();
    walk.Apply(fresh.Filter, copies);
    fresh.Update();
    SCOPED_TRACE("step " + std::to_string(step) + ", values " + walk.Describe());
    ExpectSameOutputs(used.Filter, fresh.Filter);
    used.ExpectProgress();
    fresh.ExpectProgress();
    if (used.HasRun())
    {
      EXPECT_EQ(Texts(used.Log->Errors), Texts(fresh.Log->Errors));
      EXPECT_EQ(Texts(used.Log->Warnings), Texts(fresh.Log->Warnings));
    }
    successes +=
      fresh.Filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::POINT) > 0;
  }
  EXPECT_GT(successes, 30); // the walk is not one of errors only
}

INSTANTIATE_TEST_SUITE_P(OfEveryFilter, History, testing::ValuesIn(Subjects()),
  [](const auto& subject) { return subject.param.Name; });

TEST(History, EveryClassIsASubject)
{
  // Bases, and what is not a filter.
  std::set<std::string> covered = { "vtkCompressedSurfaceReader", "vtkCompressedSurfaceWriter",
    "vtkDifferentialFilter", "vtkFrameDeformation", "vtkHandleMotion", "vtkSetNumberMacro",
    "vtkSurfaceComparison", "vtkSurfaceDeformation", "vtkSurfaceFilter" };
  for (const Subject& subject : Subjects())
  {
    covered.insert(subject.New()->GetClassName());
  }
  std::istringstream classes(CARTAN_CLASSES);
  std::set<std::string> existing;
  for (std::string name; classes >> name;)
  {
    existing.insert(name);
  }
  EXPECT_EQ(existing, covered);
}
}
