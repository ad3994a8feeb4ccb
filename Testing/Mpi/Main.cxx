// SPDX-License-Identifier: BSD-3-Clause
// All ranks run all tests, each of which all ranks enter together.
#include "vtkMPIController.h"

#include <gtest/gtest.h>

int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  vtkMPIController* controller = vtkMPIController::New();
  controller->Initialize(&argc, &argv, 0);
  vtkMultiProcessController::SetGlobalController(controller);
  if (controller->GetLocalProcessId() != 0)
  {
    // Progress is the first rank's to tell, failures are everyone's.
    testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
    testing::TestEventListener* printer = listeners.Release(listeners.default_result_printer());
    class Failures : public testing::EmptyTestEventListener
    {
      void OnTestPartResult(const testing::TestPartResult& result) override
      {
        if (result.failed())
        {
          std::cerr << result.file_name() << ":" << result.line_number() << ": " << result.message()
                    << std::endl;
        }
      }
    };
    listeners.Append(new Failures);
    delete printer;
  }
  int result = RUN_ALL_TESTS();
  controller->Barrier();
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  controller->Delete();
  return result;
}
