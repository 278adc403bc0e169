// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_reader.h"

#include "file_format.h"
#include "point_fields.h"
#include "tool_error.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace erkpa::tool
{

namespace
{

using Reader = RawCloud (*) (std::string_view bytes, const std::string &path);

constexpr std::array<Format<Reader>, 7> READERS = {{{".pcd", readPcd},
                                                    {".ply", readPly},
                                                    {".xyz", readXyz},
                                                    {".xyzn", readXyz},
                                                    {".pwn", readPwn},
                                                    {".obj", readObj},
                                                    {".off", readOff}}};

/** \brief The content of a file. */
struct FileBytes
{
  std::unique_ptr<char[]> bytes; ///< not a string: that would write zeros first
  std::size_t size = 0;
  std::size_t capacity = 0;

  void
  grow (std::size_t new_capacity)
  {
    std::unique_ptr<char[]> larger (new char[new_capacity]);
    std::copy_n (bytes.get (), size, larger.get ());
    bytes.swap (larger);
    capacity = new_capacity;
  }
};

FileBytes
readFile (const std::string &path)
{
  const auto fail = [&path] ()
  { throw ToolError ("cannot read " + path + ": " + std::strerror (errno) + "; check the name and its permissions"); };
  const std::unique_ptr<std::FILE, int (*) (std::FILE *)> file (std::fopen (path.c_str (), "rb"), std::fclose);
  if (!file)
    fail ();
  std::error_code is_no_file; // a pipe, perhaps: its size is not known
  const std::uintmax_t size = std::filesystem::file_size (path, is_no_file);
  FileBytes result;
  result.grow (is_no_file ? (1u << 16) : static_cast<std::size_t> (size) + 1);
  while (const std::size_t got =
             std::fread (result.bytes.get () + result.size, 1, result.capacity - result.size, file.get ()))
  {
    result.size += got;
    if (result.size == result.capacity)
      result.grow (2 * result.capacity);
  }
  if (std::ferror (file.get ()) != 0)
    fail ();
  return result;
}

} // namespace

bool
isReadable (const std::string &path)
{
  return findFormat (READERS, path) != nullptr;
}

std::string
readableFormats ()
{
  return listFormats (READERS);
}

RawCloud
readCloud (const std::string &path)
{
  const Reader *reader = findFormat (READERS, path);
  if (reader == nullptr)
    throw ToolError ("cannot read " + path + ": the format is unknown; use one of " + readableFormats ());
  FileBytes file = readFile (path);
  RawCloud result = (*reader) (std::string_view (file.bytes.get (), file.size), path);
  for (const char *name : {"x", "y", "z"})
    if (!FieldReader (result.cloud, {name}).exists ())
      throw ToolError (path + ": the points have no field " + name + "; export them with x, y and z");
  if (result.cloud.width == 0 || result.cloud.height == 0)
    throw ToolError (path + ": the file holds no points; export it again");
  return result;
}

} // namespace erkpa::tool
