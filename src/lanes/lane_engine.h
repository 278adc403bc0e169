// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_enriched_fit.h"
#include "lane_fit.h"
#include "lane_moments.h"

namespace erkpa::lanes
{

/** \brief Evaluates point after point, so many at once as there are lanes. */
template <typename B>
class LaneEngine
{
public:
  /** \brief At most so many vectors of points share a list of nodes. */
  static constexpr std::size_t SHARED = 4;

  LaneEngine (const Settings &settings, const Nodes &nodes, const Points &points, const Scratch &scratch,
              const Samples &samples)
      : settings_ (settings), nodes_ (nodes), points_ (points), scratch_ (scratch), samples_ (samples)
  {
  }

  /** \param[in] prepare prepare (supports, count) is told of the supports that are taken next
   * \param[in] take take (s, support, first point) makes the fit there and stores it
   */
  template <typename PrepareT, typename TakeT>
  void
  evaluate (PrepareT prepare, TakeT take) const
  {
    // Supports of k nodes differ too much for one list.
    const std::size_t together = settings_.k > 0 ? 1 : SHARED;
    LaneSupport<B> supports[SHARED];
    for (std::size_t first = 0; first < points_.count; first += together * B::size)
    {
      std::size_t count = 0;
      for (std::size_t at = first; count < together && at < points_.count; at += B::size)
        supports[count++].moveTo (settings_, nodes_, points_, at, scratch_);
      LaneSupport<B>::listNodes (supports, count);
      prepare (supports, count);
      for (std::size_t s = 0; s < count; ++s)
        take (s, supports[s], first + s * B::size);
    }
  }

  /** \brief Store what a fit, LaneFit or LaneEnrichedFit, says. */
  template <typename FitT>
  void
  store (const LaneSupport<B> &support, FitT &fit, std::size_t first) const
  {
    const B nan (__builtin_nanf (""));
    const B value = xsimd::select (fit.isDefined (), fit.value (), nan);
    support.radius ().store_unaligned (samples_.radius + first);
    value.store_unaligned (samples_.value + first);
    const B one (1.0f), zero (0.0f);
    const B near = xsimd::select (fit.reach ().isInReach (), one, zero);
    B state = xsimd::select (fit.isDefined (), zero, one);
    storeFit (fit, first);
    if (settings_.gradients)
      storeGradients (support, fit, first, state);
    state = xsimd::select (support.isShort (), B (3.0f), state);
    storeBytes (near, state, fit, first);
    if (samples_.nearest != nullptr)
      storeNearest (support.nodeAt (fit.reach ().squaredNearest ()), first);
  }

  /** \brief Leave the points of a vector to LocalField. */
  void
  leaveOpen (std::size_t first) const
  {
    for (std::size_t i = first; i < first + B::size; ++i)
    {
      samples_.state[i] = State::UNSETTLED;
      samples_.support[i] = samples_.active[i] = 0;
    }
  }

private:
  template <typename FitT>
  void
  storeFit (const FitT &fit, std::size_t first) const
  {
    if (samples_.nearest_distance != nullptr)
      xsimd::sqrt (fit.reach ().squaredNearest ()).store_unaligned (samples_.nearest_distance + first);
    if (samples_.aside != nullptr)
      fit.aside ().store_unaligned (samples_.aside + first);
    for (int j = 0; j < (samples_.coefficients != nullptr ? FitT::SIZE : 0); ++j)
      fit.coefficient (j).store_unaligned (samples_.coefficients + static_cast<std::size_t> (j) * points_.stride +
                                           first);
  }

  template <typename FitT>
  void
  storeGradients (const LaneSupport<B> &support, FitT &fit, std::size_t first, B &state) const
  {
    B growth[3] = {B (0.0f), B (0.0f), B (0.0f)}, gradient[3];
    if (points_.growth[0] != nullptr)
      for (int a = 0; a < 3; ++a)
        growth[a] = B::load_unaligned (points_.growth[a] + first);
    if (settings_.k > 0)
      support.radiusGradient (growth);
    fit.gradient (growth, gradient);
    for (int a = 0; a < 3; ++a)
      gradient[a].store_unaligned (samples_.gradient[a] + first);
    for (int a = 0; a < (samples_.radius_gradient[0] != nullptr ? 3 : 0); ++a)
      growth[a].store_unaligned (samples_.radius_gradient[a] + first);
    fit.borderOffset (gradient).store_unaligned (samples_.border_offset + first);
    for (std::size_t c = 0; c < nodes_.channels; ++c)
      fit.blend (nodes_.attributes + c * nodes_.count)
          .store_unaligned (samples_.attributes + c * points_.stride + first);
    state = xsimd::select (fit.isUnsettled () && state < B (0.5f), B (2.0f), state);
  }

