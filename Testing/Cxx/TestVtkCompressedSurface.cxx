// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCompressedSurfaceReader.h"
#include "vtkCompressedSurfaceWriter.h"

#include "AdviceWords.h"
#include "CompressedFiles.h"
#include "TimeSource.h"
#include "VtkTestHelpers.h"

#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"

#include <cstdio>
#include <fstream>

namespace
{
std::string PathOf(const std::string& name)
{
  return std::string(CARTAN_TEST_OUTPUT) + "/" + name;
}

vtkSmartPointer<vtkPolyData> MakeInput(int precision = VTK_DOUBLE)
{
  shapes::Shape shape = shapes::Union(shapes::Noisy(shapes::Torus(24, 14), 0.02), shapes::Plane(5));
  shape.Positions.conservativeResize(shape.Positions.rows() + 1, 3);
  shape.Positions.bottomRows(1) << 7.0, 8.0, std::numeric_limits<double>::quiet_NaN();
  return vtktest::MakePolyData(shape, precision);
}

/// A writer to a file of its own, and a reader of it.
class CompressedFile : public testing::Test
{
protected:
  CompressedFile()
    : Path(
        PathOf(testing::UnitTest::GetInstance()->current_test_info()->name() + std::string(".csf")))
    , WriterLog(vtktest::Observe(this->Writer))
    , ReaderLog(vtktest::Observe(this->Reader))
  {
    std::remove(this->Path.c_str());
    this->Writer->SetFileName(this->Path.c_str());
    this->Reader->SetFileName(this->Path.c_str());
  }

  bool Exists() const { return std::ifstream(this->Path).good(); }

  vtkPolyData* Read()
  {
    this->Reader->Modified();
    this->Reader->Update();
    return this->Reader->GetOutput();
  }

  std::string Path;
  vtkNew<vtkCompressedSurfaceWriter> Writer;
  vtkNew<vtkCompressedSurfaceReader> Reader;
  vtkSmartPointer<vtktest::Log> WriterLog;
  vtkSmartPointer<vtktest::Log> ReaderLog;
};

double VisualErrorOf(const shapes::Shape& shape, vtkPolyData* decoded)
{
  const Eigen::VectorXd errors =
    cartan::VisualError(shapes::MakeMesh(shape), shape.Positions, vtktest::PointsOf(decoded), 0.15);
  return errors.norm() / std::sqrt(static_cast<double>(shape.NumberOfVertices()));
}
}

TEST_F(CompressedFile, ComesBackRoundedAndInItsPrecision)
{
  for (const int precision : { VTK_FLOAT, VTK_DOUBLE })
  {
    const auto input = MakeInput(precision);
    this->Writer->SetInputData(input);
    this->Writer->Write();
    vtkPolyData* output = this->Read();
    ASSERT_EQ(output->GetNumberOfPoints(), input->GetNumberOfPoints());
    EXPECT_EQ(output->GetNumberOfPolys(), input->GetNumberOfPolys());
    EXPECT_EQ(output->GetPoints()->GetDataType(), precision);
    const vtkIdType used = input->GetNumberOfPoints() - 1;
    const cartan::Points distance =
      (vtktest::PointsOf(output) - vtktest::PointsOf(input)).topRows(used);
    EXPECT_LT(distance.rowwise().norm().maxCoeff(), 0.1);
    EXPECT_EQ(output->GetPoint(used)[0], 7.0);
    EXPECT_TRUE(std::isnan(output->GetPoint(used)[2]));
    EXPECT_EQ(this->Writer->GetUsedBits(), 7);
    EXPECT_EQ(this->Writer->GetUsedAnchors(), 20);
    EXPECT_EQ(this->Writer->GetFileSize(),
      static_cast<long long>(std::ifstream(this->Path, std::ios::ate | std::ios::binary).tellg()));
  }
  EXPECT_EQ(this->Reader->CanReadFile(this->Path.c_str()), 1);
  EXPECT_EQ(this->Reader->CanReadFile("/nowhere.csf"), 0);
  vtktest::ExpectQuiet(*this->WriterLog);
  vtktest::ExpectQuiet(*this->ReaderLog);
}

