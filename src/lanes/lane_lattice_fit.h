// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_lattice.h"
#include "lane_raises.h"
#include "lane_reach.h"
#include "lane_system.h"
#include "lanes.h"

namespace erkpa::lanes
{

/** \brief LaneFit with moments that are interpolated between the points of a lattice; lengths are in ε.
 *
 * Interpolating moments is the same as interpolating the weights of the nodes: terms are reproduced as ever. The change
 * of the sums with x is that of the interpolation.
 */
template <typename B, Basis BASIS, Constraint CONSTRAINT>
class LatticeFit
{
public:
  using TermsT = Terms<B, BASIS>;
  using ColumnsT = LatticeColumns<TermsT, CONSTRAINT>;
  using Mask = decltype (B () < B ());
  static constexpr int SIZE = TermsT::SIZE;

  /** \param[in] x the evaluation points, about the origin of the lattice's sums */
  LatticeFit (const Settings &settings, const Lattice &lattice, const B *x)
      : lattice_ (lattice), min_nodes_ (static_cast<float> (settings.min_nodes))
  {
    for (int a = 0; a < 3; ++a)
    {
      x_[a] = x[a];
      axes_[a] = LatticeAxis<B> (x[a], lattice.first[a], lattice.spacing, lattice.sides[a]);
    }
    sum<0, ColumnsT::COUNT> (NONE, 0, sums_);
    ColumnsT::shift (x_, sums_);
    takeSystem (sums_, system_.M, system_.b);
    weight_ = sums_[0];
    spread_ = B (0.0f);
    for (int a = 0; a < 3; ++a)
    {
      const B moment = sums_[1 + a];
      centroid_[a] = moment / weight_;
      spread_ += fnma (centroid_[a], moment, squareOf (sums_, a));
    }
    system_.factorize (CONSTRAINT, spread_);
    for (int j = 0; j < SIZE; ++j)
      c_[j] = system_.b[j];
    system_.solve (c_);
  }

  /** \brief f(x). */
  B
  value () const
  {
    return c_[0];
  }

  /** \brief See LaneFit::aside (). */
  B
  aside () const
  {
    return xsimd::sqrt (dot (centroid_, centroid_));
  }

  /** \brief About how many nodes are in the support. */
  B
  supportNodes () const
  {
    return sums_[ColumnsT::SUPPORT];
  }

  /** \brief Where few nodes, or many of them far off or aside, leave it open whether the field is defined and in reach,
   * or pivots are raised in a way that is reckoned with elsewhere: ask the nodes. */
  Mask
  isUnsettled () const
  {
    // In reach is a quarter; numbers of nodes are less smooth than their weights. Where the data end, all weights are
    // small beside those that the error is a share of.
    constexpr float CLEARLY = 0.35f, ENOUGH = 4.0f, WITHIN = 0.45f;
    Mask unsettled = !(sums_[ColumnsT::SUPPORT] >= B (ENOUGH * min_nodes_)) ||
                     !(sums_[ColumnsT::NEAR] >= B (CLEARLY) * sums_[ColumnsT::ON_SURFACE]) || !(weight_ > B (0.0f)) ||
                     !(aside () <= B (WITHIN));
    for (int j = RAISES_MATTER && SIZE == 4 ? 4 : 1; j < SIZE; ++j)
      unsettled = unsettled || system_.pivot (j).raise > B (0.0f);
    return unsettled;
  }

  /** \brief ∇f(x). */
  void
  gradient (B *gradient)
  {
    for (int j = 0; j < SIZE; ++j)
      a_[j] = B (j == 0 ? 1.0f : 0.0f);
    system_.solve (a_);
    B changes[3][ColumnsT::SUPPORT], M[SystemT::MOMENTS], b[SIZE];
    for (int axis = 0; axis < 3; ++axis)
    {
      sum<0, ColumnsT::SUPPORT> (axis, 0, changes[axis]);
      ColumnsT::shift (x_, changes[axis]);
      takeSystem (changes[axis], M, b);
      gradient[axis] = c_[1 + axis];
      for (int i = 0; i < SIZE; ++i)
      {
        B rest = b[i];
        for (int j = 0; j < SIZE; ++j)
          rest = fnma (M[i < j ? at (j, i) : at (i, j)], c_[j], rest);
        if constexpr (CONSTRAINT == Constraint::FUNCTIONAL)
          rest += sums_[ColumnsT::NORMALS + axis * SIZE + i];
        gradient[axis] = xsimd::fma (a_[i], rest, gradient[axis]);
      }
    }
    if constexpr (RAISES_MATTER)
    {
      const B fixed[3] = {B (0.0f), B (0.0f), B (0.0f)};
      subtractRaises<B, TermsT> (gradient, system_, a_, c_, fixed, spread_,
                                 [&] (const B *v, B *of_pivot, B *of_spread)
                                 { sumChanges (changes, v, of_pivot, of_spread); });
    }
  }

