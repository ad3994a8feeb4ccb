// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLandmarkHandles.h"

#include "Advice.h"
#include "Kernel/Deformation/LandmarkWeights.h"

#include "vtkAsRigidAsPossibleDeformation.h"
#include "vtkLaplacianDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkSimilarityDeformation.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace
{
using cartan::Points;
using vtktest::Advice;
using vtktest::Advised;
using vtktest::PointsOf;

using Strings = std::vector<std::string>;

vtkSmartPointer<vtkStringArray> Names(const Strings& names)
{
  auto array = vtkSmartPointer<vtkStringArray>::New();
  array->SetName("label");
  for (const std::string& name : names)
  {
    array->InsertNextValue(name);
  }
  return array;
}

vtkSmartPointer<vtkPolyData> Cloud(const Points& positions, const Strings& names = {})
{
  auto cloud = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (Eigen::Index k = 0; k < positions.rows(); ++k)
  {
    points->InsertNextPoint(positions.row(k).data());
  }
  cloud->SetPoints(points);
  if (!names.empty())
  {
    cloud->GetPointData()->AddArray(Names(names));
  }
  return cloud;
}

vtkSmartPointer<vtkTable> Table(const Points& positions, const Strings& columns)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  for (int i = 0; i < 3; ++i)
  {
    vtkNew<vtkDoubleArray> column;
    column->SetName(columns[i].c_str());
    for (Eigen::Index k = 0; k < positions.rows(); ++k)
    {
      column->InsertNextValue(positions(k, i));
    }
    table->AddColumn(column);
  }
  return table;
}

/// A sphere with landmarks near `count` of its points, which go elsewhere.
struct Ball : Advised<vtkLandmarkHandles>
{
  explicit Ball(int count = 12, double noise = 0.1)
  {
    const shapes::Shape sphere = shapes::Icosphere(3);
    this->Surface = vtktest::MakePolyData(sphere);
    this->From.resize(count, 3);
    this->To.resize(count, 3);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> draw(-1.0, 1.0);
    for (int k = 0; k < count; ++k)
    {
      const int v = (7 + 53 * k) % sphere.NumberOfVertices();
      this->PointIds.push_back(v);
      for (int i = 0; i < 3; ++i)
      {
        this->From(k, i) = sphere.Positions(v, i) * 1.01;
        this->To(k, i) = this->From(k, i) * (1.2 + 0.3 * i) + noise * draw(random);
      }
    }
    this->Connect();
  }

  void Connect(const Strings& from = {}, const Strings& to = {})
  {
    (*this)->SetInputData(this->Surface);
    (*this)->SetFromData(Cloud(this->From, from));
    (*this)->SetToData(Cloud(this->To, to));
  }

  void WorksWith(const Points& from, const Points& to)
  {
    (*this)->SetFromData(Cloud(from));
    (*this)->SetToData(Cloud(to));
    this->Works();
  }

  vtkSmartPointer<vtkPolyData> Surface;
  std::vector<int> PointIds;
  Points From;
  Points To;
};

/// How far each landmark's point ends from its target.
template <typename Method>
Eigen::VectorXd Misses(vtkPolyData* marked, const Ball& ball, bool isSoft)
{
  Advised<Method> deform;
  deform->SetInputData(marked);
  deform->SetTargetPositionArrayName("TargetPosition");
  deform->SetConstraintWeightArrayName(isSoft ? "ConstraintWeight" : "");
  deform->SetRoundingCheckLimit(0);
  const auto result = deform.Works();
  Eigen::VectorXd misses(ball.From.rows());
  for (Eigen::Index k = 0; k < misses.size(); ++k)
  {
    const Eigen::Vector3d rest(ball.Surface->GetPoint(ball.PointIds[k]));
    const Eigen::Vector3d target = rest + (ball.To.row(k) - ball.From.row(k)).transpose();
    misses[k] = (Eigen::Vector3d(result->GetPoint(ball.PointIds[k])) - target).norm();
  }
  return misses;
}
}