  template <typename FitT>
  void
  storeBytes (B near, B state, const FitT &fit, std::size_t first) const
  {
    float nears[B::size], states[B::size], support[B::size];
    near.store_unaligned (nears);
    state.store_unaligned (states);
    fit.reach ().supportNodes ().store_unaligned (support);
    for (std::size_t i = 0; i < B::size; ++i)
    {
      samples_.in_reach[first + i] = nears[i] > 0.5f ? 1 : 0;
      samples_.state[first + i] = static_cast<State> (static_cast<int> (states[i]));
      samples_.support[first + i] = static_cast<std::uint32_t> (support[i]);
    }
    if (samples_.active != nullptr)
      for (std::size_t i = 0; i < B::size; ++i)
        samples_.active[first + i] = 0;
    if constexpr (FitT::IS_ENRICHED)
      storeActive (fit, first);
  }

  void
  storeNearest (B node, std::size_t first) const
  {
    float nodes[B::size];
    node.store_unaligned (nodes);
    for (std::size_t i = 0; i < B::size; ++i)
      samples_.nearest[first + i] = static_cast<std::uint32_t> (nodes[i]);
  }

  template <typename FitT>
  void
  storeActive (const FitT &fit, std::size_t first) const
  {
    for (int s = 0; s < fit.kinks ().surfaces (); ++s)
    {
      float active[B::size];
      fit.kinks ().isActive (s).store_unaligned (active);
      for (std::size_t i = 0; i < B::size; ++i)
        samples_.active[first + i] |= active[i] > 0.5f ? 1u << fit.kinks ().number (s) : 0u;
    }
  }

