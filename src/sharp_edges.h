// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "face_map.h"
#include "face_segmentation.h"

#include <erkpa/sharp_detection.h>

#include <vector>

namespace erkpa
{

/** \brief Faces found in the nodes, and where sharp surfaces keep them apart. */
struct FoundFaces
{
  std::vector<int> faces; ///< face of each node, -1 for none
  int count = 0;
  std::vector<Meeting> separations; ///< by surface, numbered from 0
};

FoundFaces
findFaces (const OrientedPoints &points, const NeighborSearch &search, const SharpOptions &options, int threads);

} // namespace erkpa