TEST(VtkLandmarkHandles, KeepsWeightsForTheSameLandmarks)
{
  Ball ball;
  ball->SetAccuracy(0.05);
  vtkNew<vtktest::ProgressLog> progress;
  ball->AddObserver(vtkCommand::ProgressEvent, progress);
  // Factorizations of the harmonic model report between .3 and .9 of all.
  const auto reports = [&]()
  {
    progress->Fractions.clear();
    ball.Works();
    return std::count_if(progress->Fractions.begin(), progress->Fractions.end(),
      [](double fraction) { return fraction > 0.301 && fraction < 0.899; });
  };
  const auto firstWeight = [&]()
  { return ball->GetLandmarkTable()->GetValueByName(0, "Weight").ToDouble(); };
  EXPECT_GT(reports(), 0);
  const double weight = firstWeight();
  ball->SetHandleArrayName("Landmark");
  EXPECT_EQ(reports(), 0);
  EXPECT_EQ(firstWeight(), weight);
  ball->SetAccuracy(0.02);
  EXPECT_GT(reports(), 0);
  EXPECT_GT(firstWeight(), weight);
  ball.To.row(0) *= 2.0;
  ball.Connect();
  EXPECT_GT(reports(), 0);
}

TEST(VtkLandmarkHandles, PutsTheNearestPointsWhereTheyBelong)
{
  Ball ball;
  const auto copy = vtktest::CopyOf(ball.Surface);
  const auto marked = ball.Works();
  vtktest::ExpectSameSurface(ball.Surface, copy);
  EXPECT_EQ(ball->GetNumberOfLandmarks(), 12);
  EXPECT_NEAR(ball->GetLargestDistance(), 0.01, 1e-12);
  EXPECT_FALSE(marked->GetPointData()->HasArray("ConstraintWeight"));
  vtkTable* table = ball->GetLandmarkTable();
  ASSERT_EQ(table->GetNumberOfRows(), 12);
  for (int k = 0; k < 12; ++k)
  {
    EXPECT_EQ(table->GetValueByName(k, "PointId").ToInt(), ball.PointIds[k]);
    EXPECT_EQ(table->GetValueByName(k, "HandleId").ToInt(), k + 1);
    EXPECT_EQ(marked->GetPointData()->GetArray("Handle")->GetTuple1(ball.PointIds[k]), k + 1);
  }
  EXPECT_LT(Misses<vtkSimilarityDeformation>(marked, ball, false).maxCoeff(), 1e-12);
  EXPECT_LT(Misses<vtkAsRigidAsPossibleDeformation>(marked, ball, false).maxCoeff(), 1e-12);
  EXPECT_LT(Misses<vtkLaplacianDeformation>(marked, ball, false).maxCoeff(), 1e-12);
}

// The harmonic displacement is what rotation-invariant coordinates make of targets alone:
// a second algorithm for the half that the weights allow. Others keep within the whole.
TEST(VtkLandmarkHandles, KeepsLandmarksWithinTheirAccuracy)
{
  for (const double accuracy : { 0.003, 0.03, 0.1 })
  {
    Ball ball(40);
    ball->SetAccuracy(accuracy);
    const auto marked = ball.Works();
    const double harmonic = Misses<vtkRotationInvariantDeformation>(marked, ball, true).maxCoeff();
    EXPECT_LE(harmonic, 0.5 * accuracy * (1.0 + 1e-9));
    EXPECT_GE(harmonic, 0.4 * accuracy);
    EXPECT_LE(Misses<vtkSimilarityDeformation>(marked, ball, true).maxCoeff(), accuracy);
    EXPECT_LE(Misses<vtkAsRigidAsPossibleDeformation>(marked, ball, true).maxCoeff(), accuracy);
    EXPECT_LE(Misses<vtkLaplacianDeformation>(marked, ball, true).maxCoeff(), accuracy);
  }
}

