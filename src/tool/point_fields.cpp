// SPDX-License-Identifier: BSD-3-Clause
#include "point_fields.h"

#include "../field_type.h"
#include "../threads.h"
#include "tool_error.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <type_traits>

namespace erkpa::tool
{

namespace
{

using Field = pcl::PCLPointField;

template <typename T>
T
load (const std::uint8_t *from)
{
  T value;
  std::memcpy (&value, from, sizeof (T));
  return value;
}

/** \brief A number as the bytes of a type; what an integer type cannot hold becomes its nearest value.
 * \return where the next one goes
 */
template <typename T>
std::uint8_t *
store (double value, std::uint8_t *to)
{
  constexpr auto LEAST = static_cast<double> (std::numeric_limits<T>::lowest ());
  constexpr auto MOST = static_cast<double> (std::numeric_limits<T>::max ());
  T stored = value >= MOST ? std::numeric_limits<T>::max () : std::numeric_limits<T>::lowest ();
  if (std::is_floating_point_v<T> || (value > LEAST && value < MOST))
    stored = static_cast<T> (value);
  std::memcpy (to, &stored, sizeof (T));
  return to + sizeof (T);
}

/** \brief The values of a row of text as the bytes of a point. */
void
storeRow (const TextScanner &scanner, const std::vector<std::string_view> &tokens, const std::vector<Field> &fields,
          std::uint8_t *to)
{
  auto token = tokens.begin ();
  for (const Field &field : fields)
    for (std::uint32_t i = 0; i < field.count; ++i, ++token)
    {
      const double value = scanner.number (*token);
      to = withType (field.datatype, [&] (auto zero) { return store<decltype (zero)> (value, to); });
    }
}

} // namespace

std::size_t
sizeOfType (std::uint8_t datatype)
{
  return withType (datatype, [] (auto zero) { return sizeof (zero); });
}

void
appendField (pcl::PCLPointCloud2 &cloud, const std::string &name, std::uint8_t datatype, std::uint32_t count)
{
  Field field;
  field.name = name;
  field.offset = cloud.point_step;
  field.datatype = datatype;
  field.count = count;
  cloud.fields.push_back (field);
  cloud.point_step += static_cast<std::uint32_t> (sizeOfType (datatype) * count);
}

std::size_t
columnsOf (const pcl::PCLPointCloud2 &cloud)
{
  std::size_t columns = 0;
  for (const Field &field : cloud.fields)
    columns += field.count;
  return columns;
}

void
appendNormals (const std::vector<Eigen::Vector3d> &normals, pcl::PCLPointCloud2 &cloud)
{
  if (normals.empty ())
    return;
  const std::size_t old_step = cloud.point_step;
  for (const char *name : {"nx", "ny", "nz"})
    appendField (cloud, name, Field::FLOAT64);
  std::vector<std::uint8_t> data (normals.size () * cloud.point_step);
  for (std::size_t i = 0; i < normals.size (); ++i)
  {
    std::copy_n (cloud.data.data () + i * old_step, old_step, data.data () + i * cloud.point_step);
    std::memcpy (data.data () + i * cloud.point_step + old_step, normals[i].data (), 3 * sizeof (double));
  }
  cloud.data.swap (data);
}

namespace
{

constexpr std::size_t STRETCH = 2048; // rows that one thread reads at a time

/** \brief Passes over rows, up to the end or \a most of them.
 * \param[out] rows how many there were
 * \return where each stretch of them begins; the last one may have none
 */
std::vector<TextScanner>
findStretches (TextScanner &scanner, std::size_t most, std::size_t &rows)
{
  std::vector<TextScanner> stretches{scanner};
  for (rows = 0; rows < most && scanner.skipRow ();)
    if (++rows % STRETCH == 0)
      stretches.push_back (scanner);
  return stretches;
}

} // namespace

std::size_t
readRows (TextScanner &scanner, std::size_t most, pcl::PCLPointCloud2 &cloud)
{
  std::size_t rows = 0;
  std::vector<TextScanner> stretches = findStretches (scanner, most, rows);
  const std::size_t columns = columnsOf (cloud);
  TextScanner first = stretches.front ();
  if (std::vector<std::string_view> tokens; rows > 0 && first.nextRow (tokens))
    first.requireColumns (tokens, columns); // before a broken header makes room for points that are none
  cloud.data.resize (rows * cloud.point_step);
  const auto read = [&] (std::vector<std::string_view> &tokens, std::size_t i)
  {
    TextScanner &stretch = stretches[i];
    for (std::size_t row = i * STRETCH; row < std::min (rows, (i + 1) * STRETCH); ++row)
    {
      stretch.nextRow (tokens);
      stretch.requireColumns (tokens, columns);
      storeRow (stretch, tokens, cloud.fields, &cloud.data[row * cloud.point_step]);
    }
  };
  std::vector<std::exception_ptr> errors (stretches.size ());
  parallelFor (
      stretches.size (), 0, [] { return std::vector<std::string_view> (); },
      [&] (std::vector<std::string_view> &tokens, std::size_t i)
      {
        try
        {
          read (tokens, i);
        }
        catch (const ToolError &)
        {
          errors[i] = std::current_exception ();
        }
      });
  for (const std::exception_ptr &error : errors)
    if (error)
      std::rethrow_exception (error);
  return rows;
}

void
requireRows (TextScanner &scanner, std::size_t count, pcl::PCLPointCloud2 &cloud)
{
  const std::size_t rows = readRows (scanner, count, cloud);
  if (rows < count)
    scanner.failEarly ("point " + std::to_string (rows + 1) + " of " + std::to_string (count));
}

FieldReader::FieldReader (const pcl::PCLPointCloud2 &cloud, const std::vector<std::string> &names)
{
  for (const std::string &name : names)
  {
    const auto field = std::find_if (cloud.fields.begin (), cloud.fields.end (),
                                     [&name] (const Field &f) { return f.name == name && f.count > 0; });
    if (field == cloud.fields.end ())
      continue;
    cloud_ = &cloud;
    offset_ = field->offset;
    datatype_ = field->datatype;
    return;
  }
}

double
FieldReader::operator() (std::size_t point) const
{
  const std::uint8_t *from = cloud_->data.data () + point * cloud_->point_step + offset_;
  return withType (datatype_, [from] (auto zero) { return static_cast<double> (load<decltype (zero)> (from)); });
}

std::uint32_t
FieldReader::bits (std::size_t point) const
{
  return load<std::uint32_t> (cloud_->data.data () + point * cloud_->point_step + offset_);
}

} // namespace erkpa::tool
