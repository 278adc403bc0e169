// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes/lanes.h"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <vector>

namespace bench
{

/** \brief Where a box is evaluated. */
enum class Place
{
  EDGE,  ///< around the middle parts of its edges: one sharp plane is in reach
  CORNER ///< around its corners: three of them
};

struct FieldCase
{
  Place place;
  bool planes;                        ///< twelve sharp planes halve its edges
  const erkpa::lanes::Engine *engine; ///< BlockField with these vectors, for a field without planes; null: LocalField
  bool gradients;
};

/** \brief The field of a box at the grid nodes of blocks, nodes gathered for each block as the polygonizer does it. */
class FieldProblem
{
public:
  explicit FieldProblem (const FieldCase &what);
  ~FieldProblem ();

  /** \brief Gathers for a ball and evaluates its points; the balls take turns. */
  void
  evaluate (std::size_t ball);

  std::size_t
  evaluations () const;

  /** \brief Nodes in the supports of all evaluations together. */
  std::size_t
  pairs () const;

private:
  void
  chooseBalls ();

  void
  evaluateTogether (const Eigen::Vector3d &center);

  void
  evaluateAlone (const Eigen::Vector3d &center);

  struct Fields;
  FieldCase what_;
  std::unique_ptr<Fields> fields_;
  std::vector<Eigen::Vector3d> centers_, offsets_;
  double extent_ = 0.0; // of a block
  double sum_ = 0.0;    // of what was found, so that it is used
};

} // namespace bench
