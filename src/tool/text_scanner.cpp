// SPDX-License-Identifier: BSD-3-Clause
#include "text_scanner.h"

#include "tool_error.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>

namespace erkpa::tool
{

namespace
{

bool
isSeparator (char c)
{
  return c == ' ' || c == '\t' || c == ',' || c == '\r' || c == '\v' || c == '\f';
}

void
split (std::string_view line, std::vector<std::string_view> &tokens)
{
  tokens.clear ();
  for (std::size_t i = 0; i < line.size () && line[i] != '#';)
  {
    const std::size_t begin = i;
    while (i < line.size () && !isSeparator (line[i]) && line[i] != '#')
      ++i;
    if (i > begin)
      tokens.push_back (line.substr (begin, i - begin));
    else
      ++i;
  }
}

} // namespace

bool
TextScanner::nextRow (std::vector<std::string_view> &tokens)
{
  while (offset_ < text_.size ())
  {
    split (takeLine (), tokens);
    if (!tokens.empty ())
      return true;
  }
  return false;
}

bool
TextScanner::skipRow ()
{
  while (offset_ < text_.size ())
  {
    const std::string_view line = takeLine ();
    const auto *const first = std::find_if_not (line.begin (), line.end (), isSeparator);
    if (first != line.end () && *first != '#')
      return true;
  }
  return false;
}

std::string_view
TextScanner::takeLine ()
{
  const std::size_t end = std::min (text_.find ('\n', offset_), text_.size ());
  const std::string_view line = text_.substr (offset_, end - offset_);
  offset_ = std::min (end + 1, text_.size ());
  ++line_;
  return line;
}

void
TextScanner::requireRow (std::vector<std::string_view> &tokens, const char *expected)
{
  if (!nextRow (tokens))
    failEarly (expected);
}

double
TextScanner::number (std::string_view token) const
{
  const std::string_view digits = !token.empty () && token[0] == '+' ? token.substr (1) : token;
  double value = 0.0;
  const auto [end, error] = std::from_chars (digits.data (), digits.data () + digits.size (), value);
  if (error == std::errc::invalid_argument || end != digits.data () + digits.size ())
    fail (quoted (token) + " is not a number");
  if (error == std::errc::result_out_of_range) // from_chars leaves the value alone; strtod gives 0 or infinity
    value = std::strtod (std::string (digits).c_str (), nullptr);
  return value;
}

std::size_t
TextScanner::count (std::string_view token) const
{
  std::size_t value = 0;
  const auto [end, error] = std::from_chars (token.data (), token.data () + token.size (), value);
  if (error != std::errc () || end != token.data () + token.size ())
    fail (quoted (token) + " is not a count");
  return value;
}

void
TextScanner::requireColumns (const std::vector<std::string_view> &tokens, std::size_t columns) const
{
  if (tokens.size () != columns)
    fail ("the row has " + std::to_string (tokens.size ()) + " columns where " + std::to_string (columns) +
          " are expected");
}

void
TextScanner::fail (const std::string &what) const
{
  throw ToolError (file_ + ", line " + std::to_string (line_) + ": " + what);
}

void
TextScanner::failEarly (const std::string &missing) const
{
  fail ("the file ends early, " + missing + " is missing; write or copy it again");
}

std::string
quoted (std::string_view token)
{
  constexpr std::size_t LONGEST = 32;
  std::string text (token.substr (0, LONGEST));
  std::replace_if (
      text.begin (), text.end (), [] (unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return "'" + text + (token.size () > LONGEST ? "...'" : "'");
}

} // namespace erkpa::tool
