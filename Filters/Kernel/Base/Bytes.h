// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <cstddef>
#include <string>
#include <vector>

/// How much memory containers hold beyond their own size, for caches that are
/// limited in bytes.
namespace cartan
{
template <typename Derived>
std::size_t BytesOf(const Eigen::PlainObjectBase<Derived>& matrix)
{
  return Derived::SizeAtCompileTime == Eigen::Dynamic
    ? static_cast<std::size_t>(matrix.size()) * sizeof(typename Derived::Scalar)
    : 0;
}

template <typename Scalar, int Options, typename Index>
std::size_t BytesOf(const Eigen::SparseMatrix<Scalar, Options, Index>& matrix)
{
  return static_cast<std::size_t>(matrix.data().allocatedSize()) *
    (sizeof(Scalar) + sizeof(Index)) +
    static_cast<std::size_t>(matrix.outerSize() + 1) * sizeof(Index);
}

inline std::size_t BytesOf(const std::string& text)
{
  return text.capacity();
}

template <typename Value>
std::size_t BytesOf(const std::vector<Value>& values)
{
  return values.capacity() * sizeof(Value);
}

template <typename Value>
std::size_t BytesOf(const std::vector<std::vector<Value>>& values)
{
  std::size_t bytes = values.capacity() * sizeof(std::vector<Value>);
  for (const std::vector<Value>& value : values)
  {
    bytes += BytesOf(value);
  }
  return bytes;
}

template <typename Scalar, int Rows, int Columns, int Options>
std::size_t BytesOf(const std::vector<Eigen::Matrix<Scalar, Rows, Columns, Options>>& matrices)
{
  std::size_t bytes = matrices.capacity() * sizeof(matrices[0]);
  for (const auto& matrix : matrices)
  {
    bytes += BytesOf(matrix);
  }
  return bytes;
}

/// The sum over several containers.
template <typename... Containers>
std::size_t TotalBytes(const Containers&... containers)
{
  return (std::size_t{ 0 } + ... + BytesOf(containers));
}
}