TEST_F(CompressedFile, KeepsPointArraysInEachOrder)
{
  const auto input = MakeInput();
  vtkNew<vtkFloatArray> vectors;
  vectors->SetName("Vectors");
  vectors->SetNumberOfComponents(3);
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("Ids");
  vtkNew<vtkStringArray> words;
  words->SetName("Words");
  for (vtkIdType v = 0; v < input->GetNumberOfPoints(); ++v)
  {
    vectors->InsertNextTuple(input->GetPoint(v));
    ids->InsertNextValue(v);
    words->InsertNextValue("word");
  }
  for (vtkAbstractArray* array : { static_cast<vtkAbstractArray*>(vectors),
         static_cast<vtkAbstractArray*>(ids), static_cast<vtkAbstractArray*>(words) })
  {
    input->GetPointData()->AddArray(array);
  }
  this->Writer->SetInputData(input);
  long long size = 0;
  for (const bool keepsOrder : { true, false })
  {
    this->WriterLog->Clear();
    this->Writer->SetKeepPointOrder(keepsOrder);
    this->Writer->Write();
    vtktest::ExpectMessage(this->WriterLog->Warnings, { "not written: Words" });
    EXPECT_TRUE(keepsOrder || this->Writer->GetFileSize() < size);
    size = this->Writer->GetFileSize();
    vtkPointData* arrays = this->Read()->GetPointData();
    ASSERT_EQ(arrays->GetNumberOfArrays(), 2);
    vtkDataArray* order = arrays->GetArray("Ids");
    for (vtkIdType v = 0; v < input->GetNumberOfPoints(); ++v)
    {
      const auto id = static_cast<vtkIdType>(order->GetTuple1(v));
      EXPECT_TRUE(!keepsOrder || id == v);
      for (int axis = 0; axis < 3; ++axis)
      {
        const double expected = vectors->GetComponent(id, axis);
        const double actual = arrays->GetArray("Vectors")->GetComponent(v, axis);
        EXPECT_TRUE(actual == expected || (std::isnan(actual) && std::isnan(expected)));
      }
    }
  }
  this->Writer->SetWritePointArrays(false);
  this->Writer->Write();
  EXPECT_EQ(this->Read()->GetPointData()->GetNumberOfArrays(), 0);
}

TEST_F(CompressedFile, MeetsAnErrorWithTheFewestBits)
{
  const shapes::Shape shape = shapes::Noisy(shapes::Torus(40, 24, 1000.0, 300.0), 5.0);
  const auto input = vtktest::MakePolyData(shape);
  this->Writer->SetInputData(input);
  for (const double bound : { 2e-3, 2e-4 })
  {
    this->Writer->SetMaximumError(bound);
    this->Writer->Write();
    EXPECT_LE(VisualErrorOf(shape, this->Read()), 1.0001 * bound * input->GetLength());
    const int bits = this->Writer->GetUsedBits();
    this->Writer->SetMaximumError(0.0);
    this->Writer->SetBits(bits - 1);
    this->Writer->Write();
    EXPECT_GT(VisualErrorOf(shape, this->Read()), bound * input->GetLength());
  }
  vtktest::ExpectQuiet(*this->WriterLog);
}

