// SPDX-License-Identifier: BSD-3-Clause
#include "sharp_options.h"

#include "option_values.h"

#include <erkpa/sharp_surface_io.h>

namespace po = boost::program_options;

namespace erkpa::tool
{

namespace
{

/** \brief Gives \a take the surfaces of an option that may be repeated, with their coefficients. */
template <typename TakeT>
void
forEachSurface (const po::variables_map &variables, const char *name, const char *form, SurfaceModel model, TakeT take)
{
  if (variables.count (name) == 0)
    return;
  for (const std::string &text : variables[name].as<std::vector<std::string>> ())
  {
    const OptionText option{name, text};
    const std::vector<double> numbers = toNumbers (option, form);
    const std::vector<float> coefficients (numbers.begin (), numbers.end ());
    SharpSurface::ConstPtr surface;
    const Outcome outcome = makeSharpSurface (model, coefficients, surface);
    if (!outcome.ok ())
      option.refuse (outcome.message);
    take (surface, coefficients);
  }
}

void
takeSharpSurfaces (const po::variables_map &variables, CommandLine &line)
{
  std::vector<SharpSurface::ConstPtr> &surfaces = line.options.field.sharp_surfaces;
  const auto add = [&] (const SharpSurface::ConstPtr &surface, const std::vector<float> &)
  { surfaces.push_back (surface); };
  forEachSurface (variables, "sharp", "a,b,c,d", SurfaceModel::PLANE, add);
  forEachSurface (variables, "sharp_sphere", "x,y,z,r", SurfaceModel::SPHERE, add);
  forEachSurface (variables, "sharp_cylinder", "x,y,z,dx,dy,dz,r", SurfaceModel::CYLINDER, add);
  forEachSurface (variables, "sharp_cone", "x,y,z,dx,dy,dz,angle", SurfaceModel::CONE, add);
  ifGiven (variables, "sharp_edges", [&] (const OptionText &o) { line.sharp_edges = o.text; });
  if (line.sharp_edges.empty ())
    return;
  std::vector<SharpSurface::ConstPtr> loaded;
  const Outcome outcome = loadSharpSurfaces (line.sharp_edges, loaded);
  if (!outcome.ok ())
    throw ToolError ("option -sharp_edges: " + outcome.message);
  surfaces.insert (surfaces.end (), loaded.begin (), loaded.end ());
}

} // namespace

void
takeSharpEdges (const po::variables_map &variables, CommandLine &line)
{
  takeSharpSurfaces (variables, line);
  SharpOptions &sharp = line.options.sharp;
  const auto toAngle = [] (const OptionText &option)
  {
    const double angle = toNumber (option);
    if (!(angle >= 5.0 && angle <= 90.0)) // as SharpOptions::angle says
      option.refuse ("give an angle of 5 to 90 degrees");
    return angle;
  };
  sharp.automatic = variables["sharp_auto"].as<bool> ();
  ifGiven (variables, "sharp_angle", [&] (const OptionText &o) { sharp.angle = toAngle (o); });
  forEachSurface (variables, "face", "a,b,c,d", SurfaceModel::PLANE,
                  [&] (const SharpSurface::ConstPtr &, const std::vector<float> &coefficients) {
                    sharp.faces.push_back ({SurfaceModel::PLANE, coefficients});
                  });
  ifGiven (variables, "face_tolerance", [&] (const OptionText &o) { sharp.face_tolerance = toLength (o); });
  ifGiven (variables, "save_sharp_edges", [&] (const OptionText &o) { line.saved_sharp_edges = o.text; });
  ifGiven (variables, "creases", [&] (const OptionText &o) { line.creases = o.text; });
  line.options.polygonizer.split_normals = variables["split_normals"].as<bool> ();
}

} // namespace erkpa::tool
