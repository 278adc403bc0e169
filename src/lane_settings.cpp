// SPDX-License-Identifier: BSD-3-Clause
#include "lane_settings.h"

#include "face_tree.h"
#include "support.h"
#include "support_size.h"

#include <algorithm>

namespace erkpa
{

namespace
{

lanes::Basis
laneBasisOf (Order order)
{
  switch (order)
  {
    case Order::CONSTANT:
      return lanes::Basis::CONSTANT;
    case Order::LINEAR:
      return lanes::Basis::LINEAR;
    case Order::QUADRATIC:
      return lanes::Basis::QUADRATIC;
    case Order::AUTOMATIC: // settled by the field
    case Order::SPHERICAL:
      break;
  }
  return lanes::Basis::SPHERICAL;
}

lanes::Constraint
laneConstraintOf (Constraint constraint)
{
  switch (constraint)
  {
    case Constraint::FUNCTIONAL:
      return lanes::Constraint::FUNCTIONAL;
    case Constraint::OFFSURFACE:
      return lanes::Constraint::VALUES;
    case Constraint::HERMITE:
      break;
  }
  return lanes::Constraint::HERMITE;
}

/** \brief All trees, as the lanes see them. */
struct LaneTrees
{
  static_assert (lanes::FaceFits::MAX == FaceTree::MAX_FACES);
  lanes::Trees::Step steps[FaceTree::MAX_FACES + 1][lanes::Trees::MAX][FaceTree::MAX_FACES - 1] = {};

  LaneTrees ()
  {
    for (int faces = 1; faces <= FaceTree::MAX_FACES; ++faces)
    {
      std::size_t t = 0;
      for (const FaceTree &tree : treesOf (faces))
      {
        for (std::size_t s = 0; s + 1 < static_cast<std::size_t> (faces); ++s)
          steps[faces][t][s] = {static_cast<std::uint8_t> (tree.steps[s].face),
                                static_cast<std::uint8_t> (tree.steps[s].other), tree.steps[s].larger};
        ++t;
      }
    }
  }
};

} // namespace

std::optional<lanes::Kernel>
laneKernelOf (const FieldOptions &options)
{
  if (options.user_kernel || options.interpolation == Interpolation::SINGULAR)
    return std::nullopt;
  switch (options.kernel)
  {
    case KernelType::AUTOMATIC:
      return options.interpolation == Interpolation::COLLOCATION ? lanes::Kernel::WENDLAND_C2 : lanes::Kernel::PAPER;
    case KernelType::PAPER:
      return lanes::Kernel::PAPER;
    case KernelType::WENDLAND_C2:
      return lanes::Kernel::WENDLAND_C2;
    case KernelType::WENDLAND_C4:
      return lanes::Kernel::WENDLAND_C4;
    case KernelType::GAUSSIAN:
      return lanes::Kernel::GAUSSIAN;
    case KernelType::SINGULAR: // weights of 1e12 leave nothing of the others in float
      break;
  }
  return std::nullopt;
}

lanes::Settings
laneSettingsOf (const ImplicitField &field)
{
  lanes::Settings settings{};
  settings.basis = laneBasisOf (field.options ().order);
  settings.constraint = laneConstraintOf (field.options ().constraint);
  settings.kernel = laneKernelOf (field.options ()).value_or (lanes::Kernel::PAPER);
  const double flatten = field.options ().flatten;
  settings.stretch = static_cast<float> (1.0 / (flatten * flatten) - 1.0);
  const bool by_nearest = field.supportSize ().kind () == SupportSize::Kind::NEAREST;
  settings.k = by_nearest ? std::min (field.supportSize ().k (), static_cast<int> (field.points ().size ())) : 0;
  settings.min_nodes = static_cast<int> (std::min (Support::MIN_NODES, field.points ().size ()));
  return settings;
}

lanes::Trees
laneTreesOf (std::size_t faces)
{
  static const LaneTrees ALL;
  return {treesOf (static_cast<int> (faces)).size (), ALL.steps[faces]};
}

std::size_t
termsOf (lanes::Basis basis)
{
  switch (basis)
  {
    case lanes::Basis::CONSTANT:
      return ConstantBasis::SIZE;
    case lanes::Basis::LINEAR:
      return LinearBasis::SIZE;
    case lanes::Basis::SPHERICAL:
      return SphericalBasis::SIZE;
    case lanes::Basis::QUADRATIC:
      break;
  }
  return QuadraticBasis::SIZE;
}

} // namespace erkpa
