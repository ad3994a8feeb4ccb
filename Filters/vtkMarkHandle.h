// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMarkHandle
 * @brief marks the points of a region as a handle
 *
 * A *handle* is a set of points that the user fixes or moves while a
 * deformation filter moves the rest. This filter marks the points of a handle.
 *
 * Input port 0: a vtkPolyData with points of any kind; all blocks of a
 * composite data set are marked at once. Growing needs triangles or polygons
 * that form an oriented manifold. Input port 1, optional: a vtkSelection of
 * points or cells.
 *
 * Output: the input with the point array `Handle` (int, one component, no unit;
 * the name is settable): 0 for free points, k >= 1 for the points of handle k.
 * If the input has that array, it is copied and extended, so chained filters
 * mark several handles. It becomes the active point scalars, by which viewers
 * color the surface, unless there are others. The input itself is not changed.
 *
 * The region is given by an implicit function (points with a value <= 0 are in:
 * the inside of a box, sphere or cylinder, the back side of a plane), by the
 * selection (points of selected cells count as selected) with a list of point
 * ids, or by all of them, and can be grown over the surface by rings of edges or by geodesic
 * distance. Points in no triangle can be marked, but the region does not grow from or to them.
 *
 * A region without points gives a warning and no new marks, because this can
 * happen while a widget is dragged.
 *
 * @warning vtkExtractSelection evaluates the selection; a query of ParaView's
 * Find Data needs another extractor, see SetSelectionExtractor(). Nodes of a
 * selection that name a block (COMPOSITE_INDEX, HIERARCHICAL_INDEX) select in
 * that block only.
 *
 * @sa vtkHandleMotion vtkSurfaceDeformation vtkExtractSelection
 */
#ifndef vtkMarkHandle_h
#define vtkMarkHandle_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSmartPointer.h"   // For the held objects
#include "vtkSurfaceFilter.h"

#include <string> // For the array's name
#include <vector> // For blocks and ids

namespace cartan
{
class ExecutionContext;
}
class vtkExtractSelection;
class vtkIdTypeArray;
class vtkImplicitFunction;
class vtkSelection;

