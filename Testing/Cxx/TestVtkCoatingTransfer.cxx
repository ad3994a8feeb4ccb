// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCoatingTransfer.h"

#include "Advice.h"

#include "vtkFloatArray.h"

#include <complex>

namespace
{
using vtktest::Advice;
using vtktest::ExpectMessage;
using vtktest::ExpectQuiet;
using vtktest::MakePolyData;
using vtktest::PointsOf;

/// A relief of the unit sphere, as a function of the place.
double Relief(const Eigen::Vector3d& p)
{
  return 0.03 * std::sin(7.0 * p[0] + 1.0) * std::cos(6.0 * p[1]) * std::cos(5.0 * p[2] + 0.5);
}

shapes::Shape WithRelief(shapes::Shape sphere)
{
  for (int v = 0; v < sphere.NumberOfVertices(); ++v)
  {
    sphere.Positions.row(v) *= 1.0 + Relief(sphere.Positions.row(v).transpose());
  }
  return sphere;
}

/// A smooth target, and the same surface with a relief.
class CoatingTransfer : public testing::Test
{
protected:
  void SetUp() override { this->Log = vtktest::Observe(this->Filter); }

  void Connect(const shapes::Shape& target, const shapes::Shape& source, const shapes::Shape& base)
  {
    this->Target = MakePolyData(target);
    this->Source = MakePolyData(source);
    this->Base = MakePolyData(base);
    this->Filter->SetInputData(this->Target);
    this->Filter->SetSourceData(this->Source);
    this->Filter->SetSmoothSourceData(this->Base);
  }

  cartan::Points Result()
  {
    this->Log->Clear();
    this->Filter->Update();
    return PointsOf(this->Filter->GetOutput());
  }

  void ExpectError(const std::vector<std::string>& parts)
  {
    EXPECT_EQ(this->Result().rows(), 0);
    ExpectMessage(this->Log->Errors, parts);
  }

