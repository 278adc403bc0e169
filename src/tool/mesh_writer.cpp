// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_writer.h"

#include "../threads.h"
#include "file_format.h"

#include <Eigen/Geometry>
#include <boost/endian/conversion.hpp>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace erkpa::tool
{

namespace
{

/** \brief Part of a file while it is put together. */
class Bytes
{
public:
  template <typename T>
  void
  putLittle (T value)
  {
    value = boost::endian::native_to_little (value);
    put (&value, sizeof (value));
  }

  void
  putLittle (float value)
  {
    putLittle (bitsOf (value));
  }

  void
  putBig (std::uint32_t value)
  {
    value = boost::endian::native_to_big (value);
    put (&value, sizeof (value));
  }

  void
  putBig (float value)
  {
    putBig (bitsOf (value));
  }

  /** \brief A number in the fewest digits that give the same again. */
  template <typename T>
  void
  putText (T value)
  {
    char text[64];
    put (text, static_cast<std::size_t> (std::to_chars (text, text + sizeof (text), value).ptr - text));
  }

  void
  put (std::string_view text)
  {
    put (text.data (), text.size ());
  }

  void
  put (const void *bytes, std::size_t size)
  {
    const auto *begin = static_cast<const char *> (bytes);
    bytes_.insert (bytes_.end (), begin, begin + size);
  }

  const std::vector<char> &
  bytes () const
  {
    return bytes_;
  }

  void
  clear ()
  {
    bytes_.clear ();
  }

private:
  static std::uint32_t
  bitsOf (float value)
  {
    std::uint32_t bits = 0;
    std::memcpy (&bits, &value, sizeof (bits));
    return bits;
  }

  std::vector<char> bytes_;
};

/** \brief What a mesh is written from and to. */
struct Job
{
  const TriangleMesh &mesh;
  int threads;
  OutputFile &file;

  bool
  hasColours () const
  {
    return mesh.channels == 3;
  }

  bool
  hasIntensities () const
  {
    return mesh.channels == 1;
  }

  /** \brief Write what put (bytes, i) appends for i = 0 .. count - 1: several stretches are made at once, then written.
   */
  template <typename PutT>
  void
  writeAll (std::size_t count, PutT put) const
  {
    constexpr std::size_t STRETCH = 16384;
    std::vector<Bytes> parts (2 * static_cast<std::size_t> (threadCount (threads)));
    for (std::size_t first = 0; first < count; first += parts.size () * STRETCH)
    {
      parallelFor (
          parts.size (), threads, [] { return 0; },
          [&] (int, std::size_t p)
          {
            parts[p].clear ();
            const std::size_t begin = first + p * STRETCH, end = std::min (count, begin + STRETCH);
            for (std::size_t i = begin; i < end; ++i)
              put (parts[p], i);
          });
      for (const Bytes &part : parts)
        file.write (part.bytes ().data (), part.bytes ().size ());
    }
  }
};

void
putColour (const TriangleMesh &mesh, std::size_t vertex, Bytes &bytes)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    const float value = mesh.attributes[3 * vertex + c];
    bytes.putLittle (static_cast<std::uint8_t> (value < 0.0f ? 0.0f : value > 255.0f ? 255.0f : value + 0.5f));
  }
}

void
writePlyHeader (const Job &job)
{
  job.file.write ("ply\nformat binary_little_endian 1.0\nelement vertex ");
  job.file.writeNumber (job.mesh.vertices.size ());
  job.file.write ("\nproperty float x\nproperty float y\nproperty float z\n"
                  "property float nx\nproperty float ny\nproperty float nz\n");
  if (job.hasColours ())
    job.file.write ("property uchar red\nproperty uchar green\nproperty uchar blue\n");
  if (job.hasIntensities ())
    job.file.write ("property float intensity\n");
  job.file.write ("element face ");
  job.file.writeNumber (job.mesh.triangles.size ());
  job.file.write ("\nproperty list uchar int vertex_indices\nend_header\n");
}

void
writePly (const Job &job)
{
  const TriangleMesh &mesh = job.mesh;
  writePlyHeader (job);
  job.writeAll (mesh.vertices.size (),
                [&] (Bytes &bytes, std::size_t i)
                {
                  for (const Eigen::Vector3f *vector : {&mesh.vertices[i], &mesh.normals[i]})
                    for (int axis = 0; axis < 3; ++axis)
                      bytes.putLittle ((*vector)[axis]);
                  if (job.hasColours ())
                    putColour (mesh, i, bytes);
                  if (job.hasIntensities ())
                    bytes.putLittle (mesh.attributes[i]);
                });
  job.writeAll (mesh.triangles.size (),
                [&] (Bytes &bytes, std::size_t t)
                {
                  bytes.putLittle (std::uint8_t (3));
                  for (const int vertex : mesh.triangles[t])
                    bytes.putLittle (static_cast<std::uint32_t> (vertex));
                });
}

