// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleProblem.h"

namespace cartan
{
/// Finds which vertices are held together (HandleProblem::JoinedWith): those in the same
/// place that have equal `ids` (#V or none; negative or NaN: alone), but for those in no
/// triangle, and those with a neighbor among them. The first stands for them, of those
/// in handles if there are such. All of them are in its handle then, with the largest
/// of their soft weights. Throws Error(BadInput) where they are in several handles.
void HoldTogether(const Eigen::VectorXd& ids, HandleProblem& problem);

/// Adds to the share of each vertex those of the vertices that it stands for: #V.
void AddShares(const std::vector<int>& joinedWith, Eigen::VectorXd& shares);

/// The other way round: each of the vertices that are one gets an equal part of the value
/// of the one that stands for them: #V.
void ShareEvenly(const std::vector<int>& joinedWith, Eigen::VectorXd& values);

/// The problem on a mesh with one vertex for all that are held together: with P, which
/// gives all of them its values, and any matrix A that is a sum over edges or
/// triangles, a method that does not know of joined vertices solves with P^T A P. The
/// same problem where all are alone. To be called after WithoutSlivers, which needs a
/// manifold.
HandleProblem WithJoinedVertices(HandleProblem problem);

/// Gives each vertex the values, a row per vertex, of the one that stands for it.
/// Nothing where there are no values.
template <typename Values>
void FollowJoined(const std::vector<int>& joinedWith, Values& values)
{
  for (std::size_t v = 0; v < joinedWith.size() && values.rows() > 0; ++v)
  {
    if (joinedWith[v] != static_cast<int>(v))
    {
      values.row(static_cast<Eigen::Index>(v)) = values.row(joinedWith[v]).eval();
    }
  }
}

/// Gives all vertices that are one the mean of their values, a row per vertex. What is equal
/// stays to the last bit. Nothing where no vertices are joined, or there are no values.
template <typename Values>
void MeetHalfway(const std::vector<int>& joinedWith, Values& values)
{
  Eigen::VectorXd copies = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(joinedWith.size()));
  AddShares(joinedWith, copies);
  Values sums = values;
  sums.setZero();
  for (std::size_t v = 0; v < joinedWith.size() && values.rows() > 0; ++v)
  {
    sums.row(joinedWith[v]) += values.row(static_cast<Eigen::Index>(v)) - values.row(joinedWith[v]);
  }
  for (Eigen::Index v = 0; v < copies.size() && values.rows() > 0; ++v)
  {
    values.row(v) += sums.row(v) / copies[v];
  }
  FollowJoined(joinedWith, values);
}
}
