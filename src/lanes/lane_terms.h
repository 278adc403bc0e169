// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_vector.h"
#include "lanes.h"

namespace erkpa::lanes
{

/** \brief Place of M_ij, i >= j, in a triangle stored row after row. */
constexpr int
at (int i, int j)
{
  return i * (i + 1) / 2 + j;
}

/** \brief The reproduction vector (eq. 15) in lanes: see basis.h. Coordinates u, q = |u|². */
template <typename B, Basis BASIS>
struct Terms;

template <typename B>
struct Terms<B, Basis::CONSTANT>
{
  static constexpr int SIZE = 1;

  static constexpr int
  degree (int)
  {
    return 0;
  }

  static constexpr int
  power (int, int)
  {
    return 0;
  }

  static void
  evaluate (const B *, B, B *R)
  {
    R[0] = B (1.0f);
  }

  static void
  slopes (const B *, const B *, B *G)
  {
    G[0] = G[1] = G[2] = B (0.0f);
  }

  static void
  shift (const B *, B *)
  {
  }

  static void
  addGradientMoments (B *)
  {
  }

  static void
  addNormal (B, const B *, const B *, B *)
  {
  }
};

template <typename B>
struct Terms<B, Basis::LINEAR>
{
  static constexpr int SIZE = 4;

  static constexpr int
  degree (int term)
  {
    return term == 0 ? 0 : 1;
  }

  /** \brief With which power a factor, x, y, z or q, is in a term. */
  static constexpr int
  power (int term, int factor)
  {
    return term == 1 + factor ? 1 : 0;
  }

  static void
  evaluate (const B *u, B, B *R)
  {
    R[0] = B (1.0f);
    for (int a = 0; a < 3; ++a)
      R[1 + a] = u[a];
  }

  /** \brief Σ_j c_j ∂R_j: the gradient of a combination of the terms. */
  static void
  slopes (const B *c, const B *, B *G)
  {
    for (int a = 0; a < 3; ++a)
      G[a] = c[1 + a];
  }

  /** \brief R (u - s) from R (u), or a sum of such. */
  static void
  shift (const B *s, B *R)
  {
    for (int a = 0; a < 3; ++a)
      R[1 + a] = fnma (s[a], R[0], R[1 + a]);
  }

  /** \brief Σ w ∂R ∂R^T, which follows from Σ w R R^T. */
  static void
  addGradientMoments (B *M)
  {
    for (int a = 0; a < 3; ++a)
      M[at (1 + a, 1 + a)] += M[0];
  }

  /** \brief w ∂R n to the right-hand side. */
  static void
  addNormal (B w, const B *, const B *n, B *b)
  {
    for (int a = 0; a < 3; ++a)
      b[1 + a] = xsimd::fma (w, n[a], b[1 + a]);
  }
};

template <typename B>
struct Terms<B, Basis::SPHERICAL>
{
  static constexpr int SIZE = 5;

  static constexpr int
  degree (int term)
  {
    return term == 4 ? 2 : Terms<B, Basis::LINEAR>::degree (term);
  }

  static constexpr int
  power (int term, int factor)
  {
    return term == 1 + factor ? 1 : 0;
  }

  static void
  evaluate (const B *u, B q, B *R)
  {
    Terms<B, Basis::LINEAR>::evaluate (u, q, R);
    R[4] = q;
  }

  static void
  slopes (const B *c, const B *u, B *G)
  {
    const B twice = c[4] + c[4];
    for (int a = 0; a < 3; ++a)
      G[a] = xsimd::fma (twice, u[a], c[1 + a]);
  }

  static void
  shift (const B *s, B *R)
  {
    Terms<B, Basis::LINEAR>::shift (s, R);
    for (int a = 0; a < 3; ++a)
      R[4] = fnma (s[a], R[1 + a] + xsimd::fma (s[a], R[0], R[1 + a]), R[4]);
  }

