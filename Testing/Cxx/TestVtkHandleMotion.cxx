// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandleMotion.h"

#include <gtest/gtest.h>

#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkTransform.h"

#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace
{
void ExpectSameMatrix(vtkMatrix4x4* actual, vtkMatrix4x4* expected, double tolerance = 1e-12)
{
  for (int i = 0; i < 16; ++i)
  {
    EXPECT_NEAR(actual->GetData()[i], expected->GetData()[i], tolerance) << "element " << i;
  }
}

void ExpectIdentity(vtkHandleMotion* motion)
{
  vtkNew<vtkMatrix4x4> matrix;
  matrix->Zero();
  motion->GetTransform(matrix);
  EXPECT_TRUE(matrix->IsIdentity());
  double vector[3];
  motion->GetRotationVector(vector);
  EXPECT_EQ(vtkMath::Norm(vector), 0.0);
  EXPECT_TRUE(motion->IsRigid());
  EXPECT_TRUE(motion->IsIdentity());
}

void ExpectVector(vtkHandleMotion* motion, double x, double y, double z)
{
  double vector[3];
  motion->GetRotationVector(vector);
  EXPECT_NEAR(vector[0], x, 1e-12);
  EXPECT_NEAR(vector[1], y, 1e-12);
  EXPECT_NEAR(vector[2], z, 1e-12);
}

// The problem's sentence must name `part`, and the motion be the identity.
void ExpectProblem(vtkHandleMotion* motion, const std::string& part)
{
  EXPECT_NE(motion->GetProblem().find(part), std::string::npos) << motion->GetProblem();
  ExpectIdentity(motion);
}

const double Pi = vtkMath::Pi();
const double NaN = std::numeric_limits<double>::quiet_NaN();
}

TEST(HandleMotion, IsTheIdentityAtFirst)
{
  vtkNew<vtkHandleMotion> motion;
  EXPECT_EQ(motion->GetProblem(), "");
  ExpectIdentity(motion);
  EXPECT_EQ(motion->GetMode(), vtkHandleMotion::AXIS_ANGLE);
}

TEST(HandleMotion, ScalesThenRotatesAboutTheCenterThenTranslates)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetCenter(1.0, -2.0, 0.5);
  motion->SetScale(2.0, 3.0, -0.5);
  motion->SetAxis(1.0, 2.0, -2.0);
  motion->SetAngle(70.0);
  motion->SetTranslation(0.1, 0.2, 0.3);

  vtkNew<vtkTransform> expected;
  expected->Translate(0.1, 0.2, 0.3);
  expected->Translate(1.0, -2.0, 0.5);
  expected->RotateWXYZ(70.0, 1.0, 2.0, -2.0);
  expected->Scale(2.0, 3.0, -0.5);
  expected->Translate(-1.0, 2.0, -0.5);

  vtkNew<vtkMatrix4x4> matrix;
  motion->GetTransform(matrix);
  ExpectSameMatrix(matrix, expected->GetMatrix());
  EXPECT_FALSE(motion->IsRigid());
  EXPECT_FALSE(motion->IsIdentity());
}

TEST(HandleMotion, KeepsLaps)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(0.0, 0.0, -7.0);
  motion->SetAngle(480.0);
  ExpectVector(motion, 0.0, 0.0, -480.0 * Pi / 180.0);
  EXPECT_TRUE(motion->IsRigid());

  vtkNew<vtkMatrix4x4> matrix;
  vtkNew<vtkMatrix4x4> once;
  motion->GetTransform(matrix);
  motion->SetAngle(120.0);
  motion->GetTransform(once);
  ExpectSameMatrix(matrix, once);

  motion->SetAngle(-360.0);
  ExpectVector(motion, 0.0, 0.0, 2.0 * Pi);
  EXPECT_TRUE(motion->IsRigid());
  EXPECT_FALSE(motion->IsIdentity());
}

TEST(HandleMotion, AcceptsAxesOfAnyLength)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetAngle(90.0);
  for (const double length : { 1e-200, 1.0, 1e200 })
  {
    motion->SetAxis(0.0, length, 0.0);
    EXPECT_EQ(motion->GetProblem(), "");
    ExpectVector(motion, 0.0, 0.5 * Pi, 0.0);
  }
}

