// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkHandleMotion
 * @brief the motion of a handle: rotation, scale, translation, or any affine map
 *
 * A handle is a set of points that the user fixes or moves (see vtkMarkHandle).
 * This object describes the absolute motion of one handle: it maps its position
 * in the undeformed surface to its position in the deformed one. A deformation
 * filter takes one motion per handle id. A new motion is the identity, which
 * leaves the handle in place.
 *
 * There are three ways to describe the map; `Mode` chooses one:
 *
 * - `AXIS_ANGLE` (default): about `Center`, scale along the coordinate axes by
 *   `Scale`, then rotate by `Angle` about `Axis` through `Center`, then
 *   translate: x' = Center + R (Scale * (x - Center)) + Translation. The angle
 *   counts full turns: 480 degrees twist the surface between the handle and the
 *   pinned parts by one full turn more than 120 degrees.
 * - `BOX`: x' = T(BoxPosition) Rz Rx Ry S(BoxScale) x, with the Euler angles
 *   `BoxRotation`: the map of `BoxReferenceBounds` to the interactive box of
 *   ParaView or of vtkBoxRepresentation. The visible box is the image of the
 *   reference bounds, so a box that starts around the handle stays around it
 *   and can be grabbed again.
 * - `MATRIX`: an affine map, x' = Matrix x; its linear part is free (rotation,
 *   scale, shear, reflection).
 *
 * A singular map (a scale of 0) flattens the handle. It is allowed, but not
 * rigid. With invalid numbers (see GetProblem()) every result is the identity;
 * filters refuse such a motion with GetProblem() as the message.
 *
 * @sa vtkMarkHandle vtkSurfaceDeformation
 */
#ifndef vtkHandleMotion_h
#define vtkHandleMotion_h

#include "vtkCartanModule.h" // For the export macro

#include "vtkObject.h"
#include "vtkSmartPointer.h" // For the matrix

#include <string> // For GetProblem

class vtkMatrix4x4;

