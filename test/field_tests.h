// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "shapes.h"

#include "lanes/lanes.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

using Eigen::Vector3d;
using erkpa::FieldOptions;
using erkpa::ImplicitField;
using erkpa::Order;

/** \brief What the tests of the field share: random points, functions to reproduce, options. */

inline std::mt19937 random_engine;

/** \brief Each test starts with the same random numbers, whichever run before it. */
class FieldTest : public testing::Test
{
protected:
  void
  SetUp () override
  {
    random_engine.seed (11);
  }
};

inline Vector3d
randomPoint (double size)
{
  std::uniform_real_distribution<double> uniform (-size, size);
  return {uniform (random_engine), uniform (random_engine), uniform (random_engine)};
}

/** \brief The lanes of every instruction set that this processor has. */
inline std::vector<const erkpa::lanes::Engine *>
allEngines ()
{
  std::size_t count = 0;
  const erkpa::lanes::Engine *const *const engines = erkpa::lanes::engines (count);
  return {engines, engines + count};
}

/** \brief Nodes all through a cube, as a fit in space needs them. */
inline shapes::Samples
nodesInCube (int count)
{
  shapes::Samples samples;
  for (int i = 0; i < count; ++i)
    samples.add (randomPoint (1.0).cast<float> ().cast<double> (), randomPoint (1.0).normalized ());
  return samples;
}

using Function = std::function<double (const Vector3d &)>;

inline Vector3d
differences (const Function &g, const Vector3d &x, double step = 1e-6)
{
  Vector3d result;
  for (int a = 0; a < 3; ++a)
  {
    const Vector3d to = step * Vector3d::Unit (a);
    result[a] = (g (x + to) - g (x - to)) / (2.0 * step);
  }
  return result;
}

inline FieldOptions
optionsOf (Order order, int k, double radius = 0.0)
{
  FieldOptions options;
  options.order = order;
  options.k = k;
  options.radius = radius;
  return options;
}

inline const std::vector<std::pair<std::string, Function>> MONOMIALS = {
    {"1", [] (const Vector3d &) { return 1.0; }},
    {"x", [] (const Vector3d &p) { return p.x (); }},
    {"y", [] (const Vector3d &p) { return p.y (); }},
    {"z", [] (const Vector3d &p) { return p.z (); }},
    {"x²+y²+z²", [] (const Vector3d &p) { return p.squaredNorm (); }},
    {"x²", [] (const Vector3d &p) { return p.x () * p.x (); }},
    {"y²", [] (const Vector3d &p) { return p.y () * p.y (); }},
    {"z²", [] (const Vector3d &p) { return p.z () * p.z (); }},
    {"xy", [] (const Vector3d &p) { return p.x () * p.y (); }},
    {"xz", [] (const Vector3d &p) { return p.x () * p.z (); }},
    {"yz", [] (const Vector3d &p) { return p.y () * p.z (); }},
};