/** \brief The point data of a VTK file. */
void
writeVtkAttributes (const Job &job)
{
  const TriangleMesh &mesh = job.mesh;
  const std::size_t count = mesh.vertices.size ();
  job.file.write ("\nPOINT_DATA ");
  job.file.writeNumber (count);
  if (job.hasColours ())
  {
    job.file.write ("\nCOLOR_SCALARS Colors 3\n"); // the name PCL's loader looks for
    job.writeAll (count, [&] (Bytes &bytes, std::size_t i) { putColour (mesh, i, bytes); });
  }
  if (job.hasIntensities ())
  {
    job.file.write ("\nSCALARS intensity float 1\nLOOKUP_TABLE default\n");
    job.writeAll (count, [&] (Bytes &bytes, std::size_t i) { bytes.putBig (mesh.attributes[i]); });
  }
  job.file.write ("\nNORMALS normals float\n");
  job.writeAll (count,
                [&] (Bytes &bytes, std::size_t i)
                {
                  for (int axis = 0; axis < 3; ++axis)
                    bytes.putBig (mesh.normals[i][axis]);
                });
  job.file.write ("\n");
}

void
writeVtk (const Job &job)
{
  const TriangleMesh &mesh = job.mesh;
  job.file.write ("# vtk DataFile Version 3.0\nmesh\nBINARY\nDATASET POLYDATA\nPOINTS ");
  job.file.writeNumber (mesh.vertices.size ());
  job.file.write (" float\n");
  job.writeAll (mesh.vertices.size (),
                [&] (Bytes &bytes, std::size_t i)
                {
                  for (int axis = 0; axis < 3; ++axis)
                    bytes.putBig (mesh.vertices[i][axis]);
                });
  job.file.write ("\nPOLYGONS ");
  job.file.writeNumber (mesh.triangles.size ());
  job.file.write (" ");
  job.file.writeNumber (4 * mesh.triangles.size ());
  job.file.write ("\n");
  job.writeAll (mesh.triangles.size (),
                [&] (Bytes &bytes, std::size_t t)
                {
                  bytes.putBig (std::uint32_t (3));
                  for (const int vertex : mesh.triangles[t])
                    bytes.putBig (static_cast<std::uint32_t> (vertex));
                });
  writeVtkAttributes (job);
}

void
writeStl (const Job &job)
{
  const TriangleMesh &mesh = job.mesh;
  std::string header = "binary STL"; // not "solid": that begins a text file
  header.resize (80, ' ');
  job.file.write (header);
  Bytes count;
  count.putLittle (static_cast<std::uint32_t> (mesh.triangles.size ()));
  job.file.write (count.bytes ().data (), count.bytes ().size ());
  job.writeAll (mesh.triangles.size (),
                [&] (Bytes &bytes, std::size_t t)
                {
                  const auto corner = [&] (std::size_t c) -> const Eigen::Vector3f &
                  { return mesh.vertices[static_cast<std::size_t> (mesh.triangles[t][c])]; };
                  const Eigen::Vector3f normal =
                      (corner (1) - corner (0)).cross (corner (2) - corner (0)).normalized ();
                  for (const Eigen::Vector3f *vector : {&normal, &corner (0), &corner (1), &corner (2)})
                    for (int axis = 0; axis < 3; ++axis)
                      bytes.putLittle ((*vector)[axis]);
                  bytes.putLittle (std::uint16_t (0));
                });
}

/** \brief A line of three numbers. */
void
putObjLine (std::string_view keyword, const Eigen::Vector3f &vector, Bytes &bytes)
{
  bytes.put (keyword);
  for (int axis = 0; axis < 3; ++axis)
  {
    bytes.put (" ");
    bytes.putText (vector[axis]);
  }
  bytes.put ("\n");
}

void
writeObj (const Job &job)
{
  const TriangleMesh &mesh = job.mesh;
  job.writeAll (mesh.vertices.size (),
                [&] (Bytes &bytes, std::size_t i) { putObjLine ("v", mesh.vertices[i], bytes); });
  job.writeAll (mesh.normals.size (), [&] (Bytes &bytes, std::size_t i) { putObjLine ("vn", mesh.normals[i], bytes); });
  job.writeAll (mesh.triangles.size (),
                [&] (Bytes &bytes, std::size_t t)
                {
                  bytes.put ("f");
                  for (const int vertex : mesh.triangles[t])
                  {
                    bytes.put (" ");
                    bytes.putText (vertex + 1);
                    bytes.put ("//");
                    bytes.putText (vertex + 1);
                  }
                  bytes.put ("\n");
                });
}

using Writer = void (*) (const Job &job);

constexpr std::array<Format<Writer>, 4> WRITERS = {
    {{".ply", writePly}, {".vtk", writeVtk}, {".stl", writeStl}, {".obj", writeObj}}};

} // namespace

bool
isWritable (const std::string &path)
{
  return findFormat (WRITERS, path) != nullptr;
}

std::string
writableFormats ()
{
  return listFormats (WRITERS);
}

void
writeMesh (const TriangleMesh &mesh, const std::string &path, int threads, OutputFile &file)
{
  (*findFormat (WRITERS, path)) ({mesh, threads, file});
  file.close ();
}

} // namespace erkpa::tool
