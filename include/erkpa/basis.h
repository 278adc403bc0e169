// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace erkpa
{

/** \brief Functions the field reproduces exactly: the paper's "n-th order" and the spheres between them. */
enum class Order
{
  AUTOMATIC, ///< spherical; linear for functional constraints, which say too little about squares on a surface
  CONSTANT,  ///< 1
  LINEAR,    ///< 1, x, y, z
  SPHERICAL, ///< 1, x, y, z, x²+y²+z²: exact on planes and spheres
  QUADRATIC  ///< all polynomials of degree two
};

/** \brief The polynomial part of the reproduction vector R (eq. 15) and of its derivatives.
 *
 * Each basis is closed under translation and scaling, so it may be written in coordinates centred on the
 * evaluation point and scaled by the support radius without changing the field. It writes its \a SIZE terms at
 * \a u to \a R and their derivatives to the columns of \a G, and gives the degree of each term.
 */
struct ConstantBasis
{
  static constexpr int SIZE = 1;

  template <typename VectorT, typename MatrixT>
  static void
  evaluate (const Eigen::Vector3d &, VectorT &R, MatrixT &G)
  {
    R[0] = 1.0;
    G.row (0).setZero ();
  }

  static int
  degree (int)
  {
    return 0;
  }
};

struct LinearBasis
{
  static constexpr int SIZE = 4;

  template <typename VectorT, typename MatrixT>
  static void
  evaluate (const Eigen::Vector3d &u, VectorT &R, MatrixT &G)
  {
    ConstantBasis::evaluate (u, R, G);
    for (int a = 0; a < 3; ++a)
    {
      R[1 + a] = u[a];
      for (int b = 0; b < 3; ++b)
        G (1 + a, b) = a == b ? 1.0 : 0.0;
    }
  }

  static int
  degree (int term)
  {
    return term == 0 ? 0 : 1;
  }
};

struct SphericalBasis
{
  static constexpr int SIZE = 5;

  template <typename VectorT, typename MatrixT>
  static void
  evaluate (const Eigen::Vector3d &u, VectorT &R, MatrixT &G)
  {
    LinearBasis::evaluate (u, R, G);
    R[4] = u.squaredNorm ();
    for (int b = 0; b < 3; ++b)
      G (4, b) = 2.0 * u[b];
  }

  static int
  degree (int term)
  {
    return term == 4 ? 2 : LinearBasis::degree (term);
  }
};

struct QuadraticBasis
{
  static constexpr int SIZE = 10;

  template <typename VectorT, typename MatrixT>
  static void
  evaluate (const Eigen::Vector3d &u, VectorT &R, MatrixT &G)
  {
    LinearBasis::evaluate (u, R, G);
    int term = 4;
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b, ++term)
      {
        R[term] = u[a] * u[b];
        for (int c = 0; c < 3; ++c)
          G (term, c) = (a == c ? u[b] : 0.0) + (b == c ? u[a] : 0.0);
      }
  }

  static int
  degree (int term)
  {
    return term >= 4 ? 2 : LinearBasis::degree (term);
  }
};

} // namespace erkpa
