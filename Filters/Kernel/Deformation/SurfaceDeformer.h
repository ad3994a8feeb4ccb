// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Deformation/CommonMotion.h"
#include "Deformation/HandleProblem.h"
#include "Deformation/PositionRows.h"

#include <cstddef>
#include <memory>
#include <string>

namespace cartan
{
/// A deformation method with everything that survives from one motion to the
/// next.
///
/// On one of several pieces (HandleProblem::Pieces) all ranks make the deformer, and move it,
/// together, and get the same surface as one process would. Only motions that are sums of
/// fields send no message: with rotation-invariant editing those without projection after
/// the first, and what is read from a table. RotationInvariantDeformer, PoissonDeformer with
/// harmonic propagation and ShapePreservingDeformer serve pieces, without volume corrections
/// other than the neutral offset, and with motions of handles rather than targets of points.
class SurfaceDeformer
{
public:
  virtual ~SurfaceDeformer() = default;

  /// Writes the deformed surface into `result`, whose memory is reused. The
  /// method sees the targets without what all handles do together (see
  /// CommonMotion): rigid motions of all handles are exact, and the same edit
  /// seen from another frame gives the same surface seen from there.
  void Deform(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context);

  /// The same without transforms, in one pass over memory where the motion is a sum over kept
  /// fields: the rows of the deformed surface, to the last bit those of Deform(), and `result`
  /// stays as it was. They hold until the next motion. Else there are none, and `result` is
  /// written.
  PositionRows DeformInRows(
    const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context);

  /// Whether the next motion by these targets sends no message to other ranks, where there are
  /// Pieces: the same on all of them.
  bool IsLocal(const HandleTargets& targets);

  /// What the deformer was made for. HandleTargets::Motions has one per Moving
  /// handle of this one.
  const HandleProblem& GetProblem() const { return this->Problem; }

  virtual int GetNumberOfFactorizations() const = 0;

  /// What is odd about the last result, in sentences; empty if nothing is.
  virtual std::string GetWarning() const { return {}; }

  /// The vertices that are solved for.
  virtual int GetNumberOfFreeVertices() const = 0;

  /// The memory that is kept from motion to motion: factors, fields and the
  /// problem, without its mesh and rest positions, which others share.
  virtual std::size_t GetBytes() const = 0;

protected:
  explicit SurfaceDeformer(HandleProblem problem)
    : Problem(std::move(problem))
  {
  }

  /// The rows for a motion that is a sum over kept fields, for methods that have such. Called
  /// before DeformRelative() of each motion, for the same targets.
  virtual PositionRows RowsRelative(const HandleTargets&, const ExecutionContext&) { return {}; }

  /// The method itself, as Deform() has it; the targets are relative to the
  /// common motion, and their rotation vectors as CommonMotion chooses them.
  virtual void DeformRelative(const HandleTargets& targets, bool wantTransforms,
    DeformedSurface& result, const ExecutionContext& context) = 0;

  /// Whether regions whose handles all make one rigid motion make just that
  /// motion; not where something else moves them too.
  virtual bool FollowsRigidHandles() const { return true; }

  /// Whether the method works on a piece; else Deform() throws Error(BadInput) there.
  virtual bool ServesPieces() const { return false; }

  /// IsLocal() for the targets of DeformRelative().
  virtual bool IsLocalRelative(const HandleTargets&) { return false; }

  /// What the targets of DeformRelative are relative to: for results beside the surface.
  const RigidMotion& GetCommonMotion() const { return this->Common->GetMotion(); }

  /// The memory of what is kept here.
  std::size_t GetBaseBytes() const
  {
    return this->Problem.GetBytes() + (this->Common ? this->Common->GetBytes() : 0);
  }

  HandleProblem Problem;

private:
  void RequireWholeUnlessServed(const HandleTargets& targets) const;
  HandleTargets Relative(const HandleTargets& targets);
  void DeformFrom(const HandleTargets& targets, const HandleTargets& relative, bool wantTransforms,
    DeformedSurface& result, const ExecutionContext& context);

  std::unique_ptr<CommonMotion> Common; ///< from the first motion on
};
}
