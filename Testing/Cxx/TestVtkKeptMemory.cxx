// SPDX-License-Identifier: BSD-3-Clause
// How much all filters keep, and what they share.
#include "History.h"

#include "vtkCurvatureError.h"
#include "vtkDiscreteForms.h"
#include "vtkFrameReconstruction.h"
#include "vtkHandleMotion.h"
#include "vtkMarkHandle.h"
#include "vtkPrepareSurface.h"
#include "vtkRestoreSurface.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkSurfaceMorph.h"
#include "vtkVolumeChange.h"

#include "vtkBox.h"

#include <cmath>

namespace
{
/// A bar that is bent a little more with each step, large enough for a limit in
/// megabytes to matter.
vtkSmartPointer<vtkPolyData> BarAt(int step)
{
  auto bar = vtktest::MakePolyData(shapes::Bar(4, 4, 120, { 1.0, 1.0, 20.0 }));
  for (int i = 0; i < step; ++i)
  {
    history::EditInPlace(bar, -1 + (i + 1) / 10);
  }
  auto* points = vtkDoubleArray::SafeDownCast(bar->GetPoints()->GetData());
  points->SetComponent(5, 0, points->GetComponent(5, 0) + 1e-3 * step);
  return bar;
}

/// Runs 20 steps with a limit, after some without: what is kept grows, and is
/// below the limit from then on, unless one step takes more.
void ExpectLimited(vtkSurfaceFilter* filter, const std::function<void(int)>& run)
{
  run(0);
  run(1);
  const double ofFirst = filter->GetKeptMemory();
  ASSERT_GT(ofFirst, 0.0);
  run(2);
  run(3);
  EXPECT_GT(filter->GetKeptMemory(), 1.2 * ofFirst);
  const int limit = static_cast<int>(std::ceil(1.5 * ofFirst));
  filter->SetKeptMemoryLimit(limit);
  for (int step = 4; step < 24; ++step)
  {
    run(step);
    ASSERT_LE(filter->GetKeptMemory(), limit) << step;
  }
}
}

TEST(VtkKeptMemory, OfAMorphOverManyTimeStepsIsLimited)
{
  vtkNew<history::TimeSteps> source;
  for (int step = 0; step < 30; ++step)
  {
    source->Steps.push_back(BarAt(step));
  }
  vtkNew<vtkSurfaceMorph> morph;
  const auto log = vtktest::Observe(morph);
  morph->SetInputConnection(source->GetOutputPort());
  morph->SetMethodToLinear();
  ExpectLimited(morph,
    [&](int step)
    {
      morph->UpdateTimeStep(10.5 + step);
      vtktest::ExpectQuiet(*log);
      ASSERT_GT(morph->GetOutput()->GetNumberOfPoints(), 0);
    });
}

TEST(VtkKeptMemory, OfMeasuresWithManyReferencesIsLimited)
{
  vtkNew<vtkVolumeChange> volume;
  vtkNew<vtkCurvatureError> curvature;
  const auto current = BarAt(0);
  for (vtkSurfaceComparison* measure :
    std::initializer_list<vtkSurfaceComparison*>{ volume, curvature })
  {
    const auto log = vtktest::Observe(measure); // the new references have kinks
    measure->SetInputData(current);
    ExpectLimited(measure,
      [&](int step)
      {
        measure->SetReferenceData(BarAt(step + 1));
        measure->Update();
        ASSERT_GT(measure->GetOutput()->GetNumberOfPoints(), 0);
      });
  }
}

TEST(VtkKeptMemory, AFilterBehindAnotherDoesNotReadItsSurfaceAgain)
{
  // A filter that reads a surface says so on the way: it is busy between its start
  // and the tenth that reading takes.
  const auto reads = [](vtkAlgorithm* filter)
  {
    vtkNew<vtktest::ProgressLog> progress;
    const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, progress);
    filter->Update();
    filter->RemoveObserver(tag);
    EXPECT_FALSE(progress->Fractions.empty());
    return std::any_of(progress->Fractions.begin(), progress->Fractions.end(),
      [](double fraction) { return fraction > 0.05 && fraction < 0.08; });
  };
  const auto surface = BarAt(7);
  vtktest::AddHandles(surface, [](const Eigen::Vector3d& p) { return p.z() < 1.0 ? 2 : 0; });
  vtkNew<vtkBox> box;
  box->SetBounds(-9.0, 9.0, -9.0, 9.0, 19.0, 30.0);
  vtkNew<vtkMarkHandle> mark;
  mark->SetInputData(surface);
  mark->SetRegion(box);
  mark->SetGrowRings(1); // needs the connectivity
  mark->Update();
  vtkNew<vtkRotationInvariantDeformation> behind;
  vtkNew<vtkHandleMotion> motion;
  behind->SetInputConnection(mark->GetOutputPort());
  behind->SetHandleMotion(1, motion);
  EXPECT_FALSE(reads(behind));
  vtkNew<vtkVolumeChange> measure; // another filter, other arrays
  measure->SetInputConnection(mark->GetOutputPort());
  measure->SetReferenceData(surface);
  EXPECT_FALSE(reads(measure));

  // One that nobody has seen is read.
  const auto unseen = BarAt(8);
  unseen->GetPointData()->AddArray(mark->GetOutput()->GetPointData()->GetArray("Handle"));
  behind->SetInputData(unseen);
  EXPECT_TRUE(reads(behind));
}

TEST(VtkKeptMemory, IsThatOfThePage)
{
  // Documentation/Memory.md: the surface, or nothing.
  const auto bar = BarAt(3);
  const auto points = static_cast<double>(bar->GetNumberOfPoints());
  vtkNew<vtkDiscreteForms> forms;
  forms->SetInputData(bar);
  forms->Update();
  EXPECT_NEAR(1e6 * forms->GetKeptMemory() / points, 144.0, 15.0);
  vtkNew<vtkFrameReconstruction> reconstruction;
  reconstruction->SetInputData(bar);
  reconstruction->SetFormsConnection(forms->GetOutputPort(1));
  vtkNew<vtkPrepareSurface> prepare;
  prepare->SetInputData(bar);
  vtkNew<vtkRestoreSurface> restore;
  restore->SetInputConnection(prepare->GetOutputPort());
  restore->SetOriginalData(bar);
  for (vtkSurfaceFilter* filter :
    std::initializer_list<vtkSurfaceFilter*>{ reconstruction, prepare, restore })
  {
    filter->Update();
    EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(filter->GetKeptMemory(), 0.0);
  }
}
