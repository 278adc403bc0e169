// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/collocation.h>

#include "local_field.h"
#include "local_inverse.h"
#include "text.h"
#include "threads.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace erkpa
{

namespace
{

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/** \brief The system Φ λ' = b, a row for each value point. */
class CollocationSystem
{
public:
  SparseMatrix matrix;
  Eigen::VectorXd rhs;
  Eigen::VectorXd radii; ///< support radius at each value point

  CollocationSystem (const ImplicitField &field, int threads)
      : field_ (field), rows_ (field.points ().size () * static_cast<std::size_t> (field.valuesPerNode ()))
  {
    rhs.resize (static_cast<Eigen::Index> (rows_.size ()));
    radii.resize (rhs.size ());
    parallelFor (
        field.points ().size (), threads, [&] { return LocalField (field, true); },
        [&] (LocalField &local, std::size_t node) { makeRows (local, static_cast<int> (node)); });
    assemble ();
  }

  /** \brief Largest miss of a solution, in support radii. */
  double
  residualOf (const Eigen::VectorXd &values) const
  {
    const double residual = ((rhs - matrix * values).cwiseQuotient (radii)).cwiseAbs ().maxCoeff ();
    return std::isfinite (residual) ? residual : HUGE_VAL;
  }

private:
  struct Entry
  {
    int column;
    double value;
  };

  void
  makeRows (LocalField &local, int node)
  {
    const auto i = static_cast<std::size_t> (node);
    const Eigen::Vector3d position = field_.points ().positions[i].cast<double> ();
    const Eigen::Vector3d normal = field_.points ().normals[i].cast<double> ();
    makeRow (local, position, node, 0);
    if (field_.valuesPerNode () == 1)
      return;
    for (const int side : {1, -1})
      makeRow (local, position + side * field_.offsetOf (node) * normal, node, side);
  }

  void
  makeRow (LocalField &local, const Eigen::Vector3d &position, int node, int side)
  {
    const std::size_t row = field_.valueIndex (node, side);
    const auto i = static_cast<Eigen::Index> (row);
    rhs[i] = field_.nodeValue (node, side);
    local.gather (position, 0.0);
    for (const ShapeFunction &shape : local.shapeFunctions (position))
    {
      rows_[row].push_back ({static_cast<int> (field_.valueIndex (shape.node, shape.side)), shape.phi});
      const Eigen::Vector3f &normal = field_.points ().normals[static_cast<std::size_t> (shape.node)];
      rhs[i] -= shape.psi.dot (normal.cast<double> ());
    }
    if (rows_[row].empty ()) // the field is not defined here
      rows_[row].push_back ({static_cast<int> (row), 1.0});
    radii[i] = std::max (local.support ().radius (), 1e-300);
  }

  void
  assemble ()
  {
    Eigen::VectorXi sizes (rhs.size ());
    for (std::size_t row = 0; row < rows_.size (); ++row)
      sizes[static_cast<Eigen::Index> (row)] = static_cast<int> (rows_[row].size ());
    matrix.resize (rhs.size (), rhs.size ());
    matrix.reserve (sizes);
    for (std::size_t row = 0; row < rows_.size (); ++row)
    {
      std::sort (rows_[row].begin (), rows_[row].end (),
                 [] (const Entry &a, const Entry &b) { return a.column < b.column; });
      for (const Entry &entry : rows_[row])
        matrix.insert (static_cast<Eigen::Index> (row), entry.column) = entry.value;
      std::vector<Entry> ().swap (rows_[row]);
    }
    matrix.makeCompressed ();
  }

  const ImplicitField &field_;
  std::vector<std::vector<Entry>> rows_;
};

// Shares of the support radius: the iteration goes on to the first, and the second is still told as a success.
constexpr double TARGET = 1e-7, ACCEPTABLE = 1e-5;

/** \brief Iterates as long as that helps; whether the miss has become small everywhere, not only in the mean. */
template <typename PreconditionerT>
bool
iterate (Eigen::BiCGSTAB<SparseMatrix, PreconditionerT> &solver, const CollocationSystem &system,
         Eigen::VectorXd &values, CollocationReport &report)
{
  constexpr int ROUNDS = 5, ITERATIONS = 120;
  solver.setMaxIterations (ITERATIONS);
  solver.setTolerance (1e-10);
  solver.compute (system.matrix);
  for (int round = 0; round < ROUNDS && report.residual > TARGET; ++round)
  {
    const Eigen::VectorXd next = solver.solveWithGuess (system.rhs, values);
    report.iterations += static_cast<int> (solver.iterations ());
    const double residual = system.residualOf (next), before = report.residual;
    if (!(residual < before))
      break;
    values = next;
    report.residual = residual;
    if (residual > 0.2 * before) // it crawls
      break;
  }
  return report.residual <= ACCEPTABLE;
}

bool
solveDirectly (const CollocationSystem &system, Eigen::VectorXd &values, CollocationReport &report)
{
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver;
  solver.compute (system.matrix);
  if (solver.info () != Eigen::Success)
    return false;
  const Eigen::VectorXd solution = solver.solve (system.rhs);
  const double residual = system.residualOf (solution);
  if (!(residual < report.residual))
    return false;
  values = solution;
  report.residual = residual;
  return residual <= ACCEPTABLE;
}

/** \brief Small systems directly. Others by iteration, from the cheapest preconditioner to the dearest: how hard a
 * system is depends on how evenly the nodes are spread. */
bool
solve (const CollocationSystem &system, int threads, Eigen::VectorXd &values, CollocationReport &report,
       const ProgressCallback &progress)
{
  constexpr std::size_t SMALL = 2000;
  const auto tell = [&progress] (double done)
  {
    if (progress)
      progress (done);
  };
  const auto iterateLocally = [&] (std::size_t block)
  {
    Eigen::BiCGSTAB<SparseMatrix, LocalInverse> solver;
    solver.preconditioner ().set (block, threads);
    return iterate (solver, system, values, report);
  };
  values = system.rhs;
  report.residual = system.residualOf (values);
  if (report.unknowns <= SMALL && solveDirectly (system, values, report))
    return true;
  tell (0.3);
  // Blocks much smaller than the rows are a poor inverse.
  constexpr std::size_t BLOCK = 32, LARGE_BLOCK = 72;
  if (2 * report.nonzeros < 3 * BLOCK * report.unknowns && iterateLocally (BLOCK))
    return true;
  tell (0.4);
  Eigen::BiCGSTAB<SparseMatrix> plain;
  if (iterate (plain, system, values, report))
    return true;
  tell (0.6);
  return iterateLocally (LARGE_BLOCK);
}

} // namespace

Outcome
interpolateNodes (ImplicitField &field, int threads, CollocationReport &report, const ProgressCallback &progress)
{
  report = CollocationReport ();
  const CollocationSystem system (field, threads);
  report.unknowns = static_cast<std::size_t> (system.rhs.size ());
  report.nonzeros = static_cast<std::size_t> (system.matrix.nonZeros ());
  Eigen::VectorXd values;
  if (!solve (system, threads, values, report, progress))
    return {Status::NOT_CONVERGED,
            "collocation did not converge: at a node the field misses its value by " + toText (report.residual) +
                " of the support radius after " + std::to_string (report.iterations) +
                " iterations; use the kernel wendland_c2 or wendland_c4, a smaller support, or no interpolation"};
  field.setNodeValues ({values.data (), values.data () + values.size ()});
  if (progress)
    progress (1.0);
  return {};
}

} // namespace erkpa