  const Settings &settings_;
  const Nodes &nodes_;
  const Points &points_;
  const Scratch &scratch_;
  const Samples &samples_;
};

template <typename B, Basis BASIS, Constraint CONSTRAINT, template <typename> class KernelT>
void
evaluateWith (const Settings &settings, const Nodes &nodes, const Points &points, const Scratch &scratch,
              const Samples &samples)
{
  const LaneEngine<B> engine (settings, nodes, points, scratch, samples);
  LaneMoments<B, BASIS, CONSTRAINT, KernelT> moments (settings);
  engine.evaluate ([&] (const LaneSupport<B> *supports, std::size_t count) { moments.sum (supports, count); },
                   [&] (std::size_t s, const LaneSupport<B> &support, std::size_t first)
                   {
                     LaneFit<B, BASIS, CONSTRAINT, KernelT> fit (settings, support, moments.reach (s),
                                                                 moments.system (s));
                     engine.store (support, fit, first);
                   });
}

template <typename B, Basis BASIS, Constraint CONSTRAINT, LaneEnrichment FORM, template <typename> class KernelT>
void
evaluateEnriched (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
                  const Scratch &scratch, const Samples &samples)
{
  const LaneEngine<B> engine (settings, nodes, points, scratch, samples);
  const auto take_with = [&] (auto fit, const LaneSupport<B> &support, std::size_t first)
  { engine.store (support, fit, first); };
  LaneMoments<B, BASIS, CONSTRAINT, KernelT> moments (settings);
  engine.evaluate (
      [] (const LaneSupport<B> *, std::size_t) {},
      [&] (std::size_t, const LaneSupport<B> &support, std::size_t first)
      {
        const LaneSurfaces<B> near (sharp, first, support);
        if (!near.has_all)
        {
          engine.leaveOpen (first);
          return;
        }
        if (near.count == 0)
        {
          moments.sum (&support, 1);
          take_with (LaneFit<B, BASIS, CONSTRAINT, KernelT> (settings, support, moments.reach (0), moments.system (0)),
                     support, first);
          return;
        }
        if constexpr (CONSTRAINT == Constraint::HERMITE) // the default, of which one surface is worth a case of its own
          if (near.count == 1)
          {
            take_with (
                LaneEnrichedFit<B, BASIS, CONSTRAINT, KernelT, FORM, 1> (settings, near, first, support, moments),
                support, first);
            return;
          }
        take_with (
            LaneEnrichedFit<B, BASIS, CONSTRAINT, KernelT, FORM, ANY_COUNT> (settings, near, first, support, moments),
            support, first);
      });
}

template <typename B, Basis BASIS, template <typename> class KernelT>
void
evaluateEnriched (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
                  const Scratch &scratch, const Samples &samples)
{
  constexpr Constraint HERMITE = Constraint::HERMITE, FUNCTIONAL = Constraint::FUNCTIONAL;
  const auto with = [&] (auto evaluate) { evaluate (settings, nodes, points, sharp, scratch, samples); };
  if (settings.constraint != FUNCTIONAL)
    with (evaluateEnriched<B, BASIS, HERMITE, LaneEnrichment::KINKS_AND_SQUARES, KernelT>);
  else if (sharp.jumps)
    with (evaluateEnriched<B, BASIS, FUNCTIONAL, LaneEnrichment::JUMPS, KernelT>);
  else
    with (evaluateEnriched<B, BASIS, FUNCTIONAL, LaneEnrichment::KINKS, KernelT>);
}

template <typename B, Basis BASIS>
void
evaluateEnriched (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
                  const Scratch &scratch, const Samples &samples)
{
  if (settings.kernel == Kernel::PAPER)
    evaluateEnriched<B, BASIS, PaperKernel> (settings, nodes, points, sharp, scratch, samples);
  else
    evaluateEnriched<B, BASIS, AnyKernel> (settings, nodes, points, sharp, scratch, samples);
}

template <typename B, Basis BASIS, Constraint CONSTRAINT>
void
evaluateWith (const Settings &settings, const Nodes &nodes, const Points &points, const Scratch &scratch,
              const Samples &samples)
{
  constexpr bool IS_COMMON = BASIS == Basis::LINEAR || BASIS == Basis::SPHERICAL;
  if constexpr (IS_COMMON)
    if (settings.kernel == Kernel::PAPER && settings.stretch == 0.0f)
    {
      evaluateWith<B, BASIS, CONSTRAINT, PaperKernel> (settings, nodes, points, scratch, samples);
      return;
    }
  evaluateWith<B, BASIS, CONSTRAINT, AnyKernel> (settings, nodes, points, scratch, samples);
}

template <typename B, Basis BASIS>
void
evaluateWith (const Settings &settings, const Nodes &nodes, const Points &points, const Scratch &scratch,
              const Samples &samples)
{
  switch (settings.constraint)
  {
    case Constraint::HERMITE:
      evaluateWith<B, BASIS, Constraint::HERMITE> (settings, nodes, points, scratch, samples);
      break;
    case Constraint::VALUES:
      evaluateWith<B, BASIS, Constraint::VALUES> (settings, nodes, points, scratch, samples);
      break;
    case Constraint::FUNCTIONAL:
      evaluateWith<B, BASIS, Constraint::FUNCTIONAL> (settings, nodes, points, scratch, samples);
      break;
  }
}

/** \brief What an Engine does, in vectors of one instruction set. */
template <typename ArchT>
void
evaluate (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
          const Scratch &scratch, const Samples &samples)
{
  using B = xsimd::batch<float, ArchT>;
  if (sharp.count > 0)
  {
    if (settings.basis == Basis::LINEAR)
      evaluateEnriched<B, Basis::LINEAR> (settings, nodes, points, sharp, scratch, samples);
    else
      evaluateEnriched<B, Basis::SPHERICAL> (settings, nodes, points, sharp, scratch, samples);
    return;
  }
  switch (settings.basis)
  {
    case Basis::CONSTANT: // has no gradient to fit: FieldFit takes the functional value for the Hermite constraint
      if (settings.constraint == Constraint::VALUES)
        evaluateWith<B, Basis::CONSTANT, Constraint::VALUES> (settings, nodes, points, scratch, samples);
      else
        evaluateWith<B, Basis::CONSTANT, Constraint::FUNCTIONAL> (settings, nodes, points, scratch, samples);
      break;
    case Basis::LINEAR:
      evaluateWith<B, Basis::LINEAR> (settings, nodes, points, scratch, samples);
      break;
    case Basis::SPHERICAL:
      evaluateWith<B, Basis::SPHERICAL> (settings, nodes, points, scratch, samples);
      break;
    case Basis::QUADRATIC:
      evaluateWith<B, Basis::QUADRATIC> (settings, nodes, points, scratch, samples);
      break;
  }
}

} // namespace erkpa::lanes