  vtkSmartPointer<vtkPolyData> Target;
  vtkSmartPointer<vtkPolyData> Source;
  vtkSmartPointer<vtkPolyData> Base;
  vtkNew<vtkCoatingTransfer> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST_F(CoatingTransfer, FollowsSimilaritiesOfTheBaseExactly)
{
  const shapes::Shape base = shapes::Icosphere(3);
  const shapes::Shape source = WithRelief(base);
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(4, 3.0);
  shapes::Shape target = motion(base);
  this->Connect(target, source, base);
  this->Filter->SetCorrespondenceToPointId();
  EXPECT_LT((this->Result() - motion(source.Positions)).rowwise().norm().maxCoeff(), 1e-12);
  ExpectQuiet(*this->Log);
  EXPECT_GT(this->Filter->GetCoatingRMS(), 0.005);

  // Twice as large, with details as large as they were or not.
  target.Positions *= 2.0;
  this->Connect(target, source, base);
  const cartan::Points scaled = 2.0 * motion(source.Positions);
  EXPECT_LT((this->Result() - scaled).rowwise().norm().maxCoeff(), 1e-12);
  this->Filter->ScaleDetailsOff();
  const cartan::Points unscaled =
    target.Positions + (motion(source.Positions) - motion(base.Positions));
  EXPECT_LT((this->Result() - unscaled).rowwise().norm().maxCoeff(), 1e-12);
  this->Filter->SetStrength(-0.5);
  const cartan::Points inwards =
    target.Positions - 0.5 * (motion(source.Positions) - motion(base.Positions));
  EXPECT_LT((this->Result() - inwards).rowwise().norm().maxCoeff(), 1e-12);
}

TEST_F(CoatingTransfer, CarriesLaplaciansOfTheBase)
{
  const shapes::Shape base = shapes::Icosphere(3);
  const shapes::Shape source = WithRelief(base);
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(4, 3.0);
  this->Connect(motion(base), source, base);
  this->Filter->SetCorrespondenceToPointId();
  this->Filter->SetRepresentationToLaplacians();
  const double distance = (this->Result() - motion(source.Positions)).rowwise().norm().maxCoeff();
  ExpectQuiet(*this->Log);
  shapes::ShowFigure("error in parts of the coating", distance / this->Filter->GetCoatingRMS());
  EXPECT_LT(distance, 1e-8 * this->Filter->GetCoatingRMS());

  // Half of a coating is half of its Laplacian coordinates, on a base that is bent, too.
  shapes::Shape bent = base;
  for (int v = 0; v < bent.NumberOfVertices(); ++v)
  {
    const double z = bent.Positions(v, 2);
    bent.Positions(v, 0) += 0.3 * z * z;
  }
  this->Connect(bent, source, base);
  const cartan::Points whole = this->Result() - bent.Positions;
  EXPECT_GT(whole.norm(), 0.5 * (source.Positions - base.Positions).norm());
  EXPECT_LT(whole.norm(), 1.5 * (source.Positions - base.Positions).norm());
  this->Filter->SetStrength(0.5);
  EXPECT_LT((this->Result() - bent.Positions - 0.5 * whole).norm(), 1e-9 * whole.norm());
}

TEST_F(CoatingTransfer, LaplaciansNeedTheSameTriangles)
{
  const shapes::Shape base = shapes::Icosphere(2);
  this->Connect(base, WithRelief(base), base);
  this->Filter->SetRepresentationToLaplacians();
  this->ExpectError({ "need POINT_ID", Advice("Choose DISPLACEMENTS.") });
  this->Filter->SetCorrespondenceToPointId();
  EXPECT_GT(this->Result().rows(), 0);
  this->Connect(shapes::Inverted(base), WithRelief(base), base);
  this->ExpectError({ "the source's triangles on the target" });
  this->Filter->SetRepresentationToDisplacements();
  EXPECT_GT(this->Result().rows(), 0);
}

TEST_F(CoatingTransfer, ReachesOtherConnectivities)
{
  // 4052 points with their poles on another axis, and 1002.
  shapes::Shape base = shapes::UvSphere(90, 45);
  const cartan::Points before = base.Positions;
  base.Positions.col(0) = before.col(1);
  base.Positions.col(1) = before.col(2);
  base.Positions.col(2) = before.col(0);
  const shapes::Shape target = shapes::UvSphere(40, 25);
  this->Connect(target, WithRelief(base), base);
  this->Filter->SetAlignmentToAsTheyLie();
  const cartan::Points result = this->Result();
  ExpectQuiet(*this->Log);
  const double error =
    std::sqrt((result - WithRelief(target).Positions).squaredNorm() / target.NumberOfVertices());
  const double relief = std::sqrt(
    (WithRelief(target).Positions - target.Positions).squaredNorm() / target.NumberOfVertices());
  shapes::ShowFigure("error in parts of the coating", error / relief);
  EXPECT_LT(error, 0.04 * relief);
}

TEST_F(CoatingTransfer, AlignsByShapeOrByKeys)
{
  // An ellipsoid, somewhere else, turned and larger.
  const shapes::Shape base = shapes::Ellipsoid(4, { 1.0, 0.7, 0.5 });
  shapes::Shape source = base;
  for (int v = 0; v < source.NumberOfVertices(); ++v)
  {
    source.Positions.row(v) *= 1.0 + Relief(source.Positions.row(v).transpose());
  }
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto moved = [&](const cartan::Points& points)
  {
    return cartan::Points(
      (2.0 * points * turn.transpose()).rowwise() + Eigen::RowVector3d(5.0, 1.0, -2.0));
  };
  shapes::Shape target = base;
  target.Positions = moved(base.Positions);
  this->Connect(target, source, base);
  const double size = 4.0;
  EXPECT_LT((this->Result() - moved(source.Positions)).rowwise().norm().maxCoeff(), 0.01 * size);
  ExpectQuiet(*this->Log);

  this->Filter->SetCorrespondenceToKeys();
  const auto setKeys = [](vtkPolyData* surface, const std::vector<vtkIdType>& points)
  {
    vtkNew<vtkIntArray> keys;
    keys->SetName("CorrespondenceKey");
    keys->SetNumberOfValues(surface->GetNumberOfPoints());
    keys->Fill(0.0);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      keys->SetValue(points[i], static_cast<int>(i) + 1);
    }
    surface->GetPointData()->AddArray(keys);
  };
  setKeys(this->Source, { 0, 100 });
  setKeys(this->Target, { 0, 100 });
  this->ExpectError({ "2 points have equal keys",
    Advice("give three points or more, not on one line, equal numbers from 1 on both.") });
  setKeys(this->Source, { 0, 100, 500, 900 });
  setKeys(this->Target, { 0, 100, 500, 900 });
  EXPECT_LT((this->Result() - moved(source.Positions)).rowwise().norm().maxCoeff(), 1e-10);
  ExpectQuiet(*this->Log);
}

TEST_F(CoatingTransfer, UsesTextureCoordinates)
{
  const auto wave = [](const Eigen::Vector3d& p)
  { return 0.05 * std::sin(6.0 * p[0] + 4.0 * p[1]); };
  const shapes::Shape base = shapes::Plane(33);
  shapes::Shape source = base;
  for (int v = 0; v < source.NumberOfVertices(); ++v)
  {
    source.Positions(v, 2) += wave(base.Positions.row(v).transpose());
  }
  // The target is rolled up; its texture coordinates say from where.
  const shapes::Shape flat = shapes::Plane(21);
  shapes::Shape target = flat;
  for (int v = 0; v < target.NumberOfVertices(); ++v)
  {
    const double x = flat.Positions(v, 0);
    target.Positions.row(v) << std::sin(x), flat.Positions(v, 1), std::cos(x);
  }
  this->Connect(target, source, base);
  this->Filter->SetCorrespondenceToTextureCoordinates();
  this->ExpectError({ "The target has no texture coordinates",
    Advice("make some, or choose another Correspondence.") });
  for (const auto& [surface, shape] :
    { std::make_pair(this->Target, flat), std::make_pair(this->Source, base) })
  {
    vtkNew<vtkFloatArray> coordinates;
    coordinates->SetName("Texture");
    coordinates->SetNumberOfComponents(2);
    for (int v = 0; v < shape.NumberOfVertices(); ++v)
    {
      coordinates->InsertNextTuple2(shape.Positions(v, 0), shape.Positions(v, 1));
    }
    surface->GetPointData()->SetTCoords(coordinates);
  }
  const cartan::Points result = this->Result();
  ExpectQuiet(*this->Log);
  for (int v = 0; v < flat.NumberOfVertices(); ++v)
  {
    const double height = wave(flat.Positions.row(v).transpose());
    const Eigen::Vector3d axis(0, target.Positions(v, 1), 0);
    const double radius = (result.row(v).transpose() - axis).norm();
    EXPECT_NEAR(radius, 1.0 + height, 0.004);
  }
}

TEST_F(CoatingTransfer, MakesTheBaseBySmoothing)
{
  // A spherical harmonic of degree 10, whose squared wave number is 110.
  const shapes::Shape base = shapes::Icosphere(4);
  shapes::Shape source = base;
  for (int v = 0; v < source.NumberOfVertices(); ++v)
  {
    const std::complex<double> z(base.Positions(v, 0), base.Positions(v, 1));
    source.Positions.row(v) *= 1.0 + 0.02 * std::pow(z, 10).real();
  }
  this->Connect(base, source, base);
  this->Filter->SetSmoothSourceData(nullptr);
  this->Filter->SetCorrespondenceToPointId();
  this->Filter->SetSmoothing(20.0);
  const cartan::Points relief = source.Positions - base.Positions;
  const cartan::Points moved = this->Result() - base.Positions;
  ExpectQuiet(*this->Log);
  const cartan::TriangleMesh mesh = shapes::MakeMesh(base);
  double edges = 0.0;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    edges += (base.Positions.row(mesh.Origin(d)) - base.Positions.row(mesh.Neighbor(d))).norm();
  }
  const double frequency = 2.0 * shapes::Pi / (20.0 * edges / mesh.NumberOfDirectedEdges());
  const double kept = 1.0 / (1.0 + std::pow(110.0 / (frequency * frequency), 2));
  const double part = (moved.array() * relief.array()).sum() / relief.squaredNorm();
  EXPECT_NEAR(part, (1.0 - kept) * (1.0 - kept), 0.045);
  EXPECT_LT((moved - part * relief).norm(), 0.1 * relief.norm());
  // The base that it made, as an input, gives the same.
  vtkNew<vtkPolyData> made;
  made->DeepCopy(this->Filter->GetBase());
  this->Filter->SetSmoothSourceData(made);
  EXPECT_LT((this->Result() - base.Positions - moved).norm(), 1e-12);
  EXPECT_EQ((PointsOf(this->Filter->GetBase()) - PointsOf(made)).norm(), 0.0);
  this->Filter->SetSmoothSourceData(nullptr);
  this->Filter->SetSmoothing(0.0);
  EXPECT_LT((this->Result() - base.Positions).norm(), 1e-12);
  ExpectMessage(
    this->Log->Warnings, { Advice("raise Smoothing, or connect another smooth source.") });
  this->Filter->SetSmoothing(2.0);
  this->Result();
  ExpectQuiet(*this->Log);
}

