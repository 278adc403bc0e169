// SPDX-License-Identifier: BSD-3-Clause
#include "float_cloud.h"

#include "../threads.h"
#include "point_fields.h"
#include "tool_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

namespace erkpa::tool
{

namespace
{

using Field = pcl::PCLPointField;
using Triple = std::array<FieldReader, 3>;

bool
allExist (const Triple &fields)
{
  return std::all_of (fields.begin (), fields.end (), [] (const FieldReader &field) { return field.exists (); });
}

Triple
positionFields (const pcl::PCLPointCloud2 &cloud)
{
  return {FieldReader (cloud, {"x"}), FieldReader (cloud, {"y"}), FieldReader (cloud, {"z"})};
}

std::size_t
sizeOf (const pcl::PCLPointCloud2 &cloud)
{
  return static_cast<std::size_t> (cloud.width) * cloud.height;
}

/** \brief The colours of a cloud: packed into one field as PCL does, or one field for each channel. */
class ColourReader
{
public:
  explicit ColourReader (const pcl::PCLPointCloud2 &cloud)
      : packed_ (cloud, {"rgb", "rgba"}), channels_{FieldReader (cloud, {"red", "diffuse_red", "r"}),
                                                    FieldReader (cloud, {"green", "diffuse_green", "g"}),
                                                    FieldReader (cloud, {"blue", "diffuse_blue", "b"})},
        is_packed_ (packed_.exists () && sizeOfType (packed_.datatype ()) == sizeof (std::uint32_t))
  {
  }

  bool
  exists () const
  {
    return is_packed_ || allExist (channels_);
  }

  /** \brief 0xrrggbb */
  std::uint32_t
  operator() (std::size_t point) const
  {
    if (is_packed_)
      return packed_.bits (point) & 0xffffffu;
    return (brightness (channels_[0], point) << 16) | (brightness (channels_[1], point) << 8) |
           brightness (channels_[2], point);
  }

private:
  static std::uint32_t
  brightness (const FieldReader &channel, std::size_t point)
  {
    double value = channel (point);
    if (channel.datatype () == Field::FLOAT32 || channel.datatype () == Field::FLOAT64)
      value *= 255.0;
    else if (channel.datatype () == Field::UINT16)
      value /= 257.0;
    return value > 0.0 ? static_cast<std::uint32_t> (std::lround (std::min (value, 255.0))) : 0u;
  }

  FieldReader packed_;
  Triple channels_;
  bool is_packed_;
};

/** \brief " x y z": the names of the fields of a cloud. */
std::string
namesOf (const pcl::PCLPointCloud2 &cloud)
{
  std::string names;
  for (const Field &field : cloud.fields)
    names += " " + field.name;
  return names;
}

/** \brief The fields of \a cloud that are numbers, in the order of the result, whose layout is begun. */
std::vector<FieldReader>
takeNumbers (const pcl::PCLPointCloud2 &cloud, const std::vector<std::string> &others, pcl::PCLPointCloud2 &result)
{
  std::vector<FieldReader> fields;
  const auto take = [&] (const Triple &triple, const std::string &prefix)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      fields.push_back (triple[a]);
      appendField (result, prefix + "xyz"[a], Field::FLOAT32);
    }
  };
  take (positionFields (cloud), "");
  const Triple normal = {FieldReader (cloud, {"normal_x", "nx"}), FieldReader (cloud, {"normal_y", "ny"}),
                         FieldReader (cloud, {"normal_z", "nz"})};
  if (allExist (normal))
    take (normal, "normal_");
  const FieldReader intensity (cloud, {"intensity"});
  if (intensity.exists ())
  {
    fields.push_back (intensity);
    appendField (result, "intensity", Field::FLOAT32);
  }
  for (const std::string &name : others)
  {
    if (name.empty () || FieldReader (result, {name}).exists ())
      continue;
    const FieldReader other (cloud, {name});
    if (!other.exists ())
      throw ToolError ("the points have no field " + name + "; they have" + namesOf (cloud));
    fields.push_back (other);
    appendField (result, name, Field::FLOAT32);
  }
  return fields;
}

} // namespace

std::vector<Eigen::Vector3d>
positionsOf (const pcl::PCLPointCloud2 &cloud)
{
  const Triple xyz = positionFields (cloud);
  std::vector<Eigen::Vector3d> positions (sizeOf (cloud));
  for (std::size_t i = 0; i < positions.size (); ++i)
    positions[i] = Eigen::Vector3d (xyz[0](i), xyz[1](i), xyz[2](i));
  return positions;
}

namespace
{

/** \brief Whether the fields of the cloud lie as those of the result already, but for their names. */
bool
hasLayoutOf (const pcl::PCLPointCloud2 &result, const std::vector<FieldReader> &numbers,
             const pcl::PCLPointCloud2 &cloud)
{
  bool is_same = cloud.point_step == result.point_step && cloud.fields.size () == result.fields.size () &&
                 numbers.size () == result.fields.size ();
  for (std::size_t n = 0; n < numbers.size () && is_same; ++n)
    is_same = numbers[n].datatype () == Field::FLOAT32 && numbers[n].offset () == result.fields[n].offset;
  return is_same;
}

} // namespace

pcl::PCLPointCloud2
toFloatFields (pcl::PCLPointCloud2 cloud, const std::vector<std::string> &others)
{
  pcl::PCLPointCloud2 result;
  const std::vector<FieldReader> numbers = takeNumbers (cloud, others, result);
  const ColourReader colour (cloud);
  if (colour.exists ())
    appendField (result, "rgb", Field::FLOAT32);
  result.width = cloud.width;
  result.height = cloud.height;
  result.row_step = result.width * result.point_step;
  if (hasLayoutOf (result, numbers, cloud))
  {
    result.data.swap (cloud.data);
    return result;
  }
  result.data.resize (sizeOf (cloud) * result.point_step);
  const auto convert = [&] (std::size_t i)
  {
    std::uint8_t *const to = result.data.data () + i * result.point_step;
    for (std::size_t n = 0; n < numbers.size (); ++n)
    {
      const auto value = static_cast<float> (numbers[n](i));
      std::memcpy (to + n * sizeof (value), &value, sizeof (value));
    }
    if (colour.exists ())
    {
      const std::uint32_t value = colour (i);
      std::memcpy (to + numbers.size () * sizeof (value), &value, sizeof (value));
    }
  };
  parallelRanges (sizeOf (cloud), 0,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t i = first; i < last; ++i)
                      convert (i);
                  });
  return result;
}

double
largestRounding (const pcl::PCLPointCloud2 &cloud)
{
  double largest = 0.0;
  for (const FieldReader &coordinate : positionFields (cloud))
  {
    for (std::size_t i = 0; i < sizeOf (cloud) && coordinate.datatype () != Field::FLOAT32; ++i)
    {
      const double value = coordinate (i);
      const double error = std::abs (value - static_cast<double> (static_cast<float> (value)));
      largest = error > largest ? error : largest; // false for what is not finite
    }
  }
  return largest;
}

} // namespace erkpa::tool
