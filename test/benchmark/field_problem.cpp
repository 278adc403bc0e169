// SPDX-License-Identifier: BSD-3-Clause
#include "field_problem.h"

#include "block_field.h"
#include "local_field.h"
#include "shapes.h"

#include <optional>

namespace bench
{

namespace
{

constexpr int POINTS = 20000, K = 20;

Eigen::Vector3d
halfOfBox ()
{
  return {1.0, 0.7, 0.5};
}

std::shared_ptr<erkpa::ImplicitField>
makeField (bool planes)
{
  erkpa::FieldOptions options;
  options.k = K;
  if (planes)
    for (const Eigen::Vector4d &plane : shapes::boxBisectors (halfOfBox ()))
      options.sharp_surfaces.push_back (shapes::plane (plane));
  return shapes::field (shapes::box (POINTS, halfOfBox ()), options);
}

} // namespace

struct FieldProblem::Fields
{
  std::shared_ptr<erkpa::ImplicitField> field;
  erkpa::LocalField local;
  std::optional<erkpa::BlockField> block;

  explicit Fields (const FieldCase &what) : field (makeField (what.planes)), local (*field)
  {
    if (what.engine != nullptr)
      block.emplace (*field, *what.engine);
  }
};

FieldProblem::FieldProblem (const FieldCase &what) : what_ (what), fields_ (std::make_unique<Fields> (what))
{
  const double voxel = 0.7 * fields_->field->spacing (), half = 1.5 * voxel;
  extent_ = std::sqrt (3.0) * half;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z)
        offsets_.push_back (voxel * Eigen::Vector3d (x, y, z) - Eigen::Vector3d::Constant (half));
  chooseBalls ();
}

FieldProblem::~FieldProblem () = default;

void
FieldProblem::chooseBalls ()
{
  constexpr int STEPS = 20;
  const std::vector<Eigen::Vector3d> edges = shapes::boxEdgePoints (halfOfBox (), STEPS);
  constexpr std::size_t TO_EDGE = STEPS + 1;
  for (std::size_t i = 0; i < edges.size (); ++i)
  {
    const std::size_t step = i % TO_EDGE;
    const bool is_corner = step == 0 || step == STEPS, is_middle = step >= 4 && step <= STEPS - 4;
    if (what_.place == Place::CORNER ? is_corner : is_middle)
      centers_.push_back (edges[i]);
  }
}

void
FieldProblem::evaluate (std::size_t ball)
{
  const Eigen::Vector3d &center = centers_[ball % centers_.size ()];
  if (fields_->block)
    evaluateTogether (center);
  else
    evaluateAlone (center);
}

void
FieldProblem::evaluateTogether (const Eigen::Vector3d &center)
{
  erkpa::BlockField &block = *fields_->block;
  if (!block.gather (center, extent_))
    return;
  for (const Eigen::Vector3d &offset : offsets_)
    block.addPoint (center + offset);
  block.evaluate (what_.gradients);
  for (std::size_t i = 0; i < block.size (); ++i)
    sum_ += block.value (i);
}

void
FieldProblem::evaluateAlone (const Eigen::Vector3d &center)
{
  erkpa::LocalField &local = fields_->local;
  local.gather (center, extent_);
  for (const Eigen::Vector3d &offset : offsets_)
    sum_ += what_.gradients ? local.sample (center + offset).value : local.value (center + offset);
}

std::size_t
FieldProblem::evaluations () const
{
  return fields_->block ? fields_->block->evaluations () : fields_->local.evaluations ();
}

std::size_t
FieldProblem::pairs () const
{
  return fields_->block ? fields_->block->supportNodes () : fields_->local.supportNodes ();
}

} // namespace bench
