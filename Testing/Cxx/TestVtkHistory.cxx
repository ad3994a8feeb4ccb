// SPDX-License-Identifier: BSD-3-Clause
// The law of everything that is kept: after any history of inputs, parameters and
// edits, a filter gives what a fresh one gives, to the last bit.
#include "VtkTestHelpers.h"

#include "vtkAsRigidAsPossibleDeformation.h"
#include "vtkBox.h"
#include "vtkCurvatureError.h"
#include "vtkDiscreteForms.h"
#include "vtkFrameReconstruction.h"
#include "vtkHandleMotion.h"
#include "vtkLaplacianDeformation.h"
#include "vtkMarkHandle.h"
#include "vtkMultiresolutionDeformation.h"
#include "vtkPoissonDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkSimilarityDeformation.h"
#include "vtkSurfaceMorph.h"
#include "vtkTable.h"
#include "vtkVolumeChange.h"

#include <random>

namespace
{
using Surfaces = std::vector<vtkSmartPointer<vtkPolyData>>;

/// One thing about a filter that can change: how many values it has, and how the
/// filter gets one. The inputs are there because some values are edits of them.
struct Choice
{
  int Count;
  std::function<void(vtkAlgorithm*, int, Surfaces&)> Apply;
};

struct Subject
{
  std::string Name;
  std::function<vtkSmartPointer<vtkAlgorithm>()> New;
  std::vector<Choice> Choices;
};

void PrintTo(const Subject& subject, std::ostream* stream)
{
  *stream << subject.Name;
}

template <typename Filter>
Choice Of(int count, const std::function<void(Filter*, int)>& apply)
{
  return { count, [apply](vtkAlgorithm* filter, int value, Surfaces&) {
            apply(static_cast<Filter*>(filter), value);
          } };
}

/// Bends and shifts the points where they are, and tells of it by the data set's
/// time only, as a script does that writes into the array of a numpy view.
void EditInPlace(vtkPolyData* surface, int value)
{
  auto* points = vtkDoubleArray::SafeDownCast(surface->GetPoints()->GetData());
  for (vtkIdType v = 0; v < points->GetNumberOfTuples(); ++v)
  {
    double* point = points->GetPointer(3 * v);
    point[0] += 0.01 * (value + 1) * point[2] * point[2];
  }
  surface->Modified();
}

/// Moves the border of handle 2, in the array, and tells of it as above.
void EditHandles(vtkPolyData* surface, int value)
{
  auto* handles = vtkIntArray::SafeDownCast(surface->GetPointData()->GetArray("Handle"));
  for (vtkIdType v = 0; v < handles->GetNumberOfTuples(); ++v)
  {
    const double z = surface->GetPoint(v)[2];
    handles->SetValue(v, z < 0.6 ? 1 : z > 3.0 + 0.3 * value ? 2 : 0);
  }
  surface->Modified();
}

Surfaces MakeSurfaces()
{
  Surfaces surfaces;
  for (const int size : { 8, 10, 8 })
  {
    auto surface = vtktest::MakePolyData(shapes::Bar(2, 2, size, { 1.0, 1.0, 4.0 }));
    EditInPlace(surface, static_cast<int>(surfaces.size()));
    vtktest::AddHandles(
      surface, [](const Eigen::Vector3d& p) { return p.z() < 0.6 ? 1
                                                : p.z() > 3.4    ? 2
                                                                 : 0; });
    vtktest::AddArray(surface, "Target", 3,
      [&](vtkIdType v, double* target)
      {
        surface->GetPoint(v, target);
        target[1] += target[2] > 3.0 ? 0.5 : 0.0;
      });
    vtktest::AddArray(
      surface, "Weight", 1, [](vtkIdType v, double* weight) { *weight = 1.0 + v % 3; });
    surfaces.push_back(surface);
  }
  return surfaces;
}

/// The input, by number; and edits in place of the one that is connected.
std::vector<Choice> InputChoices()
{
  return { { 3, [](vtkAlgorithm* filter, int value, Surfaces& surfaces) {
              filter->SetInputDataObject(0, surfaces[value]);
            } } };
}

template <typename Filter>
std::vector<Choice> DeformationChoices(std::vector<Choice> own = {})
{
  std::vector<Choice> choices = InputChoices();
  choices.push_back(Of<Filter>(6,
    [](Filter* filter, int value)
    {
      filter->RemoveAllHandleMotions();
      for (int id = 1; id <= 2; ++id)
      {
        if (value % (id + 1) > 0 || value == 0)
        {
          vtkNew<vtkHandleMotion> motion;
          motion->SetAngle(20.0 * value);
          motion->SetAxis(1.0, 0.1 * id, 0.0);
          motion->SetTranslation(0.1 * id, 0.0, 0.0);
          filter->SetHandleMotion(id, motion);
        }
      }
    }));
  choices.push_back(Of<Filter>(3, [](Filter* f, int value) { f->SetLaplacianWeights(value); }));
  choices.push_back(Of<Filter>(
    2, [](Filter* f, int value) { f->SetTargetPositionArrayName(value ? "Target" : ""); }));
  choices.push_back(Of<Filter>(
    2, [](Filter* f, int value) { f->SetConstraintWeightArrayName(value ? "Weight" : ""); }));
  choices.push_back(
    Of<Filter>(2, [](Filter* f, int value) { f->SetConstrainHandlePositions(value == 0); }));
  choices.push_back(Of<Filter>(2, [](Filter* f, int value) { f->SetGenerateFrameChange(value); }));
  choices.push_back(
    Of<Filter>(2, [](Filter* f, int value) { f->SetKeptMemoryLimit(2000 * value); }));
  choices.insert(choices.end(), own.begin(), own.end());
  return choices;
}

template <typename Filter>
std::vector<Choice> FrameChoices(std::vector<Choice> own = {})
{
  own.push_back(Of<Filter>(3, [](Filter* f, int value) { f->SetVolumeCorrection(value); }));
  own.push_back(Of<Filter>(2, [](Filter* f, int value) { f->SetCloseVolume(value); }));
  own.push_back(Of<Filter>(4, [](Filter* f, int value) { f->SetPositionWeights(value); }));
  own.push_back(Of<Filter>(2, [](Filter* f, int value) { f->SetGenerateVolumeArrays(value); }));
  own.push_back(Of<Filter>(2, [](Filter* f, int value) { f->SetGenerateShapeDistance(value); }));
  return DeformationChoices<Filter>(std::move(own));
}

template <typename Filter>
Subject Make(const std::string& name, std::vector<Choice> choices)
{
  return { name, [] { return vtkSmartPointer<Filter>::New(); }, std::move(choices) };
}

template <typename Filter>
std::vector<Choice> ComparisonChoices(std::vector<Choice> own)
{
  std::vector<Choice> choices = InputChoices();
  choices.push_back({ 3, [](vtkAlgorithm* filter, int value, Surfaces& surfaces) {
                       filter->SetInputDataObject(1, surfaces[value]);
                     } });
  choices.insert(choices.end(), own.begin(), own.end());
  return choices;
}

Subject Morph()
{
  using Filter = vtkSurfaceMorph;
  std::vector<Choice> choices;
  choices.push_back({ 2,
    [](vtkAlgorithm* filter, int value, Surfaces& surfaces)
    {
      filter->RemoveAllInputConnections(0);
      filter->AddInputDataObject(0, surfaces[2 * value]);
      filter->AddInputDataObject(0, surfaces[2 - 2 * value]);
    } });
  choices.push_back(Of<Filter>(5, [](Filter* f, int value) { f->SetParameter(0.25 * value); }));
  choices.push_back(Of<Filter>(4, [](Filter* f, int value) { f->SetMethod(value); }));
  choices.push_back(Of<Filter>(2, [](Filter* f, int value) { f->SetPlacement(value); }));
  choices.push_back(Of<Filter>(2, [](Filter* f, int value) { f->SetCloseVolume(value); }));
  choices.push_back(Of<Filter>(3, [](Filter* f, int value) { f->SetStitching(value); }));
  choices.push_back(Of<Filter>(3, [](Filter* f, int value) { f->SetFrameSolver(value); }));
  choices.push_back(Of<Filter>(2, [](Filter* f, int value) { f->SetLengthPolish(value); }));
  return Make<Filter>("SurfaceMorph", choices);
}

Subject Mark()
{
  using Filter = vtkMarkHandle;
  std::vector<Choice> choices = InputChoices();
  choices.push_back(Of<Filter>(3,
    [](Filter* filter, int value)
    {
      vtkNew<vtkBox> box;
      box->SetBounds(-9.0, 9.0, -9.0, 9.0, 1.0 + value, 2.0 + value);
      filter->SetRegion(box);
    }));
  choices.push_back(Of<Filter>(3, [](Filter* f, int value) { f->SetHandleId(value); }));
  choices.push_back(Of<Filter>(3, [](Filter* f, int value) { f->SetGrowRings(value); }));
  choices.push_back(Of<Filter>(2, [](Filter* f, int value) { f->SetGrowDistance(value); }));
  return Make<Filter>("MarkHandle", choices);
}

Subject Reconstruction()
{
  using Filter = vtkFrameReconstruction;
  std::vector<Choice> choices = ComparisonChoices<Filter>({});
  choices[1].Apply = [](vtkAlgorithm* filter, int value, Surfaces& surfaces)
  {
    vtkNew<vtkDiscreteForms> forms; // a filter, because the surface may be edited
    forms->SetInputData(surfaces[value]);
    filter->SetInputConnection(1, forms->GetOutputPort(1));
  };
  choices.push_back(Of<Filter>(2, [](Filter* f, int value) { f->SetSeedPoint(value); }));
  choices.push_back(Of<Filter>(2, [](Filter* f, int value) { f->SetTransitionMethod(value); }));
  return Make<Filter>("FrameReconstruction", choices);
}

std::vector<Subject> Subjects()
{
  using RotationInvariant = vtkRotationInvariantDeformation;
  using Similarity = vtkSimilarityDeformation;
  using Rigid = vtkAsRigidAsPossibleDeformation;
  return {
    Make<RotationInvariant>("RotationInvariant",
      FrameChoices<RotationInvariant>({ Of<RotationInvariant>(
        3, [](RotationInvariant* f, int value) { f->SetFrameProjection(value); }) })),
    Make<vtkShapePreservingDeformation>("ShapePreserving",
      FrameChoices<vtkShapePreservingDeformation>({ Of<vtkShapePreservingDeformation>(3,
        [](vtkShapePreservingDeformation* f, int value)
        { f->SetMaximumIterations(1 + value); }) })),
    Make<vtkPoissonDeformation>("Poisson",
      FrameChoices<vtkPoissonDeformation>({ Of<vtkPoissonDeformation>(
        2, [](vtkPoissonDeformation* f, int value) { f->SetPropagation(value); }) })),
    Make<Similarity>("Similarity",
      DeformationChoices<Similarity>(
        { Of<Similarity>(2, [](Similarity* f, int value) { f->SetCoherenceRings(1 + value); }),
          Of<Similarity>(3, [](Similarity* f, int value) { f->SetReconstruction(value); }),
          Of<Similarity>(2, [](Similarity* f, int value) { f->SetRefits(value); }),
          Of<Similarity>(
            2, [](Similarity* f, int value) { f->SetConstrainHandleTransforms(value); }),
          Of<Similarity>(2, [](Similarity* f, int value) { f->SetScaleFeatures(value); }) })),
    Make<vtkLaplacianDeformation>("Laplacian",
      DeformationChoices<vtkLaplacianDeformation>(
        { Of<vtkLaplacianDeformation>(
            3, [](vtkLaplacianDeformation* f, int value) { f->SetRotations(value); }),
          Of<vtkLaplacianDeformation>(
            2, [](vtkLaplacianDeformation* f, int value) { f->SetRounds(2 + value); }) })),
    Make<vtkMultiresolutionDeformation>("Multiresolution",
      DeformationChoices<vtkMultiresolutionDeformation>({ Of<vtkMultiresolutionDeformation>(
        3, [](vtkMultiresolutionDeformation* f, int value) { f->SetSmoothness(1 + value); }) })),
    // PREVIOUS_RESULT depends on the way by its definition.
    Make<Rigid>("AsRigidAsPossible",
      DeformationChoices<Rigid>({ Of<Rigid>(3, [](Rigid* f, int value) { f->SetEnergy(value); }),
        Of<Rigid>(3, [](Rigid* f, int value) { f->SetInitialGuess(value ? value + 1 : 0); }),
        Of<Rigid>(2, [](Rigid* f, int value) { f->SetMaximumIterations(1 + 3 * value); }),
        Of<Rigid>(2, [](Rigid* f, int value) { f->SetGenerateRigidityEnergy(value); }) })),
    Make<vtkCurvatureError>("CurvatureError",
      ComparisonChoices<vtkCurvatureError>({ Of<vtkCurvatureError>(
        2, [](vtkCurvatureError* f, int value) { f->SetComputeDirections(value); }) })),
    Make<vtkVolumeChange>("VolumeChange",
      ComparisonChoices<vtkVolumeChange>({ Of<vtkVolumeChange>(
        2, [](vtkVolumeChange* f, int value) { f->SetComputeLocalVolume(value); }) })),
    Make<vtkDiscreteForms>("DiscreteForms", InputChoices()),
    Reconstruction(),
    Mark(),
    Morph(),
  };
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

class History : public testing::TestWithParam<Subject>
{
};

TEST_P(History, DoesNotMatter)
{
  const Subject& subject = GetParam();
  std::mt19937 random(20261125u);
  const auto draw = [&random](int count) { return static_cast<int>(random() % count); };
  Surfaces surfaces = MakeSurfaces();
  const auto used = subject.New();
  const auto log = vtktest::Observe(used);
  std::vector<int> state(subject.Choices.size(), 0);
  for (std::size_t c = 0; c < state.size(); ++c)
  {
    subject.Choices[c].Apply(used, 0, surfaces);
  }
  int successes = 0;
  for (int step = 0; step < 200; ++step)
  {
    const int change = draw(static_cast<int>(state.size()) + 2);
    if (change < static_cast<int>(state.size()))
    {
      state[change] = draw(subject.Choices[change].Count);
      subject.Choices[change].Apply(used, state[change], surfaces);
    }
    else if (change == static_cast<int>(state.size()))
    {
      EditInPlace(surfaces[draw(3)], draw(5) - 3);
    }
    else
    {
      EditHandles(surfaces[draw(3)], draw(3));
    }
    log->Clear();
    used->Update();

    const auto fresh = subject.New();
    const auto freshLog = vtktest::Observe(fresh);
    Surfaces copies;
    for (const auto& surface : surfaces)
    {
      copies.push_back(vtktest::CopyOf(surface));
    }
    for (std::size_t c = 0; c < state.size(); ++c)
    {
      subject.Choices[c].Apply(fresh, state[c], copies);
    }
    fresh->Update();
    SCOPED_TRACE("step " + std::to_string(step) + ", choice " + std::to_string(change));
    ExpectSameOutputs(used, fresh);
    if (!log->Errors.empty())
    {
      EXPECT_EQ(Texts(log->Errors), Texts(freshLog->Errors));
    }
    successes += fresh->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::POINT) > 0;
    if (HasFailure())
    {
      return;
    }
  }
  EXPECT_GT(successes, 30); // the walk is not one of errors only
}

INSTANTIATE_TEST_SUITE_P(OfEveryFilter, History, testing::ValuesIn(Subjects()),
  [](const auto& subject) { return subject.param.Name; });
}
