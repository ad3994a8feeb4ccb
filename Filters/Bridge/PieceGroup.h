// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Base/Error.h"

#include <functional>
#include <memory>

class vtkMultiProcessController;

/// Surfaces that stay where they are. Private to the filters, not installed.
namespace cartan
{
class Ranks;

/// The ranks that have a surface in pieces, as the kernel reaches them (cartan::Ranks). All
/// functions but the first few are collective.
class PieceGroup
{
public:
  /// Nothing where Cartan has no hypre, or VTK's controller no MPI. The first call for a
  /// controller is collective.
  static std::shared_ptr<const PieceGroup> Of(vtkMultiProcessController* controller);

  /// Whether Together() has thrown this error on all ranks.
  static bool IsShared(const Error& error);

  int GetRank() const;
  const std::shared_ptr<const Ranks>& GetRanks() const { return this->Members; }

  /// Calls work(), which may be collective. When it throws on some ranks, all throw one error.
  void Together(const std::function<void()>& work) const;

  /// The same, where ids in errors of work() are those of this rank's piece: the error says of
  /// which rank.
  void TogetherByRank(const std::function<void()>& work) const;

  bool Any(bool value) const;

private:
  explicit PieceGroup(std::shared_ptr<const Ranks> members)
    : Members(std::move(members))
  {
  }

  std::shared_ptr<const Ranks> Members;
};
}
