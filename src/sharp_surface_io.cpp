// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/sharp_surface_io.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <system_error>

namespace erkpa
{

namespace
{

namespace fs = std::filesystem;

std::string
reasonOf (int error)
{
  return error != 0 ? std::strerror (error) : "no reason is known";
}

Outcome
cannotWrite (const std::string &path, const std::string &reason)
{
  return {Status::INVALID_SETTING, "cannot write sharp surfaces to " + path + ": " + reason +
                                       "; choose a place that exists, is writable and has room"};
}

/** \brief Writes a file; empty, or the reason why it could not. */
std::string
writeFile (const fs::path &path, const std::string &text)
{
  errno = 0;
  std::ofstream file (path, std::ios::binary | std::ios::trunc);
  file.write (text.data (), static_cast<std::streamsize> (text.size ()));
  file.close (); // tells whether all of it arrived
  return file ? "" : reasonOf (errno);
}

/** \brief A name beside a file that no other file has. */
fs::path
nameBeside (const fs::path &path)
{
  std::random_device random;
  fs::path name;
  std::error_code error;
  do
    name = path.string () + "." + std::to_string (random ());
  while (fs::exists (fs::symlink_status (name, error)));
  return name;
}

} // namespace

Outcome
saveSharpSurfaces (const std::string &path, const std::vector<SharpSurface::ConstPtr> &surfaces)
{
  std::string text;
  const Outcome outcome = writeSharpSurfaces (surfaces, text);
  if (!outcome.ok ())
    return {outcome.status, "cannot write sharp surfaces to " + path + ": " + outcome.message};
  std::error_code error;
  const fs::path target = fs::canonical (path, error), file = error ? fs::path (path) : target; // a link stays
  const fs::file_status status = fs::status (file, error);
  if (fs::exists (status) && !fs::is_regular_file (status)) // /dev/stdout is written to, not replaced
  {
    const std::string reason = fs::is_directory (status) ? "it is a directory" : writeFile (file, text);
    return reason.empty () ? Outcome () : cannotWrite (path, reason);
  }
  const fs::path temporary = nameBeside (file);
  const std::string reason = writeFile (temporary, text);
  if (reason.empty ())
    fs::rename (temporary, file, error);
  if (reason.empty () && !error)
    return {};
  const std::string why = reason.empty () ? error.message () : reason;
  fs::remove (temporary, error);
  return cannotWrite (path, why);
}

Outcome
loadSharpSurfaces (const std::string &path, std::vector<SharpSurface::ConstPtr> &surfaces)
{
  const auto bad = [&] (const std::string &why) {
    return Outcome{Status::INVALID_SETTING, "cannot read sharp surfaces from " + path + ": " + why};
  };
  std::error_code error;
  if (fs::is_directory (path, error))
    return bad ("it is a directory; give the name of a file");
  errno = 0;
  std::ifstream file (path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char> (file), std::istreambuf_iterator<char> ()};
  if (!file.is_open () || file.bad ())
    return bad (reasonOf (errno) + "; give the name of a file that can be read");
  const Outcome outcome = readSharpSurfaces (text, surfaces);
  return outcome.ok () ? outcome : bad (outcome.message);
}

} // namespace erkpa
