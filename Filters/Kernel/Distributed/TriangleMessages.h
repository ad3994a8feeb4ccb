// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/SurfacePiece.h"

#include <array>
#include <set>
#include <unordered_map>

namespace cartan
{
/// The bits of a number as a message has them, alike for both kinds of zero, and back.
std::int64_t BitsOf(double value);
double ValueOf(std::int64_t bits);

/// Adds a triangle of the piece to a message: of each corner the point's global id, owner and
/// place.
void AppendTriangle(
  const SurfacePiece& piece, Eigen::Index triangle, std::vector<std::int64_t>& message);

/// Adds triangles of messages, and their points, to a piece.
class TriangleReceiver
{
public:
  /// Points are found among those at `points` of the piece, or made. With `onlyNew`, triangles
  /// at ghosts that the piece has are not added again.
  TriangleReceiver(SurfacePiece& piece, const std::vector<int>& points, bool onlyNew);

  void Add(const std::vector<std::vector<std::int64_t>>& messages);

private:
  using Key = std::array<int, 3>;
  static Key KeyOf(Key corners);

  SurfacePiece& Piece;
  bool OnlyNew;
  std::unordered_map<std::int64_t, int> PointOfId;
  std::set<Key> Known;
};
}