TEST_F(CoatingTransfer, StaysInItsRegionAndFades)
{
  const shapes::Shape base = shapes::Icosphere(4);
  this->Connect(base, WithRelief(base), base);
  this->Filter->SetCorrespondenceToPointId();
  vtktest::AddHandles(this->Target, [](const Eigen::Vector3d& p) { return p[2] > 0.0 ? 1 : 0; });
  this->Filter->SetRegionArrayName("Handle");
  const cartan::Points hard = this->Result();
  this->Filter->SetFadeWidth(0.5);
  const cartan::Points soft = this->Result();
  ExpectQuiet(*this->Log);
  const cartan::Points full = WithRelief(base).Positions;
  for (int v = 0; v < base.NumberOfVertices(); ++v)
  {
    const Eigen::RowVector3d rest = base.Positions.row(v);
    const bool isInside = rest[2] > 0.0;
    EXPECT_LT((hard.row(v) - (isInside ? full.row(v) : rest)).norm(), 1e-12);
    if (!isInside)
    {
      EXPECT_EQ((soft.row(v) - rest).norm(), 0.0);
    }
    else if (std::asin(rest[2]) > 0.6)
    {
      EXPECT_LT((soft.row(v) - full.row(v)).norm(), 1e-12);
    }
    else
    {
      EXPECT_LE((soft.row(v) - rest).norm(), (full.row(v) - rest).norm() + 1e-12);
    }
  }
  this->Filter->SetRegionArrayName("Missing");
  EXPECT_EQ(this->Result().rows(), 0);
  EXPECT_EQ(this->Log->Errors.size(), 1u);
}

