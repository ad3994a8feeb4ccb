// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkLandmarkHandles
 * @brief makes handles with target positions of landmarks
 *
 * A *landmark* is a place that is known in two states: where it is on the surface at rest
 * (input 1), and where it is to be (input 2). For each one this filter makes a handle of the
 * nearest point of the surface, which is to move from its place by the difference of the
 * two. Any deformation takes it from there, with TargetPositionArrayName "TargetPosition"
 * and, for an Accuracy, ConstraintWeightArrayName "ConstraintWeight". Where landmarks alone
 * hold the surface, use a method that computes rotations from positions:
 * vtkSimilarityDeformation, vtkAsRigidAsPossibleDeformation or vtkLaplacianDeformation.
 *
 * Input 0: the surface, possibly with handles. Inputs 1 and 2: the landmarks from and to, as
 * many in both: a vtkPointSet, or a vtkTable with the columns x, y, z (or r, a, s; l, p, s;
 * Points:0, Points:1, Points:2). A string array (label, name, or the first one) names them.
 *
 * Output 0: the surface with the point arrays
 * - `Handle` (int, settable name): the ids of landmarks follow those that are there, in the
 *   order of the landmarks. A point of another handle leaves it.
 * - `TargetPosition` (3 doubles, length units): elsewhere the point itself, or what the input
 *   has.
 * - with an accuracy `ConstraintWeight` (double): see vtkSurfaceDeformation; infinity at
 *   handles that are exact, and elsewhere, or what the input has.
 *
 * Output 1: a vtkTable with a row per landmark, in the order of input 1: `Landmark` (its name,
 * or its number from 0), `HandleId`, `PointId`, `Distance` (from the landmark to the point),
 * `Displacement` (3, length units), `Accuracy`, `Weight`.
 *
 * Errors, each with empty outputs, name the landmarks: none, or more than points in
 * triangles; other numbers in both sets, or other names with Matching by name; coordinates
 * that are not finite; two landmarks in one place, or with one nearest point; a landmark
 * farther from the surface than Tolerance; an accuracy that is negative. Warnings: landmarks
 * far from the surface; names that are the same in another order. See also vtkSurfaceFilter.
 *
 * @sa vtkMarkHandle vtkSurfaceDeformation vtkThinPlateSplineTransform
 */
#ifndef vtkLandmarkHandles_h
#define vtkLandmarkHandles_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceFilter.h"

#include <string> // For array names

class vtkTable;

class VTKCARTAN_EXPORT vtkLandmarkHandles : public vtkSurfaceFilter
{
public:
  static vtkLandmarkHandles* New();
  vtkTypeMacro(vtkLandmarkHandles, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkLandmarkHandles(const vtkLandmarkHandles&) = delete;
  void operator=(const vtkLandmarkHandles&) = delete;

  ///@{
  /**
   * Where landmarks are on the surface, input 1, and where they are to be, input 2: a
   * vtkPointSet or a vtkTable each.
   */
  void SetFromConnection(vtkAlgorithmOutput* from) { this->SetInputConnection(1, from); }
  void SetFromData(vtkDataObject* from) { this->SetInputDataObject(1, from); }
  void SetToConnection(vtkAlgorithmOutput* to) { this->SetInputConnection(2, to); }
  void SetToData(vtkDataObject* to) { this->SetInputDataObject(2, to); }
  ///@}

  enum MatchingType
  {
    ORDER = 0,
    NAME = 1
  };

  ///@{
  /**
   * Which landmarks belong together: those of the same number, or of the same name.
   * Default: ORDER.
   */
  vtkSetClampMacro(Matching, int, ORDER, NAME);
  vtkGetMacro(Matching, int);
  void SetMatchingToOrder() { this->SetMatching(ORDER); }
  void SetMatchingToName() { this->SetMatching(NAME); }
  ///@}

  ///@{
  /**
   * How far a landmark may be from the nearest point of the surface, in length units, >= 0.
   * 0: any distance. Default: 0.
   */
  vtkSetNumberMacro(Tolerance, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * By how much a landmark's point may miss its target, in length units, >= 0. Weights are
   * the smallest for which the harmonic displacement misses no target by more than half of
   * it; the other half is for methods of another energy. 0: the target is met exactly.
   * Default: 0.
   */
  vtkSetNumberMacro(Accuracy, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Accuracy, double);
  ///@}

  ///@{
  /**
   * An array of input 1 with the accuracy of each landmark, in place of Accuracy. Empty:
   * none. Default: empty.
   */
  void SetAccuracyArrayName(const std::string& name)
  {
    this->SetMember(this->AccuracyArrayName, name);
  }
  std::string GetAccuracyArrayName() const { return this->AccuracyArrayName; }
  ///@}

  ///@{
  /**
   * The name of the handles' array. Default: "Handle".
   */
  void SetHandleArrayName(const std::string& name) { this->SetMember(this->HandleArrayName, name); }
  std::string GetHandleArrayName() const { return this->HandleArrayName; }
  ///@}

  /**
   * Output 1, valid after Update().
   */
  vtkTable* GetLandmarkTable();

  ///@{
  /**
   * Valid after Update(): how many landmarks there are, and the largest distance from one to
   * its point, in length units.
   */
  vtkGetMacro(NumberOfLandmarks, int);
  vtkGetMacro(LargestDistance, double);
  ///@}

protected:
  vtkLandmarkHandles();
  ~vtkLandmarkHandles() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override;
  void UsePreparedInput(cartan::FilterRun&) const override { this->RefusePrepareInput(); }

private:
  struct Placed;
  Placed ReadAndPlace(cartan::FilterRun& run) const;
  void RequireNear(const Placed& placed, cartan::FilterRun& run) const;
  void WriteArrays(const Placed& placed, cartan::FilterRun& run) const;

  int Matching = ORDER;
  double Tolerance = 0.0;
  double Accuracy = 0.0;
  std::string AccuracyArrayName;
  std::string HandleArrayName = "Handle";
  int NumberOfLandmarks = 0;
  double LargestDistance = 0.0;
};

#endif
