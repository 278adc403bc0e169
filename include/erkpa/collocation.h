// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/implicit_field.h>
#include <erkpa/progress.h>

#include <cstddef>

namespace erkpa
{

/** \brief What a collocation did. */
struct CollocationReport
{
  std::size_t unknowns = 0; ///< nodes, and off-surface points where there are some; 0 = no collocation was asked for
  std::size_t nonzeros = 0; ///< entries of the matrix
  int iterations = 0;       ///< of the iterative solver; 0 = solved directly
  double residual = 0.0;    ///< largest |f - λ| at a node, in units of the support radius there
};

/** \brief Make a field interpolate: find node values λ' with Σ_j φ_j(x_i) λ'_j = λ_i (eq. 26-27), the field's own.
 *
 * Where normals take part, their share stands on the right-hand side: Σ_j φ_j(x_i) λ'_j = λ_i - Σ_j ψ_j(x_i)·n_j.
 * The matrix is sparse and not symmetric: small systems are solved directly, others by BiCGSTAB with an approximate
 * inverse made of small blocks.
 * \param[in,out] field gets the values; unchanged on error
 * \param[in] threads 0 = all processors
 * \param[out] report what was done
 * \param[in] progress may be empty
 * \return Status::NOT_CONVERGED where |f| at the nodes stays above 1e-5 of the support radius
 */
Outcome
interpolateNodes (ImplicitField &field, int threads, CollocationReport &report, const ProgressCallback &progress = {});

} // namespace erkpa
