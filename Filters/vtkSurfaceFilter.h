// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSurfaceFilter
 * @brief base of the filters that work on triangle surfaces
 *
 * A concrete filter implements Execute(), which reads surfaces, calls the
 * mathematics and writes the output. This class does the rest:
 *
 * - Every problem becomes one vtkErrorMacro; all outputs are empty then, the
 *   input is not changed, and GetErrorCode() is vtkErrorCode::UserError. The update
 *   itself counts as done, so that an interactive application goes on when the
 *   cause is removed.
 * - An input without points and cells gives empty outputs without a warning:
 *   a pipeline that is being set up.
 * - AbortExecute empties the outputs.
 * - Warnings, with each update that they concern: cells that use a point twice
 *   (ignored), cells without area, and border edges that coincide, where the
 *   surface looks closed and is not (vtkPrepareSurface merges their points).
 * - A surface in pieces on several ranks is joined on the first, which runs the filter; each
 *   rank gets its piece of an output that has the input's points and cells, with its own ghost
 *   cells. Other outputs are whole on the first rank. Points are joined by their global ids
 *   (the attribute), or else where points of several pieces are in the same place. There is one
 *   warning of that, and beyond GatherLimit an error. Filters that say so leave the surface
 *   where it is: each rank works on its piece, and asks the others for what it needs of them.
 * - A problem on one rank ends the update on all of them, with one message of the first.
 * - What is expensive is kept from one update to the next, found by the contents
 *   that it was made from. The output never depends on earlier updates, inputs
 *   or settings. Surfaces with equal cells share one mesh, also among filters.
 */
#ifndef vtkSurfaceFilter_h
#define vtkSurfaceFilter_h

#include "vtkCartanModule.h" // For the export macro

#include "vtkPolyDataAlgorithm.h"

#include <memory> // For what is kept
#include <string> // For messages

class vtkMultiProcessController;

namespace cartan
{
class FilterRun;
class KeptResults;
class RankGroup;
}