TEST(HandleMotion, FollowsABox)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetModeToBox();
  ExpectIdentity(motion);
  motion->SetBoxPosition(1.0, 2.0, 3.0);
  motion->SetBoxRotation(20.0, -35.0, 110.0);
  motion->SetBoxScale(1.5, 0.5, 2.0);

  vtkNew<vtkTransform> expected;
  expected->Translate(1.0, 2.0, 3.0);
  expected->RotateZ(110.0);
  expected->RotateX(20.0);
  expected->RotateY(-35.0);
  vtkNew<vtkMatrix4x4> rotation;
  rotation->DeepCopy(expected->GetMatrix());
  expected->Scale(1.5, 0.5, 2.0);

  vtkNew<vtkMatrix4x4> matrix;
  motion->GetTransform(matrix);
  ExpectSameMatrix(matrix, expected->GetMatrix());
  EXPECT_FALSE(motion->IsRigid());
  EXPECT_FALSE(motion->IsIdentity());

  // What VTK reads back from the map is what was set, so that a box can be
  // grasped again.
  double read[3];
  expected->GetOrientation(read);
  EXPECT_NEAR(read[0], 20.0, 1e-9);
  EXPECT_NEAR(read[1], -35.0, 1e-9);
  EXPECT_NEAR(read[2], 110.0, 1e-9);

  // The rotation vector is that of the same rotation.
  double vector[3];
  motion->GetRotationVector(vector);
  const double angle = vtkMath::Norm(vector);
  EXPECT_LE(angle, Pi);
  vtkNew<vtkTransform> again;
  again->Translate(1.0, 2.0, 3.0);
  again->RotateWXYZ(vtkMath::DegreesFromRadians(angle), vector);
  ExpectSameMatrix(again->GetMatrix(), rotation);

  motion->SetBoxScale(1.0, 1.0, 1.0);
  EXPECT_TRUE(motion->IsRigid());
}

TEST(HandleMotion, ReferenceBoundsDoNotMoveAnything)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetModeToBox();
  const vtkMTimeType time = motion->GetMTime();
  motion->SetBoxReferenceBounds(-1.0, 2.0, -3.0, 4.0, -5.0, 6.0);
  EXPECT_EQ(motion->GetMTime(), time);
  EXPECT_EQ(motion->GetBoxReferenceBounds()[5], 6.0);
  ExpectIdentity(motion);
}

TEST(HandleMotion, TakesAMatrix)
{
  vtkNew<vtkTransform> transform;
  transform->Translate(3.0, 4.0, 5.0);
  transform->RotateWXYZ(200.0, 0.0, 0.0, 1.0);
  vtkNew<vtkMatrix4x4> matrix;
  matrix->DeepCopy(transform->GetMatrix());

  vtkNew<vtkHandleMotion> motion;
  motion->SetAngle(30.0);
  motion->SetMatrix(matrix);
  EXPECT_EQ(motion->GetMode(), vtkHandleMotion::MATRIX);
  EXPECT_TRUE(motion->IsRigid());
  ExpectVector(motion, 0.0, 0.0, -160.0 * Pi / 180.0); // the short way round
  vtkNew<vtkMatrix4x4> read;
  motion->GetTransform(read);
  ExpectSameMatrix(read, matrix);

  // A shear is a linear map like any other.
  matrix->Identity();
  matrix->SetElement(0, 1, 0.5);
  EXPECT_EQ(motion->GetProblem(), "");
  EXPECT_FALSE(motion->IsRigid());
  motion->GetTransform(read);
  ExpectSameMatrix(read, matrix);

  motion->SetMatrix(nullptr);
  EXPECT_EQ(motion->GetMode(), vtkHandleMotion::AXIS_ANGLE);
  ExpectVector(motion, 0.0, 0.0, Pi / 6.0);
}

TEST(HandleMotion, TakesTheElementsOfAMatrixWithoutChangingTheMode)
{
  const double elements[16] = { 1, 0, 0, 7, 0, 1, 0, 8, 0, 0, 1, 9, 0, 0, 0, 1 };
  vtkNew<vtkHandleMotion> motion;
  motion->SetMatrixElements(elements);
  EXPECT_TRUE(motion->IsIdentity());
  motion->SetModeToMatrix();
  vtkNew<vtkMatrix4x4> read;
  motion->GetTransform(read);
  EXPECT_EQ(read->GetElement(1, 3), 8.0);
  EXPECT_FALSE(motion->IsIdentity());
  const vtkMTimeType time = motion->GetMTime();
  motion->SetMatrixElements(elements);
  EXPECT_EQ(motion->GetMTime(), time);
}

TEST(HandleMotion, KnowsWhatIsRigid)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetAngle(77.0);
  motion->SetTranslation(1.0, 1.0, 1.0);
  EXPECT_TRUE(motion->IsRigid());
  motion->SetScale(1.0 + 1e-11, 1.0, 1.0);
  EXPECT_TRUE(motion->IsRigid());
  motion->SetScale(1.0 + 1e-8, 1.0, 1.0);
  EXPECT_FALSE(motion->IsRigid());
  motion->SetScale(-1.0, -1.0, 1.0); // half a turn about z
  EXPECT_TRUE(motion->IsRigid());
  motion->SetScale(-1.0, 1.0, 1.0); // a mirror
  EXPECT_FALSE(motion->IsRigid());
  motion->SetScale(1.0, 1.0, 0.0); // a flattening
  EXPECT_FALSE(motion->IsRigid());
  EXPECT_EQ(motion->GetProblem(), "");
}

