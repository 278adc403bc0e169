// SPDX-License-Identifier: BSD-3-Clause
#include "option_list.h"

#include "named_values.h"

#include <sstream>
#include <string>
#include <vector>

namespace po = boost::program_options;

namespace erkpa::tool
{

namespace
{

/** \brief The value of -evaluate: two words, no more and no fewer, so that file names may follow. */
class TwoFiles : public po::typed_value<std::vector<std::string>>
{
public:
  TwoFiles () : po::typed_value<std::vector<std::string>> (nullptr)
  {
    value_name ("QUERY.xyz OUT.txt");
  }

  unsigned
  min_tokens () const override
  {
    return 2;
  }

  unsigned
  max_tokens () const override
  {
    return 2;
  }
};

template <typename T>
std::string
withDefault (const std::string &text, const T &value, const std::string &meaning = "")
{
  std::ostringstream stream;
  stream << text << " (default: " << value << (meaning.empty () ? "" : ", ") << meaning << ")";
  return stream.str ();
}

po::typed_value<std::string> *
word (const char *name)
{
  return po::value<std::string> ()->value_name (name);
}

po::typed_value<std::vector<std::string>> *
words (const char *name)
{
  return po::value<std::vector<std::string>> ()->value_name (name);
}

po::options_description
describeSupport (const FieldOptions &field)
{
  po::options_description description;
  description.add_options () //
      ("k", word ("N"),
       withDefault ("the support of the field reaches to the N-th nearest point", field.k, "chosen from the noise")
           .c_str ())                                                                                              //
      ("radius", word ("R"), withDefault ("constant support radius instead of k", field.radius, "use k").c_str ()) //
      ("radius_ramp", word ("axis,from,to"),
       "instead: a support radius that changes linearly along the axis x, y or z, from the lowest point to the highest "
       "(default: none)") //
      ("radius_field", word ("NAME"),
       "instead: the field of the cloud that holds the support radius of each point (default: none)") //
      ("flatten", word ("F"),
       withDefault ("how far the support of a point reaches along its normal, as a share of the radius", field.flatten)
           .c_str ()) //
      ("confidence_field", word ("NAME"),
       "the field of the cloud by which each point is weighed (default: none)") //
      ("kernel", word ("NAME"),
       withDefault (listNames (KERNELS) + ": how points are weighed by distance", nameOf (KERNELS, field.kernel),
                    "the paper's, or wendland_c2 for collocation")
           .c_str ());
  return description;
}

po::options_description
describeField (const FieldOptions &field)
{
  po::options_description description;
  description.add_options () //
      ("order", word ("NAME"),
       withDefault (listNames (ORDERS) + ": what the field reproduces exactly", nameOf (ORDERS, field.order),
                    "spherical, or linear for functional constraints")
           .c_str ()) //
      ("constraint", word ("NAME"),
       withDefault (listNames (CONSTRAINTS) + ": what the points ask of the field",
                    nameOf (CONSTRAINTS, field.constraint))
           .c_str ()) //
      ("offset", word ("F"),
       withDefault ("how far off-surface points are from theirs, as a share of the support radius", field.offset)
           .c_str ()) //
      ("interpolate", word ("NAME"),
       withDefault (listNames (INTERPOLATIONS) + ": how the surface is made to pass through the points",
                    nameOf (INTERPOLATIONS, field.interpolation))
           .c_str ());
  return description;
}

po::options_description
describeSharpEdges (const Options &options)
{
  po::options_description description;
  description.add_options () //
      ("sharp", words ("a,b,c,d"),
       "a sharp edge where the plane a x + b y + c z + d = 0 cuts the surface; may be repeated (default: none)") //
      ("sharp_sphere", words ("x,y,z,r"), "the same with a sphere: center and radius (default: none)")           //
      ("sharp_cylinder", words ("x,y,z,dx,dy,dz,r"),
       "the same with a cylinder: point on the axis, direction of the axis, radius (default: none)") //
      ("sharp_cone", words ("x,y,z,dx,dy,dz,angle"),
       "the same with a cone: apex, direction of the axis, angle between axis and side in radians (default: none)") //
      ("sharp_edges", word ("FILE.json"), "sharp edges from a file that -save_sharp_edges wrote (default: none)")   //
      ("face", words ("a,b,c,d"),
       "a face of the solid, in the plane a x + b y + c z + d = 0: sharp edges where faces meet in the points; may be "
       "repeated (default: none)") //
      ("face_tolerance", word ("T"),
       withDefault ("how far points may lie off their face", options.sharp.face_tolerance, "half their spacing")
           .c_str ())                                                                     //
      ("sharp_auto", po::bool_switch (), "find sharp edges in the points (default: not)") //
      ("sharp_angle", word ("DEGREES"),
       withDefault ("edges found in the points turn by at least this, 5 to 90", options.sharp.angle).c_str ()) //
      ("save_sharp_edges", word ("FILE.json"),
       "also write all sharp edges, those given and those found (default: none)") //
      ("creases", word ("FILE"),
       "also write the creases of the mesh as lines, .vtk or .ply (default: none)") //
      ("split_normals", po::bool_switch (),
       "vertices of creases are doubled, with the normals of each side (default: not)") //
      ("enrichment", word ("NAME"),
       withDefault (listNames (ENRICHMENTS) + ": what sharp edges add to the field; jump is for functional constraints",
                    nameOf (ENRICHMENTS, options.field.enrichment))
           .c_str ());
  return description;
}

po::options_description
describeMeshing (const PolygonizerOptions &polygonizer)
{
  po::options_description description;
  description.add_options () //
      ("voxel", word ("S"),
       withDefault ("side of a grid cell", polygonizer.voxel_size, "from the spacing of the points").c_str ()) //
      ("resolution", word ("N"),
       withDefault ("instead: grid cells along the longest side of the cloud", polygonizer.resolution,
                    "use voxel")
           .c_str ())                                                                                             //
      ("iso", word ("V"), withDefault ("the surface is f = V, positive outside", polygonizer.iso_level).c_str ()) //
      ("moment_tolerance", word ("T"),
       withDefault ("how far weights may be off, as a share of the largest, where supports of a constant radius hold "
                    "many hundreds of points and sums are interpolated; 0: none are",
                    polygonizer.moment_tolerance)
           .c_str ()) //
      ("viewpoint", word ("x,y,z"),
       "where the sensor stood, for the sign of estimated normals (default: as a .pcd or .ply file says; "
       "without, "
       "normals point outwards)") //
      ("threads", word ("N"),
       withDefault ("number of threads, but for reading text; the mesh does not depend on it", polygonizer.threads,
                    "all processors")
           .c_str ()) //
      ("evaluate", new TwoFiles,
       "write x y z f gx gy gz at the points of QUERY.xyz, nan where f is not defined (default: "
       "none)")                                                                                        //
      ("report", word ("FILE.json"), "also write what was done, and how long it took (default: none)") //
      ("help,h", "print this text, as -h does") ("version", "print the version");
  return description;
}

} // namespace

po::options_description
listOptions (const Options &defaults)
{
  po::options_description description;
  description.add (describeSupport (defaults.field));
  description.add (describeField (defaults.field)).add (describeSharpEdges (defaults));
  description.add (describeMeshing (defaults.polygonizer));
  return description;
}

} // namespace erkpa::tool
