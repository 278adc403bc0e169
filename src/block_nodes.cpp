// SPDX-License-Identifier: BSD-3-Clause
#include "block_nodes.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

namespace
{

/** \brief Calls take (i, place) for each place; where many follow each other, in a loop that a compiler makes vectors
 * of. */
template <typename TakeT>
void
visitPlaces (const std::vector<std::uint32_t> &places, std::size_t count, TakeT take)
{
  constexpr std::uint32_t RUN = 8;
  for (std::size_t i = 0; i < count; i += RUN)
  {
    const std::uint32_t first = places[i];
    if (i + RUN <= count && places[i + RUN - 1] - first == RUN - 1)
      for (std::uint32_t j = 0; j < RUN; ++j)
        take (i + j, first + j);
    else
      for (std::size_t j = i; j < std::min (i + RUN, count); ++j)
        take (j, places[j]);
  }
}

} // namespace

BlockNodes::BlockNodes (const ImplicitField &field, const lanes::Engine &engine, double unit)
    : field_ (field), table_ (field.nodeTable ()), search_ (*engine.search), index_ (table_.grid->index ()),
      inverse_unit_ (1.0 / unit)
{
}

void
BlockNodes::find (const Eigen::Vector3d &center, double reach)
{
  center_ = center;
  const float limit = limitOf (reach);
  const PointGrid &grid = *table_.grid;
  stretches_.clear ();
  std::size_t most = lanes::MAX_WIDTH;
  grid.visitNear (center, std::sqrt (static_cast<double> (limit)),
                  [&] (std::size_t first, std::size_t last)
                  {
                    stretches_.push_back ({static_cast<std::uint32_t> (first), static_cast<std::uint32_t> (last)});
                    most += last - first;
                  });
  if (places_.size () < most || squared_.size () < most)
  {
    places_.resize (2 * most);
    squared_.resize (2 * most);
  }
  const Eigen::Vector3f middle = center.cast<float> ();
  const lanes::Cloud cloud{grid.coordinates (0).data (), grid.coordinates (1).data (), grid.coordinates (2).data ()};
  count_ = search_.findWithin (cloud, stretches_.data (), stretches_.size (), middle.data (), limit,
                               {places_.data (), squared_.data ()});
}

float
BlockNodes::limitOf (double reach) const
{
  constexpr double ROUNDING = 1e-5; // of a length, in float
  const double all = (reach + field_.largestOffset ()) * (1.0 + ROUNDING);
  return static_cast<float> (all * all);
}

void
BlockNodes::keepWithin (double reach)
{
  count_ = search_.keepWithin ({places_.data (), squared_.data ()}, count_, limitOf (reach));
}

double
BlockNodes::boundOfKth (std::size_t k, double guess) const
{
  constexpr int PER_DOUBLING = 32;
  const auto distance_at = [] (int step) { return std::exp2 (static_cast<double> (step) / PER_DOUBLING); };
  const auto has_k = [&] (int step)
  {
    const double distance = distance_at (step);
    return search_.countWithin (squared_.data (), count_, static_cast<float> (distance * distance)) >= k;
  };
  int high = static_cast<int> (std::floor (std::log2 (guess) * PER_DOUBLING)),
      wide = PER_DOUBLING / 4; // most guesses are good
  if (!has_k (high))
    return HUGE_VAL;
  int low = high - wide;
  for (; distance_at (low) > 0.0 && has_k (low); low -= wide *= 2)
    high = low;
  while (high - low > 1)
    (has_k (low + (high - low) / 2) ? high : low) = low + (high - low) / 2;
  return distance_at (high);
}

void
BlockNodes::copy ()
{
  const auto per_node = static_cast<std::size_t> (field_.valuesPerNode ());
  value_points_ = per_node * count_;
  const bool has_values = field_.hasNodeValues () || per_node > 1;
  const bool has_confidences = !table_.confidences.empty ();
  copyPositions ();
  for (std::size_t a = 0; a < 3; ++a)
  {
    normals_[a].resize (value_points_);
    float *const to = normals_[a].data ();
    const float *const from = table_.normals[a].data ();
    visitPlaces (places_, count_, [=] (std::size_t i, std::uint32_t place) { to[i] = from[place]; });
  }
  confidences_.resize (has_confidences ? value_points_ : 0);
  for (std::size_t i = 0; i < confidences_.size (); ++i)
    confidences_[i] = table_.confidences[places_[i % count_]];
  lambdas_.resize (has_values ? value_points_ : 0);
  for (std::size_t i = 0; i < lambdas_.size (); ++i)
    lambdas_[i] = static_cast<float> (inverse_unit_ * field_.nodeValue (node (i % count_), sideOf (i)));
  for (std::size_t i = count_; i < value_points_; ++i)
    for (std::size_t a = 0; a < 3; ++a)
    {
      normals_[a][i] = normals_[a][i % count_];
      const auto offset = static_cast<float> (sideOf (i) * inverse_unit_ * field_.offsetOf (node (i % count_)));
      positions_[a][i] = positions_[a][i % count_] + offset * normals_[a][i];
    }
}

void
BlockNodes::copyPositions ()
{
  const auto per_node = static_cast<std::size_t> (field_.valuesPerNode ());
  const auto scale = static_cast<float> (inverse_unit_);
  for (std::size_t a = 0; a < 3; ++a)
  {
    positions_[a].resize (per_node * count_ + lanes::MAX_WIDTH);
    float *const to = positions_[a].data ();
    const float *const from = table_.grid->coordinates (static_cast<int> (a)).data ();
    const auto center = static_cast<float> (center_[static_cast<Eigen::Index> (a)]);
    visitPlaces (places_, count_,
                 [=] (std::size_t i, std::uint32_t place) { to[i] = (from[place] - center) * scale; });
  }
}

void
BlockNodes::copyAttributes ()
{
  const OrientedPoints &points = field_.points ();
  const auto channels = static_cast<std::size_t> (points.channels);
  attributes_.resize (channels * value_points_);
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t i = 0; i < value_points_; ++i)
      attributes_[c * value_points_ + i] =
          points.attributes[static_cast<std::size_t> (node (i % count_)) * channels + c];
}

lanes::Nodes
BlockNodes::view (bool attributes) const
{
  lanes::Nodes nodes{};
  nodes.count = value_points_;
  nodes.on_surface = count_;
  nodes.x = positions_[0].data ();
  nodes.y = positions_[1].data ();
  nodes.z = positions_[2].data ();
  nodes.nx = normals_[0].data ();
  nodes.ny = normals_[1].data ();
  nodes.nz = normals_[2].data ();
  nodes.lambda = lambdas_.empty () ? nullptr : lambdas_.data ();
  nodes.confidence = confidences_.empty () ? nullptr : confidences_.data ();
  nodes.attributes = attributes_.data ();
  nodes.channels = attributes ? static_cast<std::size_t> (field_.points ().channels) : 0;
  return nodes;
}

} // namespace erkpa
