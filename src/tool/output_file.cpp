// SPDX-License-Identifier: BSD-3-Clause
#include "output_file.h"

#include "tool_error.h"

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
  if (access (directoryOf (path).c_str (), W_OK | X_OK) != 0)
    failToWrite (path, errno);
}

OutputFile::OutputFile (std::string path) : path_ (std::move (path)), temporary_ (path_ + ".XXXXXX")
{
  descriptor_ = mkstemp (temporary_.data ());
  if (descriptor_ < 0)
  {
    temporary_.clear ();
    fail (errno);
  }
  const mode_t mask = umask (0); // mkstemp makes it private; it shall be as readable as any new file
  umask (mask);
  fchmod (descriptor_, 0666 & ~mask);
  buffer_.reserve (BUFFER_SIZE);
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
  if (buffer_.size () + size > BUFFER_SIZE)
    flush ();
  const auto *begin = static_cast<const char *> (bytes);
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
  char text[64];
  if (std::isnan (value))
    write ("nan");
  else
    write (text, static_cast<std::size_t> (
                     std::to_chars (text, text + sizeof (text), value, std::chars_format::general, digits).ptr -
                     text));
}

void
OutputFile::writeNumber (std::size_t value)
{
  write (std::to_string (value));
}

void
OutputFile::flush ()
{
  for (std::size_t done = 0; done < buffer_.size ();)
  {
    const ssize_t written = ::write (descriptor_, buffer_.data () + done, buffer_.size () - done);
    if (written < 0 && errno != EINTR)
      fail (errno);
    done += written > 0 ? static_cast<std::size_t> (written) : 0;
  }
  buffer_.clear ();
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
  if (std::rename (temporary_.c_str (), path_.c_str ()) != 0)
    fail (errno);
  temporary_.clear ();
}

void
OutputFile::fail (int error) const
{
  failToWrite (path_, error);
}

} // namespace erkpa::tool
