// SPDX-License-Identifier: BSD-3-Clause
#include "block_points.h"

#include <cstddef>

namespace erkpa
{

void
BlockPoints::add (const Eigen::Vector3f &x)
{
  if (stride () < count_ + lanes::MAX_WIDTH)
    resize (2 * (count_ + lanes::MAX_WIDTH));
  for (std::size_t a = 0; a < 3; ++a)
    points_[a][count_] = x[static_cast<Eigen::Index> (a)];
  ++count_;
}

void
BlockPoints::resize (std::size_t size)
{
  for (auto *arrays : {&points_, &growths_, &gradients, &radius_gradients})
    for (std::vector<float> &array : *arrays)
      array.resize (size);
  for (std::vector<float> *array : {&bounds_, &guesses_, &values, &radii, &border_offsets, &nearest_distances, &asides})
    array->resize (size);
  in_reach.resize (size);
  states.resize (size);
  nearest.resize (size);
  supports.resize (size);
  active.resize (size);
  attributes_.resize (size * channels_);
  coefficients_.resize (size * terms_);
}

void
BlockPoints::pad ()
{
  const std::size_t padded = (count_ + lanes::MAX_WIDTH - 1) / lanes::MAX_WIDTH * lanes::MAX_WIDTH;
  const auto repeat_last = [&] (std::vector<float> &array)
  {
    for (std::size_t i = count_; i < padded; ++i)
      array[i] = array[count_ - 1];
  };
  for (std::size_t a = 0; a < 3; ++a)
  {
    repeat_last (points_[a]);
    repeat_last (growths_[a]);
  }
  repeat_last (bounds_);
  repeat_last (guesses_);
}

lanes::Points
BlockPoints::points (bool growths) const
{
  const auto growth = [&] (std::size_t a) { return growths ? growths_[a].data () : nullptr; };
  return {count_,
          points_[0].data (),
          points_[1].data (),
          points_[2].data (),
          bounds_.data (),
          guesses_.data (),
          {growth (0), growth (1), growth (2)},
          stride ()};
}

lanes::Samples
BlockPoints::samples ()
{
  lanes::Samples samples{};
  samples.value = values.data ();
  samples.radius = radii.data ();
  samples.in_reach = in_reach.data ();
  samples.state = states.data ();
  samples.nearest = wants_nearest_ ? nearest.data () : nullptr;
  samples.nearest_distance = nearest_distances.data ();
  samples.aside = asides.data ();
  samples.coefficients = terms_ > 0 ? coefficients_.data () : nullptr;
  samples.support = supports.data ();
  samples.active = active.data ();
  for (std::size_t a = 0; a < 3; ++a)
  {
    samples.gradient[a] = gradients[a].data ();
    samples.radius_gradient[a] = radius_gradients[a].data ();
  }
  samples.border_offset = border_offsets.data ();
  samples.attributes = attributes_.data ();
  return samples;
}

void
BlockPoints::run (const lanes::Engine &engine, const lanes::Settings &settings, const lanes::Nodes &nodes, bool growths,
                  const lanes::SharpSurfaces *sharp)
{
  pad ();
  engine.evaluate (settings, nodes, points (growths), sharp != nullptr ? *sharp : lanes::SharpSurfaces{},
                   memory_.scratchFor (nodes.count), samples ());
}

void
BlockPoints::interpolate (const lanes::Engine &engine, const lanes::Settings &settings, const lanes::Lattice &lattice)
{
  pad ();
  engine.lattice->interpolate (settings, lattice, points (false), samples ());
}

} // namespace erkpa
