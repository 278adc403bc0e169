// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_columns.h"
#include "lane_engine.h"
#include "lane_lattice_fit.h"

namespace erkpa::lanes
{

/** \brief Sums up what nodes bring to points of a lattice. */
template <typename B, Basis BASIS, Constraint CONSTRAINT>
class LatticeSummer
{
public:
  LatticeSummer (const Settings &settings, const Nodes &nodes, std::size_t stride, float *sums)
      : settings_ (settings), nodes_ (nodes), stride_ (stride), sums_ (sums), columns_ (settings)
  {
  }

  /** \param[in] first place of the point in the first lane */
  void
  take (const LaneSupport<B> &support, std::size_t first)
  {
    const float origin[3] = {0.0f, 0.0f, 0.0f};
    LaneReach<B> reach (settings_, support.radius (), support.squaredRadius ());
    B added[ColumnsT::COUNT];
    for (B &sum : added)
      sum = B (0.0f);
    for (std::size_t i = 0; i < support.size (); i += LaneColumnsT::CHUNK)
    {
      const std::size_t nodes = std::min (LaneColumnsT::CHUNK, support.size () - i);
      columns_.fill (origin, support, i, nodes);
      fillHeights (support, i, nodes);
      columns_.weigh (support, i, nodes, reach);
      columns_.template addTo<0, LaneColumnsT::COLUMNS> (nodes, columns_.of_nodes, added);
      columns_.template addTo<0, HEIGHTS> (nodes, heights_, added + ColumnsT::HEIGHTS);
    }
    added[ColumnsT::SUPPORT] = reach.supportNodes ();
    added[ColumnsT::ON_SURFACE] = reach.nodesOnSurface ();
    added[ColumnsT::NEAR] = reach.nodesInReach ();
    for (std::size_t c = 0; c < ColumnsT::COUNT; ++c)
      added[c].store_unaligned (sums_ + c * stride_ + first);
    const LaneWeights<B, AnyKernel> weights (settings_, support);
    for (std::size_t c = 0; c < nodes_.channels; ++c)
      weights.sum (nodes_.attributes + c * nodes_.count)
          .store_unaligned (sums_ + (ColumnsT::COUNT + c) * stride_ + first);
  }

private:
  using TermsT = Terms<B, BASIS>;
  using ColumnsT = LatticeColumns<TermsT, CONSTRAINT>;
  using LaneColumnsT = LaneColumns<B, BASIS, CONSTRAINT, AnyKernel>;
  static constexpr int HEIGHTS = ColumnsT::SUPPORT - ColumnsT::HEIGHTS;

  /** \brief h R and, for eq. (2), n R of a chunk. */
  void
  fillHeights (const LaneSupport<B> &support, std::size_t first, std::size_t count)
  {
    for (std::size_t i = 0; i < count; i += B::size)
    {
      const B level = B::load_unaligned (columns_.levels + i);
      for (int j = 0; j < TermsT::SIZE; ++j)
      {
        const B term = B::load_unaligned (columns_.of_nodes[j] + i);
        (level * term).store_unaligned (heights_[j] + i);
        if constexpr (CONSTRAINT == Constraint::FUNCTIONAL)
          for (int a = 0; a < 3; ++a)
          {
            const float *const normals = support.near (LaneSupport<B>::NORMAL + static_cast<std::size_t> (a)) + first;
            (B::load_unaligned (normals + i) * term).store_unaligned (heights_[(1 + a) * TermsT::SIZE + j] + i);
          }
      }
    }
  }

