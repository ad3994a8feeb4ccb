// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkCompressedSurfaceWriter
 * @brief writes surfaces as small files
 *
 * Writes triangle surfaces as `.csf` files, which vtkCompressedSurfaceReader reads. Rounded
 * positions make a surface rough; here differential coordinates are rounded (see
 * vtkHighPassQuantization), so that the surface that is read differs by a smooth and hardly
 * visible error. Choose how exact it is by Bits, or by MaximumError.
 *
 * What is read again: the points, rounded so, in the precision of the input; the triangles
 * in another order, and other polygons and strips as triangles; point arrays without any
 * change. Points in no triangle keep their place. Lines, vertices, cell arrays and field data
 * are not written.
 *
 * Errors, each without a file: no FileName, or a file that cannot be written; more anchors
 * than points; a MaximumError that 16 bits do not meet (the message says what they reach);
 * time steps of different cells; inputs that are not the surfaces that vtkSurfaceFilter
 * takes. Warnings: point arrays of text or of bits, which are
 * not written, and those of vtkSurfaceFilter.
 *
 * Reference: Sorkine, Cohen-Or, Toledo, High-pass Quantization for Mesh Encoding, Symposium
 * on Geometry Processing 2003.
 *
 * @sa vtkCompressedSurfaceReader vtkHighPassQuantization
 */
#ifndef vtkCompressedSurfaceWriter_h
#define vtkCompressedSurfaceWriter_h

#include "vtkCartanModule.h" // For the export macro

#include "vtkSetNumberMacro.h" // For properties
#include "vtkWriter.h"

#include <memory> // For what is collected
#include <vector> // For the bytes of a file

namespace cartan
{
class FilterRun;
}

class VTKCARTAN_EXPORT vtkCompressedSurfaceWriter : public vtkWriter
{
public:
  static vtkCompressedSurfaceWriter* New();
  vtkTypeMacro(vtkCompressedSurfaceWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkCompressedSurfaceWriter(const vtkCompressedSurfaceWriter&) = delete;
  void operator=(const vtkCompressedSurfaceWriter&) = delete;

  ///@{
  /**
   * The file to write. None by default.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * The bits of each differential coordinate, 1 to 16. 5 look like 10 bits of a position, 7
   * like 12. Used where MaximumError is 0. Default: 7.
   */
  vtkSetClampMacro(Bits, int, 1, 16);
  vtkGetMacro(Bits, int);
  ///@}

  ///@{
  /**
   * How many points keep their position, >= 1: spread over the surface, at least one per
   * connected component. With a MaximumError the search for their number begins here.
   * Default: 20.
   */
  vtkSetClampMacro(NumberOfAnchors, int, 1, VTK_INT_MAX);
  vtkGetMacro(NumberOfAnchors, int);
  ///@}

  ///@{
  /**
   * The largest root mean square of the visual error of a time step, in parts of the
   * bounding box's diagonal, >= 0: the fewest bits and anchors that meet it are used. The
   * search decodes the surface once for each number of bits and factorizes a system for each
   * number of anchors that it tries. 0 uses Bits and NumberOfAnchors. Default: 0.
   */
  vtkSetNumberMacro(MaximumError, 0.0, 1.0);
  vtkGetMacro(MaximumError, double);
  ///@}

  ///@{
  /**
   * How much the distance counts in the visual error, in [0, 1]; the rest is roughness.
   * Default: .15.
   */
  vtkSetNumberMacro(VisualErrorAlpha, 0.0, 1.0);
  vtkGetMacro(VisualErrorAlpha, double);
  ///@}

  ///@{
  /**
   * Whether points come back in their order. Otherwise they are numbered as they lie side
   * by side, which saves about as many bits per point as their number has digits in base
   * 2. On by default.
   */
  vtkSetMacro(KeepPointOrder, bool);
  vtkGetMacro(KeepPointOrder, bool);
  vtkBooleanMacro(KeepPointOrder, bool);
  ///@}

  ///@{
  /**
   * Whether to write the point arrays, without any loss: real numbers hardly become
   * smaller. On by default.
   */
  vtkSetMacro(WritePointArrays, bool);
  vtkGetMacro(WritePointArrays, bool);
  vtkBooleanMacro(WritePointArrays, bool);
  ///@}

  ///@{
  /**
   * Whether to write all time steps of the input into the file, rather than the one that it
   * has. They need the same cells. Off by default.
   */
  vtkSetMacro(WriteAllTimeSteps, bool);
  vtkGetMacro(WriteAllTimeSteps, bool);
  vtkBooleanMacro(WriteAllTimeSteps, bool);
  ///@}

  ///@{
  /**
   * Results of the last Write(): the bits of each differential coordinate, the number of
   * anchors, and the bytes of the file; 0 without one.
   */
  vtkGetMacro(UsedBits, int);
  vtkGetMacro(UsedAnchors, int);
  vtkGetMacro(FileSize, vtkTypeInt64);
  ///@}

protected:
  vtkCompressedSurfaceWriter();
  ~vtkCompressedSurfaceWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  /**
   * Not used: RequestData() knows more than the input.
   */
  void WriteData() override {}

private:
  struct Internals;

  void Execute(cartan::FilterRun& run);
  void WriteFile(const std::vector<unsigned char>& bytes) const;

  std::unique_ptr<Internals> Collected;
  char* FileName = nullptr;
  int Bits = 7;
  int NumberOfAnchors = 20;
  double MaximumError = 0.0;
  double VisualErrorAlpha = 0.15;
  bool KeepPointOrder = true;
  bool WritePointArrays = true;
  bool WriteAllTimeSteps = false;
  int UsedBits = 0;
  int UsedAnchors = 0;
  vtkTypeInt64 FileSize = 0;
};

#endif
