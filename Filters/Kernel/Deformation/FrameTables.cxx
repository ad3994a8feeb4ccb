// SPDX-License-Identifier: BSD-3-Clause
// What frame-based deformations do to read turns from a table.
#include "Deformation/FrameDeformer.h"

#include <cmath>

namespace cartan
{
namespace
{
bool AreEqualRatios(const Eigen::VectorXd& a, const Eigen::VectorXd& b)
{
  return a.size() == b.size() && (a - b).cwiseAbs().maxCoeff() <= 1e-9;
}
}

std::optional<FrameDeformer::Turn> FrameDeformer::FindTurn(const HandleTargets& targets)
{
  // Frame scaling and the closing of volumes are not linear in the frames.
  const bool isLinear = !this->PreservesVolume() ||
    (this->Correction == VolumeCorrection::NeutralOffset && !this->Close);
  Turn turn;
  Eigen::VectorXd angles;
  if (!(this->TableOptions.Range > 0.0) || !isLinear || targets.Motions.empty() ||
    !this->FindTurns(targets, turn.Axis, angles))
  {
    return {};
  }
  Eigen::Index most = 0;
  const double largest = angles.cwiseAbs().maxCoeff(&most);
  if (largest > this->TableOptions.Range || (largest == 0.0 && angles.size() > 1))
  {
    return {};
  }
  turn.Angle = angles[most];
  turn.Ratios = largest > 0.0 ? Eigen::VectorXd(angles / turn.Angle) : Eigen::VectorXd::Ones(1);
  return turn;
}

PositionRows FrameDeformer::TableSums(const HandleTargets& targets, const ExecutionContext& context)
{
  const std::optional<Turn> turn = this->FindTurn(targets);
  // A table that could not be made has the range 0.
  const double range =
    turn && this->HasTable(turn->Ratios, context) ? this->Table->GetRange() : 0.0;
  if (range == 0.0 || std::abs(turn->Angle) > range)
  {
    return {};
  }
  std::vector<Eigen::Vector3d> translations;
  for (const HandleMotion& motion : targets.Motions)
  {
    translations.push_back(motion.Translation);
  }
  return this->Table->Evaluate(turn->Angle, turn->Axis, translations);
}

bool FrameDeformer::IsTableCurrent() const
{
  return this->Table && this->MadeWith.Range == this->TableOptions.Range &&
    this->MadeWith.Tolerance == this->TableOptions.Tolerance &&
    this->MadeWithOffsets == this->NeutralOffsets();
}

bool FrameDeformer::IsLocalRelative(const HandleTargets& targets)
{
  if (const std::optional<Turn> turn = this->FindTurn(targets))
  {
    return this->IsTableCurrent() && AreEqualRatios(turn->Ratios, this->MadeForRatios) &&
      std::abs(turn->Angle) <= this->Table->GetRange();
  }
  return !this->PreservesVolume() && this->HasDirectSums(targets);
}

/// Whether there is a table for these ratios, which may be made here.
bool FrameDeformer::HasTable(const Eigen::VectorXd& ratios, const ExecutionContext& context)
{
  const bool isRepeated = AreEqualRatios(ratios, this->LastRatios);
  this->LastRatios = ratios;
  const bool isCurrent = this->IsTableCurrent();
  if (isCurrent && AreEqualRatios(ratios, this->MadeForRatios))
  {
    return true;
  }
  // Handles that are dragged one after the other have another ratio at each motion.
  if (isCurrent && !isRepeated)
  {
    return false;
  }
  const Points* offsets = this->NeutralOffsets();
  this->Table.reset();
  this->Table = std::make_unique<TurnTable>(this->PositionSystem, this->Problem.Rest, offsets,
    this->TurnsWith(ratios), this->TableOptions, context);
  this->MadeWith = this->TableOptions;
  this->MadeWithOffsets = offsets;
  this->MadeForRatios = ratios;
  return true;
}

TurnsOfAngle FrameDeformer::TurnsWith(const Eigen::VectorXd& ratios) const
{
  const auto ofHandle = [ratios](int handle, double angle)
  {
    const double turn = ratios[handle] * angle;
    return TurnParts{ std::sin(turn), 1.0 - std::cos(turn) };
  };
  if (this->PositionSystem == this->FrameSystem)
  {
    return { [this, ratios](int local, double angle) { return this->TurnOf(local, ratios, angle); },
      ofHandle };
  }
  std::vector<int> frameLocal(this->Problem.Handle.size(), -1);
  for (int i = 0; i < this->FrameSystem->NumberOfLocals(); ++i)
  {
    frameLocal[this->FrameSystem->Vertex(i)] = i;
  }
  return { [this, ratios, ofHandle, frameLocal = std::move(frameLocal)](int local, double angle)
    {
      const int frame = frameLocal[this->PositionSystem->Vertex(local)];
      const int handle = this->PositionSystem->MovingHandle(local);
      return frame >= 0 ? this->TurnOf(frame, ratios, angle)
        : handle >= 0   ? ofHandle(handle, angle)
                        : TurnParts{};
    },
    ofHandle };
}
}
