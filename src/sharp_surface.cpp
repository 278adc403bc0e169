// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/sharp_surface.h>

#include <cmath>
#include <string>

namespace erkpa
{

Outcome
makeSharpPlane (const std::vector<float> &coefficients, SharpSurface::ConstPtr &surface)
{
  const auto bad = [] (const std::string &why)
  {
    return Outcome{Status::INVALID_SETTING, "a sharp edge needs the four coefficients a, b, c, d of a plane "
                                            "a x + b y + c z + d = 0, " +
                                                why};
  };
  if (coefficients.size () != 4)
    return bad ("but " + std::to_string (coefficients.size ()) + " are given");
  for (const float value : coefficients)
    if (!std::isfinite (value))
      return bad ("but one of them is not finite");
  const Eigen::Vector3d normal (coefficients[0], coefficients[1], coefficients[2]);
  const double length = normal.norm ();
  if (length == 0.0)
    return bad ("but its normal a, b, c is zero");
  surface = std::make_shared<SharpPlane> (normal / length, coefficients[3] / length);
  return {};
}

} // namespace erkpa
