// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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

  static constexpr std::size_t MAX_ORDERS = 24; ///< of so many values

  int faces = 1;
  std::array<Step, MAX_FACES - 1> steps{};        ///< faces - 1 of them; the result is left at the face of the last
  std::array<std::uint8_t, MAX_ORDERS> winners{}; ///< per order of the values (orderOf), the face whose value counts

  /** \brief The face whose value is that of the whole. */
  int
  winner (const double *values) const
  {
    return winners[orderOf (values, faces)];
  }

  /** \brief The order that values are in, as the place of their ranks among all permutations. */
  static std::size_t
  orderOf (const double *values, int faces)
  {
    std::size_t order = 0;
    for (int face = 0; face + 1 < faces; ++face)
    {
      std::size_t smaller = 0;
      for (int later = face + 1; later < faces; ++later)
        smaller += values[later] < values[face] ? 1 : 0;
      order = order * static_cast<std::size_t> (faces - face) + smaller; // factorial digits, the first counts most
    }
    return order;
  }

  /** \brief Whether it is the larger of two faces that counts, where they meet. */
  bool
  takesLarger (int face, int other) const;
};

/** \brief All trees over a number of faces (1 .. MAX_FACES), each once. */
const std::vector<FaceTree> &
treesOf (int faces);

} // namespace erkpa