TEST(HandleMotion, LosesNoDigitsFarFromTheOrigin)
{
  const double origin[3] = { 1e6, -2e6, 3e6 };
  vtkNew<vtkHandleMotion> near;
  near->SetCenter(0.25, 0.5, -0.125);
  near->SetAxis(1.0, 1.0, 1.0);
  near->SetAngle(50.0);
  near->SetScale(1.0, 2.0, 1.0);
  vtkNew<vtkHandleMotion> far;
  far->SetCenter(origin[0] + 0.25, origin[1] + 0.5, origin[2] - 0.125);
  far->SetAxis(1.0, 1.0, 1.0);
  far->SetAngle(50.0);
  far->SetScale(1.0, 2.0, 1.0);

  vtkNew<vtkMatrix4x4> expected;
  near->GetTransform(expected);
  vtkNew<vtkMatrix4x4> matrix;
  far->GetTransformRelativeTo(origin, matrix);
  ExpectSameMatrix(matrix, expected, 1e-14);
}

TEST(HandleMotion, SaysWhatIsWrong)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(0.0, 0.0, 0.0);
  EXPECT_EQ(motion->GetProblem(), ""); // nothing to rotate
  motion->SetAngle(10.0);
  ExpectProblem(motion, "Axis has length zero");
  motion->SetAxis(0.0, NaN, 1.0);
  ExpectProblem(motion, "Axis has a number that is NaN or infinite");
  motion->SetAxis(0.0, 0.0, 1.0);
  motion->SetAngle(std::numeric_limits<double>::infinity());
  ExpectProblem(motion, "Angle has a number");
  motion->SetAngle(0.0);
  motion->SetScale(NaN, 1.0, 1.0);
  ExpectProblem(motion, "Scale");
  motion->SetScale(1.0, 1.0, 1.0);
  motion->SetCenter(0.0, 0.0, NaN);
  ExpectProblem(motion, "Center");
  motion->SetCenter(0.0, 0.0, 0.0);
  motion->SetTranslation(0.0, NaN, 0.0);
  ExpectProblem(motion, "Translation");

  motion->SetModeToBox(); // the other modes' numbers do not matter
  EXPECT_EQ(motion->GetProblem(), "");
  motion->SetBoxRotation(0.0, NaN, 0.0);
  ExpectProblem(motion, "BoxRotation");

  motion->SetModeToMatrix();
  ExpectProblem(motion, "there is no matrix");
  vtkNew<vtkMatrix4x4> matrix;
  motion->SetMatrix(matrix);
  EXPECT_EQ(motion->GetProblem(), "");
  matrix->SetElement(3, 0, 0.5);
  ExpectProblem(motion, "last row of Matrix is not 0 0 0 1");
  matrix->SetElement(3, 0, 0.0);
  matrix->SetElement(3, 3, 2.0);
  ExpectProblem(motion, "last row");
  matrix->SetElement(3, 3, 1.0);
  matrix->SetElement(0, 0, NaN);
  ExpectProblem(motion, "Matrix has a number");
}

TEST(HandleMotion, IsModifiedByItsMatrixAndItsParameters)
{
  vtkNew<vtkHandleMotion> motion;
  vtkNew<vtkMatrix4x4> matrix;
  motion->SetMatrix(matrix);
  vtkMTimeType time = motion->GetMTime();
  matrix->SetElement(0, 3, 5.0);
  EXPECT_GT(motion->GetMTime(), time);
  time = motion->GetMTime();
  motion->SetMatrix(matrix);
  EXPECT_EQ(motion->GetMTime(), time);
  motion->SetModeToBox();
  EXPECT_GT(motion->GetMTime(), time);
  time = motion->GetMTime();
  motion->SetBoxPosition(0.0, 0.0, 1.0);
  EXPECT_GT(motion->GetMTime(), time);
}

TEST(HandleMotion, PrintsItself)
{
  vtkNew<vtkHandleMotion> motion;
  std::ostringstream text;
  motion->Print(text);
  EXPECT_NE(text.str().find("Mode: AxisAngle"), std::string::npos);
  EXPECT_NE(text.str().find("Matrix: (none)"), std::string::npos);
  vtkNew<vtkMatrix4x4> matrix;
  motion->SetMatrix(matrix);
  motion->Print(text);
  EXPECT_NE(text.str().find("Mode: Matrix"), std::string::npos);
}
