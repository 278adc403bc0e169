// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_reader.h"

#include "file_format.h"
#include "point_fields.h"
#include "tool_error.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
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

std::string
readFile (const std::string &path)
{
  const std::unique_ptr<std::FILE, int (*) (std::FILE *)> file (std::fopen (path.c_str (), "rb"), std::fclose);
  std::string bytes;
  std::size_t got = 0;
  errno = file ? 0 : errno;
  while (file && (bytes.resize (got + (got > (1u << 16) ? got : (1u << 16))), true))
  {
    const std::size_t more = std::fread (bytes.data () + got, 1, bytes.size () - got, file.get ());
    got += more;
    if (more == 0)
      break;
  }
  if (!file || std::ferror (file.get ()) != 0)
    throw ToolError ("cannot read " + path + ": " + std::strerror (errno) + "; check the name and its permissions");
  bytes.resize (got);
  return bytes;
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
  RawCloud result = (*reader) (readFile (path), path);
  for (const char *name : {"x", "y", "z"})
    if (!FieldReader (result.cloud, {name}).exists ())
      throw ToolError (path + ": the points have no field " + name + "; export them with x, y and z");
  if (result.cloud.width == 0 || result.cloud.height == 0)
    throw ToolError (path + ": the file holds no points; export it again");
  return result;
}

} // namespace erkpa::tool
