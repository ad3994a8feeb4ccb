// SPDX-License-Identifier: BSD-3-Clause
/// What the blocks of C++ in the pages start from.
#pragma once

#include "OffReader.h"

#include "vtkBox.h"
#include "vtkCellArray.h"
#include "vtkHandleMotion.h"
#include "vtkMarkHandle.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

#include <gtest/gtest.h>

#include <filesystem>

/// In a folder where the demo has run: build/demo/camel-before.vtp is there.
class Pages : public testing::Test
{
protected:
  Pages()
  {
    const std::filesystem::path folder = std::filesystem::path(CARTAN_TEST_OUTPUT) / "Pages" /
      testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder / "build/demo");
    std::filesystem::current_path(folder);
    WriteCamel("build/demo/camel-before.vtp");
    this->Reader->SetFileName("build/demo/camel-before.vtp");
    const double bounds[3][6] = { { -1.0, 1.0, -1.0, 1.0, -1.0, 0.1 },
      { -1.0, 1.0, 0.4, 1.0, 0.36, 1.0 }, { -1.0, 1.0, 0.4, 1.0, 0.3, 0.34 } };
    vtkAlgorithm* source = this->Reader;
    for (int i = 0; i < 3; ++i)
    {
      vtkNew<vtkBox> box;
      box->SetBounds(bounds[i]);
      this->Marks[i]->SetInputConnection(source->GetOutputPort());
      this->Marks[i]->SetRegion(box);
      this->Marks[i]->SetHandleId(i + 1);
      source = this->Marks[i];
    }
    this->Turn->SetAxis(0.0, 1.0, 0.0);
    this->Turn->SetAngle(30.0);
    this->Motion->SetScale(1.2, 1.2, 1.2);
    this->Deformation->SetInputConnection(this->Marked->GetOutputPort());
    this->Deformation->SetHandleMotion(2, this->Turn);
  }

  static void WriteCamel(const char* path)
  {
    const offreader::Mesh camel = offreader::Read(offreader::MeshPath("camel"));
    vtkNew<vtkPoints> points;
    for (std::size_t i = 0; i < camel.Points.size(); i += 3)
    {
      points->InsertNextPoint(&camel.Points[i]);
    }
    vtkNew<vtkCellArray> triangles;
    for (std::size_t i = 0; i < camel.Triangles.size(); i += 3)
    {
      const vtkIdType ids[3] = { camel.Triangles[i], camel.Triangles[i + 1],
        camel.Triangles[i + 2] };
      triangles->InsertNextCell(3, ids);
    }
    vtkNew<vtkPolyData> surface;
    surface->SetPoints(points);
    surface->SetPolys(triangles);
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(surface);
    writer->SetFileName(path);
    writer->SetDataModeToBinary();
    ASSERT_TRUE(writer->Write());
  }

  vtkNew<vtkXMLPolyDataReader> Reader;
  vtkNew<vtkMarkHandle> Marks[3];
  vtkMarkHandle* Marked = this->Marks[2];
  vtkNew<vtkHandleMotion> Turn;
  vtkNew<vtkHandleMotion> Motion;
  vtkNew<vtkRotationInvariantDeformation> Deformation;
};
