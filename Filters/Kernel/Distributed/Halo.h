// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/SurfacePiece.h"

#include <memory>
#include <vector>

namespace cartan
{
/// Who has copies of which rows of a table: found once, used for all tables with a row per
/// point of the piece and per copy of it.
class Halo
{
public:
  /// Collective. `copyOf` names the row that each one beyond the piece's points repeats.
  /// Throws Error(BadInput) where a ghost's owner does not have the point.
  Halo(const SurfacePiece& piece, std::vector<int> copyOf);

  const Ranks& GetRanks() const { return *this->Group; }
  int NumberOfRows() const { return this->NumberOfPoints + static_cast<int>(this->CopyOf.size()); }
  bool IsOwned(int row) const { return this->Owned[static_cast<std::size_t>(row)] != 0; }

  /// Gives the rows of ghosts the values that their owners have; collective, a message to
  /// and from each rank that owns one or has one.
  void Update(Eigen::Ref<Field> values) const;

  std::size_t GetBytes() const;

private:
  /// The rows that go to, or come from, another rank, in the same order there.
  struct Link
  {
    int Rank;
    std::vector<int> Rows;
  };

  std::shared_ptr<const Ranks> Group;
  int NumberOfPoints;
  std::vector<int> CopyOf;
  std::vector<char> Owned; ///< #rows
  std::vector<Link> Given;
  std::vector<Link> Taken;
};
}
