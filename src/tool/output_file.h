// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace erkpa::tool
{

/** \brief A file that appears whole or not at all.
 *
 * Bytes go to a file beside it, which takes the name when everything is written. Until commit () an older
 * file of that name stays as it is. Every failure throws a ToolError that names the file.
 */
class OutputFile
{
public:
  explicit OutputFile (std::string path);
  ~OutputFile ();
  OutputFile (const OutputFile &) = delete;
  OutputFile &
  operator= (const OutputFile &) = delete;

  /** \brief Throws if a file of that name could not be written, as far as can be told without writing. */
  static void
  check (const std::string &path);

  void
  write (const void *bytes, std::size_t size);

  void
  write (std::string_view text)
  {
    write (text.data (), text.size ());
  }

  /** \brief A number in the fewest digits that give the same float again. */
  void
  writeNumber (float value);

  /** \brief A number in as many significant digits; "nan" where it is none. */
  void
  writeNumber (double value, int digits);

  void
  writeNumber (std::size_t value);

  /** \brief Writes what is left, checks that all of it arrived, and closes the file. */
  void
  close ();

  /** \brief Gives the closed file its name. */
  void
  commit ();

private:
  void
  flush ();

  void
  writeThrough (const char *bytes, std::size_t size);

  [[noreturn]] void
  fail (int error) const;

  std::string path_;
  std::string temporary_; ///< beside path_; empty where there is nothing to rename or remove
  int descriptor_ = -1;
  std::vector<char> buffer_;
};

} // namespace erkpa::tool
