// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OffReader.h"
#include "TestShapes.h"

#include "Kernel/Mesh/TriangleMesh.h"

#include <iomanip>
#include <iostream>
#include <string>

/// Scanned meshes as the kernel sees them, and what several kernel tests do
/// with surfaces.
namespace shapes
{
/// The mesh in a file, with its points as they are.
inline Shape ReadShape(const std::string& path)
{
  const offreader::Mesh mesh = offreader::Read(path);
  Shape shape;
  shape.Positions = Eigen::Map<const cartan::Points>(
    mesh.Points.data(), static_cast<Eigen::Index>(mesh.Points.size() / 3), 3);
  shape.Faces = Eigen::Map<const cartan::Triangles>(
    mesh.Triangles.data(), static_cast<Eigen::Index>(mesh.Triangles.size() / 3), 3);
  return shape;
}

/// The scanned mesh of this name ("camel").
inline Shape RealMesh(const std::string& name)
{
  return ReadShape(offreader::MeshPath(name));
}

inline cartan::TriangleMesh MakeMesh(const Shape& shape)
{
  return cartan::TriangleMesh(shape.NumberOfVertices(), shape.Faces);
}

/// The rigid motion that best maps the rows of `from` on those of `to`.
inline RigidMotion BestRigidMotion(const cartan::Points& from, const cartan::Points& to)
{
  const Eigen::Matrix4d motion = Eigen::umeyama(from.transpose(), to.transpose(), false);
  return { motion.topLeftCorner<3, 3>(), motion.topRightCorner<3, 1>() };
}

/// Shows a measured figure beside the bound that a test asserts, for those who
/// want to know how far from it we are.
inline void ShowFigure(const std::string& name, double value)
{
  std::cout << "[ figure   ] " << name << ": " << std::setprecision(4) << value << std::endl;
}
}