TEST(VtkLandmarkHandles, TakesAnAccuracyForEachLandmark)
{
  Ball ball;
  const auto from = Cloud(ball.From);
  vtktest::AddArray(from, "Error", 1, [](vtkIdType k, double* value) { *value = 0.02 * (k % 3); });
  ball->SetFromData(from);
  ball->SetAccuracyArrayName("Error");
  const Eigen::VectorXd misses = Misses<vtkRotationInvariantDeformation>(ball.Works(), ball, true);
  for (int k = 0; k < 12; ++k)
  {
    EXPECT_LE(misses[k], 0.01 * (k % 3) + 1e-12) << k;
  }
  EXPECT_GT(misses.maxCoeff(), 0.007);
}

TEST(VtkLandmarkHandles, GoesOnWhereHandlesAreAlready)
{
  Ball ball;
  vtktest::AddHandles(ball.Surface, [](const Eigen::Vector3d& p) { return p.z() < -0.9 ? 4 : 0; });
  vtktest::AddArray(ball.Surface, "TargetPosition", 3,
    [](vtkIdType, double* target) { std::fill_n(target, 3, 7.0); });
  const auto marked = ball.Works();
  vtkDataArray* handles = marked->GetPointData()->GetArray("Handle");
  vtkDataArray* targets = marked->GetPointData()->GetArray("TargetPosition");
  for (vtkIdType v = 0; v < marked->GetNumberOfPoints(); ++v)
  {
    const auto place = std::find(ball.PointIds.begin(), ball.PointIds.end(), v);
    const bool isLandmark = place != ball.PointIds.end();
    const int before = marked->GetPoint(v)[2] < -0.9 ? 4 : 0;
    EXPECT_EQ(handles->GetTuple1(v),
      isLandmark ? 5 + static_cast<int>(place - ball.PointIds.begin()) : before);
    EXPECT_EQ(targets->GetComponent(v, 0) == 7.0, !isLandmark);
  }
}

TEST(VtkLandmarkHandles, ReadsTablesAndMatchesNames)
{
  Ball ball;
  const auto expected = ball.Works();
  for (const Strings& columns : { Strings{ "x", "y", "z" }, Strings{ "R", "A", "S" },
         Strings{ "Points:0", "Points:1", "Points:2" } })
  {
    ball->SetFromData(Table(ball.From, columns));
    vtktest::ExpectSameSurface(ball.Works(), expected);
  }
  Strings names;
  Strings reversed;
  for (int k = 0; k < 12; ++k)
  {
    names.push_back("L" + std::to_string(k));
    reversed.insert(reversed.begin(), names.back());
  }
  ball->SetFromData(Cloud(ball.From, names));
  ball->SetToData(Cloud(ball.To.colwise().reverse(), reversed));
  ball.Warns(
    { "same names in another order", Advice("choose Matching by name if they belong together.") });
  ball->SetMatchingToName();
  vtktest::ExpectSameSurface(ball.Works(), expected);
  EXPECT_EQ(ball->GetLandmarkTable()->GetValueByName(3, "Landmark").ToString(), "L3");
}

TEST(AdviceOnLandmarks, ThereAreAsManyInBoth)
{
  Ball ball;
  ball->SetToConnection(nullptr);
  ball.Refuses({ "no landmarks to",
    Advice("connect points, such as a point source, or a table of landmarks.") });
  ball->SetToData(Cloud(ball.To.topRows(11)));
  ball.Refuses({ "12 landmarks from and 11 to", Advice("give as many in both.") });
  ball->SetToData(Table(ball.To, { "u", "v", "w" }));
  ball.Refuses({ "no three numeric columns", Advice("name them x, y and z.") });
  ball->SetToData(Table(ball.To, { "x", "y", "z" }));
  ball.Works();
}

TEST(AdviceOnLandmarks, NamesArePartners)
{
  Ball ball(3);
  ball->SetMatchingToName();
  ball.Connect({ "a", "b", "c" }, { "a", "b", "b" });
  ball.Refuses({ "the name b", Advice("name each once, or choose Matching by order.") });
  ball.Connect({ "a", "b", "nose" }, { "a", "b", "c" });
  ball.Refuses({ "landmark 2 (nose)",
    Advice("give both sets the same names, each once, or choose Matching by order.") });
  ball->SetMatchingToOrder();
  ball.Works();
  ball->SetMatchingToName();
  ball.Connect({ "a", "b", "c" }, { "b", "c", "a" });
  ball.Works();
}

