// SPDX-License-Identifier: BSD-3-Clause
#include "crease_writer.h"

#include "file_format.h"

#include <Eigen/Core>

#include <map>

namespace erkpa::tool
{

namespace
{

/** \brief The creases of a mesh over vertices of their own. */
struct Lines
{
  std::vector<Eigen::Vector3f> points;
  std::vector<Crease> lines; ///< over points
};

Lines
gatherLines (const TriangleMesh &mesh, const std::vector<Crease> &creases)
{
  Lines result{{}, creases};
  std::map<int, int> numbers;
  for (Crease &line : result.lines)
    for (int &vertex : line.vertices)
    {
      const auto [entry, is_new] = numbers.try_emplace (vertex, static_cast<int> (result.points.size ()));
      if (is_new)
        result.points.push_back (mesh.vertices[static_cast<std::size_t> (vertex)]);
      vertex = entry->second;
    }
  return result;
}

void
writeNumbers (OutputFile &file, const std::vector<int> &numbers)
{
  for (std::size_t i = 0; i < numbers.size (); ++i)
    file.write ((i > 0 ? " " : "") + std::to_string (numbers[i]));
  file.write ("\n");
}

void
writePoints (const Lines &lines, OutputFile &file)
{
  for (const Eigen::Vector3f &p : lines.points)
  {
    file.writeNumber (p.x ());
    file.write (" ");
    file.writeNumber (p.y ());
    file.write (" ");
    file.writeNumber (p.z ());
    file.write ("\n");
  }
}

void
writeVtk (const Lines &lines, OutputFile &file)
{
  const std::string count = std::to_string (lines.lines.size ());
  std::size_t numbers = 0;
  for (const Crease &line : lines.lines)
    numbers += line.vertices.size () + 1;
  file.write ("# vtk DataFile Version 3.0\ncreases\nASCII\nDATASET POLYDATA\nPOINTS ");
  file.writeNumber (lines.points.size ());
  file.write (" float\n");
  writePoints (lines, file);
  file.write ("LINES " + count + " ");
  file.writeNumber (numbers);
  file.write ("\n");
  for (const Crease &line : lines.lines)
  {
    file.writeNumber (line.vertices.size ());
    file.write (" ");
    writeNumbers (file, line.vertices);
  }
  file.write ("CELL_DATA " + count + "\nSCALARS surface int 1\nLOOKUP_TABLE default\n");
  for (const Crease &line : lines.lines)
    writeNumbers (file, {line.surface});
}

void
writePly (const Lines &lines, OutputFile &file)
{
  std::size_t edges = 0;
  for (const Crease &line : lines.lines)
    edges += line.vertices.size () - 1;
  file.write ("ply\nformat ascii 1.0\nelement vertex ");
  file.writeNumber (lines.points.size ());
  file.write ("\nproperty float x\nproperty float y\nproperty float z\nelement edge ");
  file.writeNumber (edges);
  file.write ("\nproperty int vertex1\nproperty int vertex2\nproperty int surface\nend_header\n");
  writePoints (lines, file);
  for (const Crease &line : lines.lines)
    for (std::size_t i = 0; i + 1 < line.vertices.size (); ++i)
      writeNumbers (file, {line.vertices[i], line.vertices[i + 1], line.surface});
}

using Writer = void (*) (const Lines &lines, OutputFile &file);

constexpr std::array<Format<Writer>, 2> WRITERS = {{{".vtk", writeVtk}, {".ply", writePly}}};

} // namespace

void
writeCreases (const TriangleMesh &mesh, const std::vector<Crease> &creases, const std::string &path, OutputFile &file)
{
  (*findFormat (WRITERS, path)) (gatherLines (mesh, creases), file);
  file.close ();
}

bool
isWritableForCreases (const std::string &path)
{
  return findFormat (WRITERS, path) != nullptr;
}

std::string
writableCreaseFormats ()
{
  return listFormats (WRITERS);
}

double
lengthOf (const TriangleMesh &mesh, const std::vector<Crease> &creases)
{
  const Lines lines = gatherLines (mesh, creases);
  const auto at = [&lines] (int point)
  { return Eigen::Vector3d (lines.points[static_cast<std::size_t> (point)].cast<double> ()); };
  double length = 0.0;
  for (const Crease &line : lines.lines)
    for (std::size_t i = 0; i + 1 < line.vertices.size (); ++i)
      length += (at (line.vertices[i + 1]) - at (line.vertices[i])).norm ();
  return length;
}

} // namespace erkpa::tool
