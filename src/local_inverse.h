// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "threads.h"

#include <Eigen/LU>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief A sparse approximate inverse for matrices whose rows couple neighbours, as a preconditioner for Eigen.
 *
 * Row i of the inverse is that of the small matrix over the columns that weigh most in row i (restricted additive
 * Schwarz with one row per block). What makes interpolation ill-conditioned, nodes close to each other, is thus solved
 * exactly.
 */
class LocalInverse
{
public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  using StorageIndex = Matrix::StorageIndex;
  enum
  {
    ColsAtCompileTime = Eigen::Dynamic,
    MaxColsAtCompileTime = Eigen::Dynamic
  };

  /** \param[in] block columns of a small matrix
   * \param[in] threads 0 = all processors
   */
  void
  set (std::size_t block, int threads)
  {
    block_ = block;
    threads_ = threads;
  }

  LocalInverse &
  analyzePattern (const Matrix &)
  {
    return *this;
  }

  LocalInverse &
  factorize (const Matrix &matrix)
  {
    return compute (matrix);
  }

  LocalInverse &
  compute (const Matrix &matrix)
  {
    const auto rows = static_cast<std::size_t> (matrix.rows ());
    columns_.assign (rows, {});
    values_.assign (rows, {});
    parallelFor (
        rows, threads_, [] { return Scratch (); },
        [&] (Scratch &scratch, std::size_t row) { invertAround (matrix, static_cast<int> (row), scratch); });
    return *this;
  }

  Eigen::VectorXd
  solve (const Eigen::VectorXd &rhs) const
  {
    Eigen::VectorXd result (rhs.size ());
    parallelFor (
        columns_.size (), threads_, [] { return 0; },
        [&] (int, std::size_t row)
        {
          double sum = 0.0;
          for (std::size_t i = 0; i < columns_[row].size (); ++i)
            sum += values_[row][i] * rhs[columns_[row][i]];
          result[static_cast<Eigen::Index> (row)] = sum;
        });
    return result;
  }

  Eigen::ComputationInfo
  info () const
  {
    return Eigen::Success;
  }

private:
  struct Scratch
  {
    std::vector<std::pair<double, int>> order;
    Eigen::MatrixXd block;
  };

  void
  invertAround (const Matrix &matrix, int row, Scratch &scratch)
  {
    scratch.order.clear ();
    for (Matrix::InnerIterator entry (matrix, row); entry; ++entry)
      scratch.order.emplace_back (entry.col () == row ? -HUGE_VAL : -std::abs (entry.value ()),
                                  static_cast<int> (entry.col ()));
    std::sort (scratch.order.begin (), scratch.order.end ());
    scratch.order.resize (std::min (scratch.order.size (), block_));
    std::vector<int> &columns = columns_[static_cast<std::size_t> (row)];
    for (const auto &[weight, column] : scratch.order)
      columns.push_back (column);
    std::sort (columns.begin (), columns.end ());

    const auto size = static_cast<Eigen::Index> (columns.size ());
    scratch.block.setZero (size, size);
    for (Eigen::Index i = 0; i < size; ++i)
      fillRow (matrix, columns, i, scratch.block);
    const auto self = std::lower_bound (columns.begin (), columns.end (), row) - columns.begin ();
    Eigen::VectorXd inverse = scratch.block.transpose ().partialPivLu ().solve (
        Eigen::VectorXd::Unit (size, static_cast<Eigen::Index> (self)));
    if (!inverse.allFinite ())
      inverse = Eigen::VectorXd::Unit (size, static_cast<Eigen::Index> (self));
    values_[static_cast<std::size_t> (row)].assign (inverse.data (), inverse.data () + size);
  }

  /** \brief The part of a row that lies in the block; both are sorted by column. */
  static void
  fillRow (const Matrix &matrix, const std::vector<int> &columns, Eigen::Index i, Eigen::MatrixXd &block)
  {
    auto column = columns.begin ();
    for (Matrix::InnerIterator entry (matrix, columns[static_cast<std::size_t> (i)]); entry; ++entry)
    {
      column = std::lower_bound (column, columns.end (), static_cast<int> (entry.col ()));
      if (column == columns.end ())
        return;
      if (*column == entry.col ())
        block (i, column - columns.begin ()) = entry.value ();
    }
  }

  std::size_t block_ = 32;
  int threads_ = 0;
  std::vector<std::vector<int>> columns_;
  std::vector<std::vector<double>> values_;
};

} // namespace erkpa
