// SPDX-License-Identifier: BSD-3-Clause
#include "enrichment.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace erkpa
{

namespace
{

/** \brief The pencil of three planes, if they make one: α θ_a + β θ_b + γ θ_c = 0 with no factor near zero. */
bool
pencilOf (const std::array<const SharpPlane *, 3> &planes, double tolerance, Pencil &pencil)
{
  Eigen::Matrix<double, 3, 3> normals;
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero ();
  for (int i = 0; i < 3; ++i)
    normals.col (i) = planes[static_cast<std::size_t> (i)]->thetaGradient (zero);
  constexpr double PARALLEL = 0.05; // about 3 degrees: planes found by segmentation are not exact
  if (std::abs (normals.determinant ()) > 1.5 * PARALLEL)
    return false; // the smallest singular value is larger than PARALLEL: the other two make at most 1.5
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd (normals, Eigen::ComputeFullV);
  if (svd.singularValues ()[2] > PARALLEL || svd.singularValues ()[1] < PARALLEL)
    return false;
  const Eigen::Vector3d factors = svd.matrixV ().col (2);
  // A point on two of the planes: there the third must vanish too, else the three bound a prism.
  const Eigen::Vector3d offsets (planes[0]->theta (zero), planes[1]->theta (zero), planes[2]->theta (zero));
  if (std::abs (factors.dot (offsets)) > tolerance)
    return false;
  if (factors.cwiseAbs ().minCoeff () < 0.1)
    return false;
  pencil.scale_a = factors[0];
  pencil.scale_b = -factors[1];
  return true;
}

} // namespace

std::vector<Pencil>
findPencils (const std::vector<SharpSurface::ConstPtr> &surfaces, double tolerance)
{
  std::vector<const SharpPlane *> planes (surfaces.size ());
  std::vector<const SpaceWarp *> warps (surfaces.size ());
  for (std::size_t i = 0; i < surfaces.size (); ++i)
    planes[i] = planeBehind (*surfaces[i], &warps[i]);
  std::vector<Pencil> pencils;
  const int n = static_cast<int> (surfaces.size ());
  const auto plane = [&] (int i) { return planes[static_cast<std::size_t> (i)]; };
  const auto warp = [&] (int i) { return warps[static_cast<std::size_t> (i)]; };
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b)
      for (int c = b + 1; c < n; ++c)
      {
        Pencil pencil{{a, b, c}, 0.0, 0.0};
        if (plane (a) && plane (b) && plane (c) && warp (a) == warp (b) && warp (b) == warp (c) &&
            pencilOf ({plane (a), plane (b), plane (c)}, tolerance, pencil))
          pencils.push_back (pencil);
      }
  return pencils;
}

Enrichment::Enrichment (const ImplicitField &field)
    : field_ (field), jumps_ (field.options ().enrichment == EnrichmentType::JUMP)
{
  for (const SharpSurface::ConstPtr &surface : field.options ().sharp_surfaces)
  {
    const SpaceWarp *warp = nullptr;
    const bool is_linear = planeBehind (*surface, &warp) != nullptr && warp == nullptr;
    reversible_.push_back (jumps_ || (is_linear && field.options ().order != Order::CONSTANT) ? 1 : 0);
  }
}

void
Enrichment::gather (const Support &support)
{
  near_count_ = 0;
  near_pencils_.clear ();
  const int surfaces = static_cast<int> (field_.options ().sharp_surfaces.size ());
  for (int surface = 0; surface < surfaces; ++surface)
    evaluateThetas (support, surface);
  if (near_count_ < 3)
    return;
  std::vector<char> is_near (static_cast<std::size_t> (surfaces), 0);
  for (std::size_t i = 0; i < near_count_; ++i)
    is_near[static_cast<std::size_t> (near_[i].surface)] = 1;
  for (const Pencil &pencil : field_.pencils ())
    if (std::all_of (pencil.surfaces.begin (), pencil.surfaces.end (),
                     [&] (int surface) { return is_near[static_cast<std::size_t> (surface)] != 0; }))
      near_pencils_.push_back (pencil);
}

/** \brief Keep a surface that has gathered nodes on either side. */
void
Enrichment::evaluateThetas (const Support &support, int surface)
{
  const SharpSurface &sharp = *field_.options ().sharp_surfaces[static_cast<std::size_t> (surface)];
  const std::size_t slots = support.points ().size ();
  const auto position = [&] (std::size_t slot)
  { return Eigen::Vector3d (support.position (slot) + field_.points ().origin); };
  if (near_.size () == near_count_)
    near_.emplace_back ();
  NearSurface &near = near_[near_count_];
  near.surface = surface;
  near.at_nodes.clear ();
  bool below = false, above = false;
  for (std::size_t slot = 0; slot < slots; ++slot)
  {
    const double theta = sharp.theta (position (slot));
    near.at_nodes.push_back ({theta, Eigen::Vector3d::Zero ()});
    below = below || theta < 0.0;
    above = above || theta > 0.0;
  }
  if (!below || !above)
    return;
  for (std::size_t slot = 0; slot < slots; ++slot)
    near.at_nodes[slot].gradient = sharp.thetaGradient (position (slot));
  ++near_count_;
}

