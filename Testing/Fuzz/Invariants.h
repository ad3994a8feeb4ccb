// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Compare.h"

#include <optional>

namespace fuzz
{
/// A law that was broken.
struct Finding
{
  std::string Invariant;
  std::string Text;             ///< what differs; its part before a colon is the kind
  std::optional<Case> Original; ///< with Changed: the case that was compared with
  Case Changed;                 ///< the case that shows it
  Motion Map;                   ///< that should map the original's result on the changed one's
};

/// Something that must hold between the results of related cases.
struct Invariant
{
  std::string Name;
  std::function<bool(const Case&)> Applies;
  /// Nothing if it holds, or if a warning or an error says that it may not.
  std::function<std::optional<Finding>(const Case&, const Outcome&, Random&)> Check;
};

const std::vector<Invariant>& Invariants();

/// Compares the results of a case and of a changed one. Where rounding of the input
/// alone would do as much, the digits of the input do not determine the result: of a
/// measure this is no finding, of others it is one of stability.
std::optional<Finding> CheckChanged(const std::string& name, const Case& original,
  const Outcome& first, const Case& changed, Relation relation);
}
