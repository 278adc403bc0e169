// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "named_values.h"
#include "tool_error.h"

#include <boost/program_options.hpp>

#include <string>
#include <vector>

namespace erkpa::tool
{

/** \brief An option of the command line with its text, for conversions that throw a ToolError naming both. */
struct OptionText
{
  std::string name;
  std::string text;

  /** \brief Throws: this is not what the option takes. */
  [[noreturn]] void
  refuse (const std::string &remedy) const;
};

/** \brief Gives \a take the text of an option that was given. */
template <typename TakeT>
void
ifGiven (const boost::program_options::variables_map &variables, const char *name, TakeT take)
{
  if (variables.count (name) > 0)
    take (OptionText{name, variables[name].as<std::string> ()});
}

/** \brief A whole number of at least \a least, or 0 where that means "choose". */
int
toCount (const OptionText &option, int least);

/** \brief A finite number, nothing behind it. */
double
toNumber (const OptionText &option);

/** \brief A positive number, or 0 where that means "choose". */
double
toLength (const OptionText &option);

/** \brief As many finite numbers as \a form has letters: "a,b,c,d". */
std::vector<double>
toNumbers (const OptionText &option, const std::string &form);

template <typename EnumT, std::size_t N>
EnumT
toEnum (const OptionText &option, const std::array<NamedValue<EnumT>, N> &values)
{
  for (const NamedValue<EnumT> &candidate : values)
    if (option.text == candidate.name)
      return candidate.value;
  option.refuse ("give one of " + listNames (values));
}

} // namespace erkpa::tool