class VTKCARTAN_EXPORT vtkMarkHandle : public vtkSurfaceFilter
{
public:
  static vtkMarkHandle* New();
  vtkTypeMacro(vtkMarkHandle, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkMarkHandle(const vtkMarkHandle&) = delete;
  void operator=(const vtkMarkHandle&) = delete;

  ///@{
  /**
   * The selection on port 1, optional.
   */
  void SetSelectionConnection(vtkAlgorithmOutput* output);
  void SetSelectionData(vtkSelection* selection);
  ///@}

  ///@{
  /**
   * The id for the region's points, >= 0. With 0 the points become free again.
   * Default: 1.
   */
  vtkSetClampMacro(HandleId, int, 0, VTK_INT_MAX);
  vtkGetMacro(HandleId, int);
  ///@}

  ///@{
  /**
   * The name of the point array. Default: "Handle".
   */
  void SetHandleArrayName(const std::string& name) { this->SetMember(this->HandleArrayName, name); }
  std::string GetHandleArrayName() const { return this->HandleArrayName; }
  ///@}

  enum RegionSourceType
  {
    FUNCTION_OR_SELECTION = 0,
    FUNCTION = 1,
    SELECTION = 2,
    ALL_POINTS = 3
  };

  ///@{
  /**
   * Which points form the region. FUNCTION_OR_SELECTION, the default: the
   * points in either; a missing one contributes none. FUNCTION and SELECTION
   * use one and ignore the other. The point ids are part of the selection.
   * ALL_POINTS needs neither; with HandleId 0 it clears all marks.
   */
  vtkSetClampMacro(RegionSource, int, FUNCTION_OR_SELECTION, ALL_POINTS);
  vtkGetMacro(RegionSource, int);
  void SetRegionSourceToFunctionOrSelection() { this->SetRegionSource(FUNCTION_OR_SELECTION); }
  void SetRegionSourceToFunction() { this->SetRegionSource(FUNCTION); }
  void SetRegionSourceToSelection() { this->SetRegionSource(SELECTION); }
  void SetRegionSourceToAllPoints() { this->SetRegionSource(ALL_POINTS); }
  const char* GetRegionSourceAsString();
  ///@}

  ///@{
  /**
   * The function whose values <= 0 make the region, in the surface's
   * coordinates. Default: none.
   */
  void SetRegion(vtkImplicitFunction* region);
  vtkImplicitFunction* GetRegion();
  ///@}

  ///@{
  /**
   * Takes the points with a value > 0 of the function instead. It does not
   * affect the selection, whose nodes have an inverse of their own. Default:
   * off.
   */
  vtkSetMacro(InsideOut, bool);
  vtkGetMacro(InsideOut, bool);
  vtkBooleanMacro(InsideOut, bool);
  ///@}

  ///@{
  /**
   * Points of the region by their ids, >= 0 and less than the number of points;
   * others are an error. Up to 100,000,000. In a composite data set, ids are counted on from block
   * to block. Unlike a selection they need no other filter, so that states and
   * traces in Python hold them. Default: none.
   */
  void SetNumberOfPointIds(int count);
  int GetNumberOfPointIds() const { return static_cast<int>(this->PointIds.size()); }
  void SetPointId(int index, vtkIdType id);
  vtkIdType GetPointId(int index) const;
  ///@}

  ///@{
  /**
   * Adds the points within this number of edges of the region, >= 0. Default:
   * 0.
   */
  vtkSetClampMacro(GrowRings, int, 0, VTK_INT_MAX);
  vtkGetMacro(GrowRings, int);
  ///@}

  ///@{
  /**
   * Adds the points within this distance of the region along the surface, in
   * length units, >= 0. Together with GrowRings, points that either reaches are
   * added. Default: 0.
   */
  vtkSetNumberMacro(GrowDistance, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(GrowDistance, double);
  ///@}

  ///@{
  /**
   * On: points of other handles in the region change to HandleId. Off: only
   * free points are marked. Default: on.
   */
  vtkSetMacro(Overwrite, bool);
  vtkGetMacro(Overwrite, bool);
  vtkBooleanMacro(Overwrite, bool);
  ///@}

  ///@{
  /**
   * An extractor whose class evaluates the selection; each execution creates a
   * new instance of that class. ParaView's vtkPVExtractSelection also supports
   * queries. None, the default: vtkExtractSelection.
   */
  void SetSelectionExtractor(vtkExtractSelection* extractor);
  vtkExtractSelection* GetSelectionExtractor();
  ///@}

  /**
   * The number of points of the region that have HandleId after the last
   * execution; with HandleId 0, that are free. Of a surface that stays in pieces, those of this
   * rank's piece.
   */
  vtkGetMacro(NumberOfMarkedPoints, vtkIdType);

  /**
   * The ids of the points of the output that have HandleId, increasing, and counted
   * on from block to block in a composite data set: what PointIds would have to be
   * to mark them again. Empty with HandleId 0.
   */
  vtkIdTypeArray* GetMarkedPointIds();

  /**
   * Includes the region's function with its transform.
   */
  vtkMTimeType GetMTime() override;

  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkMarkHandle();
  ~vtkMarkHandle() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  void UsePreparedInput(cartan::FilterRun&) const override {} // only to grow
  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override { this->NumberOfMarkedPoints = 0; }
  bool SupportsPieces() const override;

private:
  struct Block;

  /// Makes `output` have the structure of `input`, and pairs their blocks.
  static std::vector<Block> MakeBlocks(
    vtkDataObject* input, vtkDataObject* evaluated, vtkDataObject* output);
  bool UsesSelection() const
  {
    return this->RegionSource == SELECTION || this->RegionSource == FUNCTION_OR_SELECTION;
  }
  void MarkBlock(
    const Block& block, cartan::FilterRun& run, const cartan::ExecutionContext& context);

  void WriteMarks(const Block& block, const std::vector<unsigned char>& mask);

  /// Why no point is marked, in a sentence.
  std::string DescribeEmptyRegion(bool hasSelection);

  int HandleId = 1;
  std::string HandleArrayName = "Handle";
  int RegionSource = FUNCTION_OR_SELECTION;
  bool InsideOut = false;
  int GrowRings = 0;
  double GrowDistance = 0.0;
  bool Overwrite = true;
  vtkSmartPointer<vtkImplicitFunction> Region;
  vtkSmartPointer<vtkExtractSelection> SelectionExtractor;
  vtkIdType NumberOfMarkedPoints = 0;
  std::vector<vtkIdType> PointIds;
  vtkSmartPointer<vtkIdTypeArray> MarkedPointIds;
};

#endif
