// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkCompressedSurfaceReader
 * @brief reads what vtkCompressedSurfaceWriter wrote
 *
 * Output: the triangles, points in the precision that the writer's input had, and the point
 * arrays. A file of several time steps says so to the pipeline; the step at, or else last
 * before, the time that is asked for is read. All steps share one factorization, which is
 * kept from one update to the next.
 *
 * Errors, each with an empty output: no FileName, a file that cannot be read, is no
 * compressed surface, of another version, cut off or damaged.
 * A file from a stranger can do no harm: every number in it is checked, and the memory that
 * is taken is in proportion to its length.
 *
 * @sa vtkCompressedSurfaceWriter
 */
#ifndef vtkCompressedSurfaceReader_h
#define vtkCompressedSurfaceReader_h

#include "vtkCartanModule.h" // For the export macro

#include "vtkPolyDataAlgorithm.h"

#include <memory> // For what is kept

class VTKCARTAN_EXPORT vtkCompressedSurfaceReader : public vtkPolyDataAlgorithm
{
public:
  static vtkCompressedSurfaceReader* New();
  vtkTypeMacro(vtkCompressedSurfaceReader, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkCompressedSurfaceReader(const vtkCompressedSurfaceReader&) = delete;
  void operator=(const vtkCompressedSurfaceReader&) = delete;

  ///@{
  /**
   * The file to read. None by default.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /**
   * 1 if the file begins as a compressed surface does.
   */
  virtual int CanReadFile(VTK_FILEPATH const char* fileName);

protected:
  vtkCompressedSurfaceReader();
  ~vtkCompressedSurfaceReader() override;

  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  struct Internals;

  std::unique_ptr<Internals> Kept;
  char* FileName = nullptr;
};

#endif
