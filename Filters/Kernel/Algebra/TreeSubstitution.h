// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Base/ExecutionContext.h"
#include "Base/Types.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace cartan
{
/// A Cholesky factor L by columns, the diagonal first and rows increasing, of
/// P A P^T = L L^T.
template <typename Index>
struct FactorColumns
{
  Index Size;
  const Index* Begin; ///< of each column, and the end of the last: #U + 1
  const Index* Rows;
  const double* Values;
  const Index* Permutation; ///< the unknown that each column stands for: #U
};

/// Substitutes in a Cholesky factor on all threads.
///
/// Column j changes only columns that are above it in the elimination tree, in which the parent
/// of a column is the first row below its diagonal (Liu, The Role of Elimination Trees in Sparse
/// Factorization, 1990). So subtrees go side by side: what they give to the columns above them is
/// collected for each, and added in the same order whatever the threads. The tree must be
/// postordered, so that a subtree is a range of columns.
template <typename Index>
class TreeSubstitution
{
public:
  /// Chooses the subtrees by the pattern of a factor.
  void Analyze(const FactorColumns<Index>& factor)
  {
    std::vector<Subtree> subtrees = this->FindSubtrees(factor);
    if (!this->AreApart(factor, subtrees))
    {
      subtrees.clear();
      this->PutOnTop(factor.Size, subtrees);
    }
    std::int64_t loads[NumberOfParts] = {};
    this->Parts.assign(NumberOfParts, {});
    for (const Subtree& subtree : subtrees)
    {
      const auto part = std::min_element(loads, loads + NumberOfParts) - loads;
      loads[part] += subtree.Entries;
      this->Parts[part].push_back(subtree.Columns);
    }
  }

  /// A x = b for any number of columns.
  void Solve(const FactorColumns<Index>& factor,
    const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide, Eigen::MatrixXd& solution,
    const ExecutionContext& context)
  {
    solution.resize(rightHandSide.rows(), rightHandSide.cols());
    for (Eigen::Index first = 0; first < rightHandSide.cols(); first += 4)
    {
      const Eigen::Index count = std::min<Eigen::Index>(4, rightHandSide.cols() - first);
      const auto from = rightHandSide.middleCols(first, count);
      auto to = solution.middleCols(first, count);
      count == 1     ? this->SolveLanes<1>(factor, from, to, context)
        : count == 2 ? this->SolveLanes<2>(factor, from, to, context)
                     : this->SolveLanes<4>(factor, from, to, context);
    }
  }

  std::size_t GetBytes() const
  {
    return TotalBytes(this->Top, this->PlaceInTop, this->Work, this->Gifts);
  }

private:
  /// As many as threads can take. More make the columns above them more, which one thread does.
  static constexpr int NumberOfParts = 8;
  /// A smaller factor is done before threads have started.
  static constexpr std::int64_t FewestEntries = 300000;

  using Range = std::pair<Index, Index>; ///< its first and last column
  struct Subtree
  {
    Range Columns;
    std::int64_t Entries;
  };

  /// The largest subtrees of at most a part's share of entries, the largest first. Top gets all
  /// other columns.
  std::vector<Subtree> FindSubtrees(const FactorColumns<Index>& factor)
  {
    const Index size = factor.Size;
    std::vector<Index> first(size);
    std::vector<std::int64_t> entries(size, 0);
    for (Index j = 0; j < size; ++j)
    {
      first[j] = j;
    }
    for (Index j = 0; j < size; ++j)
    {
      const Index count = factor.Begin[j + 1] - factor.Begin[j];
      entries[j] += count;
      if (count > 1)
      {
        const Index parent = factor.Rows[factor.Begin[j] + 1];
        first[parent] = std::min(first[parent], first[j]);
        entries[parent] += entries[j];
      }
    }
    const std::int64_t all = factor.Begin[size];
    const std::int64_t most = all < FewestEntries ? -1 : all / NumberOfParts;
    std::vector<Subtree> subtrees;
    // The root of a subtree is its last column.
    for (Index j = size - 1; j >= 0;)
    {
      const bool isSubtree = entries[j] <= most;
      if (isSubtree)
      {
        subtrees.push_back({ { first[j], j }, entries[j] });
      }
      j = (isSubtree ? first[j] : j) - 1;
    }
    this->PutOnTop(size, subtrees);
    std::stable_sort(subtrees.begin(), subtrees.end(),
      [](const Subtree& a, const Subtree& b) { return a.Entries > b.Entries; });
    return subtrees;
  }

  /// All columns that are in no subtree; these are sorted by their columns, the last one first.
  void PutOnTop(Index size, const std::vector<Subtree>& subtrees)
  {
    this->Top.clear();
    this->PlaceInTop.assign(size, -1);
    Index column = 0;
    const auto putBefore = [&](Index end)
    {
      for (; column < end; ++column)
      {
        this->PlaceInTop[column] = static_cast<Index>(this->Top.size());
        this->Top.push_back(column);
      }
    };
    for (auto subtree = subtrees.rbegin(); subtree != subtrees.rend(); ++subtree)
    {
      putBefore(subtree->Columns.first);
      column = subtree->Columns.second + 1;
    }
    putBefore(size);
  }

  /// Whether all rows of a subtree's columns are its own or of Top, and those of Top in Top: so
  /// it is where the tree is postordered and no entry is missing because it is zero.
  bool AreApart(const FactorColumns<Index>& factor, const std::vector<Subtree>& subtrees) const
  {
    const auto isOwn = [&](Index column, Index last)
    {
      return std::all_of(factor.Rows + factor.Begin[column], factor.Rows + factor.Begin[column + 1],
        [&](Index row) { return row <= last || this->PlaceInTop[row] >= 0; });
    };
    return std::all_of(subtrees.begin(), subtrees.end(),
             [&](const Subtree& subtree)
             {
               bool isApart = true;
               for (Index j = subtree.Columns.first; j <= subtree.Columns.second; ++j)
               {
                 isApart = isApart && isOwn(j, subtree.Columns.second);
               }
               return isApart;
             }) &&
      std::all_of(
        this->Top.begin(), this->Top.end(), [&](Index column) { return isOwn(column, -1); });
  }

  template <int Lanes>
  using Row = Eigen::Array<double, Lanes, 1>;
  template <int Lanes>
  using Place = Eigen::Map<Row<Lanes>>;

  /// Whether the next column has the same rows but for its own, so that both are done at once.
  static bool IsPair(const FactorColumns<Index>& factor, Index column, Index last)
  {
    const Index begin = factor.Begin[column];
    const Index next = factor.Begin[column + 1];
    return column < last && next - begin > 1 && factor.Rows[begin + 1] == column + 1 &&
      factor.Begin[column + 2] - next == next - begin - 1;
  }

  /// y_i -= l_ij y_j for the rows below column j, or below a pair of them: `at(i)` is where y_i is.
  template <int Lanes, typename At>
  static Index Forward(const FactorColumns<Index>& factor,
    double* work, // NOLINT(readability-non-const-parameter): a Map writes through it
    Index column, Index last, const At& at)
  {
    const Index begin = factor.Begin[column];
    const Index end = factor.Begin[column + 1];
    Place<Lanes> first(work + Lanes * column);
    first /= factor.Values[begin];
    const Row<Lanes> y = first;
    if (!IsPair(factor, column, last))
    {
      for (Index p = begin + 1; p < end; ++p)
      {
        Place<Lanes>(at(factor.Rows[p])) -= factor.Values[p] * y;
      }
      return column + 1;
    }
    Place<Lanes> second(work + Lanes * (column + 1));
    second = (second - factor.Values[begin + 1] * y) / factor.Values[end];
    const Row<Lanes> z = second;
    const double* values = factor.Values + end - (begin + 1);
    for (Index p = begin + 2; p < end; ++p)
    {
      Place<Lanes>(at(factor.Rows[p])) -= factor.Values[p] * y + values[p] * z;
    }
    return column + 2;
  }

  /// x_j = (y_j - sum_i l_ij x_i) / l_jj of column j, or of a pair of it and the one before.
  /// Returns the next column.
  template <int Lanes>
  static Index Backward(const FactorColumns<Index>& factor,
    double* work, // NOLINT(readability-non-const-parameter): a Map writes through it
    Index column, Index first)
  {
    const Index begin = factor.Begin[column];
    const Index end = factor.Begin[column + 1];
    const bool isPair = column > first && IsPair(factor, column - 1, column);
    Place<Lanes> x(work + Lanes * column);
    Row<Lanes> sum = Row<Lanes>::Zero();
    if (!isPair)
    {
      for (Index p = begin + 1; p < end; ++p)
      {
        sum += factor.Values[p] * Place<Lanes>(work + Lanes * factor.Rows[p]);
      }
      x = (x - sum) / factor.Values[begin];
      return column - 1;
    }
    const Index before = factor.Begin[column - 1];
    const double* values = factor.Values + before + 1 - begin;
    Row<Lanes> sumBefore = Row<Lanes>::Zero();
    for (Index p = begin + 1; p < end; ++p)
    {
      const Row<Lanes> above = Place<Lanes>(work + Lanes * factor.Rows[p]);
      sum += factor.Values[p] * above;
      sumBefore += values[p] * above;
    }
    x = (x - sum) / factor.Values[begin];
    Place<Lanes> y(work + Lanes * (column - 1));
    y = (y - sumBefore - factor.Values[before + 1] * x) / factor.Values[before];
    return column - 2;
  }

  template <int Lanes, typename From, typename To>
  void SolveLanes(
    const FactorColumns<Index>& factor, const From& from, To& to, const ExecutionContext& context)
  {
    this->Work.resize(Lanes * static_cast<std::size_t>(factor.Size));
    double* work = this->Work.data();
    context.For(static_cast<int>(factor.Size),
      [&](int begin, int end)
      {
        for (int i = begin; i < end; ++i)
        {
          for (int lane = 0; lane < Lanes; ++lane)
          {
            work[static_cast<std::size_t>(Lanes) * i + lane] =
              lane < from.cols() ? from(factor.Permutation[i], lane) : 0.0;
          }
        }
      });
    this->SubstituteForward<Lanes>(factor, work, context);
    for (std::size_t i = this->Top.size(); i > 0;)
    {
      const Index column = this->Top[i - 1];
      const bool hasNext = i > 1 && this->Top[i - 2] == column - 1;
      i -= column - Backward<Lanes>(factor, work, column, hasNext ? column - 1 : column);
    }
    context.For(NumberOfParts,
      [&](int begin, int end)
      {
        for (int part = begin; part < end; ++part)
        {
          for (const auto& [first, last] : this->Parts[part])
          {
            for (Index j = last; j >= first;)
            {
              j = Backward<Lanes>(factor, work, j, first);
            }
          }
        }
      });
    context.For(static_cast<int>(factor.Size),
      [&](int begin, int end)
      {
        for (int i = begin; i < end; ++i)
        {
          for (int lane = 0; lane < to.cols(); ++lane)
          {
            to(factor.Permutation[i], lane) = work[static_cast<std::size_t>(Lanes) * i + lane];
          }
        }
      });
  }

  template <int Lanes>
  void SubstituteForward(
    const FactorColumns<Index>& factor, double* work, const ExecutionContext& context)
  {
    const std::size_t size = Lanes * this->Top.size();
    this->Gifts.assign(NumberOfParts * size, 0.0);
    context.For(NumberOfParts,
      [&](int begin, int end)
      {
        for (int part = begin; part < end; ++part)
        {
          double* gifts = this->Gifts.data() + part * size;
          for (const auto& [first, last] : this->Parts[part])
          {
            const auto at = [&, last = last](Index row)
            { return row <= last ? work + Lanes * row : gifts + Lanes * this->PlaceInTop[row]; };
            for (Index j = first; j <= last;)
            {
              j = Forward<Lanes>(factor, work, j, last, at);
            }
          }
        }
      });
    for (std::size_t i = 0; i < this->Top.size(); ++i)
    {
      for (int part = 0; part < NumberOfParts; ++part)
      {
        Place<Lanes>(work + Lanes * this->Top[i]) +=
          Place<Lanes>(this->Gifts.data() + part * size + Lanes * i);
      }
    }
    const auto at = [&](Index row) { return work + Lanes * row; };
    for (std::size_t i = 0; i < this->Top.size();)
    {
      const Index next = i + 1 < this->Top.size() && this->Top[i + 1] == this->Top[i] + 1
        ? this->Top[i + 1]
        : this->Top[i];
      i += Forward<Lanes>(factor, work, this->Top[i], next, at) - this->Top[i];
    }
  }

  std::vector<std::vector<Range>> Parts; ///< subtrees
  std::vector<Index> Top;                ///< the columns above all subtrees, increasing
  std::vector<Index> PlaceInTop;         ///< of each column, -1 where it is in a subtree: #U
  std::vector<double> Work;
  std::vector<double> Gifts; ///< what each part gives to the columns of Top
};
}
