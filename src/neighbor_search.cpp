// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/neighbor_search.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

namespace erkpa
{

namespace
{

class KdTreeSearch : public NeighborSearch
{
public:
  explicit KdTreeSearch (const std::vector<Eigen::Vector3f> &positions) : tree_ (false)
  {
    const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud (new pcl::PointCloud<pcl::PointXYZ>);
    cloud->reserve (positions.size ());
    for (const Eigen::Vector3f &p : positions)
      cloud->push_back (pcl::PointXYZ (p.x (), p.y (), p.z ()));
    tree_.setInputCloud (cloud);
  }

  void
  nearestK (const Eigen::Vector3f &x, int k, std::vector<int> &indices,
            std::vector<float> &squared_distances) const override
  {
    tree_.nearestKSearch (pcl::PointXYZ (x.x (), x.y (), x.z ()), k, indices, squared_distances);
  }

  void
  withinRadius (const Eigen::Vector3f &x, double radius, std::vector<int> &indices,
                std::vector<float> &squared_distances) const override
  {
    tree_.radiusSearch (pcl::PointXYZ (x.x (), x.y (), x.z ()), radius, indices, squared_distances);
  }

private:
  pcl::search::KdTree<pcl::PointXYZ> tree_;
};

} // namespace

NeighborSearch::ConstPtr
makeKdTreeSearch (const std::vector<Eigen::Vector3f> &positions)
{
  return std::make_shared<KdTreeSearch> (positions);
}

} // namespace erkpa
