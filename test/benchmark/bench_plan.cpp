// SPDX-License-Identifier: BSD-3-Clause
#include "bench_plan.h"

#include <algorithm>
#include <cmath>

namespace bench
{

namespace
{

double
totalOf (const Json &result)
{
  return result.contains ("error") ? 0.0 : result["seconds"]["total"].get<double> ();
}

/** \brief Median over the repetitions of how much longer one row took than another in the same turn; 0 = not known. */
double
medianRatio (const Row &longer, const Row &shorter)
{
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min (longer.results.size (), shorter.results.size ()); ++i)
    if (totalOf (longer.results[i]) > 0.0 && totalOf (shorter.results[i]) > 0.0)
      ratios.push_back (totalOf (longer.results[i]) / totalOf (shorter.results[i]));
  if (ratios.empty ())
    return 0.0;
  std::sort (ratios.begin (), ratios.end ());
  return 0.5 * (ratios[(ratios.size () - 1) / 2] + ratios[ratios.size () / 2]);
}

/** \brief The depth at which Poisson's finest cells are about as large as the voxels. */
int
depthFor (const Json &result, int wanted)
{
  if (wanted > 0 || result.contains ("error"))
    return wanted;
  constexpr double SCALE = 1.1; // of its cube to the cloud, its default
  const double cells = SCALE * result["extent"].get<double> () / result["voxel"].get<double> ();
  return std::max (3, static_cast<int> (std::lround (std::log2 (cells))));
}

} // namespace

const Json &
Row::best () const
{
  return *std::min_element (results.begin (), results.end (),
                            [] (const Json &a, const Json &b) { return totalOf (a) < totalOf (b); });
}

std::vector<Row>
measureRows (const Plan &plan, const std::string &shape, std::size_t points)
{
  std::vector<Row> rows (plan.threads.size ()), others (plan.poisson ? plan.threads.size () : 0);
  int depth = 0;
  for (int repeat = 0; repeat < plan.repeats; ++repeat)
    for (std::size_t t = 0; t < rows.size (); ++t)
    {
      rows[t].run = {shape, points, plan.threads[t], 0};
      rows[t].results.push_back (measure (rows[t].run));
      if (depth == 0)
        depth = depthFor (rows[t].results.back (), plan.poisson_depth);
      if (!plan.poisson || depth == 0)
        continue;
      others[t].run = {shape, points, plan.threads[t], depth};
      others[t].results.push_back (measure (others[t].run));
    }
  for (std::size_t t = 0; t < others.size (); ++t)
    rows[t].poisson_ratio = medianRatio (others[t], rows[t]);
  rows.insert (rows.end (), others.begin (), others.end ());
  rows.erase (std::remove_if (rows.begin (), rows.end (), [] (const Row &row) { return row.results.empty (); }),
              rows.end ());
  for (std::size_t t = 0; t < rows.size (); ++t)
  {
    const std::size_t first = t / plan.threads.size () * plan.threads.size ();
    if (t != first)
      rows[t].speed_up = medianRatio (rows[first], rows[t]);
  }
  return rows;
}

Json
toJson (const Row &row)
{
  Json json{{"shape", row.run.shape},
            {"points", row.run.points},
            {"method", row.run.poisson_depth > 0 ? "poisson" : "erkpa"},
            {"threads", row.run.threads}};
  if (row.speed_up > 0.0)
    json["speed_up"] = row.speed_up;
  if (row.poisson_ratio > 0.0)
    json["poisson_ratio"] = row.poisson_ratio;
  json["repetitions"] = row.results;
  return json;
}

} // namespace bench
