// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/reconstruction.h>

#include <array>
#include <string>

namespace erkpa::tool
{

/** \brief A value of an enum and its name on the command line and in the report. */
template <typename EnumT>
struct NamedValue
{
  const char *name;
  EnumT value;
};

constexpr std::array<NamedValue<Order>, 5> ORDERS = {{{"automatic", Order::AUTOMATIC},
                                                      {"constant", Order::CONSTANT},
                                                      {"linear", Order::LINEAR},
                                                      {"spherical", Order::SPHERICAL},
                                                      {"quadratic", Order::QUADRATIC}}};

constexpr std::array<NamedValue<Constraint>, 3> CONSTRAINTS = {
    {{"hermite", Constraint::HERMITE}, {"functional", Constraint::FUNCTIONAL}, {"offsurface", Constraint::OFFSURFACE}}};

constexpr std::array<NamedValue<EnrichmentType>, 2> ENRICHMENTS = {
    {{"kink", EnrichmentType::KINK}, {"jump", EnrichmentType::JUMP}}};

constexpr std::array<NamedValue<Interpolation>, 3> INTERPOLATIONS = {{{"none", Interpolation::NONE},
                                                                      {"singular", Interpolation::SINGULAR},
                                                                      {"collocation", Interpolation::COLLOCATION}}};

constexpr std::array<NamedValue<KernelType>, 6> KERNELS = {{{"automatic", KernelType::AUTOMATIC},
                                                            {"paper", KernelType::PAPER},
                                                            {"wendland_c2", KernelType::WENDLAND_C2},
                                                            {"wendland_c4", KernelType::WENDLAND_C4},
                                                            {"gaussian", KernelType::GAUSSIAN},
                                                            {"singular", KernelType::SINGULAR}}};

constexpr std::array<NamedValue<Orientation>, 4> ORIENTATIONS = {{{"none", Orientation::NONE},
                                                                  {"view_point", Orientation::VIEW_POINT},
                                                                  {"one_side", Orientation::ONE_SIDE},
                                                                  {"propagation", Orientation::PROPAGATION}}};

template <typename EnumT, std::size_t N>
std::string
nameOf (const std::array<NamedValue<EnumT>, N> &values, EnumT value)
{
  for (const NamedValue<EnumT> &candidate : values)
    if (candidate.value == value)
      return candidate.name;
  return "";
}

/** \brief "a|b|c" */
template <typename EnumT, std::size_t N>
std::string
listNames (const std::array<NamedValue<EnumT>, N> &values)
{
  std::string list;
  for (const NamedValue<EnumT> &candidate : values)
    list += (list.empty () ? "" : "|") + std::string (candidate.name);
  return list;
}

} // namespace erkpa::tool
