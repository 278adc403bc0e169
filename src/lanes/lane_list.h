// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_packing.h"
#include "lanes.h"

namespace erkpa::lanes
{

/** \brief Some of the gathered nodes and what they have, closed up: those that evaluation points visit. */
template <typename B>
class LaneList
{
public:
  static constexpr std::size_t WIDTH = B::size;

  /** \brief Take up memory, in which a list that was made there before goes on. */
  void
  setUp (const Nodes &nodes, const Scratch &scratch)
  {
    nodes_ = &nodes;
    numbers_ = scratch.list;
    const std::size_t stride = nodes.count + MAX_WIDTH;
    for (std::size_t column = 0; column < Scratch::COLUMNS; ++column)
      near_[column] = scratch.near + column * stride;
  }

  /** \brief List those of the first \a value_points that lie within a ball, with the first COLUMNS of what they have.
   *
   * For once the lanes are nodes, for there are many more of these.
   */
  template <std::size_t COLUMNS>
  void
  take (const float *middle, float reach, std::size_t value_points)
  {
    const Columns columns (*nodes_);
    const B limit (reach * reach);
    std::size_t listed = 0, first = 0;
    const auto list = [&] (std::size_t left)
    {
      B x[3], d[3];
      for (std::size_t a = 0; a < 3; ++a)
      {
        x[a] = B::load_unaligned (columns.all[a] + first);
        d[a] = x[a] - B (middle[a]);
      }
      const Packing<B> packing (limit - dot (d, d), left);
      for (std::size_t a = 0; a < 3; ++a)
        packing.pack (x[a], near_[a] + listed);
      for (std::size_t column = 3; column < COLUMNS; ++column)
        if (columns.all[column] != nullptr)
          packing.pack (Packing<B>::load (columns.all[column] + first, left), near_[column] + listed);
      packing.packNumbers (first, numbers_ + listed);
      listed += packing.size ();
    };
    for (; first + WIDTH <= value_points; first += WIDTH)
      list (WIDTH);
    if (first < value_points)
      list (value_points - first);
    size_ = on_surface_ = listed;
    while (on_surface_ > 0 && numbers_[on_surface_ - 1] >= nodes_->on_surface)
      --on_surface_;
  }

  /** \brief Only nodes on the surface are listed: keep those of which keeps (i, how many are kept) is true. What they
   * have does not follow. */
  template <typename KeepsT>
  void
  keep (KeepsT keeps)
  {
    // The compiler cannot know that the list does not lie where what is said of it goes.
    std::uint32_t *const numbers = numbers_;
    std::size_t kept = 0;
    for (std::size_t i = 0, count = size_; i < count; ++i)
    {
      const bool is_kept = keeps (i, kept);
      numbers[kept] = numbers[i];
      kept += is_kept ? 1 : 0; // no branch, which none could foretell
    }
    size_ = on_surface_ = kept;
  }

  /** \brief Copy all that the listed nodes have. */
  void
  fetch ()
  {
    fetch<0, LAMBDA> ();
    if (nodes_->lambda != nullptr)
      fetch<LAMBDA, 1> ();
    if (nodes_->confidence != nullptr)
      fetch<LAMBDA + 1, 1> ();
  }

  std::size_t
  size () const
  {
    return size_;
  }

  /** \brief How many of them, the first ones, lie on the surface. */
  std::size_t
  onSurface () const
  {
    return on_surface_;
  }

  /** \brief Place of the i-th among all nodes. */
  std::size_t
  node (std::size_t i) const
  {
    return numbers_[i];
  }

  /** \brief An array of what they have: see Scratch; null where none has it. */
  const float *
  near (std::size_t column) const
  {
    const bool is_there = column < LAMBDA || (column == LAMBDA ? nodes_->lambda : nodes_->confidence) != nullptr;
    return is_there ? near_[column] : nullptr;
  }

private:
  static constexpr std::size_t LAMBDA = 6; // column

  /** \brief The arrays of what all nodes have. */
  struct Columns
  {
    const float *all[Scratch::COLUMNS];

    explicit Columns (const Nodes &nodes)
        : all{nodes.x, nodes.y, nodes.z, nodes.nx, nodes.ny, nodes.nz, nodes.lambda, nodes.confidence}
    {
    }
  };

  /** \brief The same of some columns, which all have. */
  template <std::size_t FIRST, std::size_t COUNT>
  void
  fetch ()
  {
    const Columns columns (*nodes_);
    const std::uint32_t *const numbers = numbers_;
    const float *from[COUNT];
    float *to[COUNT];
    for (std::size_t c = 0; c < COUNT; ++c)
    {
      from[c] = columns.all[FIRST + c];
      to[c] = near_[FIRST + c];
    }
    for (std::size_t i = 0, count = size_; i < count; ++i)
      for (std::size_t c = 0, node = numbers[i]; c < COUNT; ++c)
        to[c][i] = from[c][node];
  }

  const Nodes *nodes_;
  std::uint32_t *numbers_;
  float *near_[Scratch::COLUMNS];
  std::size_t size_ = 0, on_surface_ = 0;
};

} // namespace erkpa::lanes
