// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace erkpa
{

/** \brief Finds the nodes near a point. Queries are const and must be safe from several threads at once.
 *
 * Coordinates are those of OrientedPoints::positions (the local frame). The results' order is free.
 */
class NeighborSearch
{
public:
  using ConstPtr = std::shared_ptr<const NeighborSearch>;

  NeighborSearch () = default;
  NeighborSearch (const NeighborSearch &) = delete;
  NeighborSearch &
  operator= (const NeighborSearch &) = delete;
  virtual ~NeighborSearch () = default;

  /** \brief The \a k nodes nearest to \a x (all of them where there are fewer). */
  virtual void
  nearestK (const Eigen::Vector3f &x, int k, std::vector<int> &indices,
            std::vector<float> &squared_distances) const = 0;

  /** \brief All nodes within \a radius of \a x. */
  virtual void
  withinRadius (const Eigen::Vector3f &x, double radius, std::vector<int> &indices,
                std::vector<float> &squared_distances) const = 0;

  /** \brief Whether withinRadius () gives any two nodes in the same order wherever it is asked. */
  virtual bool
  hasOrder () const
  {
    return false;
  }
};

/** \brief A search over pcl::search::KdTree (KdTreeFLANN).
 * \param[in] positions the nodes, in the local frame; copied
 */
NeighborSearch::ConstPtr
makeKdTreeSearch (const std::vector<Eigen::Vector3f> &positions);

/** \brief The same over shared nodes, which are not copied until the search is asked. */
NeighborSearch::ConstPtr
makeKdTreeSearch (std::shared_ptr<const std::vector<Eigen::Vector3f>> positions);

} // namespace erkpa
