// SPDX-License-Identifier: BSD-3-Clause
#include "Compression/ConnectivityCoder.h"

#include "Base/Error.h"
#include "Compression/CutBorder.h"
#include "Compression/RangeCoder.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace cartan
{
namespace
{
/// What is on the left of a gate.
struct Step
{
  enum class Kind
  {
    Border,  ///< no triangle
    New,     ///< one whose third vertex is new
    Junction ///< one whose third vertex is on the front, before the edge Junction
  };

  Kind Is = Kind::Border;
  int Junction = -1;
};

/// What the encoder knows beyond the front: the mesh, in which each edge of the front has a
/// directed edge.
class Guide
{
public:
  explicit Guide(const TriangleMesh& mesh)
    : Mesh(mesh)
    , IsConquered(mesh.NumberOfTriangles(), 0)
    , Numbers(mesh.NumberOfVertices(), -1)
    , EdgesOfFront(mesh.NumberOfDirectedEdges(), -1)
  {
  }

  Step Look(const CutBorder& front, int gate) const
  {
    const int edge = this->DirectedEdges[gate];
    if (this->Mesh.LeftTriangle(edge) < 0)
    {
      return { Step::Kind::Border };
    }
    if (this->Numbers[this->Mesh.Opposite(edge)] < 0)
    {
      return { Step::Kind::New };
    }
    return { Step::Kind::Junction, this->FindJunction(front, edge) };
  }

  /// The first edge of the next component: that of its first triangle.
  int FindStart()
  {
    while (this->IsConquered[this->Seed])
    {
      ++this->Seed;
    }
    const auto corners = this->Mesh.GetTriangles().row(this->Seed);
    int edge = this->Mesh.RingBegin(corners[0]);
    while (this->Mesh.Neighbor(edge) != corners[1])
    {
      ++edge;
    }
    return edge;
  }

  /// The vertex gets the next number.
  void Number(int vertex)
  {
    this->Numbers[vertex] = static_cast<int>(this->Order.size());
    this->Order.push_back(vertex);
  }

  /// Edges of the front are made in the order of their ids.
  void AddEdge(int directedEdge)
  {
    this->EdgesOfFront[directedEdge] = static_cast<int>(this->DirectedEdges.size());
    this->DirectedEdges.push_back(directedEdge);
  }

  /// The triangle (a, b, c) on the left of a -> b has the new edges a -> c and c -> b.
  void Conquer(int directedEdge)
  {
    this->IsConquered[this->Mesh.LeftTriangle(directedEdge)] = 1;
    this->AddEdge(this->Mesh.Next(directedEdge));
    this->AddEdge(this->BeforeEnd(directedEdge));
  }

  const TriangleMesh& Mesh;
  std::vector<int> Order;         ///< vertices as they were numbered
  std::vector<int> DirectedEdges; ///< of each edge of the front

private:
  /// c -> b of the triangle (a, b, c) on the left of a -> b.
  int BeforeEnd(int edge) const { return this->Mesh.Next(this->Mesh.Twin(this->Mesh.Next(edge))); }

  bool IsConqueredLeft(int edge) const
  {
    return this->IsConquered[this->Mesh.LeftTriangle(edge)] != 0;
  }

  /// A vertex may be on the front several times: the edge that leaves it where the wedge of the
  /// triangle on the left of `edge` ends. The wedge is searched to both sides, as one may end
  /// at the border of the surface.
  int FindJunction(const CutBorder& front, int edge) const
  {
    int inwards = this->Mesh.Next(edge); // a -> c, then further ones to c
    while (this->Mesh.LeftTriangle(inwards) >= 0 && !this->IsConqueredLeft(inwards))
    {
      inwards = this->BeforeEnd(inwards);
    }
    if (this->Mesh.LeftTriangle(inwards) >= 0)
    {
      return this->EdgesOfFront[this->Mesh.Twin(inwards)];
    }
    int outwards = this->BeforeEnd(edge); // c -> b, then further ones from c
    while (!this->IsConqueredLeft(outwards))
    {
      outwards = this->Mesh.Next(outwards);
    }
    return front.After(this->EdgesOfFront[this->Mesh.Twin(outwards)]);
  }

  std::vector<char> IsConquered; // by triangle
  std::vector<int> Numbers;      // by vertex
  std::vector<int> EdgesOfFront; // by directed edge
  int Seed = 0;
};

/// How a step is coded: by the numbers of triangles that the ends of the gate have, and by
/// the kind of the step before.
template <typename Coder>
class StepCoder
{
public:
  explicit StepCoder(Coder& coder)
    : TheCoder(coder)
    , Integers(coder)
  {
  }

  Step Code(const CutBorder& front, int gate, const std::vector<int>& valences, const Step& step)
  {
    const auto isBorder = [&front](int edge)
    { return front.Edges[edge].Is == CutBorder::State::Border ? 1 : 0; };
    const int context = 2 * isBorder(front.Before(gate)) + isBorder(front.After(gate));
    if (this->TheCoder.Code(this->Borders[context], step.Is == Step::Kind::Border))
    {
      this->Last = 3;
      return { Step::Kind::Border };
    }
    const int from = std::min(valences[front.From(gate)], MostValence);
    const int to = std::min(valences[front.To(gate)], MostValence);
    const int around = (from * (MostValence + 1) + to) * 4 + this->Last;
    if (this->TheCoder.Code(this->News[around], step.Is == Step::Kind::New))
    {
      this->Last = 0;
      return { Step::Kind::New };
    }
    return { Step::Kind::Junction, this->CodeJunction(front, gate, around, step.Junction) };
  }

private:
  static constexpr int MostValence = 15;
  static constexpr int MostSteps = 16; // along the front; else the edge's number is coded

  /// The junction is mostly near: the edge before the gate, or after the one after it, or a
  /// few steps further, so that a small piece is cut off. `junction` is -1 in a decoder.
  int CodeJunction(const CutBorder& front, int gate, int around, int junction)
  {
    const int steps[2] = { StepsTo(front, front.Before(gate), &CutBorder::Before, junction),
      StepsTo(front, front.After(front.After(gate)), &CutBorder::After, junction) };
    const bool isAfter = this->TheCoder.Code(this->Sides[around], steps[1] < steps[0]);
    int edge = isAfter ? front.After(front.After(gate)) : front.Before(gate);
    for (int step = 0; step < MostSteps; ++step)
    {
      BitModel& model =
        step == 0 ? this->First[isAfter ? 1 : 0][around] : this->Further[isAfter ? 1 : 0][step];
      if (!this->TheCoder.Code(model, steps[isAfter ? 1 : 0] > step))
      {
        this->Last = step > 0 ? 3 : isAfter ? 1 : 2;
        return Checked(front, gate, edge);
      }
      edge = isAfter ? front.After(edge) : front.Before(edge);
    }
    this->Last = 3;
    const std::int64_t back =
      this->Integers.Code(this->Lengths, this->Sign, front.Size() - junction);
    return Checked(front, gate, front.Size() - back);
  }

  static int Checked(const CutBorder& front, int gate, std::int64_t junction)
  {
    if (junction < 0 || junction >= front.Size() || junction == gate ||
      front.Edges[junction].Is == CutBorder::State::Closed)
    {
      throw Error(ErrorCode::BadInput, "the connectivity cannot be decoded");
    }
    return static_cast<int>(junction);
  }

  static int StepsTo(
    const CutBorder& front, int edge, int (CutBorder::*next)(int) const, int junction)
  {
    int steps = 0;
    for (; steps < MostSteps && edge != junction; ++steps)
    {
      edge = (front.*next)(edge);
    }
    return steps;
  }

  using Models = std::array<BitModel, (MostValence + 1) * (MostValence + 1) * 4>;

  Coder& TheCoder;
  IntegerCoder<Coder> Integers;
  std::array<BitModel, 4> Borders;
  Models News;
  Models Sides;
  std::array<Models, 2> First;
  std::array<std::array<BitModel, MostSteps>, 2> Further;
  LengthModel Lengths;
  BitModel Sign;
  int Last = 0;
};

/// With a guide that knows the mesh, or the bytes of one that did.
template <typename Coder>
class Conquest
{
public:
  Conquest(Coder& coder, int numberOfTriangles, std::size_t mostVertices, Guide* guide = nullptr)
    : Steps(coder)
    , MostVertices(mostVertices)
    , TheGuide(guide)
    , Result(numberOfTriangles, 3)
  {
  }

  Triangles Run()
  {
    while (this->Count < this->Result.rows())
    {
      if (this->Gates.empty())
      {
        this->Start();
      }
      else
      {
        const int gate = this->Gates.back();
        this->Gates.pop_back();
        if (this->TheFront.IsOpen(gate))
        {
          this->Advance(gate);
        }
      }
    }
    return std::move(this->Result);
  }

private:
  /// The first triangle of a component.
  void Start()
  {
    const int a = static_cast<int>(this->Valences.size());
    this->AddVertices(3);
    const int edges[3] = { this->TheFront.Add(a), this->TheFront.Add(a + 2),
      this->TheFront.Add(a + 1) }; // a -> c, c -> b, b -> a
    for (int i = 0; i < 3; ++i)
    {
      this->TheFront.Link(edges[i], edges[(i + 1) % 3]);
    }
    if (this->TheGuide)
    {
      const int edge = this->TheGuide->FindStart();
      const TriangleMesh& mesh = this->TheGuide->Mesh;
      this->TheGuide->Number(mesh.Origin(edge));
      this->TheGuide->Number(mesh.Neighbor(edge));
      this->TheGuide->Number(mesh.Opposite(edge));
      this->TheGuide->Conquer(edge);
      this->TheGuide->AddEdge(mesh.Twin(edge));
    }
    this->AddTriangle(a, a + 1, a + 2);
    this->Gates = { edges[2], edges[1], edges[0] };
  }

  void Advance(int gate)
  {
    CutBorder& front = this->TheFront;
    const Step step = this->Steps.Code(
      front, gate, this->Valences, this->TheGuide ? this->TheGuide->Look(front, gate) : Step());
    const int before = front.Before(gate);
    if (step.Is == Step::Kind::Border)
    {
      front.Edges[gate].Is = CutBorder::State::Border;
      this->Gates.push_back(before);
      return;
    }
    const int from = front.From(gate);
    const int to = front.To(gate);
    const int after = front.After(gate);
    front.Edges[gate].Is = CutBorder::State::Closed;
    const bool isNew = step.Is == Step::Kind::New;
    if (isNew && this->TheGuide)
    {
      this->TheGuide->Number(this->TheGuide->Mesh.Opposite(this->TheGuide->DirectedEdges[gate]));
    }
    if (this->TheGuide)
    {
      this->TheGuide->Conquer(this->TheGuide->DirectedEdges[gate]);
    }
    if (isNew)
    {
      this->AddVertices(1);
    }
    const int apex =
      isNew ? static_cast<int>(this->Valences.size()) - 1 : front.From(step.Junction);
    this->AddTriangle(from, to, apex);
    // The loop goes along both sides; at a junction it is cut into two, or joined with another.
    const int first = front.Add(from);
    const int second = front.Add(apex);
    const int inwards = isNew ? first : front.Before(step.Junction);
    front.Link(before, first);
    front.Link(first, isNew ? second : step.Junction);
    front.Link(inwards, second);
    front.Link(second, after);
    front.Zip(first);
    front.Zip(second);
    this->Gates.push_back(second);
    this->Gates.push_back(first);
  }

  void AddVertices(std::size_t count)
  {
    if (this->Valences.size() + count > this->MostVertices)
    {
      throw Error(ErrorCode::BadInput, "the connectivity has more vertices than it should");
    }
    this->Valences.insert(this->Valences.end(), count, 0);
  }

  void AddTriangle(int a, int b, int c)
  {
    this->Result.row(this->Count++) << a, b, c;
    for (const int v : { a, b, c })
    {
      ++this->Valences[v];
    }
  }

  StepCoder<Coder> Steps;
  std::size_t MostVertices;
  Guide* TheGuide;
  CutBorder TheFront;
  std::vector<int> Gates;    // those not yet passed, the last comes first
  std::vector<int> Valences; // how many triangles a vertex has
  Triangles Result;
  Eigen::Index Count = 0;
};
}

TraversalOrder OrderByTraversal(const TriangleMesh& mesh)
{
  RangeEncoder coder;
  Guide guide(mesh);
  TraversalOrder order;
  order.Faces = Conquest<RangeEncoder>(
    coder, mesh.NumberOfTriangles(), static_cast<std::size_t>(mesh.NumberOfVertices()), &guide)
                  .Run();
  order.Vertices = std::move(guide.Order);
  order.NumberOfUsed = static_cast<int>(order.Vertices.size());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (!mesh.IsUsed(v))
    {
      order.Vertices.push_back(v);
    }
  }
  return order;
}

Points TraversalOrder::Reordered(const Points& values) const
{
  Points reordered(values.rows(), 3);
  for (std::size_t i = 0; i < this->Vertices.size(); ++i)
  {
    reordered.row(static_cast<Eigen::Index>(i)) = values.row(this->Vertices[i]);
  }
  return reordered;
}

std::vector<unsigned char> EncodeTriangles(const TriangleMesh& mesh)
{
  RangeEncoder coder;
  Guide guide(mesh);
  if (Conquest<RangeEncoder>(
        coder, mesh.NumberOfTriangles(), static_cast<std::size_t>(mesh.NumberOfVertices()), &guide)
        .Run() != mesh.GetTriangles())
  {
    throw Error(ErrorCode::BadInput, "triangles to code are not in the order of their code");
  }
  return coder.Finish();
}

Triangles DecodeTriangles(
  const unsigned char* bytes, std::size_t size, int numberOfTriangles, std::size_t mostVertices)
{
  RangeDecoder coder(bytes, size);
  return Conquest<RangeDecoder>(coder, numberOfTriangles, mostVertices).Run();
}
}
