// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SparseCore>

/// The mathematics of Cartan on Eigen. Nothing here knows VTK.
///
/// Shapes are written "#V x 3": #V vertices, #T triangles, #D directed edges
/// (twice the edges). Indices are 32-bit: half the memory traffic of 64-bit
/// ones in loops that are bound by memory. TriangleMesh refuses larger input.
namespace cartan
{
/// Vertex positions or any other vectors, one per row: #V x 3.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Vertex indices of triangles, counter-clockwise seen from outside: #T x 3.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A 3 x 3 matrix per row, its columns one after the other: #V x 9. A frame is
/// stored as (b1, b2, N), a linear transformation A as (A e1, A e2, A e3).
using Matrices = Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>;

/// `count` identities: count x 9.
inline Matrices Identities(Eigen::Index count)
{
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  return Eigen::Map<const Eigen::Matrix<double, 1, 9>>(identity.data()).replicate(count, 1);
}

/// Several scalars per vertex: #V x k, the k values of a vertex side by side.
using Field = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

using SparseMatrix = Eigen::SparseMatrix<double>;

/// The 3 x 3 matrix in a row of Matrices.
inline Eigen::Map<const Eigen::Matrix3d> MatrixAt(const Matrices& matrices, Eigen::Index row)
{
  return Eigen::Map<const Eigen::Matrix3d>(matrices.data() + 9 * row);
}
inline Eigen::Map<Eigen::Matrix3d> MatrixAt(Matrices& matrices, Eigen::Index row)
{
  return Eigen::Map<Eigen::Matrix3d>(matrices.data() + 9 * row);
}
}
