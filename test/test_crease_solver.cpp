// SPDX-License-Identifier: BSD-3-Clause
#include "field_tests.h"

#include "side_sampler.h"

#include <erkpa/sharp_detection.h>

using erkpa::LocalField;
using erkpa::Side;

namespace
{

/** \brief The face of which a field is at a place. */
int
faceAt (LocalField &local, const Vector3d &x)
{
  local.gather (x, 0.0);
  EXPECT_TRUE (local.sample (x).isDefined ());
  return local.face ();
}

} // namespace

/** \brief Where a cylinder meets its lid one Newton step does not do. */
TEST (CreaseSolver, GoesOnUntilThePiecesOfTheFieldMeetWhereTheyAreCurved)
{
  const auto points = shapes::points (shapes::tin (6000, 0.5, 0.5));
  FieldOptions options;
  ASSERT_TRUE (erkpa::findSharpSurfaces (*points, erkpa::PointLayout (*points, 0), erkpa::SharpOptions (), 0,
                                         options.sharp_surfaces)
                   .ok ());
  const auto field = shapes::field (points, options);
  const double spacing = field->spacing (), tolerance = 1e-5 * spacing;
  LocalField local (*field);
  erkpa::SideSampler sampler (*field);
  for (int i = 0; i < 12; ++i)
  {
    const Vector3d out (std::cos (0.5 * i), std::sin (0.5 * i), 0.0), up = Vector3d::UnitZ ();
    const Vector3d on_side = 0.5 * out + 0.48 * up, on_lid = 0.48 * out + 0.5 * up;
    const std::vector<Side> sides{{faceAt (local, on_side), on_side}, {faceAt (local, on_lid), on_lid}};
    ASSERT_NE (sides[0].face, sides[1].face);
    Vector3d x = 0.5 * (out + up) + 0.8 * spacing * (out - up);
    erkpa::CreaseSolver solver (sides, x, 0.0, 3.0 * spacing, tolerance);
    sampler.gather (x, 3.0 * spacing);
    erkpa::solveTogether (sampler, {&solver});
    ASSERT_TRUE (solver.hasArrived ());
    x = solver.position ();
    std::vector<erkpa::LocalSample> samples;
    local.sampleOnSides (x, sides, samples);
    for (const erkpa::LocalSample &sample : samples)
      EXPECT_LT (std::abs (sample.value), 3.0 * tolerance);
    EXPECT_LT ((x - 0.5 * (out + up)).norm (), 0.5 * spacing);
  }
}
