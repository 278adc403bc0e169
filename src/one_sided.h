// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "orientation_facets.h"
#include "viewer.h"

#include <erkpa/normals.h>

#include <vector>

namespace erkpa
{

/** \brief Orients scans that are seen from one side (findViewer): the one way in which that can be done. */
class OneSided
{
public:
  /** \param[in] points a normal that is not zero was given and keeps its sign
   * \param[in] k neighbours that the normals were estimated from
   */
  OneSided (const OrientedPoints &points, const NeighborSearch &search, int k, const NormalOptions &options);

  /** \brief Whether the two sides of a wall would not be taken for one noisy sheet: only then orient () may be asked
   * of a cloud that may be closed. */
  bool
  tellsWalls (const std::vector<Eigen::Vector3f> &normals);

  /** \brief Have the normals look to the side that the scan is seen from, if there is one.
   * \return false, and all is as before, where there is none
   */
  bool
  orient (std::vector<Eigen::Vector3f> &normals);

  /** \brief After orient (): where to. */
  Orientation
  orientation () const
  {
    return orientation_;
  }

private:
  const Facets &
  facetsOf (const std::vector<Eigen::Vector3f> &normals);

  bool
  agreesWithGiven (Viewer &viewer) const;

  std::vector<signed char>
  sidesOf (const Viewer &viewer) const;

  void
  decideRest (std::vector<signed char> &sides) const;

  const OrientedPoints &points_;
  const NeighborSearch &search_;
  const int k_;
  const NormalOptions &options_;
  Facets facets_; // of the estimated normals, once they are asked for
  bool was_asked_ = false;
  Orientation orientation_ = Orientation::ONE_SIDE;
};

} // namespace erkpa