  B
  borderOffset (const B *gradient) const
  {
    return offsetAcross (centroid_, gradient);
  }

  /** \brief Weighted mean of an attribute. */
  B
  blend (std::size_t channel) const
  {
    B sum_of_attribute;
    sum<0, 1> (NONE, ColumnsT::COUNT + channel, &sum_of_attribute);
    return sum_of_attribute / weight_;
  }

private:
  using SystemT = LaneSystem<TermsT, B>;
  static constexpr bool RAISES_MATTER = CONSTRAINT == Constraint::FUNCTIONAL;
  static constexpr int NONE = -1;

  /** \brief Interpolates columns from the \a first and FIRST on, or differentiates them along an axis. */
  template <int FIRST, int COUNT>
  void
  sum (int differentiated, std::size_t first, B *sums) const
  {
    constexpr int NOW = SUMS_AT_ONCE<B, COUNT>;
    const auto weight = [&] (int axis, std::size_t i)
    { return axis == differentiated ? axes_[axis].slope (i) : axes_[axis].weight (i); };
    B along_x[LatticeAxis<B>::MOST], added[NOW];
    for (std::size_t i = axes_[0].begin (); i < axes_[0].end (); ++i)
      along_x[i - axes_[0].begin ()] = weight (0, i);
#pragma GCC unroll 32
    for (int c = 0; c < NOW; ++c)
      added[c] = B (0.0f);
    const std::size_t count = axes_[0].end () - axes_[0].begin ();
    for (std::size_t z = axes_[2].begin (); z < axes_[2].end (); ++z)
      for (std::size_t y = axes_[1].begin (); y < axes_[1].end (); ++y)
      {
        const B of_row = weight (2, z) * weight (1, y);
        const std::size_t place = (z * lattice_.sides[1] + y) * lattice_.sides[0] + axes_[0].begin ();
        const float *record = lattice_.sums + place * lattice_.record + first + FIRST;
        for (std::size_t i = 0; i < count; ++i, record += lattice_.record)
        {
          const B of_point = of_row * along_x[i];
#pragma GCC unroll 32
          for (int c = 0; c < NOW; ++c)
            added[c] = xsimd::fma (of_point, B (record[c]), added[c]);
        }
      }
#pragma GCC unroll 32
    for (int c = 0; c < NOW; ++c)
      sums[FIRST + c] = added[c];
    if constexpr (COUNT > NOW)
      sum<FIRST + NOW, COUNT - NOW> (differentiated, first, sums);
  }

  /** \brief M and b of eq. (17), with the products of gradients. */
  static void
  takeSystem (const B *sums, B *M, B *b)
  {
    for (int m = 0; m < SystemT::MOMENTS; ++m)
      M[m] = sums[ColumnsT::PRODUCTS.column[m]];
    for (int j = 0; j < SIZE; ++j)
      b[j] = sums[ColumnsT::HEIGHTS + j];
    if constexpr (CONSTRAINT == Constraint::HERMITE)
    {
      for (int j = 1; j < SIZE; ++j)
        b[j] += sums[ColumnsT::SLOPES + j - 1];
      TermsT::addGradientMoments (M);
    }
  }

  /** \brief Σ w u_a². */
  static B
  squareOf (const B *sums, int axis)
  {
    return sums[ColumnsT::PRODUCTS.column[at (1 + axis, 1 + axis)]];
  }

  /** \brief See NodeChanges. */
  void
  sumChanges (const B (&changes)[3][ColumnsT::SUPPORT], const B *v, B *of_pivot, B *of_spread) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const B *const sums = changes[axis];
      B by_pivot (0.0f), by_spread (0.0f);
      for (int i = 0; i < SIZE; ++i)
        for (int j = 0; j <= i; ++j)
          by_pivot =
              xsimd::fma ((i == j ? v[i] : v[i] + v[i]) * v[j], sums[ColumnsT::PRODUCTS.column[at (i, j)]], by_pivot);
      for (int a = 0; a < 3; ++a)
        by_spread += squareOf (sums, a) + centroid_[a] * fnma (B (2.0f), sums[1 + a], centroid_[a] * sums[0]);
      of_pivot[axis] = by_pivot;
      of_spread[axis] = by_spread;
    }
  }

  const Lattice &lattice_;
  float min_nodes_;
  B x_[3];
  LatticeAxis<B> axes_[3];
  B sums_[ColumnsT::COUNT]; // about x
  SystemT system_;
  B centroid_[3], spread_, weight_;
  B c_[SIZE]; // M^-1 b
  B a_[SIZE]; // M^-1 R(x)
};

} // namespace erkpa::lanes
