// SPDX-License-Identifier: BSD-3-Clause
#include "command_line.h"

#include "cloud_reader.h"
#include "mesh_writer.h"
#include "option_values.h"

#include <boost/program_options.hpp>

#include <algorithm>
#include <sstream>

namespace po = boost::program_options;

namespace erkpa::tool
{

namespace
{

constexpr const char *SYNTAX = "erkpa_reconstruct INPUT OUTPUT [options]";
constexpr const char *FIELD_SYNTAX = "erkpa_reconstruct INPUT -evaluate QUERY.xyz OUT.txt [options]";

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
           .c_str ()) //
      ("sharp", words ("a,b,c,d"),
       "a sharp edge where the plane a x + b y + c z + d = 0 cuts the surface; may be repeated (default: none)") //
      ("sharp_sphere", words ("x,y,z,r"), "the same with a sphere: center and radius (default: none)")           //
      ("sharp_cylinder", words ("x,y,z,dx,dy,dz,r"),
       "the same with a cylinder: point on the axis, direction of the axis, radius (default: none)") //
      ("sharp_cone", words ("x,y,z,dx,dy,dz,angle"),
       "the same with a cone: apex, direction of the axis, angle between axis and side in radians (default: none)") //
      ("enrichment", word ("NAME"),
       withDefault (listNames (ENRICHMENTS) + ": what sharp edges add to the field; jump is for functional constraints",
                    nameOf (ENRICHMENTS, field.enrichment))
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
      ("viewpoint", word ("x,y,z"),
       "where the sensor stood, for the sign of estimated normals (default: as a .pcd or .ply file says; "
       "without, "
       "normals point outwards)") //
      ("threads", word ("N"),
       withDefault ("number of threads; the mesh does not depend on it", polygonizer.threads,
                    "all processors")
           .c_str ()) //
      ("evaluate", new TwoFiles,
       "write x y z f gx gy gz at the points of QUERY.xyz, nan where f is not defined (default: "
       "none)")                                                                                        //
      ("report", word ("FILE.json"), "also write what was done, and how long it took (default: none)") //
      ("help,h", "print this text, as -h does") ("version", "print the version");
  return description;
}

po::options_description
describe (const Options &defaults)
{
  po::options_description description;
  description.add (describeSupport (defaults.field));
  description.add (describeField (defaults.field)).add (describeMeshing (defaults.polygonizer));
  return description;
}

/** \brief The words that belong to no option. */
std::vector<std::string>
fileNames (const po::parsed_options &parsed)
{
  std::vector<std::string> names;
  for (const po::option &option : parsed.options)
    if (option.string_key.empty ())
      names.insert (names.end (), option.value.begin (), option.value.end ());
  return names;
}

/** \brief Gives \a take the text of an option that was given. */
template <typename TakeT>
void
ifGiven (const po::variables_map &variables, const char *name, TakeT take)
{
  if (variables.count (name) > 0)
    take (OptionText{name, variables[name].as<std::string> ()});
}

/** \brief The sharp surfaces given by an option that may be repeated. */
void
takeSharpSurfaces (const po::variables_map &variables, const char *name, const char *form, SurfaceModel model,
                   FieldOptions &field)
{
  if (variables.count (name) == 0)
    return;
  for (const std::string &text : variables[name].as<std::vector<std::string>> ())
  {
    const OptionText option{name, text};
    const std::vector<double> numbers = toNumbers (option, form);
    SharpSurface::ConstPtr surface;
    const Outcome outcome = makeSharpSurface (model, std::vector<float> (numbers.begin (), numbers.end ()), surface);
    if (!outcome.ok ())
      option.refuse (outcome.message);
    field.sharp_surfaces.push_back (surface);
  }
}

RadiusRamp
toRamp (const OptionText &option)
{
  const std::string form = "axis,from,to";
  const std::size_t axis = std::string ("xyz").find (option.text.substr (0, 1));
  if (axis > 2 || option.text.size () < 2 || option.text[1] != ',')
    option.refuse ("give " + form + ", an axis x, y or z and two radii with commas between and no blanks");
  RadiusRamp ramp;
  ramp.axis = static_cast<int> (axis);
  const std::vector<double> radii = toNumbers ({option.name, option.text.substr (2)}, "from,to");
  ramp.from = radii[0];
  ramp.to = radii[1];
  return ramp;
}

void
takeSupport (const po::variables_map &variables, Options &options)
{
  constexpr int LEAST_K = 5; // as FieldOptions::k says
  FieldOptions &field = options.field;
  ifGiven (variables, "k", [&] (const OptionText &o) { field.k = toCount (o, LEAST_K); });
  ifGiven (variables, "radius", [&] (const OptionText &o) { field.radius = toLength (o); });
  ifGiven (variables, "radius_ramp", [&] (const OptionText &o) { field.radius_ramp = toRamp (o); });
  ifGiven (variables, "radius_field", [&] (const OptionText &o) { options.points.radius_field = o.text; });
  ifGiven (variables, "confidence_field", [&] (const OptionText &o) { options.points.confidence_field = o.text; });
  ifGiven (variables, "flatten", [&] (const OptionText &o) { field.flatten = toNumber (o); });
  ifGiven (variables, "kernel", [&] (const OptionText &o) { field.kernel = toEnum (o, KERNELS); });
}

void
takeField (const po::variables_map &variables, FieldOptions &field)
{
  ifGiven (variables, "order", [&] (const OptionText &o) { field.order = toEnum (o, ORDERS); });
  ifGiven (variables, "constraint", [&] (const OptionText &o) { field.constraint = toEnum (o, CONSTRAINTS); });
  ifGiven (variables, "offset", [&] (const OptionText &o) { field.offset = toNumber (o); });
  ifGiven (variables, "interpolate", [&] (const OptionText &o) { field.interpolation = toEnum (o, INTERPOLATIONS); });
  ifGiven (variables, "enrichment", [&] (const OptionText &o) { field.enrichment = toEnum (o, ENRICHMENTS); });
  takeSharpSurfaces (variables, "sharp", "a,b,c,d", SurfaceModel::PLANE, field);
  takeSharpSurfaces (variables, "sharp_sphere", "x,y,z,r", SurfaceModel::SPHERE, field);
  takeSharpSurfaces (variables, "sharp_cylinder", "x,y,z,dx,dy,dz,r", SurfaceModel::CYLINDER, field);
  takeSharpSurfaces (variables, "sharp_cone", "x,y,z,dx,dy,dz,angle", SurfaceModel::CONE, field);
}

void
takeMeshing (const po::variables_map &variables, CommandLine &line)
{
  PolygonizerOptions &polygonizer = line.options.polygonizer;
  NormalOptions &normals = line.options.normals;
  ifGiven (variables, "voxel", [&] (const OptionText &o) { polygonizer.voxel_size = toLength (o); });
  ifGiven (variables, "resolution", [&] (const OptionText &o) { polygonizer.resolution = toCount (o, 1); });
  ifGiven (variables, "iso", [&] (const OptionText &o) { polygonizer.iso_level = toNumber (o); });
  ifGiven (variables, "threads", [&] (const OptionText &o) { polygonizer.threads = normals.threads = toCount (o, 1); });
  ifGiven (variables, "viewpoint",
           [&] (const OptionText &o)
           {
             normals.view_point = Eigen::Vector3d (toNumbers (o, "x,y,z").data ());
             normals.has_view_point = true;
           });
  ifGiven (variables, "report", [&] (const OptionText &o) { line.report = o.text; });
  if (variables.count ("evaluate") > 0)
  {
    const auto &files = variables["evaluate"].as<std::vector<std::string>> ();
    line.query = files.at (0);
    line.values = files.at (1);
  }
}

void
refuseBoth (const po::variables_map &variables, const char *one, const char *other)
{
  if (variables.count (one) > 0 && variables.count (other) > 0)
    throw ToolError (std::string ("options -") + one + " and -" + other + " exclude each other; give one of them");
}

void
takeFileNames (const std::vector<std::string> &names, CommandLine &line)
{
  const bool needs_mesh = line.query.empty ();
  if (names.size () > 2 || names.size () < (needs_mesh ? 2 : 1))
    throw ToolError ((names.size () < 2 ? "a file name is missing" : "too many file names: " + names[2]) +
                     "; the syntax is " + SYNTAX + ", see -help");
  line.input = names[0];
  line.output = names.size () > 1 ? names[1] : "";
  if (!isReadable (line.input))
    throw ToolError ("cannot read " + line.input + ": the format is unknown; use one of " + readableFormats ());
  if (!line.output.empty () && !isWritable (line.output))
    throw ToolError ("cannot write " + line.output + ": the format is unknown; use one of " + writableFormats ());
  if (!line.query.empty () && !isReadable (line.query))
    throw ToolError ("option -evaluate: cannot read " + line.query + ": the format is unknown; use one of " +
                     readableFormats ());
  const bool repeats = (!line.output.empty () && (line.report == line.output || line.values == line.output)) ||
                       (!line.report.empty () && line.report == line.values);
  const bool overwrites = !line.values.empty () && (line.values == line.query || line.values == line.input);
  if (overwrites)
    throw ToolError ("option -evaluate would write over " + line.values + ", which it reads; give another name");
  if (repeats)
    throw ToolError ("OUTPUT, -report and -evaluate must not write the same file; give them different names");
}

} // namespace

