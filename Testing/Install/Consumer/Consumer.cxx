// SPDX-License-Identifier: BSD-3-Clause
// A program of someone else's that uses an installed Cartan.
#include "vtkDiscreteForms.h"

#include "vtkNew.h"
#include "vtkSphereSource.h"
#include "vtkTable.h"

#include <iostream>

int main()
{
  vtkNew<vtkSphereSource> sphere;
  vtkNew<vtkDiscreteForms> forms;
  forms->SetInputConnection(sphere->GetOutputPort());
  forms->Update();

  // 50 vertices and 96 triangles make 144 edges, each seen from both ends.
  auto* table = vtkTable::SafeDownCast(forms->GetOutputDataObject(1));
  std::cout << table->GetNumberOfRows() << " directed edges\n";
  return table->GetNumberOfRows() == 288 ? 0 : 1;
}
