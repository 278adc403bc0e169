// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_nodes.h"
#include "block_points.h"
#include "enriching_surface.h"

#include <erkpa/implicit_field.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace erkpa
{

/** \brief The sharp surfaces that enrich the field at points of one ball, as the lanes see them: Enrichment's quick
 * double.
 *
 * Kinks and jumps at surfaces of any kind, limited or not, and their corners, for gradients and functional values.
 * Classes of the caller's own, and surfaces with more than one extent, are left to LocalField.
 */
class BlockEnrichment
{
public:
  /** \param[in] unit of the lanes' lengths */
  BlockEnrichment (const ImplicitField &field, double unit);

  /** \brief Find the surfaces that may add terms at points whose supports lie within \a reach of \a center. */
  void
  gather (const Eigen::Vector3d &center, double reach);

  /** \brief Whether no sharp surface is near the ball. */
  bool
  isEmpty () const
  {
    return near_.empty ();
  }

  /** \brief Whether none of them passes within \a reach of \a x (local frame): all nodes of its support lie on one side
   * of each. */
  bool
  isAbsentAt (const Eigen::Vector3d &x, double reach) const;

  /** \brief Whether those that may add terms at \a x are such as can be evaluated here. */
  bool
  canEvaluateAt (const Eigen::Vector3d &x, double reach) const;

  /** \brief Whether all surfaces of a field are such. */
  static bool
  canEvaluate (const ImplicitField &field)
  {
    const BlockEnrichment all (field, 1.0);
    return all.surfaces_.empty () || (all.can_evaluate_ && std::all_of (all.surfaces_.begin (), all.surfaces_.end (),
                                                                        [] (const EnrichingSurface &surface)
                                                                        { return surface.hasKnownPresence (); }));
  }

  /** \brief Evaluate at points that are near the surfaces.
   * \param[in] view of the nodes
   * \param[in] places of the points, local frame
   * \param[in] seen_from where each is seen from: see LocalField::sampleOnSides (); none: from where they are
   * \param[in] reach how far around each its support may go
   * \param[in,out] points what is left unsettled wants LocalField
   */
  void
  run (const lanes::Engine &engine, const lanes::Settings &settings, const lanes::Nodes &view, const BlockNodes &nodes,
       const std::vector<Eigen::Vector3d> &places, const std::vector<Eigen::Vector3d> &seen_from, double reach,
       BlockPoints &points);

  /** \brief See Enrichment::sideKey (); for a point that was run. */
  std::uint64_t
  sideKey (const BlockPoints &points, std::size_t i) const;

private:
  /** \brief A surface near the points, and θ and ∇θ at nodes and points; with the distance from its extent and ∇ of it
   * there, where it has one. */
  struct Values
  {
    int surface;
    std::vector<float> theta, theta_at, theta_seen, distance_at;
    std::array<std::vector<float>, 3> gradient, gradient_at, away_at;
  };

  /** \brief ∇θ and θ at a node. */
  struct Recalled
  {
    std::uint32_t node = ~0u;
    Eigen::Vector4f theta = Eigen::Vector4f::Zero ();
  };

  const EnrichingSurface &
  surface (int i) const
  {
    return surfaces_[static_cast<std::size_t> (i)];
  }

  /** \brief Whether some support of this reach around the points may hold nodes on either side. */
  bool
  passes (int s, const std::vector<Eigen::Vector3d> &places, double reach) const;

  void
  evaluateAtNodes (const BlockNodes &nodes, Values &values);

  Eigen::Vector4f
  thetaAtNode (const EnrichingSurface &known, const BlockNodes &nodes, std::size_t i) const;

  Eigen::Vector4f
  recall (int s, const BlockNodes &nodes, std::size_t i);

  void
  evaluatePlaneAtNodes (const SharpPlane &plane, const BlockNodes &nodes, Values &values) const;

  void
  evaluateAtPoints (const std::vector<Eigen::Vector3d> &places, Values &values) const;

  void
  evaluateFrom (const std::vector<Eigen::Vector3d> &seen_from, Values &values) const;

  void
  measureExtentAtPoints (const std::vector<Eigen::Vector3d> &places, Values &values) const;

  /** \brief List the surfaces that pass the points. */
  void
  choose (const std::vector<Eigen::Vector3d> &places, double reach);

  void
  showSurfaces (lanes::SharpSurfaces &sharp) const;

  bool
  listPencils (lanes::SharpSurfaces &sharp) const;

  const ImplicitField &field_;
  double inverse_unit_;
  bool can_evaluate_;
  std::vector<EnrichingSurface> surfaces_;
  std::vector<int> near_; // the ball: places in surfaces_
  std::size_t used_ = 0;  // of values_, whose memory is kept
  std::vector<Values> values_;
  std::vector<std::vector<Recalled>> recalled_; // by surface, and place of the node
};

} // namespace erkpa
