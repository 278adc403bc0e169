// SPDX-License-Identifier: BSD-3-Clause
#include "option_values.h"

#include "text_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace erkpa::tool
{

namespace
{

/** \brief The whole of \a text as a number. */
template <typename NumberT>
bool
convert (std::string_view text, NumberT &number)
{
  if (text.size () > 1 && text[0] == '+' && text[1] != '-')
    text.remove_prefix (1);
  const auto [end, error] = std::from_chars (text.data (), text.data () + text.size (), number);
  return error == std::errc () && end == text.data () + text.size ();
}

bool
convertFinite (std::string_view text, double &number)
{
  return convert (text, number) && std::isfinite (number);
}

} // namespace

void
OptionText::refuse (const std::string &remedy) const
{
  throw ToolError ("option -" + name + ": " + quoted (text) + " makes no sense; " + remedy);
}

int
toCount (const OptionText &option, int least)
{
  int count = 0;
  if (!convert (option.text, count) || count < 0 || (count > 0 && count < least))
    option.refuse ("give a whole number of at least " + std::to_string (least) + ", or 0 for the default");
  return count;
}

double
toNumber (const OptionText &option)
{
  double number = 0.0;
  if (!convertFinite (option.text, number))
    option.refuse ("give a number");
  return number;
}

double
toLength (const OptionText &option)
{
  double length = 0.0;
  if (!convertFinite (option.text, length) || length < 0.0)
    option.refuse ("give a positive number, or 0 for the default");
  return length;
}

std::vector<double>
toNumbers (const OptionText &option, const std::string &form)
{
  const auto expected = static_cast<std::size_t> (std::count (form.begin (), form.end (), ',')) + 1;
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= option.text.size ();)
  {
    const std::size_t end = std::min (option.text.find (',', begin), option.text.size ());
    double number = 0.0;
    if (!convertFinite (std::string_view (option.text).substr (begin, end - begin), number))
      option.refuse ("give " + form + ", numbers with commas between and no blanks");
    numbers.push_back (number);
    begin = end + 1;
  }
  if (numbers.size () != expected)
    option.refuse ("give " + form + ", " + std::to_string (expected) + " numbers");
  return numbers;
}

} // namespace erkpa::tool