TEST(AdviceOnLandmarks, PlacesAndPointsAreDistinct)
{
  Ball ball;
  Points from = ball.From;
  Points to = ball.To;
  from.row(7) = from.row(4);
  ball->SetFromData(Cloud(from));
  const std::string remove = Advice("remove one of them.");
  ball.Refuses({ "Landmarks 4 and 7 come from one place and go to different ones", remove });
  to.row(7) = to.row(4);
  ball->SetToData(Cloud(to));
  ball.Refuses({ "Landmarks 4 and 7 come from one place and go to one", remove });
  ball.WorksWith(from.topRows(7), to.topRows(7));

  from.row(7) = 1.001 * from.row(4);
  ball->SetFromData(Cloud(from));
  ball->SetToData(Cloud(to));
  ball.Refuses({ "Landmarks 4 and 7 have the same nearest point",
    Advice("remove one of the two, or subdivide the surface so that it has more points.") });
  ball.WorksWith(from.topRows(7), to.topRows(7));
  from.row(7) = from.row(4) + Eigen::RowVector3d(0.02, 0.02, 0.02);
  ball->SetInputData(vtktest::MakePolyData(shapes::Icosphere(6)));
  ball.WorksWith(from, to);
}

TEST(AdviceOnLandmarks, ThereAreNoMoreThanPoints)
{
  Ball ball(12);
  ball->SetInputData(vtktest::MakePolyData(shapes::Bar(1, 1, 1, { 1.0, 1.0, 1.0 })));
  ball.Refuses(
    { "12 landmarks, but only 8 points", Advice("remove landmarks, or subdivide the surface.") });
  ball->SetInputData(vtktest::MakePolyData(shapes::Icosphere(4)));
  ball.Works();
}

TEST(AdviceOnLandmarks, TheyAreOnTheSurface)
{
  Ball ball;
  Points from = ball.From;
  from.row(3) *= 1.5;
  ball.Connect({ "a", "b", "c", "nose", "e", "f", "g", "h", "i", "j", "k", "l" });
  ball->SetFromData(Cloud(from));
  const std::string text = ball.Warns({ "tenth of its size: 1 landmark: 3, up to 0.5",
    Advice("set Tolerance to the distance that is right.") });
  ball->SetTolerance(0.6);
  ball.Works();
  ball->SetTolerance(0.3);
  ball.Refuses({ "than Tolerance 0.3: 1 landmark: 3,",
    Advice("Move the landmarks to the surface, or raise Tolerance.") });
  ball->SetTolerance(0.6);
  ball.Works();
  ball->SetTolerance(0.3);
  ball->SetFromData(Cloud(ball.From));
  ball.Works();
}

TEST(AdviceOnLandmarks, CoordinatesAndAccuraciesAreNumbers)
{
  Ball ball;
  Points from = ball.From;
  from(2, 1) = std::nan("");
  ball->SetFromData(Cloud(from));
  ball.Refuses({ "landmarks from have 1 landmark: 2 with a NaN",
    Advice("remove or repair these landmarks.") });
  ball->SetFromData(Cloud(ball.From));
  ball->SetAccuracyArrayName("Error");
  ball.Refuses(
    { "no numeric array \"Error\"", Advice("leave AccuracyArrayName empty, or add the array.") });
  const auto cloud = Cloud(ball.From);
  const auto errors =
    vtktest::AddArray(cloud, "Error", 1, [](vtkIdType k, double* value) { *value = 1.0 - k; });
  ball->SetFromData(cloud);
  ball.Refuses({ "10 landmarks: 2, 3, 4, 5, 6, ...", Advice("give lengths, 0 for exactly.") });
  errors->Fill(0.0);
  errors->Modified();
  ball.Works();
  ball->SetAccuracyArrayName("");
  ball.Works();
}