int
Enrichment::activeIndex (int surface) const
{
  for (std::size_t i = 0; i < near_count_; ++i)
    if (near_[i].surface == surface && near_[i].active)
      return static_cast<int> (i);
  return -1;
}

void
Enrichment::select (const Support &support, const Eigen::Vector3d &x)
{
  terms_.clear ();
  if (near_count_ == 0)
    return;
  const Eigen::Vector3d position = x + field_.points ().origin;
  for (std::size_t i = 0; i < near_count_; ++i)
  {
    NearSurface &near = near_[i];
    bool below = false, above = false;
    for (const SupportNode &node : support.nodes ())
    {
      const double theta = near.at_nodes[static_cast<std::size_t> (node.slot)].value;
      below = below || theta < 0.0;
      above = above || theta > 0.0;
    }
    near.active = below && above && size () < MAX_TERMS;
    if (!near.active)
      continue;
    const SharpSurface &surface = *field_.options ().sharp_surfaces[static_cast<std::size_t> (near.surface)];
    near.at_point = {surface.theta (position), surface.thetaGradient (position)};
    addTerm (static_cast<int> (i), -1, 1.0, 1.0);
  }
  if (terms_.size () < 3)
    return;
  for (const Pencil &pencil : near_pencils_)
    addCornerTerms (pencil);
}

bool
Enrichment::isReversible (int near) const
{
  return near < 0 || reversible_[static_cast<std::size_t> (near_[static_cast<std::size_t> (near)].surface)] != 0;
}

/** \brief Adds the term that is not zero where all its scaled θ are positive, or negative if x is among those. */
void
Enrichment::addTerm (int first, int second, double scale_a, double scale_b)
{
  const auto theta = [this] (int near) { return near_[static_cast<std::size_t> (near)].at_point.value; };
  const bool holds_x = scale_a * theta (first) >= 0.0 && (second < 0 || scale_b * theta (second) >= 0.0);
  const bool reverse = holds_x && isReversible (first) && isReversible (second);
  const double sign = reverse ? -1.0 : 1.0;
  terms_.push_back ({first, second, sign * scale_a, sign * scale_b, reverse});
}

void
Enrichment::addCornerTerms (const Pencil &pencil)
{
  const int a = activeIndex (pencil.surfaces[0]), b = activeIndex (pencil.surfaces[1]);
  const int c = activeIndex (pencil.surfaces[2]);
  if (a < 0 || b < 0 || c < 0 || size () + 1 + (jumps_ ? 1 : 0) > MAX_TERMS)
    return;
  addTerm (a, b, pencil.scale_a, pencil.scale_b);
  // The six sectors around the line have six indicators: 1, H(a), H(b), H(c), and two products.
  if (jumps_)
    addTerm (b, c, 1.0, 1.0);
}

void
Enrichment::evaluate (const Term &term, const Theta &a, const Theta *b, double radius, double &value,
                      Eigen::Vector3d &gradient) const
{
  double height = term.scale_a * a.value;
  Eigen::Vector3d slope = term.scale_a * a.gradient;
  if (b != nullptr && term.scale_b * b->value < height)
  {
    height = term.scale_b * b->value;
    slope = term.scale_b * b->gradient;
  }
  value = 0.0;
  gradient.setZero ();
  if (!(height > 0.0) && (term.open || height < 0.0))
    return;
  value = jumps_ ? 1.0 : height / radius;
  if (!jumps_)
    gradient = slope;
}

void
Enrichment::atNode (int term, int slot, double radius, double &value, Eigen::Vector3d &gradient) const
{
  const Term &t = terms_[static_cast<std::size_t> (term)];
  const auto i = static_cast<std::size_t> (slot);
  const Theta *b = t.second < 0 ? nullptr : &near_[static_cast<std::size_t> (t.second)].at_nodes[i];
  evaluate (t, near_[static_cast<std::size_t> (t.first)].at_nodes[i], b, radius, value, gradient);
}

void
Enrichment::atPoint (int term, double radius, double &value, Eigen::Vector3d &gradient) const
{
  const Term &t = terms_[static_cast<std::size_t> (term)];
  const Theta *b = t.second < 0 ? nullptr : &near_[static_cast<std::size_t> (t.second)].at_point;
  evaluate (t, near_[static_cast<std::size_t> (t.first)].at_point, b, radius, value, gradient);
}

} // namespace erkpa