TEST_F(CoatingTransfer, CarriesArraysOver)
{
  const shapes::Shape base = shapes::Icosphere(3);
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(2, 1.0);
  this->Connect(motion(base), WithRelief(base), base);
  vtktest::AddArray(
    this->Source, "Height", 1, [&](vtkIdType v, double* value) { *value = base.Positions(v, 2); });
  vtktest::AddArray(this->Source, "Direction", 3,
    [&](vtkIdType v, double* value) { std::copy_n(base.Positions.row(v).data(), 3, value); });
  this->Filter->SetCorrespondenceToPointId();
  this->Filter->TransferArraysOn();
  this->Result();
  ExpectQuiet(*this->Log);
  vtkPointData* data = this->Filter->GetOutput()->GetPointData();
  for (int v = 0; v < base.NumberOfVertices(); ++v)
  {
    EXPECT_EQ(data->GetArray("Height")->GetTuple1(v), base.Positions(v, 2));
    const Eigen::Vector3d direction(data->GetArray("Direction")->GetTuple3(v));
    EXPECT_LT((direction - motion.Rotation * base.Positions.row(v).transpose()).norm(), 1e-12);
    EXPECT_EQ(data->GetArray("CorrespondenceDistance")->GetTuple1(v), 0.0);
  }
}

TEST_F(CoatingTransfer, RefusesSourcesWithoutArea)
{
  shapes::Shape line;
  line.Positions.resize(3, 3);
  line.Positions << 0.1, 0.2, 0.3, 0.1, 0.2, 0.3, 0.7, 0.5, 0.4;
  line.Faces.resize(1, 3);
  line.Faces << 0, 1, 2;
  this->Connect(line, line, line);
  this->Filter->SetAlignmentToAsTheyLie();
  this->ExpectError({ "none of the source's 1 triangles has an area" });
}

TEST_F(CoatingTransfer, SaysWhatDoesNotBelongTogether)
{
  const shapes::Shape base = shapes::Icosphere(2);
  this->Connect(shapes::UvSphere(12, 8), WithRelief(base), base);
  this->Filter->SetCorrespondenceToPointId();
  this->ExpectError({ "POINT_ID needs as many points", Advice("choose CLOSEST_POINT or KEYS.") });
  this->Filter->SetCorrespondenceToClosestPoint();
  this->Result();
  ExpectQuiet(*this->Log);

  this->Filter->SetSmoothSourceData(MakePolyData(shapes::Icosphere(3)));
  this->ExpectError({ "smooth source",
    Advice(
      "Give both the same points and cells in the same order, such as the output of Smooth.") });
  this->Filter->SetSmoothSourceData(MakePolyData(base));
  this->Result();
  ExpectQuiet(*this->Log);

  // Far away, and nobody aligned them.
  shapes::Shape far = base;
  far.Positions.col(0).array() += 3.0;
  this->Connect(far, WithRelief(base), base);
  this->Filter->SetAlignmentToAsTheyLie();
  this->Result();
  ExpectMessage(this->Log->Warnings,
    { "of its size away",
      Advice("so they may not belong together: choose KEYS with three points or more.") });
  for (vtkPolyData* surface : { this->Target.Get(), this->Source.Get() })
  {
    vtktest::AddHandles(
      surface, [](const Eigen::Vector3d&) { return 0; }, "CorrespondenceKey");
    for (const vtkIdType v : { 0, 30, 60, 90 })
    {
      surface->GetPointData()->GetArray("CorrespondenceKey")->SetTuple1(v, v + 1.0);
    }
  }
  this->Filter->SetCorrespondenceToKeys();
  this->Result();
  ExpectQuiet(*this->Log);
}
