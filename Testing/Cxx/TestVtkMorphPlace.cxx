// SPDX-License-Identifier: BSD-3-Clause
// A parameter for each point, and weights of the key frames, in vtkSurfaceMorph; their laws are
// in TestKernelMorphPlace.cxx.
#include "vtkSurfaceMorph.h"

#include "Advice.h"
#include "TimeSource.h"

#include "vtkStreamingDemandDrivenPipeline.h"

#include <cmath>

namespace
{
using vtktest::Advice;
using vtktest::Advised;
using vtktest::PointsOf;

/// Key frames: the bar, and the bar with its upper end turned by some angles.
struct Bars : Advised<vtkSurfaceMorph>
{
  explicit Bars(const std::vector<double>& degrees)
  {
    for (const double angle : degrees)
    {
      auto key = vtktest::MarkedBar();
      for (vtkIdType v = 0; v < key->GetNumberOfPoints(); ++v)
      {
        const Eigen::Vector3d place(key->GetPoint(v));
        const double part = std::clamp((place.z() - 1.0) / 2.0, 0.0, 1.0);
        const double turn = angle * part * shapes::Pi / 180.0;
        key->GetPoints()->SetPoint(v, place.x() * std::cos(turn) - place.y() * std::sin(turn),
          place.x() * std::sin(turn) + place.y() * std::cos(turn), place.z());
      }
      this->Keys.push_back(key);
      (*this)->AddInputData(key);
    }
    (*this)->SetParameter(0.4);
  }

  vtkSmartPointer<vtkDoubleArray> AddParts(const std::function<double(double)>& ofHeight)
  {
    return vtktest::AddArray(this->Keys[0], "Part", 1,
      [&](vtkIdType v, double* part) { *part = ofHeight(this->Keys[0]->GetPoint(v)[2]); });
  }

  void SetWeights(const std::vector<double>& weights)
  {
    (*this)->SetNumberOfWeights(0);
    for (std::size_t k = 0; k < weights.size(); ++k)
    {
      (*this)->SetWeight(static_cast<int>(k), weights[k]);
    }
  }

  std::vector<vtkSmartPointer<vtkPolyData>> Keys;
};

double Difference(vtkPolyData* a, vtkPolyData* b)
{
  return (PointsOf(a) - PointsOf(b)).rowwise().norm().maxCoeff();
}
}

TEST(VtkMorphPlace, TakesAParameterForEachPoint)
{
  Bars morph({ 0.0, 90.0 });
  const auto uniform = morph.Works();
  morph.AddParts([](double) { return 0.4; });
  morph->SetParameter(0.9); // is not used
  morph->SetParameterArrayName("Part");
  EXPECT_EQ(Difference(morph.Works(), uniform), 0.0);
  vtkInformation* info = morph->GetOutputInformation(0);
  EXPECT_FALSE(info->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS()));

  // The end has one shape in both key frames, and its neighbors: what it is at makes no
  // difference.
  morph.AddParts([](double z) { return z < 0.1 ? 0.0 : 1.0; });
  const auto result = morph.Works();
  const auto& last = morph.Keys[1];
  for (vtkIdType v = 1; v < last->GetNumberOfPoints(); ++v)
  {
    EXPECT_NEAR(
      (Eigen::Vector3d(result->GetPoint(v)) - Eigen::Vector3d(result->GetPoint(0))).norm(),
      (Eigen::Vector3d(last->GetPoint(v)) - Eigen::Vector3d(last->GetPoint(0))).norm(), 1e-6);
  }
}

TEST(VtkMorphPlace, BlendsAllKeyFrames)
{
  for (int method = 0; method <= vtkSurfaceMorph::LINEAR; ++method)
  {
    // Twists add up: 0.3 20 - 0.2 15 + 0.1 30 degrees are 6. Stretches grow with their squares.
    Bars morph({ 0.0, 20.0, 10.0, -15.0, 30.0 });
    morph->SetMethod(method);
    morph.SetWeights({ 0.4, 0.3, 0.0, 0.2, 0.1 });
    const auto result = morph.Works();
    EXPECT_EQ(morph->GetNumberOfKeyFrames(), 5);
    Bars twist({ 6.0, 0.0 });
    twist->SetMethod(method);
    twist->SetParameter(0.0);
    const auto expected = twist.Works();
    double largest = 0.0;
    for (vtkIdType v = 0; v < result->GetNumberOfPoints(); v += 5)
    {
      for (vtkIdType w = 0; w < v; w += 3)
      {
        const auto distance = [&](vtkPolyData* of)
        { return (Eigen::Vector3d(of->GetPoint(v)) - Eigen::Vector3d(of->GetPoint(w))).norm(); };
        largest = std::max(largest, std::abs(distance(result) - distance(expected)));
      }
    }
    EXPECT_EQ(largest < 0.03, method != vtkSurfaceMorph::LINEAR) << method << " " << largest;
    morph.SetWeights({ 0.0, 0.0, 0.0, 1.0, 0.0 });
    EXPECT_EQ(Difference(morph.Works(), morph.Keys[3]), 0.0);
  }
}

TEST(VtkMorphPlace, BlendsTimeSteps)
{
  Bars keys({ 0.0, 60.0, -30.0 });
  keys.SetWeights({ 0.5, 0.3, 0.2 });
  const auto expected = keys.Works();
  vtkNew<vtktest::TimeSource> source;
  source->SetSteps({ 1.0, 2.0, 3.0 }, keys.Keys);
  Advised<vtkSurfaceMorph> morph;
  morph->SetInputConnection(source->GetOutputPort());
  for (int k = 0; k < 3; ++k)
  {
    morph->SetWeight(k, keys->GetWeight(k));
  }
  EXPECT_LT(Difference(morph.Works(), expected), 1e-12);
}

TEST(AdviceOnMorphPlaces, WeightsBelongToKeyFramesAndSumToOne)
{
  Bars morph({ 0.0, 60.0, 30.0 });
  morph.SetWeights({ 0.5, 0.5 });
  morph.Refuses({ "2 weights for 3 key frames", Advice("give each key frame one weight.") });
  morph.SetWeights({ 0.5, 0.3, 0.1 });
  morph.Refuses({ "sum to 0.9", Advice("make them sum to 1.") });
  morph.SetWeights({ 0.5, 0.3, 0.2 });
  morph.Works();
}

TEST(AdviceOnMorphPlaces, ParametersAreNumbers)
{
  Bars morph({ 0.0, 60.0 });
  morph.AddParts([](double z) { return z < 0.6 ? std::nan("") : 1.0; });
  morph->SetParameterArrayName("Part");
  morph.Refuses({ "\"Part\" has ",
    Advice("give each point a parameter, from 0 at the first key frame to 1 at the last.") });
  morph.AddParts([](double z) { return z / 4.0; });
  morph.Works();
}

TEST(AdviceOnMorphPlaces, OneWayIsChosen)
{
  Bars morph({ 0.0, 60.0 });
  morph.AddParts([](double z) { return z / 4.0; });
  morph->SetParameterArrayName("Part");
  morph.SetWeights({ 0.5, 0.5 });
  morph.Refuses({ "weights and an array", Advice("choose one of the two.") });
  morph.SetWeights({});
  morph->CloseVolumeOn();
  morph.Refuses({ "CloseVolume needs one parameter",
    Advice("turn it off, or use neither weights nor an array of parameters.") });
  morph->CloseVolumeOff();
  morph.Works();
  morph->CloseVolumeOn();
  morph->SetParameterArrayName("");
  morph.Keys[0]->GetPointData()->RemoveArray("Part");
  morph.Works();
}
