// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Halo.h"

#include "Base/Bytes.h"

#include <algorithm>
#include <utility>

namespace cartan
{
namespace
{
/// The points that this rank owns, by their global ids in increasing order.
std::vector<std::pair<std::int64_t, int>> OwnedById(const SurfacePiece& piece)
{
  std::vector<std::pair<std::int64_t, int>> owned;
  for (std::size_t i = 0; i < piece.Owners.size(); ++i)
  {
    if (piece.Owners[i] == piece.Group->GetRank())
    {
      owned.emplace_back(piece.GlobalIds[i], static_cast<int>(i));
    }
  }
  std::sort(owned.begin(), owned.end());
  return owned;
}
}

Halo::Halo(const SurfacePiece& piece, std::vector<int> copyOf)
  : Group(piece.Group)
  , NumberOfPoints(static_cast<int>(piece.Positions.rows()))
  , CopyOf(std::move(copyOf))
  , Owned(static_cast<std::size_t>(this->NumberOfRows()), 0)
{
  const auto size = static_cast<std::size_t>(this->Group->GetSize());
  std::vector<std::vector<std::int64_t>> wanted(size);
  std::vector<std::vector<int>> rows(size);
  for (std::size_t i = 0; i < piece.Owners.size(); ++i)
  {
    const auto owner = static_cast<std::size_t>(piece.Owners[i]);
    this->Owned[i] = piece.Owners[i] == this->Group->GetRank();
    if (!this->Owned[i])
    {
      wanted[owner].push_back(piece.GlobalIds[i]);
      rows[owner].push_back(static_cast<int>(i));
    }
  }
  const std::vector<std::vector<std::int64_t>> asked = this->Group->Exchange(wanted);
  const std::vector<std::pair<std::int64_t, int>> owned = OwnedById(piece);
  IdSample missing;
  for (std::size_t rank = 0; rank < size; ++rank)
  {
    Link link{ static_cast<int>(rank), {} };
    for (const std::int64_t id : asked[rank])
    {
      const auto found = std::lower_bound(owned.begin(), owned.end(), std::make_pair(id, 0));
      if (found == owned.end() || found->first != id)
      {
        missing.Add(id);
        continue;
      }
      link.Rows.push_back(found->second);
    }
    if (!link.Rows.empty())
    {
      this->Given.push_back(std::move(link));
    }
    if (!rows[rank].empty())
    {
      this->Taken.push_back({ static_cast<int>(rank), std::move(rows[rank]) });
    }
  }
  this->Group->Together(
    [&missing]
    {
      if (!missing.IsEmpty())
      {
        throw Error(ErrorCode::BadInput,
          "The pieces of the surface contradict each other: " +
            missing.Describe("ghost point", "ghost points") +
            " of which the owner has no such point. Remove the surface's global ids and ghost "
            "cells; they are made where they are missing.");
      }
    });
}

void Halo::Update(Eigen::Ref<Field> values) const
{
  this->Group->Agree();
  const Eigen::Index columns = values.cols();
  std::vector<Field> taken;
  std::vector<Field> given;
  std::vector<MPI_Request> requests(this->Taken.size() + this->Given.size());
  std::size_t next = 0;
  for (const Link& link : this->Taken)
  {
    taken.emplace_back(static_cast<Eigen::Index>(link.Rows.size()), columns);
    MPI_Irecv(taken.back().data(), static_cast<int>(taken.back().size()), MPI_DOUBLE, link.Rank, 0,
      this->Group->GetCommunicator(), &requests[next++]);
  }
  for (const Link& link : this->Given)
  {
    given.emplace_back(static_cast<Eigen::Index>(link.Rows.size()), columns);
    for (std::size_t i = 0; i < link.Rows.size(); ++i)
    {
      given.back().row(static_cast<Eigen::Index>(i)) = values.row(link.Rows[i]);
    }
    MPI_Isend(given.back().data(), static_cast<int>(given.back().size()), MPI_DOUBLE, link.Rank, 0,
      this->Group->GetCommunicator(), &requests[next++]);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  this->Group->CountMessages(static_cast<std::int64_t>(requests.size()));
  for (std::size_t l = 0; l < this->Taken.size(); ++l)
  {
    const std::vector<int>& rows = this->Taken[l].Rows;
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      values.row(rows[i]) = taken[l].row(static_cast<Eigen::Index>(i));
    }
  }
  for (std::size_t i = 0; i < this->CopyOf.size(); ++i)
  {
    values.row(this->NumberOfPoints + static_cast<Eigen::Index>(i)) = values.row(this->CopyOf[i]);
  }
}

std::size_t Halo::GetBytes() const
{
  std::size_t bytes = TotalBytes(this->CopyOf, this->Owned);
  for (const std::vector<Link>* links : { &this->Given, &this->Taken })
  {
    for (const Link& link : *links)
    {
      bytes += BytesOf(link.Rows);
    }
  }
  return bytes;
}
}
