// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/SurfaceFit.h"

#include <algorithm>
#include <limits>

namespace cartan
{
namespace
{
/// Of a vertex with more neighbors than this, such as the pole of a sphere,
/// only evenly spaced ones are taken, from the nearest on: all of them would turn
/// every neighborhood next to it into that one fan.
constexpr int MaximumFan = 32;

/// Of more neighbors than this the nearest one is not looked for, at each point around.
constexpr int MaximumSearch = 4096;

/// Cosines of the turn of the normal beyond which a point is left out. In the
/// second ring 78 degrees: what is next to a right-angled edge must not see its
/// other side. Farther out 61, since it may be the other side of a tube; a bit
/// more than 60, the turn between the sides of a hexagon, so that rounding
/// decides nothing.
constexpr double SecondRingCosine = 0.2;
constexpr double FarCosine = 0.485;

/// 37 degrees, a bit more than those between the sides of a decagon. Circles
/// that turn farther leave their tangent so much that they seem to say more
/// about the other direction than they do.
constexpr double CloseCosine = 0.8;

constexpr double AnyCosine = -2.0;
constexpr double AnyDistance = std::numeric_limits<double>::infinity();
}

void Neighborhood::Start(int v)
{
  this->Ids.assign(1, v);
  this->Found.Clear();
  this->Found.Insert(v);
  this->Offsets.assign(1, Eigen::Vector3d::Zero());
  this->Cosines.assign(1, 1.0);
  this->AddFan(v, AnyCosine, AnyDistance);
  this->CountWithOneRing = this->Count();
}

bool Neighborhood::IsClose(int i) const
{
  return i + 1 < this->CountWithOneRing || this->Cosines[i + 1] > CloseCosine;
}

bool Neighborhood::AreAllClose() const
{
  return *std::min_element(this->Cosines.begin(), this->Cosines.end()) > CloseCosine;
}

bool Neighborhood::FacesOneWay() const
{
  return std::all_of(this->Cosines.begin() + this->CountWithOneRing, this->Cosines.end(),
    [](double cosine) { return cosine > FarCosine; });
}

void Neighborhood::Take(int v, const int* ids, int size, int oneRingSize)
{
  this->Ids.assign(1, v);
  this->Ids.insert(this->Ids.end(), ids, ids + size);
  this->Offsets.resize(size + 1);
  this->Cosines.resize(size + 1);
  this->Offsets[0].setZero();
  this->Cosines[0] = 1.0;
  for (int i = 1; i <= size; ++i)
  {
    const int w = this->Ids[i];
    this->Offsets[i] = (this->Positions.row(w) - this->Positions.row(v)).transpose();
    this->Cosines[i] = this->Normals ? this->Normals->row(v).dot(this->Normals->row(w)) : 1.0;
  }
  this->CountWithOneRing = oneRingSize + 1;
}

/// Of the neighbors of v, the place in its ring of the one nearest to the vertex in the
/// middle; the first of those that rounding cannot tell apart.
int Neighborhood::NearestInFan(int v) const
{
  int nearest = 0;
  double least = AnyDistance;
  for (int i = 0; i < this->Mesh.Valence(v); ++i)
  {
    const int w = this->Mesh.Neighbor(this->Mesh.RingBegin(v) + i);
    const double squared =
      (this->Positions.row(w) - this->Positions.row(this->Ids[0])).squaredNorm();
    if (squared < least * (1.0 - 1e-9))
    {
      least = squared;
      nearest = i;
    }
  }
  return nearest;
}

void Neighborhood::AddFan(int v, double minimumCosine, double maximumSquaredDistance)
{
  const int valence = this->Mesh.Valence(v);
  const int step = (valence + MaximumFan - 1) / MaximumFan;
  const int first = step > 1 && valence <= MaximumSearch ? this->NearestInFan(v) : 0;
  const int ring = this->Mesh.RingBegin(v);
  for (int i = 0; i < valence; i += step)
  {
    const int place = first + i < valence ? first + i : first + i - valence;
    const int w = this->Mesh.Neighbor(ring + place);
    if (this->Found.Contains(w))
    {
      continue;
    }
    const double cosine =
      this->Normals ? this->Normals->row(this->Ids[0]).dot(this->Normals->row(w)) : 1.0;
    const Eigen::Vector3d offset =
      (this->Positions.row(w) - this->Positions.row(this->Ids[0])).transpose();
    if (cosine > minimumCosine && offset.squaredNorm() <= maximumSquaredDistance)
    {
      this->Cosines.push_back(cosine);
      this->Offsets.push_back(offset);
      this->Ids.push_back(w);
      this->Found.Insert(w);
    }
  }
}

void Neighborhood::CollectRings(int v, int rings)
{
  this->Start(v);
  int begin = 1;
  for (int ring = 1;
       !this->IsFull() && (ring < rings || (ring < MaximumRings && this->Count() <= MinimumPoints));
       ++ring)
  {
    const int end = this->Count();
    for (; begin < end; ++begin)
    {
      this->AddFan(this->Ids[begin], ring == 1 ? SecondRingCosine : FarCosine, AnyDistance);
    }
  }
}

void Neighborhood::CollectBall(int v)
{
  this->CollectRings(v, 2);
  double radius = 0.0;
  for (int i = 1; i < this->CountWithOneRing; ++i)
  {
    radius = std::max(radius, this->Offsets[i].squaredNorm());
  }
  // Equal distances, as in a regular grid, must not be told apart by rounding.
  radius *= 1.0001;
  // The fans of the one-ring have given all they have.
  for (int begin = this->CountWithOneRing; begin < this->Count() && !this->IsFull();)
  {
    const int end = this->Count();
    for (; begin < end; ++begin)
    {
      if (this->Offsets[begin].squaredNorm() <= radius)
      {
        this->AddFan(this->Ids[begin], FarCosine, radius);
      }
    }
  }
}

void Neighborhood::CollectNearest(int v)
{
  this->Start(v);
  for (int i = 1; i < this->CountWithOneRing; ++i)
  {
    this->AddFan(this->Ids[i], FarCosine, AnyDistance);
  }
}
}
