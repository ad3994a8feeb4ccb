// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkLaplacianSpectrum
 * @brief the modes of lowest frequency of a surface, and the surface as a sum of them
 *
 * Computes the eigenvectors of the smallest eigenvalues of the surface's Laplacian: its
 * *modes*, as sines and cosines are those of a line. A few of them carry the shape of
 * the surface, the others its detail. A change of the coefficients in this basis is a
 * filter in the sense of signal processing.
 *
 * Output 0: the input with points as Approximation says, in the input's precision, and
 * on request (GenerateModes) with the point array `Modes`, a component per mode. Points
 * in no triangle keep their place; their modes are 0.
 *
 * Output 1: a vtkTable with a row per mode in the order of their frequency:
 * - `Mode` (int, from 0),
 * - `Eigenvalue` (double >= 0; Operator GRAPH: without unit, COTANGENT: 1 / squared
 *   length units),
 * - `X`, `Y`, `Z` (double): the coefficients of the positions,
 * - `Energy` (double in [0, 1]): the part of the surface's squared distance from its
 *   center that the modes up to this one carry,
 * - with CoefficientArrayName, a column per component of that array: its coefficients.
 *
 * Modes are orthonormal in the mass of the operator. Modes of equal eigenvalues are any
 * basis of the space that they span: on symmetric surfaces single modes mean nothing,
 * their space does. Each connected component has an eigenvalue 0.
 *
 * With PlayModes the output has time steps 1, 2, ... NumberOfModes, and at time n the
 * approximation uses n modes: ParaView's play button plays a progressive approximation.
 *
 * The modes are kept: another approximation computes none.
 *
 * Errors, each with an empty output: more modes than points; more than fit into
 * ModeMemoryLimit (the message says how many fit); see vtkSurfaceFilter.
 *
 * Reference: Sorkine, Differential Representations for Mesh Processing, Computer
 * Graphics Forum 25(4), 2006, sections 2.3 and 3.1; Karni and Gotsman, Spectral
 * Compression of Mesh Geometry, 2000.
 */
#ifndef vtkLaplacianSpectrum_h
#define vtkLaplacianSpectrum_h

#include "vtkSurfaceFilter.h"

#include <string> // For the array name

class vtkTable;

class VTKCARTAN_EXPORT vtkLaplacianSpectrum : public vtkSurfaceFilter
{
public:
  static vtkLaplacianSpectrum* New();
  vtkTypeMacro(vtkLaplacianSpectrum, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkLaplacianSpectrum(const vtkLaplacianSpectrum&) = delete;
  void operator=(const vtkLaplacianSpectrum&) = delete;

  enum OperatorType
  {
    GRAPH = 0,
    COTANGENT = 1
  };

  ///@{
  /**
   * GRAPH: the graph Laplacian, which knows the connectivity alone, as spectral
   * compression uses it. COTANGENT: that of the surface, with the mixed Voronoi area as
   * mass; its modes do not depend on the triangulation. Default: GRAPH.
   */
  vtkSetClampMacro(Operator, int, GRAPH, COTANGENT);
  vtkGetMacro(Operator, int);
  void SetOperatorToGraph() { this->SetOperator(GRAPH); }
  void SetOperatorToCotangent() { this->SetOperator(COTANGENT); }
  ///@}

  ///@{
  /**
   * How many modes are computed, >= 1. Default: 100.
   */
  vtkSetClampMacro(NumberOfModes, int, 1, VTK_INT_MAX);
  vtkGetMacro(NumberOfModes, int);
  ///@}

  enum ApproximationType
  {
    NONE = 0,
    LOW_PASS = 1,
    BAND_PASS = 2,
    HIGH_PASS = 3
  };

  ///@{
  /**
   * Which modes make the output's points. NONE: the points stay. LOW_PASS: the first
   * ApproximationModes. BAND_PASS: those from FirstMode up to ApproximationModes, around
   * the center. HIGH_PASS: all, computed or not, but the first ApproximationModes,
   * around the center. Default: LOW_PASS.
   */
  vtkSetClampMacro(Approximation, int, NONE, HIGH_PASS);
  vtkGetMacro(Approximation, int);
  void SetApproximationToNone() { this->SetApproximation(NONE); }
  void SetApproximationToLowPass() { this->SetApproximation(LOW_PASS); }
  void SetApproximationToBandPass() { this->SetApproximation(BAND_PASS); }
  void SetApproximationToHighPass() { this->SetApproximation(HIGH_PASS); }
  ///@}

  ///@{
  /**
   * How many modes the approximation uses; 0 or more than there are: all that are
   * computed. Default: 0.
   */
  vtkSetClampMacro(ApproximationModes, int, 0, VTK_INT_MAX);
  vtkGetMacro(ApproximationModes, int);
  ///@}

  ///@{
  /**
   * The first mode of BAND_PASS, >= 0. Default: 1.
   */
  vtkSetClampMacro(FirstMode, int, 0, VTK_INT_MAX);
  vtkGetMacro(FirstMode, int);
  ///@}

  ///@{
  /**
   * Whether the output has a time step for each number of modes, which takes the place
   * of ApproximationModes. Default: off.
   */
  vtkSetMacro(PlayModes, bool);
  vtkGetMacro(PlayModes, bool);
  vtkBooleanMacro(PlayModes, bool);
  ///@}

  ///@{
  /**
   * Whether to add the point array `Modes`. Default: off.
   */
  vtkSetMacro(GenerateModes, bool);
  vtkGetMacro(GenerateModes, bool);
  vtkBooleanMacro(GenerateModes, bool);
  ///@}

  ///@{
  /**
   * A numeric point array whose coefficients the table gets too, and which is
   * approximated like the points, as the array of this name with "Approximation".
   * Empty by default.
   */
  void SetCoefficientArrayName(const std::string& name)
  {
    this->SetMember(this->CoefficientArrayName, name);
  }
  std::string GetCoefficientArrayName() const { return this->CoefficientArrayName; }
  ///@}

  ///@{
  /**
   * How much memory the computation of modes may take, without the factorization, in
   * megabytes (10^6 bytes), >= 1. Default: 4000.
   */
  vtkSetClampMacro(ModeMemoryLimit, int, 1, VTK_INT_MAX);
  vtkGetMacro(ModeMemoryLimit, int);
  ///@}

  /**
   * Output 1, valid after Update().
   */
  vtkTable* GetSpectrumTable();

protected:
  vtkLaplacianSpectrum();
  ~vtkLaplacianSpectrum() override = default;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void Execute(cartan::FilterRun& run) override;

private:
  std::string CoefficientArrayName;
  int Operator = GRAPH;
  int NumberOfModes = 100;
  int Approximation = LOW_PASS;
  int ApproximationModes = 0;
  int FirstMode = 1;
  int ModeMemoryLimit = 4000;
  bool PlayModes = false;
  bool GenerateModes = false;
};

#endif
