// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSpectralWatermark.h"

#include "Advice.h"
#include "RealMeshes.h"

#include "vtkTable.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace
{
using shapes::Shape;
using vtktest::MakePolyData;
using vtktest::PointsOf;

const char* const Secret = "Cartan's"; // 64 bits

Shape UnitMesh(const std::string& name)
{
  Shape shape = shapes::RealMesh(name);
  shape.Positions /=
    (shape.Positions.colwise().maxCoeff() - shape.Positions.colwise().minCoeff()).norm();
  return shape;
}

/// The same surface with its points and triangles in another order.
Shape Shuffled(const Shape& shape)
{
  std::mt19937 random(7);
  std::vector<int> order(shape.NumberOfVertices());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  Shape shuffled = shape;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    shuffled.Positions.row(order[v]) = shape.Positions.row(v);
  }
  shuffled.Faces = shape.Faces.unaryExpr([&](int v) { return order[v]; }).colwise().reverse();
  return shuffled;
}

void TurnAndScale(cartan::Points& points)
{
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(2.4, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  points =
    ((37.0 * points * turn.transpose()).rowwise() + Eigen::RowVector3d(500.0, -3.0, 80.0)).eval();
}

/// A surface, the marked one, and a filter that reads suspects.
class WatermarkFilter : public testing::Test
{
protected:
  void Mark(const Shape& shape)
  {
    this->Original = shape;
    this->Data = MakePolyData(shape);
    vtktest::Advised<vtkSpectralWatermark> embed;
    embed->SetInputData(this->Data);
    embed->SetMessage(Secret);
    embed->SetKey("key");
    this->Marked = shape;
    const auto output = embed.Works();
    this->Marked.Positions = PointsOf(output);
    this->Change = embed->GetWatermarkRMS();
    ASSERT_NE(output->GetPointData()->GetArray("Patch"), nullptr);
    this->Extract->SetOriginalData(this->Data);
    this->Extract->SetModeToExtract();
    this->Extract->SetMessage(Secret);
    this->Extract->SetKey("key");
  }

  /// How many bits are wrong.
  int Errors(const Shape& suspect)
  {
    this->Extract->SetInputData(MakePolyData(suspect));
    this->Extract.Works();
    return this->Extract->GetBitErrors();
  }

  Shape Original;
  Shape Marked;
  vtkSmartPointer<vtkPolyData> Data;
  double Change = 0.0;
  vtktest::Advised<vtkSpectralWatermark> Extract;
};
}

TEST_F(WatermarkFilter, SurvivesSimilaritiesAndShuffledPoints)
{
  for (const char* name : { "elephant", "camel" })
  {
    this->Mark(UnitMesh(name));
    EXPECT_LT(this->Change, 4.6e-4);
    EXPECT_NEAR(this->Change,
      (this->Marked.Positions - this->Original.Positions).norm() /
        std::sqrt(this->Original.NumberOfVertices()),
      1e-6);
    Shape suspect = this->Marked;
    EXPECT_EQ(this->Errors(suspect), 0) << name;
    EXPECT_EQ(this->Extract->GetExtractedMessage(), Secret);
    EXPECT_LT(this->Extract->GetChanceProbability(), 1e-18);
    TurnAndScale(suspect.Positions);
    EXPECT_EQ(this->Errors(suspect), 0) << name << ", similarity";
    shapes::ShowFigure("similarity, confidence", this->Extract->GetWeakestConfidence());
    // The output is where the original is.
    EXPECT_LT((PointsOf(this->Extract->GetOutput()) - this->Original.Positions).norm(),
      1.1 * this->Change * std::sqrt(this->Original.NumberOfVertices()));
    EXPECT_EQ(this->Errors(Shuffled(suspect)), 0) << name << ", similarity and shuffled";
    shapes::ShowFigure("shuffled, confidence", this->Extract->GetWeakestConfidence());
  }
}

