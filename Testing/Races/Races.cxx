// SPDX-License-Identifier: BSD-3-Clause
// Loops with a race each: proof that ThreadSanitizer finds one, in loops as short as can be
// split. The argument says where; "nowhere" is the loop without a race.
#include "vtkSurfaceFilter.h"

#include "Bridge/FilterRun.h"

#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkSMPTools.h"
#include "vtkSphereSource.h"

#include <array>
#include <functional>
#include <iostream>
#include <string>

namespace
{
using Loop = std::function<void(int n, const std::function<void(int begin, int end)>& body)>;

/// Both halves of the loop write to the same place.
void Race(const Loop& loop)
{
  int sum = 0;
  loop(2, [&sum](int begin, int end) { sum += end - begin; });
  std::cout << "The sum is " << sum << ".\n";
}

void NoRace(const Loop& loop)
{
  std::array<int, 2> each = {};
  loop(2,
    [&each](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        each[i] = 1;
      }
    });
  std::cout << "The sum is " << each[0] + each[1] << ".\n";
}

void VtkLoop(int n, const std::function<void(int, int)>& body)
{
  vtkSMPTools::For(0, n,
    [&body](vtkIdType begin, vtkIdType end)
    { body(static_cast<int>(begin), static_cast<int>(end)); });
}

/// A filter whose loop, the one that the kernel is given, has a race.
class RacingFilter : public vtkSurfaceFilter
{
public:
  static RacingFilter* New();
  vtkTypeMacro(RacingFilter, vtkSurfaceFilter);

protected:
  void Execute(cartan::FilterRun& run) override
  {
    Race([&run](int n, const std::function<void(int, int)>& body) { run.Context().For(n, body); });
  }
};
vtkStandardNewMacro(RacingFilter);
}

int main(int argc, char* argv[])
{
  const std::string place = argc > 1 ? argv[1] : "";
  if (place == "vtkSMPTools")
  {
    Race(VtkLoop);
  }
  else if (place == "filter")
  {
    vtkNew<vtkSphereSource> sphere;
    vtkNew<RacingFilter> filter;
    filter->SetInputConnection(sphere->GetOutputPort());
    filter->Update();
  }
  else if (place == "nowhere")
  {
    NoRace(VtkLoop);
  }
  else
  {
    std::cerr << "usage: CartanRaces vtkSMPTools|filter|nowhere\n";
    return 2;
  }
  return 0;
}
