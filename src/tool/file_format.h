// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string>

namespace erkpa::tool
{

/** \brief A file name's ending and the function that handles such files. */
template <typename FunctionT>
struct Format
{
  const char *extension;
  FunctionT function;
};

/** \brief The function for the ending of \a path in upper or lower case; null where there is none. */
template <typename FunctionT, std::size_t N>
const FunctionT *
findFormat (const std::array<Format<FunctionT>, N> &formats, const std::string &path)
{
  std::string extension = std::filesystem::path (path).extension ().string ();
  std::transform (extension.begin (), extension.end (), extension.begin (),
                  [] (unsigned char c) { return static_cast<char> (std::tolower (c)); });
  for (const Format<FunctionT> &format : formats)
    if (extension == format.extension)
      return &format.function;
  return nullptr;
}

/** \brief ".a, .b, .c" */
template <typename FunctionT, std::size_t N>
std::string
listFormats (const std::array<Format<FunctionT>, N> &formats)
{
  std::string list;
  for (const Format<FunctionT> &format : formats)
    list += (list.empty () ? "" : ", ") + std::string (format.extension);
  return list;
}

} // namespace erkpa::tool
