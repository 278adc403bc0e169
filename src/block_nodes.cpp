// SPDX-License-Identifier: BSD-3-Clause
#include "block_nodes.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

BlockNodes::BlockNodes (const ImplicitField &field, const lanes::Engine &engine, double unit)
    : field_ (field), table_ (field.nodeTable ()), search_ (*engine.search), index_ (table_.grid->index ()),
      inverse_unit_ (1.0 / unit)
{
}

void
BlockNodes::lookAround (const Eigen::Vector3d &center, double reach)
{
  center_ = center;
  stretches_.clear ();
  looked_for_ = lanes::MAX_WIDTH;
  table_.grid->visitNear (
      center, std::sqrt (static_cast<double> (limitOf (reach))),
      [&] (std::size_t first, std::size_t last)
      {
        stretches_.push_back ({static_cast<std::uint32_t> (first), static_cast<std::uint32_t> (last)});
        looked_for_ += last - first;
      });
}

float
BlockNodes::limitOf (double reach) const
{
  constexpr double ROUNDING = 1e-5; // of a length, in float
  const double all = (reach + field_.largestOffset ()) * (1.0 + ROUNDING);
  return static_cast<float> (all * all);
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
BlockNodes::copyAround (const Eigen::Vector3d &center, double reach)
{
  lookAround (center, reach);
  makeRoom (looked_for_, squared_);
  copyColumns (reach, squared_.data ());
}

void
BlockNodes::copyWithin (double reach)
{
  copyColumns (reach, nullptr);
  addValues ();
}

void
BlockNodes::append (const BlockNodes &from, const std::uint32_t *first, const std::uint32_t *last)
{
  center_ = from.center_;
  makeArrays (count_ + static_cast<std::size_t> (last - first) + lanes::MAX_WIDTH);
  for (; first != last; ++first, ++count_)
  {
    places_[count_] = from.places_[*first];
    for (std::size_t a = 0; a < 3; ++a)
    {
      positions_[a][count_] = from.positions_[a][*first];
      normals_[a][count_] = from.normals_[a][*first];
    }
  }
}

void
BlockNodes::makeArrays (std::size_t nodes)
{
  makeRoom (nodes, places_);
  for (std::size_t a = 0; a < 3; ++a)
  {
    makeRoom (static_cast<std::size_t> (field_.valuesPerNode ()) * nodes, positions_[a]);
    makeRoom (static_cast<std::size_t> (field_.valuesPerNode ()) * nodes, normals_[a]);
  }
}

void
BlockNodes::copyColumns (double reach, float *squared)
{
  makeArrays (looked_for_);
  lanes::Table table{};
  lanes::Copies copies{places_.data (), {}, squared};
  for (std::size_t a = 0; a < 3; ++a)
  {
    table.columns[a] = table_.grid->coordinates (static_cast<int> (a)).data ();
    table.columns[3 + a] = table_.normals[a].data ();
    copies.columns[a] = positions_[a].data ();
    copies.columns[3 + a] = normals_[a].data ();
  }
  const Eigen::Vector3f center = center_.cast<float> ();
  count_ = search_.copyWithin (table, stretches_.data (), stretches_.size (), center.data (), limitOf (reach),
                               static_cast<float> (inverse_unit_), copies);
}

void
BlockNodes::addValues ()
{
  const auto per_node = static_cast<std::size_t> (field_.valuesPerNode ());
  value_points_ = per_node * count_;
  const bool has_values = field_.hasNodeValues () || per_node > 1;
  const bool has_confidences = !table_.confidences.empty ();
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
