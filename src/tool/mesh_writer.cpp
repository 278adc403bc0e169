// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_writer.h"

#include "file_format.h"
#include "point_fields.h"

#include <Eigen/Geometry>
#include <boost/endian/conversion.hpp>

#include <cstring>

namespace erkpa::tool
{

namespace
{

/** \brief The vertices of a mesh by what they have. */
struct Vertices
{
  explicit Vertices (const pcl::PCLPointCloud2 &cloud)
      : size (static_cast<std::size_t> (cloud.width) * cloud.height), position{FieldReader (cloud, {"x"}),
                                                                               FieldReader (cloud, {"y"}),
                                                                               FieldReader (cloud, {"z"})},
        normal{FieldReader (cloud, {"normal_x"}), FieldReader (cloud, {"normal_y"}), FieldReader (cloud, {"normal_z"})},
        colour (cloud, {"rgb", "rgba"}), intensity (cloud, {"intensity"})
  {
  }

  bool
  hasNormals () const
  {
    return normal[0].exists () && normal[1].exists () && normal[2].exists ();
  }

  Eigen::Vector3f
  positionOf (std::size_t vertex) const
  {
    return Eigen::Vector3d (position[0](vertex), position[1](vertex), position[2](vertex)).cast<float> ();
  }

  std::size_t size;
  FieldReader position[3], normal[3], colour, intensity;
};

template <typename T>
void
putLittle (OutputFile &file, T value)
{
  value = boost::endian::native_to_little (value);
  file.write (&value, sizeof (value));
}

void
putBig (OutputFile &file, std::uint32_t value)
{
  value = boost::endian::native_to_big (value);
  file.write (&value, sizeof (value));
}

std::uint32_t
bitsOf (double value)
{
  const auto single = static_cast<float> (value);
  std::uint32_t bits = 0;
  std::memcpy (&bits, &single, sizeof (bits));
  return bits;
}

void
putColour (OutputFile &file, std::uint32_t rgb)
{
  const std::uint8_t bytes[3] = {static_cast<std::uint8_t> (rgb >> 16), static_cast<std::uint8_t> (rgb >> 8),
                                 static_cast<std::uint8_t> (rgb)};
  file.write (bytes, sizeof (bytes));
}

void
writePlyHeader (const Vertices &vertices, std::size_t faces, OutputFile &file)
{
  file.write ("ply\nformat binary_little_endian 1.0\nelement vertex ");
  file.writeNumber (vertices.size);
  file.write ("\nproperty float x\nproperty float y\nproperty float z\n");
  if (vertices.hasNormals ())
    file.write ("property float nx\nproperty float ny\nproperty float nz\n");
  if (vertices.colour.exists ())
    file.write ("property uchar red\nproperty uchar green\nproperty uchar blue\n");
  if (vertices.intensity.exists ())
    file.write ("property float intensity\n");
  file.write ("element face ");
  file.writeNumber (faces);
  file.write ("\nproperty list uchar int vertex_indices\nend_header\n");
}

void
writePly (const pcl::PolygonMesh &mesh, OutputFile &file)
{
  const Vertices vertices (mesh.cloud);
  writePlyHeader (vertices, mesh.polygons.size (), file);
  for (std::size_t i = 0; i < vertices.size; ++i)
  {
    for (const FieldReader &coordinate : vertices.position)
      putLittle (file, bitsOf (coordinate (i)));
    for (std::size_t a = 0; a < 3 && vertices.hasNormals (); ++a)
      putLittle (file, bitsOf (vertices.normal[a](i)));
    if (vertices.colour.exists ())
      putColour (file, vertices.colour.bits (i));
    if (vertices.intensity.exists ())
      putLittle (file, bitsOf (vertices.intensity (i)));
  }
  for (const pcl::Vertices &polygon : mesh.polygons)
  {
    putLittle (file, static_cast<std::uint8_t> (polygon.vertices.size ()));
    for (const auto vertex : polygon.vertices)
      putLittle (file, static_cast<std::uint32_t> (vertex));
  }
}

/** \brief The point data of a VTK file. */
void
writeVtkAttributes (const Vertices &vertices, OutputFile &file)
{
  file.write ("\nPOINT_DATA ");
  file.writeNumber (vertices.size);
  if (vertices.colour.exists ())
  {
    file.write ("\nCOLOR_SCALARS Colors 3\n"); // the name PCL's loader looks for
    for (std::size_t i = 0; i < vertices.size; ++i)
      putColour (file, vertices.colour.bits (i));
  }
  if (vertices.intensity.exists ())
  {
    file.write ("\nSCALARS intensity float 1\nLOOKUP_TABLE default\n");
    for (std::size_t i = 0; i < vertices.size; ++i)
      putBig (file, bitsOf (vertices.intensity (i)));
  }
  if (vertices.hasNormals ())
  {
    file.write ("\nNORMALS normals float\n");
    for (std::size_t i = 0; i < vertices.size; ++i)
      for (const FieldReader &coordinate : vertices.normal)
        putBig (file, bitsOf (coordinate (i)));
  }
  file.write ("\n");
}

void
writeVtk (const pcl::PolygonMesh &mesh, OutputFile &file)
{
  const Vertices vertices (mesh.cloud);
  file.write ("# vtk DataFile Version 3.0\nmesh\nBINARY\nDATASET POLYDATA\nPOINTS ");
  file.writeNumber (vertices.size);
  file.write (" float\n");
  for (std::size_t i = 0; i < vertices.size; ++i)
    for (const FieldReader &coordinate : vertices.position)
      putBig (file, bitsOf (coordinate (i)));

  std::size_t numbers = 0;
  for (const pcl::Vertices &polygon : mesh.polygons)
    numbers += polygon.vertices.size () + 1;
  file.write ("\nPOLYGONS ");
  file.writeNumber (mesh.polygons.size ());
  file.write (" ");
  file.writeNumber (numbers);
  file.write ("\n");
  for (const pcl::Vertices &polygon : mesh.polygons)
  {
    putBig (file, static_cast<std::uint32_t> (polygon.vertices.size ()));
    for (const auto vertex : polygon.vertices)
      putBig (file, static_cast<std::uint32_t> (vertex));
  }
  writeVtkAttributes (vertices, file);
}

void
writeStl (const pcl::PolygonMesh &mesh, OutputFile &file)
{
  const Vertices vertices (mesh.cloud);
  std::string header = "binary STL"; // not "solid": that begins a text file
  header.resize (80, ' ');
  file.write (header);
  putLittle (file, static_cast<std::uint32_t> (mesh.polygons.size ()));
  for (const pcl::Vertices &polygon : mesh.polygons)
  {
    Eigen::Vector3f corners[3];
    for (std::size_t c = 0; c < 3; ++c)
      corners[c] = vertices.positionOf (polygon.vertices[c]);
    const Eigen::Vector3f normal = (corners[1] - corners[0]).cross (corners[2] - corners[0]).normalized ();
    for (const Eigen::Vector3f &vector : {normal, corners[0], corners[1], corners[2]})
      for (const float coordinate : {vector.x (), vector.y (), vector.z ()})
        putLittle (file, bitsOf (coordinate));
    putLittle (file, std::uint16_t (0));
  }
}

/** \brief A line of three numbers. */
void
writeObjLine (OutputFile &file, const char *keyword, const FieldReader (&fields)[3], std::size_t vertex)
{
  file.write (keyword);
  for (const FieldReader &coordinate : fields)
  {
    file.write (" ");
    file.writeNumber (static_cast<float> (coordinate (vertex)));
  }
  file.write ("\n");
}

void
writeObj (const pcl::PolygonMesh &mesh, OutputFile &file)
{
  const Vertices vertices (mesh.cloud);
  for (std::size_t i = 0; i < vertices.size; ++i)
    writeObjLine (file, "v", vertices.position, i);
  for (std::size_t i = 0; i < vertices.size && vertices.hasNormals (); ++i)
    writeObjLine (file, "vn", vertices.normal, i);
  for (const pcl::Vertices &polygon : mesh.polygons)
  {
    file.write ("f");
    for (const auto vertex : polygon.vertices)
    {
      const auto number = static_cast<std::size_t> (vertex) + 1;
      file.write (" ");
      file.writeNumber (number);
      if (!vertices.hasNormals ())
        continue;
      file.write ("//");
      file.writeNumber (number);
    }
    file.write ("\n");
  }
}

using Writer = void (*) (const pcl::PolygonMesh &mesh, OutputFile &file);

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
writeMesh (const pcl::PolygonMesh &mesh, const std::string &path, OutputFile &file)
{
  (*findFormat (WRITERS, path)) (mesh, file);
  file.close ();
}

} // namespace erkpa::tool
