// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief Neighbours of a point with weights for a fit; memory of one thread. */
struct Neighborhood
{
  std::vector<int> nodes;
  std::vector<Eigen::Vector3f> positions;
  std::vector<float> weights;

  // of the query
  std::vector<int> indices;
  std::vector<float> squared_distances;
  std::vector<std::pair<float, int>> order;

  /** \brief Of the \a k nearest nodes of \a x those for which keep (node) says so, in no order, all of weight 1. */
  template <typename KeepT>
  void
  gather (const NeighborSearch &search, const std::vector<Eigen::Vector3f> &all, const Eigen::Vector3f &x, int k,
          KeepT keep)
  {
    search.nearestK (x, k, indices, squared_distances);
    nodes.clear ();
    positions.clear ();
    for (const int node : indices)
    {
      if (!keep (static_cast<std::size_t> (node)))
        continue;
      nodes.push_back (node);
      positions.push_back (all[static_cast<std::size_t> (node)]);
    }
    weights.assign (nodes.size (), 1.0f);
  }

  /** \brief Bring what was gathered into the order of the distances from \a x, nearest first. */
  void
  sort (const std::vector<Eigen::Vector3f> &all, const Eigen::Vector3f &x)
  {
    order.clear ();
    for (std::size_t j = 0; j < nodes.size (); ++j)
      order.emplace_back ((positions[j] - x).squaredNorm (), nodes[j]);
    std::sort (order.begin (), order.end ());
    for (std::size_t j = 0; j < nodes.size (); ++j)
    {
      nodes[j] = order[j].second;
      positions[j] = all[static_cast<std::size_t> (nodes[j])];
    }
  }
};

} // namespace erkpa