TEST_F(CompressedFile, HasTimeSteps)
{
  vtkNew<vtktest::TimeSource> source;
  std::vector<vtkSmartPointer<vtkPolyData>> steps;
  for (const double scale : { 1.0, 1.5, 2.0 })
  {
    shapes::Shape shape = shapes::Noisy(shapes::Torus(24, 14), 0.02);
    shape.Positions *= scale;
    steps.push_back(vtktest::MakePolyData(shape));
  }
  source->SetSteps({ 0.0, 1.0, 3.0 }, steps);
  this->Writer->SetInputConnection(source->GetOutputPort());
  this->Writer->Write();
  this->Reader->UpdateInformation();
  vtkInformation* info = this->Reader->GetOutputInformation(0);
  EXPECT_FALSE(info->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS()));

  this->Writer->SetWriteAllTimeSteps(true);
  for (int round = 0; round < 2; ++round)
  {
    this->Writer->Modified();
    this->Writer->Write();
    this->Reader->Modified();
    this->Reader->UpdateInformation();
    ASSERT_EQ(info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()), 3);
    for (int step = 2; step >= 0; --step)
    {
      const double time = info->Get(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), step);
      this->Reader->UpdateTimeStep(time);
      EXPECT_LT((vtktest::PointsOf(this->Reader->GetOutput()) -
                  vtktest::PointsOf(steps[static_cast<std::size_t>(step)]))
                  .cwiseAbs()
                  .maxCoeff(),
        0.15);
      EXPECT_EQ(
        this->Reader->GetOutput()->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
    }
  }
  vtktest::ExpectQuiet(*this->WriterLog);
  steps[1] = vtktest::MakePolyData(shapes::Torus(14, 24));
  source->SetSteps({ 0.0, 1.0, 3.0 }, steps);
  this->Writer->Write();
  vtktest::ExpectMessage(this->WriterLog->Errors,
    { "time step 1", shapes::Advice("one connectivity. Turn WriteAllTimeSteps off.") });
  this->WriterLog->Clear();
  this->Writer->SetWriteAllTimeSteps(false);
  this->Writer->Write();
  vtktest::ExpectQuiet(*this->WriterLog);
}

TEST_F(CompressedFile, IsNotWrittenWhereItCannotBe)
{
  const auto input = MakeInput();
  this->Writer->SetInputData(input);
  this->Writer->SetFileName(nullptr);
  this->Writer->Write();
  vtktest::ExpectMessage(
    this->WriterLog->Errors, { shapes::Advice("There is no file to write: set FileName.") });
  this->WriterLog->Clear();
  this->Writer->SetFileName(this->Path.c_str());
  this->Writer->Write();
  vtktest::ExpectQuiet(*this->WriterLog);
  std::remove(this->Path.c_str());

  this->Writer->SetMaximumError(1e-12);
  this->Writer->Write();
  vtktest::ExpectMessage(this->WriterLog->Errors, { "16 bits with 20 anchors" });
  EXPECT_FALSE(this->Exists());
  EXPECT_EQ(this->Writer->GetFileSize(), 0);
  this->WriterLog->Clear();
  this->Writer->SetMaximumError(0.0);
  this->Writer->SetFileName("/nowhere/of/all/file.csf");
  this->Writer->Write();
  vtktest::ExpectMessage(this->WriterLog->Errors, { "/nowhere/of/all/file.csf cannot be written" });
}

TEST_F(CompressedFile, IsRefusedWhereItIsBad)
{
  EXPECT_EQ(this->Read()->GetNumberOfPoints(), 0);
  vtktest::ExpectMessage(this->ReaderLog->Errors, { this->Path, "it is not there" });
  this->Writer->SetInputData(MakeInput());
  this->Writer->Write();
  EXPECT_GT(this->Read()->GetNumberOfPoints(), 0);
  std::ifstream file(this->Path, std::ios::binary);
  const std::string bytes{ std::istreambuf_iterator<char>(file), {} };
  std::string damaged = bytes;
  damaged[damaged.size() / 2] ^= 1;
  for (const std::string& bad : { bytes.substr(0, bytes.size() / 2), std::string(), damaged })
  {
    std::ofstream(this->Path, std::ios::binary) << bad;
    this->ReaderLog->Clear();
    EXPECT_EQ(this->Read()->GetNumberOfPoints(), 0);
    vtktest::ExpectMessage(this->ReaderLog->Errors, { "cannot be read: " });
  }
  std::ofstream(this->Path, std::ios::binary) << bytes;
  this->ReaderLog->Clear();
  EXPECT_GT(this->Read()->GetNumberOfPoints(), 0);
  vtktest::ExpectQuiet(*this->ReaderLog);
}
