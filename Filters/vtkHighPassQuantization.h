// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkHighPassQuantization
 * @brief rounds a surface so that it takes few bits and looks the same
 *
 * The output is what a decoder sees: the connectivity, the differential coordinates of
 * uniform weights rounded to a few bits, and the positions of a few anchors, turned back
 * into a surface. Rounded positions make a surface rough; rounded differential coordinates
 * bend it slightly and smoothly, which is hardly visible. Use it to choose the precision at
 * which a surface is stored, and to see what that does to it.
 *
 * Output: the input with the decoded points in the input's precision, and the point arrays
 * - `VisualError` (double, length units): how visible the difference is, after Karni and
 *   Gotsman: VisualErrorAlpha times the distance plus (1 - VisualErrorAlpha) times the change
 *   of the point relative to its neighbors; positive where it moved outwards;
 * - `Anchor` (int): 1 at anchors, else 0.
 * Field data, one double each: `BitsPerPoint`, what an ideal code of order 0 needs for
 * differential coordinates and anchors; `VisualErrorRMS` and `VisualErrorMax` (length units);
 * `Bits`. The connectivity is not counted. Points in no triangle keep their place.
 *
 * Errors, each with an empty output: more anchors than points; a MaximumError that 16 bits
 * do not meet (the message says what they reach); see vtkSurfaceFilter.
 *
 * Reference: Sorkine, Cohen-Or, Toledo, High-pass Quantization for Mesh Encoding, Symposium
 * on Geometry Processing 2003; Sorkine, Differential Representations for Mesh Processing,
 * Computer Graphics Forum 25(4), 2006, section 3.2.
 *
 * @sa vtkDifferentialReconstruction
 */
#ifndef vtkHighPassQuantization_h
#define vtkHighPassQuantization_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceFilter.h"

class VTKCARTAN_EXPORT vtkHighPassQuantization : public vtkSurfaceFilter
{
public:
  static vtkHighPassQuantization* New();
  vtkTypeMacro(vtkHighPassQuantization, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkHighPassQuantization(const vtkHighPassQuantization&) = delete;
  void operator=(const vtkHighPassQuantization&) = delete;

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
   * connected component. More of them reduce the distance from the original, hardly its
   * roughness. Default: 20.
   */
  vtkSetClampMacro(NumberOfAnchors, int, 1, VTK_INT_MAX);
  vtkGetMacro(NumberOfAnchors, int);
  ///@}

  ///@{
  /**
   * The largest root mean square of the visual error, in parts of the bounding box's
   * diagonal, >= 0: the least number of bits that meets it is used. 0 uses Bits. Default: 0.
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
   * Results of the last update: the bits per point, the root mean square of the visual
   * error in length units, and the bits that were used; 0 without one.
   */
  vtkGetMacro(BitsPerPoint, double);
  vtkGetMacro(VisualErrorRMS, double);
  vtkGetMacro(UsedBits, int);
  ///@}

protected:
  vtkHighPassQuantization() = default;
  ~vtkHighPassQuantization() override = default;

  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override;

private:
  int Bits = 7;
  int NumberOfAnchors = 20;
  double MaximumError = 0.0;
  double VisualErrorAlpha = 0.15;
  double BitsPerPoint = 0.0;
  double VisualErrorRMS = 0.0;
  int UsedBits = 0;
};

#endif
