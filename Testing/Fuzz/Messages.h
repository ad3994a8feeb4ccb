// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <string>
#include <vector>

namespace fuzz
{
/// Collects errors and warnings instead of printing them.
class Messages : public vtkCommand
{
public:
  static Messages* New() { return new Messages; }
  vtkTypeMacro(Messages, vtkCommand);

  void Execute(vtkObject*, unsigned long event, void* data) override
  {
    std::vector<std::string>& messages =
      event == vtkCommand::ErrorEvent ? this->Errors : this->Warnings;
    // "... vtkFilter (0x5581): text": the address differs from run to run.
    const std::string text = static_cast<const char*>(data);
    const std::size_t colon = text.find("): ");
    messages.push_back(colon == std::string::npos ? text : text.substr(colon + 3));
  }

  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;
};

inline vtkSmartPointer<Messages> Observe(vtkAlgorithm* filter)
{
  auto messages = vtkSmartPointer<Messages>::New();
  filter->AddObserver(vtkCommand::ErrorEvent, messages);
  filter->AddObserver(vtkCommand::WarningEvent, messages);
  // After a failed RequestData the executive repeats that it failed.
  vtkNew<Messages> silence;
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, silence);
  return messages;
}
}
