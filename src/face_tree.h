// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

namespace erkpa
{

/** \brief How faces make a surface: max where they meet in a convex edge, min in a concave one, nested at corners. */
struct FaceTree
{
  /** \brief A step takes the value of \a other into that of \a face: the larger of both, or the smaller. */
  struct Step
  {
    int face, other;
    bool larger;
  };

  static constexpr int MAX_FACES = 4;

  int faces = 1;
  std::array<Step, MAX_FACES - 1> steps{}; ///< faces - 1 of them; the result is left at the face of the last

  /** \brief The face whose value is that of the whole. */
  int
  winner (const double *values) const;

  /** \brief Whether it is the larger of two faces that counts, where they meet. */
  bool
  takesLarger (int face, int other) const;
};

/** \brief All trees over a number of faces (1 .. MAX_FACES), each once. */
const std::vector<FaceTree> &
treesOf (int faces);

} // namespace erkpa
