// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/neighbor_search.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <memory>
#include <mutex>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief The tree is made when it is first asked: blocks of a plain field do without it. */
class KdTreeSearch : public NeighborSearch
{
public:
  explicit KdTreeSearch (std::shared_ptr<const std::vector<Eigen::Vector3f>> positions)
      : positions_ (std::move (positions)), tree_ (false)
  {
  }

  void
  nearestK (const Eigen::Vector3f &x, int k, std::vector<int> &indices,
            std::vector<float> &squared_distances) const override
  {
    tree ().nearestKSearch (pcl::PointXYZ (x.x (), x.y (), x.z ()), k, indices, squared_distances);
  }

  void
  withinRadius (const Eigen::Vector3f &x, double radius, std::vector<int> &indices,
                std::vector<float> &squared_distances) const override
  {
    tree ().radiusSearch (pcl::PointXYZ (x.x (), x.y (), x.z ()), radius, indices, squared_distances);
  }

private:
  const pcl::search::KdTree<pcl::PointXYZ> &
  tree () const
  {
    std::call_once (is_made_, [this] { makeTree (); });
    return tree_;
  }

  void
  makeTree () const
  {
    const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud (new pcl::PointCloud<pcl::PointXYZ>);
    cloud->reserve (positions_->size ());
    for (const Eigen::Vector3f &p : *positions_)
      cloud->push_back (pcl::PointXYZ (p.x (), p.y (), p.z ()));
    tree_.setInputCloud (cloud);
    positions_.reset ();
  }

  mutable std::once_flag is_made_;
  mutable std::shared_ptr<const std::vector<Eigen::Vector3f>> positions_; // until the tree is made
  mutable pcl::search::KdTree<pcl::PointXYZ> tree_;
};

} // namespace

NeighborSearch::ConstPtr
makeKdTreeSearch (const std::vector<Eigen::Vector3f> &positions)
{
  return makeKdTreeSearch (std::make_shared<const std::vector<Eigen::Vector3f>> (positions));
}

NeighborSearch::ConstPtr
makeKdTreeSearch (std::shared_ptr<const std::vector<Eigen::Vector3f>> positions)
{
  return std::make_shared<KdTreeSearch> (std::move (positions));
}

} // namespace erkpa
