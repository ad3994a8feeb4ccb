// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/LoosePiece.h"

#include "Distributed/Halo.h"
#include "Distributed/TriangleMessages.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace cartan
{
namespace
{
/// A point as the rank hears of it that finds out who has it.
struct Claim
{
  /// A global id, or 0 and the bits of a place.
  std::array<std::int64_t, 4> Key;
  std::array<std::int64_t, 3> Place; ///< bits
  int Rank;
  std::int64_t Point;
  bool IsUsed;
};

/// Numbers of a claim in a message.
constexpr std::size_t ClaimSize = 6;

/// Which rank finds out about a key.
std::size_t MeetingPlace(const std::array<std::int64_t, 4>& key, std::size_t size)
{
  std::uint64_t hash = 0;
  for (const std::int64_t word : key)
  {
    // The constant and the shifts are those of Steele et al., Fast Splittable Pseudorandom
    // Number Generators, 2014.
    hash = (hash ^ static_cast<std::uint64_t>(word)) + 0x9E3779B97F4A7C15ULL;
    hash = (hash ^ (hash >> 30)) * 0xBF58476D1CE4E5B9ULL;
    hash = (hash ^ (hash >> 27)) * 0x94D049BB133111EBULL;
    hash ^= hash >> 31;
  }
  return static_cast<std::size_t>(hash % size);
}

/// A point of this rank that others have too.
struct SharedPoint
{
  int Owner;
  std::int64_t PointOfOwner;
  std::vector<int> Ranks; ///< in increasing order, this one among them
};

/// How the ranks find out which points are one.
class PointMatch
{
public:
  explicit PointMatch(const LoosePiece& loose)
    : Loose(loose)
    , Group(*loose.Group)
  {
    const bool hasIds = loose.Positions.rows() == 0 || !loose.GlobalIds.empty();
    this->ById = !this->Group.Any(!hasIds) && this->Group.Any(loose.Positions.rows() > 0);
  }

  bool IsById() const { return this->ById; }
  const std::string& GetObstacle() const { return this->Obstacle; }

  /// By point of this rank.
  std::unordered_map<int, SharedPoint> Find()
  {
    this->FindTolerance();
    const std::vector<std::vector<std::int64_t>> answers =
      this->Group.Exchange(this->Answer(this->Group.Exchange(this->Claims())));
    this->Refuse();
    std::unordered_map<int, SharedPoint> shared;
    for (const std::vector<std::int64_t>& answer : answers)
    {
      for (std::size_t at = 0; at < answer.size();)
      {
        SharedPoint point{ static_cast<int>(answer[at + 1]), answer[at + 2], {} };
        const auto count = static_cast<std::size_t>(answer[at + 3]);
        for (std::size_t i = 0; i < count; ++i)
        {
          point.Ranks.push_back(static_cast<int>(answer[at + 4 + i]));
        }
        shared.emplace(static_cast<int>(answer[at]), std::move(point));
        at += 4 + count;
      }
    }
    return shared;
  }

private:
  void FindTolerance()
  {
    Eigen::VectorXd extremes =
      Eigen::VectorXd::Constant(6, -std::numeric_limits<double>::infinity());
    for (Eigen::Index v = 0; v < this->Loose.Positions.rows(); ++v)
    {
      if (this->Loose.Positions.row(v).allFinite())
      {
        const Eigen::Vector3d point = this->Loose.Positions.row(v);
        extremes.head<3>() = extremes.head<3>().cwiseMax(point);
        extremes.tail<3>() = extremes.tail<3>().cwiseMax(-point);
      }
    }
    this->Group.Max(extremes);
    this->Tolerance = 1e-5 * (extremes.head<3>() + extremes.tail<3>()).norm();
  }

  std::vector<std::vector<std::int64_t>> Claims() const
  {
    const auto size = static_cast<std::size_t>(this->Group.GetSize());
    std::vector<std::vector<std::int64_t>> claims(size);
    std::vector<char> isUsed(static_cast<std::size_t>(this->Loose.Positions.rows()), 0);
    for (Eigen::Index i = 0; i < this->Loose.Corners.size(); ++i)
    {
      isUsed[this->Loose.Corners.data()[i]] = 1;
    }
    for (std::size_t v = 0; v < isUsed.size(); ++v)
    {
      const auto point = this->Loose.Positions.row(static_cast<Eigen::Index>(v));
      const std::int64_t id = this->ById ? this->Loose.GlobalIds[v] : 0;
      const std::int64_t x = BitsOf(point[0]);
      const std::int64_t y = BitsOf(point[1]);
      const std::int64_t z = BitsOf(point[2]);
      std::vector<std::int64_t>& to = claims[MeetingPlace(this->KeyOf({ id, x, y, z }), size)];
      to.insert(to.end(), { id, x, y, z, static_cast<std::int64_t>(v), isUsed[v] });
    }
    return claims;
  }

  std::array<std::int64_t, 4> KeyOf(const std::array<std::int64_t, 4>& idAndPlace) const
  {
    return this->ById ? std::array<std::int64_t, 4>{ idAndPlace[0], 0, 0, 0 } : idAndPlace;
  }

  /// For each point that several ranks have: the point, its owner, the owner's point, and how
  /// many ranks have it, and which.
  std::vector<std::vector<std::int64_t>> Answer(
    const std::vector<std::vector<std::int64_t>>& messages)
  {
    std::vector<Claim> claims;
    for (std::size_t rank = 0; rank < messages.size(); ++rank)
    {
      const std::vector<std::int64_t>& m = messages[rank];
      for (std::size_t at = 0; at < m.size(); at += ClaimSize)
      {
        claims.push_back({ this->KeyOf({ m[at], m[at + 1], m[at + 2], m[at + 3] }),
          { m[at + 1], m[at + 2], m[at + 3] }, static_cast<int>(rank), m[at + 4], m[at + 5] != 0 });
      }
    }
    std::sort(claims.begin(), claims.end(),
      [](const Claim& a, const Claim& b)
      { return std::tie(a.Key, a.Rank, a.Point) < std::tie(b.Key, b.Rank, b.Point); });
    std::vector<std::vector<std::int64_t>> answers(messages.size());
    for (std::size_t begin = 0, end = 0; begin < claims.size(); begin = end)
    {
      while (end < claims.size() && claims[end].Key == claims[begin].Key)
      {
        ++end;
      }
      this->AnswerGroup(claims.data() + begin, claims.data() + end, answers);
    }
    return answers;
  }

  void AnswerGroup(
    const Claim* begin, const Claim* end, std::vector<std::vector<std::int64_t>>& answers)
  {
    const bool isOnOneRank = begin->Rank == (end - 1)->Rank;
    if (end - begin == 1 || (isOnOneRank && !this->ById))
    {
      return;
    }
    const auto isRepeated = [&](const Claim& claim)
    { return &claim > begin && claim.Rank == (&claim - 1)->Rank; };
    for (const Claim* claim = begin; claim < end; ++claim)
    {
      if (isRepeated(*claim))
      {
        this->Open.push_back(claim->Key[0]);
        return;
      }
    }
    if (this->ById && !this->AreTogether(begin, end))
    {
      this->Apart.push_back(begin->Key[0]);
      return;
    }
    const Claim* owner = std::find_if(begin, end, [](const Claim& claim) { return claim.IsUsed; });
    owner = owner == end ? begin : owner;
    for (const Claim* claim = begin; claim < end; ++claim)
    {
      std::vector<std::int64_t>& answer = answers[claim->Rank];
      answer.insert(answer.end(), { claim->Point, owner->Rank, owner->Point, end - begin });
      for (const Claim* other = begin; other < end; ++other)
      {
        answer.push_back(other->Rank);
      }
    }
  }

  bool AreTogether(const Claim* begin, const Claim* end) const
  {
    return std::none_of(begin, end,
      [&](const Claim& claim)
      {
        double distance = 0.0;
        for (int c = 0; c < 3; ++c)
        {
          distance =
            std::max(distance, std::abs(ValueOf(claim.Place[c]) - ValueOf(begin->Place[c])));
        }
        return distance > this->Tolerance;
      });
  }

  void Refuse()
  {
    const IdSample apart = this->Group.Sample(this->Apart);
    this->Group.Together(
      [&apart]
      {
        if (!apart.IsEmpty())
        {
          throw Error(ErrorCode::BadInput,
            "The pieces of the surface have " +
              apart.Describe("global id in different places", "global ids in different places") +
              ": make the ids anew (Generate Global Ids).");
        }
      });
    if (this->Group.Any(!this->Open.empty()))
    {
      this->Obstacle = this->ById ? "a rank has several points with one global id"
                                  : "points of several ranks meet where one of them has several";
    }
  }

  const LoosePiece& Loose;
  const Ranks& Group;
  bool ById = false;
  double Tolerance = 0.0;
  std::vector<std::int64_t> Apart;
  std::vector<std::int64_t> Open;
  std::string Obstacle;
};

/// Sends the triangles at shared points to the ranks that have these.
void ExchangeTriangles(SurfacePiece& piece, const std::unordered_map<int, SharedPoint>& shared)
{
  std::vector<std::vector<std::int64_t>> sent(static_cast<std::size_t>(piece.Group->GetSize()));
  std::vector<int> ranks;
  for (Eigen::Index t = 0; t < piece.Corners.rows(); ++t)
  {
    ranks.clear();
    for (int c = 0; c < 3; ++c)
    {
      const auto found = shared.find(piece.Corners(t, c));
      if (found != shared.end())
      {
        ranks.insert(ranks.end(), found->second.Ranks.begin(), found->second.Ranks.end());
      }
    }
    std::sort(ranks.begin(), ranks.end());
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
    for (const int rank : ranks)
    {
      if (rank != piece.Group->GetRank())
      {
        AppendTriangle(piece, t, sent[rank]);
      }
    }
  }
  std::vector<int> points;
  points.reserve(shared.size());
  for (const auto& entry : shared)
  {
    points.push_back(entry.first);
  }
  TriangleReceiver(piece, points, false).Add(piece.Group->Exchange(sent));
}

void RequireIds(const LoosePiece& loose)
{
  IdSample bad;
  for (const std::int64_t id : loose.GlobalIds)
  {
    if (id < 0)
    {
      bad.Add(id);
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The pieces of the surface have " +
        bad.Describe("negative global id", "negative global ids") +
        ": make the ids anew (Generate Global Ids).");
  }
}

/// Points in no triangle mean nothing, whatever is written there.
void ClearUnused(SurfacePiece& piece)
{
  std::vector<char> isUsed(piece.GlobalIds.size(), 0);
  for (Eigen::Index i = 0; i < piece.Corners.size(); ++i)
  {
    isUsed[piece.Corners.data()[i]] = 1;
  }
  for (std::size_t v = 0; v < isUsed.size(); ++v)
  {
    if (!isUsed[v])
    {
      piece.Positions.row(static_cast<Eigen::Index>(v)).setZero();
    }
  }
}
}

FittedPiece FitPiece(const LoosePiece& loose)
{
  const Ranks& group = *loose.Group;
  group.Together([&loose] { RequireIds(loose); });
  PointMatch match(loose);
  const std::unordered_map<int, SharedPoint> shared = match.Find();
  FittedPiece fitted;
  fitted.HasGivenIds = match.IsById();
  fitted.Obstacle = match.GetObstacle();
  const auto count = static_cast<std::int64_t>(loose.Positions.rows());
  std::vector<std::int64_t> first = group.Gather({ count }); // the id of each rank's first point
  std::int64_t next = 0;
  for (std::int64_t& id : first)
  {
    id = std::exchange(next, next + id);
  }
  SurfacePiece& piece = fitted.Piece;
  piece.Group = loose.Group;
  piece.Positions = loose.Positions;
  piece.Corners = loose.Corners;
  for (std::int64_t v = 0; v < count; ++v)
  {
    const auto found = shared.find(static_cast<int>(v));
    const bool isShared = found != shared.end();
    const int owner = isShared ? found->second.Owner : group.GetRank();
    piece.Owners.push_back(owner);
    piece.GlobalIds.push_back(fitted.HasGivenIds
        ? loose.GlobalIds[static_cast<std::size_t>(v)]
        : first[owner] + (isShared ? found->second.PointOfOwner : v));
  }
  if (!fitted.Obstacle.empty())
  {
    return fitted;
  }
  ExchangeTriangles(piece, shared);
  if (fitted.HasGivenIds)
  {
    Halo(piece, {}).Update(piece.Positions);
  }
  ClearUnused(piece);
  return fitted;
}
}