  const Settings &settings_;
  const Nodes &nodes_;
  std::size_t stride_;
  float *sums_;
  LaneColumnsT columns_;
  float heights_[HEIGHTS][LaneColumnsT::CHUNK];
};

/** \brief Calls call (basis, constraint) with the settings' as types, which say them as TYPE::value.
 *
 * A lattice is for bases that a shift of the origin leaves what they are, and that lanes need no doubles for.
 */
template <typename CallT>
auto
withBasis (const Settings &settings, CallT call)
{
  const auto with_constraint = [&] (auto basis)
  {
    using BasisT = decltype (basis);
    switch (settings.constraint)
    {
      case Constraint::VALUES:
        return call (BasisT (), std::integral_constant<Constraint, Constraint::VALUES> ());
      case Constraint::FUNCTIONAL:
        return call (BasisT (), std::integral_constant<Constraint, Constraint::FUNCTIONAL> ());
      case Constraint::HERMITE:
        break;
    }
    return call (BasisT (), std::integral_constant<Constraint, Constraint::HERMITE> ());
  };
  return settings.basis == Basis::LINEAR ? with_constraint (std::integral_constant<Basis, Basis::LINEAR> ())
                                         : with_constraint (std::integral_constant<Basis, Basis::SPHERICAL> ());
}

/** \brief See LatticeMethods::columns. */
template <typename ArchT>
std::size_t
latticeColumns (const Settings &settings)
{
  using B = xsimd::batch<float, ArchT>;
  return withBasis (settings,
                    [] (auto basis, auto constraint) -> std::size_t
                    { return LatticeColumns<Terms<B, decltype (basis)::value>, decltype (constraint)::value>::COUNT; });
}

/** \brief See LatticeMethods::sum. */
template <typename ArchT>
void
sumAtLattice (const Settings &settings, const Nodes &nodes, const Points &points, const Scratch &scratch,
              std::size_t stride, float *sums)
{
  using B = xsimd::batch<float, ArchT>;
  withBasis (settings,
             [&] (auto basis, auto constraint)
             {
               const Samples samples{};
               const LaneEngine<B> engine (settings, nodes, points, scratch, samples);
               LatticeSummer<B, decltype (basis)::value, decltype (constraint)::value> summer (settings, nodes, stride,
                                                                                               sums);
               engine.evaluate ([] (const LaneSupport<B> *, std::size_t) {},
                                [&] (std::size_t, const LaneSupport<B> &support, std::size_t first)
                                { summer.take (support, first); });
             });
}

/** \brief See LatticeMethods::shift. */
template <typename ArchT>
void
shiftLattice (const Settings &settings, std::size_t channels, const float *const *steps, const float *sums,
              std::size_t count, std::size_t stride, float *records)
{
  using B = xsimd::batch<float, ArchT>;
  withBasis (
      settings,
      [&] (auto basis, auto constraint)
      {
        using ColumnsT = LatticeColumns<Terms<B, decltype (basis)::value>, decltype (constraint)::value>;
        const std::size_t record = ColumnsT::COUNT + channels;
        for (std::size_t first = 0; first < count; first += B::size)
        {
          B step[3], shifted[ColumnsT::COUNT];
          for (int a = 0; a < 3; ++a)
            step[a] = B::load_unaligned (steps[a] + first);
          for (int c = 0; c < ColumnsT::COUNT; ++c)
            shifted[c] = B::load_unaligned (sums + static_cast<std::size_t> (c) * stride + first);
          ColumnsT::shift (step, shifted);
          const std::size_t points = std::min<std::size_t> (B::size, count - first);
          for (std::size_t c = 0; c < record; ++c)
          {
            float column[B::size];
            (c < ColumnsT::COUNT ? shifted[c] : B::load_unaligned (sums + c * stride + first)).store_unaligned (column);
            for (std::size_t i = 0; i < points; ++i)
              records[(first + i) * record + c] = column[i];
          }
        }
      });
}

/** \brief Stores what a LatticeFit says, in the way of LaneEngine. */
template <typename B, typename FitT>
void
storeLatticeFit (const Settings &settings, FitT &fit, std::size_t channels, std::size_t stride, std::size_t first,
                 const Samples &samples)
{
  const B zero (0.0f), one (1.0f);
  fit.value ().store_unaligned (samples.value + first);
  one.store_unaligned (samples.radius + first);
  if (samples.nearest_distance != nullptr)
    zero.store_unaligned (samples.nearest_distance + first);
  if (samples.aside != nullptr)
    fit.aside ().store_unaligned (samples.aside + first);
  float unsettled[B::size], support[B::size];
  xsimd::select (fit.isUnsettled (), one, zero).store_unaligned (unsettled);
  fit.supportNodes ().store_unaligned (support);
  for (std::size_t i = 0; i < B::size; ++i)
  {
    samples.state[first + i] = unsettled[i] > 0.5f ? State::UNSETTLED : State::DEFINED;
    samples.in_reach[first + i] = 1;
    samples.support[first + i] = static_cast<std::uint32_t> (support[i] > 0.0f ? support[i] + 0.5f : 0.0f);
    if (samples.active != nullptr)
      samples.active[first + i] = 0;
  }
  if (!settings.gradients)
    return;
  B gradient[3];
  fit.gradient (gradient);
  for (int a = 0; a < 3; ++a)
  {
    gradient[a].store_unaligned (samples.gradient[a] + first);
    if (samples.radius_gradient[a] != nullptr)
      zero.store_unaligned (samples.radius_gradient[a] + first);
  }
  fit.borderOffset (gradient).store_unaligned (samples.border_offset + first);
  for (std::size_t c = 0; c < channels; ++c)
    fit.blend (c).store_unaligned (samples.attributes + c * stride + first);
}

/** \brief See LatticeMethods::interpolate. */
template <typename ArchT>
void
interpolate (const Settings &settings, const Lattice &lattice, const Points &points, const Samples &samples)
{
  using B = xsimd::batch<float, ArchT>;
  withBasis (settings,
             [&] (auto basis, auto constraint)
             {
               for (std::size_t first = 0; first < points.count; first += B::size)
               {
                 const B x[] = {B::load_unaligned (points.x + first), B::load_unaligned (points.y + first),
                                B::load_unaligned (points.z + first)};
                 LatticeFit<B, decltype (basis)::value, decltype (constraint)::value> fit (settings, lattice, x);
                 storeLatticeFit<B> (settings, fit, lattice.channels, points.stride, first, samples);
               }
             });
}

template <typename ArchT>
constexpr LatticeMethods LATTICE{latticeColumns<ArchT>, sumAtLattice<ArchT>, shiftLattice<ArchT>, interpolate<ArchT>};

} // namespace erkpa::lanes
