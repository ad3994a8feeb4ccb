// SPDX-License-Identifier: BSD-3-Clause
// Writes a few small good files into a folder, where a fuzzer begins:
//     MakeSeeds <folder>
#include "CompressedFiles.h"

#include <fstream>
#include <iostream>

namespace
{
cartan::CodedArray ArrayOf(cartan::ScalarType type, int components, int vertices)
{
  cartan::CodedArray array;
  array.Name = "Array";
  array.Type = type;
  array.Components = components;
  array.Bytes.resize(static_cast<std::size_t>(vertices * components * cartan::SizeOf(type)));
  for (std::size_t i = 0; i < array.Bytes.size(); ++i)
  {
    array.Bytes[i] = static_cast<unsigned char>(i * i / 7);
  }
  return array;
}

void Write(const std::string& path, const cartan::CompressedSurface& surface)
{
  const compressed::Bytes bytes = cartan::Compress(surface);
  std::ofstream(path, std::ios::binary)
    .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}
}

int main(int argc, char** argv)
{
  if (argc != 2)
  {
    std::cerr << "usage: MakeSeeds <folder>\n";
    return 2;
  }
  const std::string folder = std::string(argv[1]) + "/";
  shapes::Shape loose = shapes::Union(shapes::Icosphere(0), shapes::Plane(2));
  loose.Positions.conservativeResize(loose.Positions.rows() + 2, 3);
  loose.Positions.bottomRows(2).setConstant(3.0);
  const std::vector<shapes::Shape> all = { shapes::Icosphere(1), shapes::Torus(6, 4),
    shapes::Plane(3), shapes::Bar(1, 1, 2, { 1.0, 1.0, 2.0 }), loose };
  int number = 0;
  for (const shapes::Shape& shape : all)
  {
    for (const int bits : { 3, 12 })
    {
      const bool isLarge = bits == 12;
      std::vector<cartan::Points> steps(isLarge ? 2 : 1, shape.Positions);
      steps.back() *= 1.125;
      cartan::CompressedSurface surface = compressed::SurfaceOf(shape, steps, bits, 4, isLarge);
      if (number % 3 == 0)
      {
        const auto type = static_cast<cartan::ScalarType>(1 + number % 10);
        surface.Steps[0].Arrays = { ArrayOf(type, 1 + number % 2, shape.NumberOfVertices()) };
      }
      Write(folder + "seed" + std::to_string(number++) + ".csf", surface);
    }
  }
  return 0;
}
