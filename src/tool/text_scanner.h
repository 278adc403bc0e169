// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace erkpa::tool
{

/** \brief Reads a text that lies in memory row by row, and knows the line for its complaints. */
class TextScanner
{
public:
  /** \param[in] text must outlive the scanner and the tokens it gives; may begin with a byte order mark (UTF-8)
   * \param[in] file named in errors
   */
  TextScanner (std::string_view text, std::string file) : text_ (text), file_ (std::move (file))
  {
    constexpr std::string_view MARK = "\xEF\xBB\xBF";
    offset_ = text.substr (0, MARK.size ()) == MARK ? MARK.size () : 0;
  }

  /** \brief Splits the next line that holds anything but blanks and comments (from # on).
   * \param[out] tokens what blanks, tabs and commas separate
   * \return false at the end of the text
   */
  bool
  nextRow (std::vector<std::string_view> &tokens);

  /** \brief Pass over what nextRow would split.
   * \return false at the end of the text
   */
  bool
  skipRow ();

  /** \brief Like nextRow, but the end of the text is an error: \a expected is missing. */
  void
  requireRow (std::vector<std::string_view> &tokens, const char *expected);

  /** \brief The value of a token; nan and inf are values, too. */
  double
  number (std::string_view token) const;

  /** \brief The value of a token that counts something. */
  std::size_t
  count (std::string_view token) const;

  /** \brief Refuses a row whose number of columns differs. */
  void
  requireColumns (const std::vector<std::string_view> &tokens, std::size_t columns) const;

  /** \brief Throws a ToolError that names file and line. */
  [[noreturn]] void
  fail (const std::string &what) const;

  /** \brief Throws the ToolError of a text that ends before \a missing. */
  [[noreturn]] void
  failEarly (const std::string &missing) const;

  /** \brief Where the line after the last row begins. */
  std::size_t
  offset () const
  {
    return offset_;
  }

private:
  /** \brief The next line, without its end; the text has one more. */
  std::string_view
  takeLine ();

  std::string_view text_;
  std::string file_;
  std::size_t offset_ = 0;
  std::size_t line_ = 0;
};

/** \brief A token as it may be shown: short, and on one line. */
std::string
quoted (std::string_view token);

} // namespace erkpa::tool