class VTKCARTAN_EXPORT vtkHandleMotion : public vtkObject
{
public:
  static vtkHandleMotion* New();
  vtkTypeMacro(vtkHandleMotion, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkHandleMotion(const vtkHandleMotion&) = delete;
  void operator=(const vtkHandleMotion&) = delete;

  enum ModeType
  {
    AXIS_ANGLE = 0,
    BOX = 1,
    MATRIX = 2
  };

  ///@{
  /**
   * Which parameters describe the map. The others are kept, but have no effect.
   * Default: AXIS_ANGLE.
   */
  vtkSetClampMacro(Mode, int, AXIS_ANGLE, MATRIX);
  vtkGetMacro(Mode, int);
  void SetModeToAxisAngle() { this->SetMode(AXIS_ANGLE); }
  void SetModeToBox() { this->SetMode(BOX); }
  void SetModeToMatrix() { this->SetMode(MATRIX); }
  const char* GetModeAsString();
  ///@}

  ///@{
  /**
   * AXIS_ANGLE: the point that scale and rotation leave in place, in the
   * surface's coordinates. Default: (0, 0, 0).
   */
  vtkSetVector3Macro(Center, double);
  vtkGetVector3Macro(Center, double);
  ///@}

  ///@{
  /**
   * AXIS_ANGLE: the factors along x, y and z. Negative factors mirror, 0
   * flattens. Default: (1, 1, 1).
   */
  vtkSetVector3Macro(Scale, double);
  vtkGetVector3Macro(Scale, double);
  ///@}

  ///@{
  /**
   * AXIS_ANGLE: the direction of the axis of rotation, of any length but zero
   * (zero is accepted while Angle is 0). Default: (0, 0, 1).
   */
  vtkSetVector3Macro(Axis, double);
  vtkGetVector3Macro(Axis, double);
  ///@}

  ///@{
  /**
   * AXIS_ANGLE: the angle of rotation in degrees by the right-hand rule, with
   * any number of full turns in either direction. Default: 0.
   */
  vtkSetMacro(Angle, double);
  vtkGetMacro(Angle, double);
  ///@}

  ///@{
  /**
   * AXIS_ANGLE: the translation after scale and rotation, in length units.
   * Default: (0, 0, 0).
   */
  vtkSetVector3Macro(Translation, double);
  vtkGetVector3Macro(Translation, double);
  ///@}

  ///@{
  /**
   * BOX: the translation after scale and rotation, in length units. Scale and
   * rotation act about the origin of the coordinates, not about the center of
   * the box. Default: (0, 0, 0).
   */
  vtkSetVector3Macro(BoxPosition, double);
  vtkGetVector3Macro(BoxPosition, double);
  ///@}

  ///@{
  /**
   * BOX: angles about x, y and z in degrees; applied about y first, then x,
   * then z, as vtkTransform::GetOrientation() and vtkProp3D define them.
   * Default: (0, 0, 0).
   */
  vtkSetVector3Macro(BoxRotation, double);
  vtkGetVector3Macro(BoxRotation, double);
  ///@}

  ///@{
  /**
   * BOX: the factors along x, y and z. Default: (1, 1, 1).
   */
  vtkSetVector3Macro(BoxScale, double);
  vtkGetVector3Macro(BoxScale, double);
  ///@}

  ///@{
  /**
   * BOX: the box (xmin, xmax, ymin, ymax, zmin, zmax) that a widget shows for
   * the identity, normally the bounds of the handle's points. It has no effect
   * on the map and does not modify this object; it is kept here so that a
   * widget, and a saved state, find it with the motion it belongs to.
   * Default: the unit cube (0, 1, 0, 1, 0, 1).
   */
  void SetBoxReferenceBounds(
    double xmin, double xmax, double ymin, double ymax, double zmin, double zmax);
  void SetBoxReferenceBounds(const double bounds[6]);
  vtkGetVector6Macro(BoxReferenceBounds, double);
  ///@}

  ///@{
  /**
   * MATRIX: the affine map for column vectors; its last row is 0 0 0 1. This
   * object keeps a reference to the matrix: later changes of its elements take
   * effect. Setting a matrix also sets Mode to MATRIX; setting none (the
   * default) in that mode sets it back to AXIS_ANGLE.
   */
  void SetMatrix(vtkMatrix4x4* matrix);
  vtkMatrix4x4* GetMatrix();
  ///@}

  /**
   * MATRIX: the same, the 16 elements row by row. Copies them into a new matrix
   * and does not change Mode, so that panels and scripts can set properties in
   * any order.
   */
  void SetMatrixElements(const double elements[16]);

  /**
   * The affine map. The identity if GetProblem() is not empty.
   */
  void GetTransform(vtkMatrix4x4* transform);

  /**
   * The same map in coordinates relative to `origin`, x - origin to x' -
   * origin. Precise also if surface and Center are far from the origin of the
   * coordinates.
   */
  void GetTransformRelativeTo(const double origin[3], vtkMatrix4x4* transform);

  /**
   * The rotation as a vector along its axis; its length is the angle in
   * radians. With AXIS_ANGLE the angle as it was set, which may exceed 2 pi.
   * Otherwise that of the rotation closest to the linear part, in [0, pi]; for
   * BOX this is the rotation by BoxRotation.
   */
  void GetRotationVector(double vector[3]);

  /**
   * Whether the map is a rotation and a translation: L^T L differs from the
   * identity by at most 1e-9 and det L > 0 for the linear part L.
   */
  bool IsRigid();

  /**
   * Whether nothing moves and nothing turns. A full turn maps every point to
   * itself but is not the identity: it twists the surface at the handle.
   */
  bool IsIdentity();

  /**
   * A sentence that says what is wrong with the numbers: one is not finite, the
   * axis of a rotation has no length, the matrix is missing or its last row is
   * not 0 0 0 1. Empty if nothing is wrong.
   */
  std::string GetProblem();

  /**
   * Includes the matrix.
   */
  vtkMTimeType GetMTime() override;

protected:
  vtkHandleMotion();
  ~vtkHandleMotion() override;

  int Mode = AXIS_ANGLE;
  double Center[3] = { 0.0, 0.0, 0.0 };
  double Scale[3] = { 1.0, 1.0, 1.0 };
  double Axis[3] = { 0.0, 0.0, 1.0 };
  double Angle = 0.0;
  double Translation[3] = { 0.0, 0.0, 0.0 };
  double BoxPosition[3] = { 0.0, 0.0, 0.0 };
  double BoxRotation[3] = { 0.0, 0.0, 0.0 };
  double BoxScale[3] = { 1.0, 1.0, 1.0 };
  double BoxReferenceBounds[6] = { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  vtkSmartPointer<vtkMatrix4x4> Matrix;
};

#endif
