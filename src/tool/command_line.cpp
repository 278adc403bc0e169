// SPDX-License-Identifier: BSD-3-Clause
#include "command_line.h"

#include "cloud_reader.h"
#include "crease_writer.h"
#include "mesh_writer.h"
#include "option_list.h"
#include "option_values.h"
#include "sharp_options.h"

#include <algorithm>
#include <sstream>

namespace po = boost::program_options;

namespace erkpa::tool
{

namespace
{

constexpr const char *SYNTAX = "erkpa_reconstruct INPUT OUTPUT [options]";
constexpr const char *FIELD_SYNTAX = "erkpa_reconstruct INPUT -evaluate QUERY.xyz OUT.txt [options]";

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
}

void
takeMeshing (const po::variables_map &variables, CommandLine &line)
{
  PolygonizerOptions &polygonizer = line.options.polygonizer;
  NormalOptions &normals = line.options.normals;
  ifGiven (variables, "voxel", [&] (const OptionText &o) { polygonizer.voxel_size = toLength (o); });
  ifGiven (variables, "resolution", [&] (const OptionText &o) { polygonizer.resolution = toCount (o, 1); });
  ifGiven (variables, "iso", [&] (const OptionText &o) { polygonizer.iso_level = toNumber (o); });
  ifGiven (variables, "moment_tolerance", [&] (const OptionText &o) { polygonizer.moment_tolerance = toNumber (o); });
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
}

/** \brief A file that one option names, to read or to write. */
struct NamedFile
{
  const char *option;
  const std::string &path;
};

/** \brief What is written must not be written twice, nor over what is read. */
void
checkFileNames (const CommandLine &line)
{
  const NamedFile written[] = {{"OUTPUT", line.output},
                               {"-report", line.report},
                               {"-evaluate", line.values},
                               {"-save_sharp_edges", line.saved_sharp_edges},
                               {"-creases", line.creases}};
  for (const NamedFile &file : written)
    for (const NamedFile &other : written)
      if (&file < &other && !file.path.empty () && file.path == other.path)
        throw ToolError (std::string (file.option) + " and " + other.option +
                         " must not write the same file; give them different names");
  for (const NamedFile &file : written)
    for (const std::string *read : {&line.input, &line.query, &line.sharp_edges})
      if (&file.path != &line.output && !file.path.empty () && file.path == *read)
        throw ToolError (std::string ("option ") + file.option + " would write over " + file.path +
                         ", which is read; give another name");
  if (line.creases.empty ())
    return;
  if (!isWritableForCreases (line.creases))
    throw ToolError ("cannot write " + line.creases + ": the format is unknown; use one of " +
                     writableCreaseFormats ());
  if (line.output.empty ())
    throw ToolError ("option -creases: there are no creases without a mesh; name an OUTPUT");
}

} // namespace

CommandLine
parseCommandLine (int argc, const char *const *argv)
{
  CommandLine line;
  const po::options_description description = listOptions (line.options);
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
    takeSharpEdges (variables, line);
    takeMeshing (variables, line);
    const Outcome outcome = ImplicitField::checkOptions (line.options.field);
    if (!outcome.ok ())
      throw ToolError (outcome.message);
    takeFileNames (fileNames (parsed), line);
    checkFileNames (line);
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
  const po::options_description description = listOptions (Options ());
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