CommandLine
parseCommandLine (int argc, const char *const *argv)
{
  CommandLine line;
  const po::options_description description = describe (line.options);
  // no abbreviations, and one dash will do for a long name; short names are there for the sake of unknown
  // options, which would count as file names without them
  using style = po::command_line_style::style_t;
  constexpr int STYLE = style::allow_long | style::long_allow_adjacent | style::long_allow_next |
                        style::allow_long_disguise | style::allow_short | style::allow_dash_for_short |
                        style::short_allow_next;
  po::variables_map variables;
  try
  {
    const po::parsed_options parsed = po::command_line_parser (argc, argv).options (description).style (STYLE).run ();
    po::store (parsed, variables);
    line.help = variables.count ("help") > 0;
    line.version = variables.count ("version") > 0;
    if (line.help || line.version)
      return line;
    refuseBoth (variables, "voxel", "resolution");
    for (const char *one : {"k", "radius", "radius_ramp", "radius_field"})
      for (const char *other : {"k", "radius", "radius_ramp", "radius_field"})
        if (one != other)
          refuseBoth (variables, one, other);
    takeSupport (variables, line.options);
    takeField (variables, line.options.field);
    takeMeshing (variables, line);
    const Outcome outcome = ImplicitField::checkOptions (line.options.field);
    if (!outcome.ok ())
      throw ToolError (outcome.message);
    takeFileNames (fileNames (parsed), line);
  }
  catch (const po::error &error)
  {
    throw ToolError (std::string (error.what ()) + "; see -help");
  }
  return line;
}

std::string
helpText ()
{
  std::ostringstream text;
  text << "Reconstruct a surface with sharp edges from a point cloud by enriched reproducing kernel "
          "approximation.\n"
       << "Syntax is: " << SYNTAX << "\n"
       << "       or: " << FIELD_SYNTAX << ", without a mesh\n"
       << "  INPUT:  " << readableFormats () << "; points with or without normals\n"
       << "  OUTPUT: " << writableFormats () << "\n"
       << "  where options (with one dash or two) are:\n";
  const po::options_description description = describe (Options ());
  for (const auto &option : description.options ())
  {
    const bool has_value = option->semantic ()->max_tokens () > 0;
    std::string syntax = "-" + option->long_name ();
    if (has_value)
      syntax += " " + option->format_parameter ();
    syntax.resize (std::max<std::size_t> (syntax.size (), 29), ' ');
    text << "    " << syntax << " = " << option->description () << "\n";
  }
  return text.str ();
}

} // namespace erkpa::tool
