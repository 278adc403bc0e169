// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes/lanes.h"
#include "node_table.h"

#include <erkpa/implicit_field.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace erkpa
{

/** \brief Arrays only grow, so that nothing is filled in where they are made longer again and again. */
template <typename T>
void
makeRoom (std::size_t size, std::vector<T> &array)
{
  if (array.size () < size)
    array.resize (2 * size);
}

/** \brief Nodes around a ball as the arrays that the lanes read: with a middle as origin and a length as unit.
 *
 * Arrays keep their memory from ball to ball.
 */
class BlockNodes
{
public:
  /** \param[in] unit of the lanes' lengths */
  BlockNodes (const ImplicitField &field, const lanes::Engine &engine, double unit);

  /** \brief Look where the nodes may be whose value points lie within \a reach of \a center, which becomes the origin;
   * floats can say it. */
  void
  lookAround (const Eigen::Vector3d &center, double reach);

  /** \brief The same, and copy them, without what addValues () makes; boundOfKth () may be asked then. */
  void
  copyAround (const Eigen::Vector3d &center, double reach);

  /** \brief Forget all nodes, to append others. */
  void
  clear ()
  {
    count_ = 0;
  }

  /** \brief Copy some of other nodes, which were copied themselves; then call addValues ().
   * \param[in] first,last which of them
   */
  void
  append (const BlockNodes &from, const std::uint32_t *first, const std::uint32_t *last);

  /** \brief Number of nodes; their off-surface points are not among them. */
  std::size_t
  count () const
  {
    return count_;
  }

  /** \brief Index of a node among the field's points. */
  int
  node (std::size_t i) const
  {
    return static_cast<int> (index_[places_[i]]);
  }

  /** \brief Of a node, in the local frame. */
  Eigen::Vector3f
  position (std::size_t i) const
  {
    const std::uint32_t place = places_[i];
    return {table_.grid->coordinates (0)[place], table_.grid->coordinates (1)[place],
            table_.grid->coordinates (2)[place]};
  }

  /** \brief A distance within which there are k of the nodes of copyAround (), little more than that of the k-th.
   *
   * The exact one is found for every point by itself; a few counts are quicker here than a selection. It is the least
   * of fixed distances, so that it does not depend on the guess.
   * \param[in] guess a distance within which all nodes were copied, and which may do; HUGE_VAL where it does not
   */
  double
  boundOfKth (std::size_t k, double guess) const;

  /** \brief Make the arrays of those whose value points may lie within \a reach, which is not more than was looked for;
   * off-surface points come after the nodes. */
  void
  copyWithin (double reach);

  /** \brief Complete the arrays of nodes that were copied: values at the nodes, and the off-surface points. */
  void
  addValues ();

  /** \brief Make the array of attributes, which are wanted at few points only. */
  void
  copyAttributes ();

  /** \brief A coordinate of the nodes that were copied. */
  const float *
  coordinates (std::size_t axis) const
  {
    return positions_[axis].data ();
  }

  /** \param[in] attributes whether copyAttributes () was called, and they are wanted */
  lanes::Nodes
  view (bool attributes) const;

private:
  /** \brief Have room for what is copied of so many nodes. */
  void
  makeArrays (std::size_t nodes);

  /** \param[out] squared room for the distances; nullptr where nobody asks for them */
  void
  copyColumns (double reach, float *squared);

  /** \brief The square of the distance within which value points may lie within \a reach. */
  float
  limitOf (double reach) const;

  /** \brief 0 at a node, 1 and -1 at its off-surface points. */
  int
  sideOf (std::size_t value_point) const
  {
    return value_point < count_ ? 0 : value_point < 2 * count_ ? 1 : -1;
  }

  const ImplicitField &field_;
  const NodeTable &table_;
  const lanes::Search &search_;
  const LargeVector<std::uint32_t> &index_;
  double inverse_unit_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  std::size_t count_ = 0, value_points_ = 0;
  std::vector<lanes::Stretch> stretches_;
  std::size_t looked_for_ = 0;        // room for the points of the stretches
  std::vector<std::uint32_t> places_; // in the table
  std::vector<float> squared_;        // distances from the center
  std::array<std::vector<float>, 3> positions_, normals_;
  std::vector<float> lambdas_, confidences_, attributes_;
};

} // namespace erkpa
