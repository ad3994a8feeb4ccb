// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <vector>

namespace fuzz
{
/// The same numbers from the same seed on every machine, also for neighboring
/// seeds: Steele, Lea, Flood, Fast Splittable Pseudorandom Number Generators, 2014.
class Random
{
public:
  explicit Random(std::uint64_t seed)
    : State(seed)
  {
  }

  std::uint64_t Bits()
  {
    std::uint64_t z = (this->State += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  double Unit() { return static_cast<double>(this->Bits() >> 11) * 0x1p-53; }
  double Real(double low, double high) { return low + (high - low) * this->Unit(); }
  /// In [low, high], evenly in the logarithm.
  double Log(double low, double high) { return low * std::pow(high / low, this->Unit()); }
  /// In [low, high].
  int Integer(int low, int high)
  {
    return low + static_cast<int>(this->Bits() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool Chance(double probability) { return this->Unit() < probability; }

  template <typename Value>
  const Value& Pick(const std::vector<Value>& values)
  {
    return values[static_cast<std::size_t>(this->Integer(0, static_cast<int>(values.size()) - 1))];
  }

  template <typename Value>
  void Shuffle(std::vector<Value>& values)
  {
    for (std::size_t i = values.size(); i > 1; --i)
    {
      std::swap(values[i - 1], values[this->Bits() % i]);
    }
  }

  Eigen::Vector3d Vector()
  {
    // One after the other: the order of a call's arguments is open.
    const double x = this->Real(-1.0, 1.0);
    const double y = this->Real(-1.0, 1.0);
    const double z = this->Real(-1.0, 1.0);
    return { x, y, z };
  }
  Eigen::Vector3d Direction()
  {
    return (this->Vector() + Eigen::Vector3d(0, 0, 1e-9)).normalized();
  }
  Eigen::Matrix3d Rotation()
  {
    const Eigen::Vector3d axis = this->Direction();
    return Eigen::AngleAxisd(this->Real(0.0, 3.14), axis).toRotationMatrix();
  }

private:
  std::uint64_t State;
};
}
