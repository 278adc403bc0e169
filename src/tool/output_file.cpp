// SPDX-License-Identifier: BSD-3-Clause
#include "output_file.h"

#include "tool_error.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace erkpa::tool
{

namespace
{

constexpr std::size_t BUFFER_SIZE = 1u << 18;

std::string
directoryOf (const std::string &path)
{
  const std::string directory = std::filesystem::path (path).parent_path ().string ();
  return directory.empty () ? "." : directory;
}

/** \brief Whether a path names a device or a pipe, such as /dev/stdout: those are written to, not replaced.
 */
bool
isStream (const std::string &path)
{
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status (path, error);
  return path.rfind ("/dev/", 0) == 0 || std::filesystem::is_fifo (status) ||
         std::filesystem::is_character_file (status) || std::filesystem::is_socket (status);
}

/** \brief The file that a link leads to: the link stays, its file is replaced. */
std::string
resolved (const std::string &path)
{
  std::error_code error;
  const std::filesystem::path target = std::filesystem::canonical (path, error);
  return error ? path : target.string ();
}

[[noreturn]] void
failToWrite (const std::string &path, int error)
{
  throw ToolError ("cannot write " + path + ": " + std::strerror (error) +
                   "; choose a place that exists, is writable and has room");
}

} // namespace

void
OutputFile::check (const std::string &path)
{
  std::error_code error;
  if (std::filesystem::is_directory (path, error))
    failToWrite (path, EISDIR);
  const std::string target = isStream (path) ? path : directoryOf (resolved (path));
  if (access (target.c_str (), W_OK) != 0)
    failToWrite (path, errno);
}

OutputFile::OutputFile (std::string path) : path_ (std::move (path))
{
  buffer_.reserve (BUFFER_SIZE);
  if (isStream (path_))
  {
    descriptor_ = open (path_.c_str (), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (descriptor_ < 0)
      fail (errno);
    return;
  }
  path_ = resolved (path_);
  std::string name = path_ + ".XXXXXX";
  descriptor_ = mkstemp (name.data ());
  if (descriptor_ < 0)
    fail (errno);
  temporary_ = name;
  const mode_t mask = umask (0); // mkstemp makes it private; it shall be as readable as any new file
  umask (mask);
  if (fchmod (descriptor_, 0666 & ~mask) != 0)
    fail (errno);
}

OutputFile::~OutputFile ()
{
  if (descriptor_ >= 0)
    ::close (descriptor_);
  if (!temporary_.empty ())
    unlink (temporary_.c_str ());
}

void
OutputFile::write (const void *bytes, std::size_t size)
{
  const auto *begin = static_cast<const char *> (bytes);
  if (buffer_.size () + size > BUFFER_SIZE)
    flush ();
  if (size > BUFFER_SIZE)
    writeThrough (begin, size);
  else
    buffer_.insert (buffer_.end (), begin, begin + size);
}

void
OutputFile::writeNumber (float value)
{
  char text[64];
  write (text, static_cast<std::size_t> (std::to_chars (text, text + sizeof (text), value).ptr - text));
}

void
OutputFile::writeNumber (double value, int digits)
{
  char text[64] = "nan"; // to_chars would write -nan for some
  char *end = text + 3;
  if (!std::isnan (value))
    end = std::to_chars (text, text + sizeof (text), value, std::chars_format::general, digits).ptr;
  write (text, static_cast<std::size_t> (end - text));
}

void
OutputFile::writeNumber (std::size_t value)
{
  write (std::to_string (value));
}

void
OutputFile::flush ()
{
  writeThrough (buffer_.data (), buffer_.size ());
  buffer_.clear ();
}

void
OutputFile::writeThrough (const char *bytes, std::size_t size)
{
  for (std::size_t done = 0; done < size;)
  {
    const ssize_t written = ::write (descriptor_, bytes + done, size - done);
    if (written < 0 && errno != EINTR)
      fail (errno);
    done += written > 0 ? static_cast<std::size_t> (written) : 0;
  }
}

void
OutputFile::close ()
{
  flush ();
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close (descriptor) != 0) // network file systems tell here that there was no room
    fail (errno);
}

void
OutputFile::commit ()
{
  if (!temporary_.empty () && std::rename (temporary_.c_str (), path_.c_str ()) != 0)
    fail (errno);
  temporary_.clear ();
}

void
OutputFile::fail (int error) const
{
  failToWrite (path_, error);
}

} // namespace erkpa::tool
