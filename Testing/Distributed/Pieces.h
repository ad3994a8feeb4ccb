// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandleShapes.h"
#include "TestShapes.h"

#include "Kernel/Distributed/DistributedMesh.h"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// Surfaces in pieces. Every rank knows the whole and cuts its piece out.
namespace pieces
{
inline std::shared_ptr<const cartan::Ranks> World()
{
  return std::make_shared<const cartan::Ranks>(MPI_COMM_WORLD);
}

/// The owner of each vertex of a shape, for so many ranks.
using Cut = std::function<std::vector<int>(const shapes::Shape& shape, int numberOfRanks)>;

/// Slices across the x axis.
inline std::vector<int> Slices(const shapes::Shape& shape, int numberOfRanks)
{
  const double low = shape.Positions.col(0).minCoeff();
  const double extent = shape.Positions.col(0).maxCoeff() - low;
  std::vector<int> owners;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    const double part = (shape.Positions(v, 0) - low) / extent;
    owners.push_back(std::min(static_cast<int>(part * numberOfRanks), numberOfRanks - 1));
  }
  return owners;
}

/// Each vertex somewhere, so that no piece hangs together.
inline std::vector<int> Scattered(const shapes::Shape& shape, int numberOfRanks)
{
  std::vector<int> owners;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    // Knuth's multiplicative hash.
    owners.push_back(static_cast<int>((static_cast<unsigned int>(v) * 2654435761U >> 16) %
      static_cast<unsigned int>(numberOfRanks)));
  }
  return owners;
}

/// The second rank has all, the last nothing, others one triangle.
inline std::vector<int> Lopsided(const shapes::Shape& shape, int numberOfRanks)
{
  const int most = numberOfRanks > 1 ? 1 : 0;
  std::vector<int> owners(static_cast<std::size_t>(shape.NumberOfVertices()), most);
  for (int rank = 0; rank + 1 < numberOfRanks; ++rank)
  {
    // Far from each other.
    const Eigen::Index t = rank * shape.Faces.rows() / numberOfRanks;
    for (int c = 0; c < 3; ++c)
    {
      owners[shape.Faces(t, c)] = rank;
    }
  }
  return owners;
}

inline std::map<std::string, Cut> AllCuts()
{
  return { { "slices", Slices }, { "scattered", Scattered }, { "lopsided", Lopsided } };
}

/// What a rank knows of the whole: the rank's piece, and the vertex of each of its points.
struct Piece
{
  cartan::SurfacePiece Surface;
  std::vector<int> Vertices;
};

/// The points of a piece come in the reverse order; a global id is the vertex times 3, plus 1.
inline Piece CutOut(const shapes::Shape& shape, const std::vector<int>& owners,
  const std::shared_ptr<const cartan::Ranks>& group)
{
  const int rank = group->GetRank();
  std::vector<char> isNeeded(owners.size(), 0);
  std::vector<Eigen::Vector3i> faces;
  for (std::size_t v = 0; v < owners.size(); ++v)
  {
    isNeeded[v] = owners[v] == rank;
  }
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    const Eigen::Vector3i face = shape.Faces.row(t);
    if (owners[face[0]] == rank || owners[face[1]] == rank || owners[face[2]] == rank)
    {
      faces.push_back(face);
    }
  }
  for (const Eigen::Vector3i& face : faces)
  {
    isNeeded[face[0]] = isNeeded[face[1]] = isNeeded[face[2]] = 1;
  }
  Piece piece;
  piece.Surface.Group = group;
  std::vector<int> local(owners.size(), -1);
  for (int v = static_cast<int>(owners.size()) - 1; v >= 0; --v)
  {
    if (isNeeded[v])
    {
      local[v] = static_cast<int>(piece.Vertices.size());
      piece.Vertices.push_back(v);
      piece.Surface.GlobalIds.push_back(3 * static_cast<std::int64_t>(v) + 1);
      piece.Surface.Owners.push_back(owners[v]);
    }
  }
  piece.Surface.Positions.resize(static_cast<Eigen::Index>(piece.Vertices.size()), 3);
  for (std::size_t i = 0; i < piece.Vertices.size(); ++i)
  {
    piece.Surface.Positions.row(static_cast<Eigen::Index>(i)) =
      shape.Positions.row(piece.Vertices[i]);
  }
  piece.Surface.Corners.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t t = 0; t < faces.size(); ++t)
  {
    piece.Surface.Corners.row(static_cast<Eigen::Index>(t)) << local[faces[t][0]],
      local[faces[t][1]], local[faces[t][2]];
  }
  return piece;
}

/// A problem of the whole, whose rest is centered as pieces are.
inline cartan::HandleProblem WholeProblem(
  const shapes::Shape& shape, const shapes::HandleOf& handleOf, const std::vector<int>& moving)
{
  cartan::HandleProblem problem = shapes::ProblemOf(shape, handleOf, moving);
  const Eigen::RowVector3d origin =
    0.5 * (shape.Positions.colwise().minCoeff() + shape.Positions.colwise().maxCoeff());
  problem.Rest = std::make_shared<const cartan::Points>(shape.Positions.rowwise() - origin);
  return problem;
}

/// The part of a whole problem that a piece has.
inline cartan::HandleProblem PartOf(const cartan::HandleProblem& whole, const Piece& piece,
  const std::shared_ptr<const cartan::DistributedMesh>& mesh)
{
  cartan::HandleProblem part = whole;
  part.Mesh = mesh->GetMesh();
  part.Rest = mesh->GetPositions();
  part.Pieces = mesh;
  part.Handle.clear();
  part.SoftWeights.resize(whole.SoftWeights.size() ? mesh->NumberOfVertices() : 0);
  for (int v = 0; v < mesh->NumberOfVertices(); ++v)
  {
    const int vertex = piece.Vertices[static_cast<std::size_t>(mesh->Point(v))];
    part.Handle.push_back(whole.Handle[vertex]);
    if (part.SoftWeights.size())
    {
      part.SoftWeights[v] = whole.SoftWeights[vertex];
    }
  }
  return part;
}
}
