// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "text_scanner.h"

#include <Eigen/Core>
#include <pcl/PCLPointCloud2.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace erkpa::tool
{

/** \brief Appends a field to the layout of a cloud.
 * \param[in] datatype a pcl::PCLPointField::PointFieldTypes
 */
void
appendField (pcl::PCLPointCloud2 &cloud, const std::string &name, std::uint8_t datatype, std::uint32_t count = 1);

/** \brief Bytes of a value of a type; 0 where there is no such type. */
std::size_t
sizeOfType (std::uint8_t datatype);

/** \brief Appends nx ny nz to every point; nothing for no normals. */
void
appendNormals (const std::vector<Eigen::Vector3d> &normals, pcl::PCLPointCloud2 &cloud);

/** \brief Number of columns a row of text has. */
std::size_t
columnsOf (const pcl::PCLPointCloud2 &cloud);

/** \brief Reads rows of text, up to the end or \a most of them, as the fields of \a cloud ask: one column per value.
 *
 * On all processors. Errors are those of the first row that has one.
 * \return how many there were
 */
std::size_t
readRows (TextScanner &scanner, std::size_t most, pcl::PCLPointCloud2 &cloud);

/** \brief Reads \a count rows, no fewer. */
void
requireRows (TextScanner &scanner, std::size_t count, pcl::PCLPointCloud2 &cloud);

/** \brief Reads one field of any numeric type. */
class FieldReader
{
public:
  FieldReader () = default;

  /** \param[in] names the field's possible names, the first that exists is taken */
  FieldReader (const pcl::PCLPointCloud2 &cloud, const std::vector<std::string> &names);

  bool
  exists () const
  {
    return cloud_ != nullptr;
  }

  std::uint8_t
  datatype () const
  {
    return datatype_;
  }

  std::size_t
  offset () const
  {
    return offset_;
  }

  double
  operator() (std::size_t point) const;

  /** \brief The first four bytes of the value: colours are packed into floats. */
  std::uint32_t
  bits (std::size_t point) const;

private:
  const pcl::PCLPointCloud2 *cloud_ = nullptr;
  std::size_t offset_ = 0;
  std::uint8_t datatype_ = 0;
};

} // namespace erkpa::tool
