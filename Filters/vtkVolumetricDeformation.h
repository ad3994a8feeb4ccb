// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkVolumetricDeformation
 * @brief deforms a closed surface together with its inside, or a mesh of tetrahedra
 *
 * The points of the surface, a lattice inside of it and a layer around it are one graph.
 * The handles' rotations, scales and shears spread through this graph instead of over the
 * surface alone, and the graph whose edges fit the mapped ones best is computed. So
 * opposite sides hold together, and volume is kept: a bar six times as long as wide that
 * is bent by 170 degrees loses .1 % of its volume, 9.4 % without an inside.
 *
 * Input 0: the surface, closed unless there is a volume mesh, with handles (see
 * vtkSurfaceDeformation). Input 1, optional: a vtkUnstructuredGrid of tetrahedra whose
 * skin is the surface, with the same points; its points and edges are the graph instead.
 *
 * Output 0: the deformed surface. Output 1: the deformed volume mesh with all its arrays,
 * empty without input 1. Cells that are turned inside out are counted
 * (GetNumberOfInvertedCells), and a warning names them.
 *
 * One motion per handle; per-point arrays are an error. A handle that is only translated
 * stretches the body without turning it. Other errors: an open surface, or one without
 * volume; a lattice that does not fit into memory (the message has a spacing that does);
 * a volume mesh with other cells than tetrahedra, or points of the surface that are not
 * its points.
 *
 * References: Zhou et al., Large Mesh Deformation Using the Volumetric Graph Laplacian,
 * ACM SIGGRAPH 2005. Sorkine, Differential Representations for Mesh Processing, Computer
 * Graphics Forum 25(4), 2006, section 4.3.
 *
 * @sa vtkShapePreservingDeformation vtkMarkHandle vtkHandleMotion
 */
#ifndef vtkVolumetricDeformation_h
#define vtkVolumetricDeformation_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceDeformation.h"

class vtkAlgorithmOutput;
class vtkUnstructuredGrid;

namespace cartan
{
struct VolumeMesh;
}

class VTKCARTAN_EXPORT vtkVolumetricDeformation : public vtkSurfaceDeformation
{
public:
  static vtkVolumetricDeformation* New();
  vtkTypeMacro(vtkVolumetricDeformation, vtkSurfaceDeformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkVolumetricDeformation(const vtkVolumetricDeformation&) = delete;
  void operator=(const vtkVolumetricDeformation&) = delete;

  ///@{
  /**
   * The mesh of tetrahedra on port 1.
   */
  void SetVolumeMeshData(vtkUnstructuredGrid* mesh);
  void SetVolumeMeshConnection(vtkAlgorithmOutput* mesh) { this->SetInputConnection(1, mesh); }
  ///@}

  /**
   * The deformed mesh of tetrahedra, output 1.
   */
  vtkUnstructuredGrid* GetVolumeMesh();

  ///@{
  /**
   * The distance between neighbors of the lattice in length units, >= 0. 0: the mean
   * length of the surface's edges, but at most two lattice points for each point of the
   * surface, and 500000 in all. A spacing of more points than that is an error. Not used with a
   * volume mesh. Default: 0.
   */
  vtkSetNumberMacro(LatticeSpacing, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(LatticeSpacing, double);
  ///@}

  ///@{
  /**
   * Whether a layer of points around the surface keeps it from folding. Not used with a
   * volume mesh. Default: on.
   */
  vtkSetMacro(OuterLayer, bool);
  vtkGetMacro(OuterLayer, bool);
  vtkBooleanMacro(OuterLayer, bool);
  ///@}

  ///@{
  /**
   * The rounds that restore the local volume, each a back-substitution that takes half of
   * the loss or more, 0 to 1000. Default: 3.
   */
  vtkSetClampMacro(VolumeRounds, int, 0, 1000);
  vtkGetMacro(VolumeRounds, int);
  ///@}

  /**
   * The points of the graph that are not the surface's, of the last update.
   */
  vtkGetMacro(NumberOfAddedPoints, int);

  /**
   * The cells of the volume mesh that the last update has turned inside out.
   */
  vtkGetMacro(NumberOfInvertedCells, int);

protected:
  vtkVolumetricDeformation();
  ~vtkVolumetricDeformation() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override;
  cartan::DeformationMethod NewMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void RequireTargets(const cartan::HandleTargets& targets) const override;
  void AddSettings(cartan::ContentKey& settings) const override;

private:
  std::shared_ptr<const cartan::Surface> Surface; ///< while an update goes on
  std::shared_ptr<const cartan::VolumeMesh> Mesh; ///< likewise; null for a lattice
  double LatticeSpacing = 0.0;
  bool OuterLayer = true;
  int VolumeRounds = 3;
  int NumberOfAddedPoints = 0;
  int NumberOfInvertedCells = 0;
};

#endif
