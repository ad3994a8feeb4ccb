// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFrameDeformation.h"

#include "Kernel/Deformation/FrameDeformer.h"
#include "Kernel/Measure/Measures.h"
#include "Kernel/Mesh/RayTree.h"
#include "KernelBridge.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <limits>
#include <vector>

/// What is kept of the surfaces that are still in use: their volume models, and
/// their local volumes once asked for.
class vtkFrameDeformation::VolumeModels
{
public:
  std::shared_ptr<const cartan::VolumeModel> Find(vtkFrameDeformation* filter,
    const cartan::HandleProblem& problem, const cartan::ExecutionContext& context)
  {
    Entry& entry = this->EntryOf(problem);
    if (!entry.Model)
    {
      const cartan::RayTree tree(problem.Mesh->GetTriangles(), *problem.Rest);
      entry.Model = std::make_shared<const cartan::VolumeModel>(cartan::MeasureVolumeModel(
        *problem.Mesh, *problem.Rest,
        [&tree](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
        { return tree.FirstHit(from, direction); },
        context));
      cartan::Warn(filter, entry.Model->Warning);
    }
    return entry.Model;
  }

  /// The part of the volume under each vertex; NaN where none is enclosed.
  Eigen::VectorXd MeasureLocalVolumes(const cartan::HandleProblem& problem,
    const cartan::VolumeModel& model, const cartan::Points& positions,
    const cartan::ExecutionContext& context)
  {
    Eigen::VectorXd volumes =
      Eigen::VectorXd::Constant(positions.rows(), std::numeric_limits<double>::quiet_NaN());
    if (!model.IsEmpty())
    {
      Entry& entry = this->EntryOf(problem);
      if (!entry.Volumes)
      {
        entry.Volumes =
          std::make_shared<const cartan::LocalVolumes>(problem.Mesh, *problem.Rest, context);
      }
      const Eigen::VectorXd measured = entry.Volumes->Measure(positions, context);
      for (Eigen::Index v = 0; v < positions.rows(); ++v)
      {
        const int component = problem.Mesh->Component(static_cast<int>(v));
        if (component < 0 || model.EnclosesVolume[component])
        {
          volumes[v] = measured[v];
        }
      }
    }
    return volumes;
  }

private:
  struct Entry
  {
    std::weak_ptr<const cartan::Points> Surface;
    std::shared_ptr<const cartan::VolumeModel> Model;
    std::shared_ptr<const cartan::LocalVolumes> Volumes;
  };

  Entry& EntryOf(const cartan::HandleProblem& problem)
  {
    this->Entries.erase(std::remove_if(this->Entries.begin(), this->Entries.end(),
                          [](const Entry& entry) { return entry.Surface.expired(); }),
      this->Entries.end());
    for (Entry& entry : this->Entries)
    {
      if (entry.Surface.lock() == problem.Rest)
      {
        return entry;
      }
    }
    this->Entries.push_back({ problem.Rest, nullptr, nullptr });
    return this->Entries.back();
  }

  std::vector<Entry> Entries;
};

vtkFrameDeformation::vtkFrameDeformation()
  : Models(std::make_unique<VolumeModels>())
{
}

vtkFrameDeformation::~vtkFrameDeformation() = default;

void vtkFrameDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "VolumeCorrection: " << this->VolumeCorrection << "\n";
  os << indent << "CloseVolume: " << this->CloseVolume << "\n";
  os << indent << "PositionWeights: " << this->PositionWeights << "\n";
  os << indent << "GenerateVolumeArrays: " << this->GenerateVolumeArrays << "\n";
  os << indent << "GenerateShapeDistance: " << this->GenerateShapeDistance << "\n";
}

void vtkFrameDeformation::SetPositionWeights(int weights)
{
  weights = std::min(std::max<int>(weights, LIKE_FRAMES), static_cast<int>(MEAN_VALUE_POSITIONS));
  if (weights != this->PositionWeights)
  {
    this->PositionWeights = weights;
    this->ForgetDeformers();
    this->Modified();
  }
}

std::unique_ptr<cartan::SurfaceDeformer> vtkFrameDeformation::NewDeformer(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  if (this->PositionWeights == LIKE_FRAMES)
  {
    return this->NewFrameDeformer(problem, backend, context);
  }
  cartan::HandleProblem complete = problem;
  complete.PositionWeights =
    static_cast<cartan::LaplacianWeights>(this->PositionWeights - UNIFORM_POSITIONS);
  return this->NewFrameDeformer(complete, backend, context);
}

void vtkFrameDeformation::ConfigureDeformer(
  cartan::SurfaceDeformer& deformer, const cartan::ExecutionContext& context)
{
  static_assert(static_cast<int>(cartan::VolumeCorrection::None) == NO_CORRECTION &&
      static_cast<int>(cartan::VolumeCorrection::FrameScaling) == FRAME_SCALING &&
      static_cast<int>(cartan::VolumeCorrection::NeutralOffset) == NEUTRAL_OFFSET,
    "the enumerations agree");
  auto& frames = static_cast<cartan::FrameDeformer&>(deformer);
  frames.SetVolumeCorrection(static_cast<cartan::VolumeCorrection>(this->VolumeCorrection));
  frames.SetCloseVolume(this->CloseVolume);
  const bool isNeeded =
    this->VolumeCorrection != NO_CORRECTION || this->CloseVolume || this->GenerateVolumeArrays;
  if (isNeeded && !frames.GetVolumeModel())
  {
    frames.SetVolumeModel(this->Models->Find(this, frames.GetProblem(), context));
  }
}

void vtkFrameDeformation::DecorateOutput(const cartan::HandleProblem& problem,
  cartan::SurfaceDeformer& deformer, const cartan::DeformedSurface& result, vtkPolyData* output,
  const cartan::ExecutionContext& context)
{
  const Eigen::Index size = problem.Rest->rows();
  if (this->GenerateVolumeArrays)
  {
    const auto& model = static_cast<cartan::FrameDeformer&>(deformer).GetVolumeModel();
    const Eigen::VectorXd depth =
      model->IsEmpty() ? Eigen::VectorXd(Eigen::VectorXd::Zero(size)) : model->LocalDepth;
    const Eigen::VectorXd volume =
      this->Models->MeasureLocalVolumes(problem, *model, result.Positions, context);
    const Eigen::VectorXd scale = result.FrameScale.size() == size
      ? result.FrameScale
      : Eigen::VectorXd(Eigen::VectorXd::Ones(size));
    cartan::AddPointArray(output, "LocalDepth", depth.data(), size, 1);
    cartan::AddPointArray(output, "LocalVolume", volume.data(), size, 1);
    cartan::AddPointArray(output, "VolumeScale", scale.data(), size, 1);
  }
  if (this->GenerateShapeDistance)
  {
    const cartan::ShapeDistance distance =
      cartan::ShapeDistanceOfRotations(*problem.Mesh, *problem.Rest, result.Transforms, context);
    cartan::AddPointArray(output, "ShapeDistanceDensity", distance.Density.data(), size, 1);
    vtkNew<vtkDoubleArray> total;
    total->SetName("ShapeDistance");
    total->InsertNextValue(distance.Total);
    output->GetFieldData()->AddArray(total);
  }
}
