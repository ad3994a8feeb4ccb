// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/TriangleMessages.h"

#include <algorithm>
#include <cstring>

namespace cartan
{
namespace
{
/// Numbers of a corner in a message.
constexpr std::size_t CornerSize = 5;
}

std::int64_t BitsOf(double value)
{
  value = value == 0.0 ? 0.0 : value; // zero has two kinds
  std::int64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

double ValueOf(std::int64_t bits)
{
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

void AppendTriangle(
  const SurfacePiece& piece, Eigen::Index triangle, std::vector<std::int64_t>& message)
{
  for (int c = 0; c < 3; ++c)
  {
    const int v = piece.Corners(triangle, c);
    const auto place = piece.Positions.row(v);
    message.insert(message.end(),
      { piece.GlobalIds[v], piece.Owners[v], BitsOf(place[0]), BitsOf(place[1]),
        BitsOf(place[2]) });
  }
}

TriangleReceiver::TriangleReceiver(
  SurfacePiece& piece, const std::vector<int>& points, bool onlyNew)
  : Piece(piece)
  , OnlyNew(onlyNew)
{
  for (const int point : points)
  {
    this->PointOfId[piece.GlobalIds[point]] = point;
  }
  for (Eigen::Index t = 0; onlyNew && t < piece.Corners.rows(); ++t)
  {
    const Key corners{ piece.Corners(t, 0), piece.Corners(t, 1), piece.Corners(t, 2) };
    if (std::any_of(corners.begin(), corners.end(),
          [&piece](int v) { return piece.Owners[v] != piece.Group->GetRank(); }))
    {
      this->Known.insert(KeyOf(corners));
    }
  }
}

TriangleReceiver::Key TriangleReceiver::KeyOf(Key corners)
{
  std::sort(corners.begin(), corners.end());
  return corners;
}

void TriangleReceiver::Add(const std::vector<std::vector<std::int64_t>>& messages)
{
  SurfacePiece& piece = this->Piece;
  std::vector<int> corners(piece.Corners.data(), piece.Corners.data() + piece.Corners.size());
  std::vector<double> places(
    piece.Positions.data(), piece.Positions.data() + piece.Positions.size());
  for (const std::vector<std::int64_t>& list : messages)
  {
    for (std::size_t at = 0; at < list.size(); at += 3 * CornerSize)
    {
      Key triangle{};
      for (std::size_t c = 0; c < 3; ++c)
      {
        const std::int64_t* corner = list.data() + at + c * CornerSize;
        const auto [known, isNew] =
          this->PointOfId.emplace(corner[0], static_cast<int>(piece.GlobalIds.size()));
        triangle[c] = known->second;
        if (isNew)
        {
          piece.GlobalIds.push_back(corner[0]);
          piece.Owners.push_back(static_cast<int>(corner[1]));
          places.insert(
            places.end(), { ValueOf(corner[2]), ValueOf(corner[3]), ValueOf(corner[4]) });
        }
      }
      if (!this->OnlyNew || this->Known.insert(KeyOf(triangle)).second)
      {
        corners.insert(corners.end(), triangle.begin(), triangle.end());
      }
    }
  }
  piece.Corners =
    Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
  piece.Positions =
    Eigen::Map<const Points>(places.data(), static_cast<Eigen::Index>(places.size() / 3), 3);
}
}