  static void
  addGradientMoments (B *M)
  {
    Terms<B, Basis::LINEAR>::addGradientMoments (M);
    for (int a = 0; a < 3; ++a)
      M[at (4, 1 + a)] += B (2.0f) * M[at (1 + a, 0)];
    M[at (4, 4)] += B (4.0f) * M[at (4, 0)];
  }

  static void
  addNormal (B w, const B *u, const B *n, B *b)
  {
    Terms<B, Basis::LINEAR>::addNormal (w, u, n, b);
    const B along = xsimd::fma (u[2], n[2], xsimd::fma (u[1], n[1], u[0] * n[0]));
    b[4] = xsimd::fma (w + w, along, b[4]);
  }
};

template <typename B>
struct Terms<B, Basis::QUADRATIC>
{
  static constexpr int SIZE = 10;

  static constexpr int
  degree (int term)
  {
    return term >= 4 ? 2 : Terms<B, Basis::LINEAR>::degree (term);
  }

  /** \brief Calls visit (term, a, b) for the terms u_a u_b, a <= b. */
  template <typename VisitT>
  static void
  visitSquares (VisitT visit)
  {
    int term = 4;
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b)
        visit (term++, a, b);
  }

  static constexpr int
  power (int term, int factor)
  {
    constexpr int SQUARES[6][3] = {{2, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 2, 0}, {0, 1, 1}, {0, 0, 2}};
    return factor == 3 ? 0 : term >= 4 ? SQUARES[term - 4][factor] : term == 1 + factor ? 1 : 0;
  }

  static void
  evaluate (const B *u, B q, B *R)
  {
    Terms<B, Basis::LINEAR>::evaluate (u, q, R);
    visitSquares ([&] (int term, int a, int b) { R[term] = u[a] * u[b]; });
  }

  static void
  slopes (const B *c, const B *u, B *G)
  {
    for (int a = 0; a < 3; ++a)
      G[a] = c[1 + a];
    visitSquares (
        [&] (int term, int a, int b)
        {
          G[a] = xsimd::fma (c[term], u[b], G[a]);
          G[b] = xsimd::fma (c[term], u[a], G[b]);
        });
  }

  static void
  shift (const B *s, B *R)
  {
    visitSquares (
        [&] (int term, int a, int b)
        {
          const B lower = fnma (s[a], R[0], R[1 + a]);
          R[term] = fnma (s[a], R[1 + b], fnma (s[b], lower, R[term]));
        });
    Terms<B, Basis::LINEAR>::shift (s, R);
  }

  static void
  addGradientMoments (B *M)
  {
    const auto product = [M] (int a, int b) { return M[a < b ? at (1 + b, 1 + a) : at (1 + a, 1 + b)]; };
    B products[3][3];
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        products[a][b] = product (a, b);
    visitSquares (
        [&] (int term, int a, int b)
        {
          M[at (term, 1 + a)] += M[at (1 + b, 0)];
          M[at (term, 1 + b)] += M[at (1 + a, 0)];
          visitSquares (
              [&] (int other, int c, int d)
              {
                if (other > term)
                  return;
                for (const auto &[p, q, r, s] :
                     {Pairs{a, c, b, d}, Pairs{a, d, b, c}, Pairs{b, c, a, d}, Pairs{b, d, a, c}})
                  if (p == q)
                    M[at (term, other)] += products[r][s];
              });
        });
    Terms<B, Basis::LINEAR>::addGradientMoments (M);
  }

  static void
  addNormal (B w, const B *u, const B *n, B *b)
  {
    Terms<B, Basis::LINEAR>::addNormal (w, u, n, b);
    visitSquares ([&] (int term, int a, int c)
                  { b[term] = xsimd::fma (w, xsimd::fma (u[a], n[c], u[c] * n[a]), b[term]); });
  }

private:
  struct Pairs
  {
    int p, q, r, s;
  };
};

/** \brief A combination of the terms. */
template <typename TermsT, typename B>
B
combine (const B *c, const B *R)
{
  B sum = c[0];
  for (int j = 1; j < TermsT::SIZE; ++j)
    sum = xsimd::fma (c[j], R[j], sum);
  return sum;
}

} // namespace erkpa::lanes