class VTKCARTAN_EXPORT vtkSurfaceFilter : public vtkPolyDataAlgorithm
{
public:
  vtkTypeMacro(vtkSurfaceFilter, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkSurfaceFilter(const vtkSurfaceFilter&) = delete;
  void operator=(const vtkSurfaceFilter&) = delete;

  ///@{
  /**
   * Whether to prepare surfaces that are refused otherwise, as vtkPrepareSurface
   * does by default, and to carry the results back to the points and cells of the
   * input, as vtkRestoreSurface does. Surfaces that belong together are prepared
   * alike: as the reference needs it, or else the first. Off by default, and an error
   * in vtkBoundaryLoops, vtkCarryAlong, vtkCoatingTransfer, vtkCurveDeformation,
   * vtkDiscreteForms, vtkFrameReconstruction, vtkLandmarkHandles, vtkMeshMerge,
   * vtkPrepareSurface, vtkRestoreSurface and vtkSpectralWatermark, and where
   * vtkVolumeChange computes rates.
   */
  vtkSetMacro(PrepareInput, bool);
  vtkGetMacro(PrepareInput, bool);
  vtkBooleanMacro(PrepareInput, bool);
  ///@}

  ///@{
  /**
   * How much memory this filter may keep from one update to the next, in
   * megabytes (10^6 bytes), >= 0. What was used longest ago is given up first;
   * what the last update used is always kept. A lower limit never
   * changes results, only how often surfaces are prepared anew. Default: 2000.
   */
  vtkSetClampMacro(KeptMemoryLimit, int, 0, VTK_INT_MAX);
  vtkGetMacro(KeptMemoryLimit, int);
  ///@}

  ///@{
  /**
   * How many points a surface in pieces on several ranks may have to be joined on the first
   * rank, >= 0: the sum over all ranks and inputs. One with more is an error. Default: 2000000.
   */
  vtkSetClampMacro(GatherLimit, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(GatherLimit, vtkIdType);
  ///@}

  /**
   * How much memory this filter keeps, in megabytes (10^6 bytes). A mesh that
   * several filters share counts in each of them.
   */
  double GetKeptMemory() const;

  /**
   * Releases the kept results.
   */
  void ReleaseKeptMemory();

  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkSurfaceFilter();
  ~vtkSurfaceFilter() override;

  /**
   * Makes the outputs from the inputs. Throws cartan::Error.
   */
  virtual void Execute(cartan::FilterRun& run) = 0;

  /**
   * Sets results that are valid after an update back to what they are without
   * one. Called before each update.
   */
  virtual void ForgetResults() {}

  /**
   * Whether Execute() runs on each rank with its own piece of a surface, with the settings as
   * they are, which are the same on all ranks. What it does there with the other ranks it does
   * on all of them, see cartan::FilterRun::Pieces(). Default: no.
   */
  virtual bool SupportsPieces() const { return false; }

  /**
   * Whether Execute() on pieces tells the other ranks of errors itself, by
   * cartan::FilterRun::Together(), so that it needs no message where the inputs are those of
   * the update before. Default: no.
   */
  virtual bool MovesAlone() const { return false; }

  /**
   * Whether an output that has the points and cells of a joined input is handed back in
   * pieces. Default: yes.
   */
  virtual bool HandsBackPieces() const { return true; }

  /**
   * Called instead of RequestData() on the other ranks while the first one runs the filter, for
   * what decides what is asked of the input next: the request tells whether that
   * continues (CONTINUE_EXECUTING). On all ranks, with `hasEnded`, where the update has ended.
   */
  virtual void FollowFirstRank(vtkInformation* vtkNotUsed(request),
    vtkInformationVector** vtkNotUsed(inputVector), bool vtkNotUsed(hasEnded))
  {
  }

  /**
   * Whether an input without points and cells is passed on without a warning.
   * Default: yes.
   */
  virtual bool AcceptsEmptyInput() const { return true; }

  /**
   * Called before Execute() when PrepareInput is on. Makes the run give prepared
   * surfaces. A filter for which that means nothing, because an output belongs to
   * edges or is a prepared surface itself, calls RefusePrepareInput().
   */
  virtual void UsePreparedInput(cartan::FilterRun& run) const;

  /**
   * Throws the error that says so, and what to do.
   */
  [[noreturn]] void RefusePrepareInput() const;

  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  /**
   * Declares what an input or output port has, for FillInputPortInformation and
   * FillOutputPortInformation: a class of data, and whether it may be missing.
   */
  static int SetPortType(vtkInformation* info, const char* className, bool isOptional = false);
  static int SetOutputType(vtkInformation* info, const char* className);

  /**
   * Assigns a member that is not a number; modifies this filter if it changes.
   */
  template <typename Member, typename Value>
  void SetMember(Member& member, const Value& value)
  {
    if (!(member == value))
    {
      member = value;
      this->Modified();
    }
  }

private:
  void EmptyOutputs();
  void ReportProblem(const std::string& problem, bool isCollective);
  /// Before each update: whether the ranks have blocks of composite data.
  void LookForBlocks();
  int RunOnFirstRank(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector, const cartan::RankGroup& ranks,
    const std::string& reason = "");
  int RunOnPieces(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector, vtkMultiProcessController* controller);
  void ExecuteOnPieces(cartan::FilterRun& run);
  bool ServesPiecesOf(vtkMultiProcessController* controller) const;
  unsigned long long StampOfInputs();

  std::unique_ptr<cartan::KeptResults> Kept;
  std::string Numbering; // what ids in messages mean while a joined surface is at work
  vtkIdType GatherLimit = 2000000;
  int KeptMemoryLimit = 2000;
  // Of the inputs whose pieces all ranks have at hand; 0 where there are none.
  unsigned long long SettledStamp = 0;
  bool HasBlocks = false;
  bool RefusesBlocks = false;
  bool HasWarnedOfGathering = false;
  bool PrepareInput = false;
};

#endif
