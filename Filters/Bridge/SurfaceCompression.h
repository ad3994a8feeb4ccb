// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/SurfaceReader.h"
#include "Kernel/Compression/CompressedSurface.h"
#include "Kernel/Compression/ConnectivityCoder.h"
#include "Kernel/Compression/QualitySearch.h"

class vtkPolyData;

/// Between VTK data and compressed surfaces. Private to writer and reader, not installed.
namespace cartan
{
/// How exactly a surface is stored.
struct CompressionSettings
{
  HighPassQuality Quality;   ///< where MaximumError is 0, else where the search begins
  double MaximumError = 0.0; ///< of the visual error, in parts of the diagonal
  double VisualErrorAlpha = 0.15;
  bool KeepPointOrder = true;
};

/// The time steps of one connectivity, and what a file has of them.
class SurfaceCompression
{
public:
  /// Throws Error(BadInput) when the cells are not those of the steps before. Returns a
  /// sentence about arrays that cannot be stored, empty if there are none.
  std::string Add(
    std::shared_ptr<const Surface> surface, vtkPolyData* input, double time, bool withArrays);

  /// The bytes of the file.
  std::vector<unsigned char> Finish(
    const CompressionSettings& settings, const ExecutionContext& context);

  /// What Finish() used.
  HighPassQuality GetQuality() const { return this->Used; }

private:
  void Encode(HighPassQuality quality, const ExecutionContext& context);
  double VisualErrorOf(double alpha, const ExecutionContext& context) const;

  std::shared_ptr<const Surface> First;
  TraversalOrder Order;
  CompressedSurface Result;
  std::vector<Points> Positions; ///< by step, in the file's order, relative to Origins
  std::vector<Eigen::Vector3d> Origins;
  std::unique_ptr<HighPassCoder> Coder;
  int CoderAnchors = 0; ///< that were asked for
  HighPassQuality Used;
};

/// A decoded step as VTK data, in the points' order that the file has.
void WriteDecodedStep(const CompressedSurface& surface, const CodedStep& step,
  const HighPassCoder& coder, vtkPolyData* output, const ExecutionContext& context);
}
