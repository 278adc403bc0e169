// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_reader.h"

#include "file_format.h"
#include "point_fields.h"
#include "tool_error.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
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

[[noreturn]] void
failToRead (const std::string &path)
{
  throw ToolError ("cannot read " + path + ": " + std::strerror (errno) + "; check the name and its permissions");
}

/** \brief The content of a file, in place where it can be mapped. */
class FileBytes
{
public:
  explicit FileBytes (const std::string &path)
  {
    const int descriptor = ::open (path.c_str (), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
      failToRead (path);
    const bool done = map (descriptor) || read (descriptor);
    const int error = errno;
    ::close (descriptor);
    errno = error;
    if (!done)
      failToRead (path);
  }

  ~FileBytes ()
  {
    if (mapped_ != nullptr)
      munmap (mapped_, size_);
  }

  FileBytes (const FileBytes &) = delete;
  FileBytes &
  operator= (const FileBytes &) = delete;

  std::string_view
  view () const
  {
    return {mapped_ != nullptr ? static_cast<const char *> (mapped_) : bytes_.get (), size_};
  }

private:
  bool
  map (int descriptor)
  {
    struct stat status = {};
    if (fstat (descriptor, &status) != 0 || !S_ISREG (status.st_mode) || status.st_size <= 0)
      return false;
    const auto size = static_cast<std::size_t> (status.st_size);
    void *const mapped = mmap (nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (mapped == MAP_FAILED)
      return false;
    madvise (mapped, size, MADV_SEQUENTIAL);
    mapped_ = mapped;
    size_ = size;
    return true;
  }

  /** \brief Of a pipe, say, whose size is not known. */
  bool
  read (int descriptor)
  {
    for (std::size_t capacity = 0;;)
    {
      if (size_ == capacity)
      {
        capacity = std::max<std::size_t> (1u << 16, 2 * capacity);
        std::unique_ptr<char[]> larger (new char[capacity]); // not a string: that would write zeros first
        std::copy_n (bytes_.get (), size_, larger.get ());
        bytes_.swap (larger);
      }
      const ssize_t got = ::read (descriptor, bytes_.get () + size_, capacity - size_);
      if (got == 0)
        return true;
      if (got < 0 && errno != EINTR)
        return false;
      size_ += got > 0 ? static_cast<std::size_t> (got) : 0;
    }
  }

  void *mapped_ = nullptr;
  std::unique_ptr<char[]> bytes_;
  std::size_t size_ = 0;
};

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
  const FileBytes file (path);
  RawCloud result = (*reader) (file.view (), path);
  for (const char *name : {"x", "y", "z"})
    if (!FieldReader (result.cloud, {name}).exists ())
      throw ToolError (path + ": the points have no field " + name + "; export them with x, y and z");
  if (result.cloud.width == 0 || result.cloud.height == 0)
    throw ToolError (path + ": the file holds no points; export it again");
  return result;
}

} // namespace erkpa::tool
