// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointField.h>

#include <cstdint>

namespace erkpa
{

/** \brief Calls \a action with a zero of the type that a field's datatype names; a double where it names none. */
template <typename ActionT>
auto
withType (std::uint8_t datatype, ActionT action)
{
  using Field = pcl::PCLPointField;
  switch (datatype)
  {
    // NOLINTNEXTLINE(bugprone-branch-clone): the branches differ in type
    case Field::INT8:
      return action (std::int8_t ());
    case Field::BOOL:
    case Field::UINT8:
      return action (std::uint8_t ());
    case Field::INT16:
      return action (std::int16_t ());
    case Field::UINT16:
      return action (std::uint16_t ());
    case Field::INT32:
      return action (std::int32_t ());
    case Field::UINT32:
      return action (std::uint32_t ());
    case Field::INT64:
      return action (std::int64_t ());
    case Field::UINT64:
      return action (std::uint64_t ());
    case Field::FLOAT32:
      return action (float ());
    default:
      return action (double ());
  }
}

} // namespace erkpa
