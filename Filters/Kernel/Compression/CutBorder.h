// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace cartan
{
/// The boundary of the triangles so far: directed edges in loops. What is on their left is
/// not known while they are open, nothing at the border of the surface, and a triangle when
/// they are closed, which are in no loop.
struct CutBorder
{
  enum class State : char
  {
    Open,
    Border,
    Closed
  };
  struct Edge
  {
    int From;
    int Before = -1;
    int After = -1;
    State Is = State::Open;
  };

  int Add(int from)
  {
    this->Edges.push_back({ from });
    return static_cast<int>(this->Edges.size()) - 1;
  }

  void Link(int edge, int after)
  {
    this->Edges[edge].After = after;
    this->Edges[after].Before = edge;
  }

  /// Closes a loop of two edges: they are the two directions of one.
  void Zip(int edge)
  {
    const int after = this->Edges[edge].After;
    if (this->Edges[after].After == edge)
    {
      this->Edges[edge].Is = State::Closed;
      this->Edges[after].Is = State::Closed;
    }
  }

  bool IsOpen(int edge) const { return this->Edges[edge].Is == State::Open; }
  int From(int edge) const { return this->Edges[edge].From; }
  int To(int edge) const { return this->From(this->After(edge)); }
  int Before(int edge) const { return this->Edges[edge].Before; }
  int After(int edge) const { return this->Edges[edge].After; }
  int Size() const { return static_cast<int>(this->Edges.size()); }

  std::vector<Edge> Edges;
};
}