TEST_F(WatermarkFilter, ReportsABitPerRow)
{
  this->Mark(shapes::Noisy(shapes::Torus(80, 50), 0.02));
  EXPECT_EQ(this->Errors(this->Marked), 0);
  vtkTable* table = this->Extract->GetBitTable();
  ASSERT_EQ(table->GetNumberOfRows(), 64);
  for (vtkIdType i = 0; i < 64; ++i)
  {
    const int bit = (Secret[i / 8] >> (7 - i % 8)) & 1;
    EXPECT_EQ(table->GetValueByName(i, "Bit").ToInt(), bit);
    EXPECT_EQ(table->GetValueByName(i, "Expected").ToInt(), bit);
    EXPECT_EQ(table->GetValueByName(i, "Score").ToDouble() > 0.0, bit == 1);
    EXPECT_GE(table->GetValueByName(i, "Confidence").ToDouble(), 0.5);
  }
  // Without the message: as many bits as are asked for, here all of them as bits.
  this->Extract->SetMessage("");
  this->Extract->SetMessageFormatToBits();
  EXPECT_EQ(this->Errors(this->Marked), -1);
  EXPECT_EQ(this->Extract->GetExtractedMessage().size(), 64U);
  EXPECT_EQ(this->Extract->GetExtractedMessage().substr(0, 8), "01000011"); // C
  EXPECT_LT(this->Extract->GetChanceProbability(), 1e-12);
  // Another key, or no watermark.
  this->Extract->SetKey("another");
  this->Errors(this->Marked);
  EXPECT_GT(this->Extract->GetChanceProbability(), 1e-3);
  this->Extract->SetKey("key");
  this->Errors(this->Original);
  EXPECT_GT(this->Extract->GetChanceProbability(), 1e-3);
}

TEST_F(WatermarkFilter, FollowsItsAdvice)
{
  using shapes::Advice;
  this->Data = MakePolyData(shapes::Noisy(shapes::Torus(40, 24), 0.02));
  vtktest::Advised<vtkSpectralWatermark> embed;
  embed->SetInputData(this->Data);
  embed.Refuses({ "0 bits", Advice(" bits: give a message.") });
  embed->SetMessage("01x");
  embed->SetMessageFormatToBits();
  embed.Refuses({ "at place 2", Advice(": write bits, or choose the message format Text.") });
  embed->SetMessageFormatToText();
  embed.Works();
  embed->SetMessageFormatToBits();
  embed->SetMessage("011");
  const auto marked = embed.Works();
  embed->SetMessage(std::string(300, '1'));
  embed.Refuses({ "300", Advice(" bits: shorten the message, or raise ModeFraction.") });
  embed->SetModeFraction(0.2);
  embed.Works();
  embed->SetModeFraction(0.07);
  embed->SetMessage(std::string(100, '1'));
  embed.Works();

  vtktest::Advised<vtkSpectralWatermark> extract;
  extract->SetInputData(marked);
  extract->SetModeToExtract();
  extract->SetMessageFormatToBits();
  extract->SetMessage("011");
  extract.Refuses({ Advice("is missing: connect it to input port 1 (Original).") });
  extract->SetOriginalData(this->Data);
  extract.Works();
  EXPECT_EQ(extract->GetBitErrors(), 0);

  // Patches and modes that do not fit.
  embed->SetInputData(MakePolyData(shapes::Noisy(shapes::Torus(80, 50), 0.02)));
  embed->SetModeMemoryLimit(1);
  embed.Refuses({ "megabytes",
    Advice(": use smaller patches or a smaller ModeFraction, or raise the memory limit.") });
  embed->SetModeMemoryLimit(100);
  embed.Works();
  embed->SetPrepareInput(true);
  embed.Refuses({ "vtkSpectralWatermark" });
}

TEST_F(WatermarkFilter, TakesTheWholeSurfaceWithoutMetis)
{
  this->Data = MakePolyData(shapes::Noisy(shapes::Torus(60, 40), 0.02));
  vtktest::Advised<vtkSpectralWatermark> embed;
  embed->SetInputData(this->Data);
  embed->SetMessage("A");
  embed->SetPatchSize(500);
  vtkNew<vtkSpectralWatermark> plain;
  const auto log = vtktest::Observe(plain);
  plain->SetInputData(this->Data);
  plain->SetMessage("A");
  plain->SetPatchSize(500);
  plain->Update();
  if (!log->Errors.empty())
  {
    vtktest::ExpectMessage(
      log->Errors, { shapes::Advice(" patches: use the whole surface as one patch.") });
  }
  embed->SetPatchSize(0);
  const auto output = embed.Works();
  double range[2];
  output->GetPointData()->GetArray("Patch")->GetRange(range);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_EQ(range[1], 0.0);
}
