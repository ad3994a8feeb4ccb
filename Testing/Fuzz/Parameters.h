// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Case.h"

namespace fuzz
{
using Draw = std::function<std::vector<double>(Random&, const Mesh&)>;

/// A setter, and how its values are drawn.
struct Parameter
{
  Setting Call;
  Draw Values;
};

template <typename Class, typename Value>
Parameter Make(const char* name, void (Class::*set)(Value), Draw values, Kind type = Kind::Scalar,
  double power = 0)
{
  Setting call;
  call.Name = name;
  call.Type = type;
  call.Power = power;
  call.Apply = [set](vtkAlgorithm* filter, const std::vector<double>& v)
  { (static_cast<Class*>(filter)->*set)(static_cast<Value>(v[0])); };
  return { call, std::move(values) };
}

inline Draw Flag()
{
  return [](Random& random, const Mesh&) -> std::vector<double>
  { return { random.Chance(0.5) ? 1.0 : 0.0 }; };
}

/// In [low, high], now and then one more or less.
inline Draw Integer(int low, int high)
{
  return [low, high](Random& random, const Mesh&) -> std::vector<double>
  {
    const bool isOutside = random.Chance(0.03);
    return { static_cast<double>(
      isOutside ? random.Pick<int>({ low - 1, high + 1, -7 }) : random.Integer(low, high)) };
  };
}

inline Draw Real(double low, double high)
{
  return [low, high](Random& random, const Mesh&) -> std::vector<double>
  {
    const double margin = random.Chance(0.03) ? 0.2 * (high - low) : 0.0;
    return { random.Real(low - margin, high + margin) };
  };
}

/// Evenly in the logarithm.
inline Draw Logarithmic(double low, double high)
{
  return [low, high](Random& random, const Mesh&) -> std::vector<double>
  { return { random.Log(low, high) }; };
}

/// A part of the size of the surface.
inline Draw Length(double low, double high)
{
  return [low, high](Random& random, const Mesh& mesh) -> std::vector<double>
  { return { Size(mesh.Points) * random.Log(low, high) }; };
}

using Parameters = std::vector<Parameter>;

inline Parameters With(Parameters base, const Parameters& own)
{
  base.insert(base.end(), own.begin(), own.end());
  return base;
}
}
