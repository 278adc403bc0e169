// SPDX-License-Identifier: BSD-3-Clause
//
// How fast the field is evaluated: node evaluations per second, pairs of an evaluation point and a node in its support,
// and which share of what the processor can do they make.
#include "field_problem.h"
#include "lane_problem.h"
#include "peak_rate.h"

#include <benchmark/benchmark.h>

#include <string>
#include <utility>

namespace
{

using bench::LaneCase;
using erkpa::lanes::Basis;
using erkpa::lanes::Constraint;
using erkpa::lanes::Engine;

struct NamedFit
{
  const char *name;
  Basis basis;
  Constraint constraint;
};

constexpr NamedFit FITS[] = {{"constant", Basis::CONSTANT, Constraint::FUNCTIONAL},
                             {"linear", Basis::LINEAR, Constraint::HERMITE},
                             {"linear_functional", Basis::LINEAR, Constraint::FUNCTIONAL},
                             {"spherical", Basis::SPHERICAL, Constraint::HERMITE},
                             {"quadratic", Basis::QUADRATIC, Constraint::HERMITE}};

/** \brief Node evaluations as the benchmark's items, and the share of the peak that their operations make. */
void
count (benchmark::State &state, double pairs, double evaluations, double seconds, double flops, const Engine *engine)
{
  state.SetItemsProcessed (static_cast<std::int64_t> (pairs));
  state.counters["nodes"] = evaluations > 0.0 ? pairs / evaluations : 0.0;
  const double rate = seconds > 0.0 ? flops * pairs / seconds : 0.0;
  if (flops > 0.0)
    state.counters["GFLOPS"] = 1e-9 * rate;
  if (engine != nullptr && bench::peakRate (*engine) > 0.0)
    state.counters["of_peak"] = rate / bench::peakRate (*engine);
}

void
measureLanes (benchmark::State &state, const Engine &engine, const LaneCase &what)
{
  bench::LaneProblem problem (what);
  bench::peakRate (engine); // before the clock starts
  const double start = bench::threadSeconds ();
  for (auto _ : state)
  {
    problem.evaluate (engine);
    benchmark::ClobberMemory ();
  }
  const double seconds = bench::threadSeconds () - start, iterations = static_cast<double> (state.iterations ());
  count (state, iterations * static_cast<double> (problem.pairs ()),
         iterations * static_cast<double> (problem.points ()), seconds,
         bench::flopsPerPair (what.basis, what.constraint, what.gradients), &engine);
  if (!problem.isDefined ())
    state.SkipWithError ("the field is undefined at a point");
  else if (what.k == 0 && problem.pairs () != what.nodes * problem.points ())
    state.SkipWithError ("a node is in no support");
}

void
measurePeak (benchmark::State &state, const Engine &engine)
{
  for (auto _ : state)
    benchmark::DoNotOptimize (bench::peakRate (engine));
  state.counters["GFLOPS"] = 1e-9 * bench::peakRate (engine);
}

void
measureField (benchmark::State &state, const bench::FieldCase &what)
{
  bench::FieldProblem problem (what);
  if (what.engine != nullptr)
    bench::peakRate (*what.engine);
  std::size_t ball = 0;
  const double start = bench::threadSeconds ();
  for (auto _ : state)
    problem.evaluate (ball++);
  const double seconds = bench::threadSeconds () - start;
  // The flops of the lanes' float sums say nothing about the scalar field's.
  const double flops =
      what.engine != nullptr ? bench::flopsPerPair (Basis::SPHERICAL, Constraint::HERMITE, what.gradients) : 0.0;
  count (state, static_cast<double> (problem.pairs ()), static_cast<double> (problem.evaluations ()), seconds, flops,
         what.engine);
  if (problem.evaluations () == 0)
    state.SkipWithError ("nothing was evaluated");
}

void
addLanes (const Engine &engine)
{
  const std::string of_engine = engine.name;
  benchmark::RegisterBenchmark (("peak/" + of_engine).c_str (),
                                [&engine] (benchmark::State &state) { measurePeak (state, engine); })
      ->Iterations (1);
  const auto add = [&] (const char *basis, const std::string &nodes, const LaneCase &what)
  {
    const std::string name =
        "lanes/" + of_engine + "/" + basis + "/" + nodes + (what.gradients ? "/gradient" : "/value");
    benchmark::RegisterBenchmark (name.c_str (),
                                  [&engine, what] (benchmark::State &state) { measureLanes (state, engine, what); });
  };
  for (const auto &[name, basis, constraint] : FITS)
    for (const bool gradients : {false, true})
    {
      for (const std::size_t nodes : {20, 40, 100, 400, 3000})
        add (name, "nodes:" + std::to_string (nodes), {basis, constraint, 0, nodes, gradients});
      for (const int k : {20, 40})
        add (name, "k:" + std::to_string (k), {basis, constraint, k, 0, gradients});
    }
}

void
addField (const std::string &name, bench::FieldCase what)
{
  for (const bool gradients : {false, true})
  {
    what.gradients = gradients;
    benchmark::RegisterBenchmark (("field/" + name + (gradients ? "/gradient" : "/value")).c_str (),
                                  [what] (benchmark::State &state) { measureField (state, what); });
  }
}

} // namespace

int
main (int argc, char **argv)
{
  benchmark::Initialize (&argc, argv);
  if (benchmark::ReportUnrecognizedArguments (argc, argv))
    return 2;
  std::size_t engines = 0;
  const Engine *const *engine = erkpa::lanes::engines (engines);
  for (std::size_t e = 0; e < engines; ++e)
    addLanes (*engine[e]);
  using bench::Place;
  for (std::size_t e = 0; e < engines; ++e)
    for (const bool planes : {false, true})
      addField (std::string ("block/") + engine[e]->name + (planes ? "/edge/planes" : "/edge/no_planes"),
                {Place::EDGE, planes, engine[e], false});
  for (const auto &[name, place] : {std::pair ("edge", Place::EDGE), std::pair ("corner", Place::CORNER)})
    for (const bool planes : {false, true})
      addField (std::string ("scalar/") + name + (planes ? "/planes" : "/no_planes"), {place, planes, nullptr, false});
  if (benchmark::RunSpecifiedBenchmarks () == 0)
    return 1;
  benchmark::Shutdown ();
  return 0;
}
