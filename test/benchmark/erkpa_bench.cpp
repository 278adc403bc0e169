// SPDX-License-Identifier: BSD-3-Clause
//
// How long reconstructions of many points take, stage by stage, and how much memory: on generated shapes, with more and
// more points and threads, beside pcl::Poisson.
#include "bench_shapes.h"
#include "bench_table.h"
#include "machine.h"

#include <erkpa/large_pages.h>
#include <erkpa/version.h>

#include <boost/program_options.hpp>
#include <omp.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace
{

namespace po = boost::program_options;
using bench::Json;
using bench::Plan;

/** \brief A command line that makes no sense. */
class UsageError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

std::vector<std::string>
split (const std::string &text)
{
  std::vector<std::string> words;
  std::istringstream stream (text);
  for (std::string word; std::getline (stream, word, ',');)
    words.push_back (word);
  return words;
}

/** \brief A whole number, at least \a least; 10k and 1M are 10000 and 1000000 where \a has_units. */
std::size_t
parseNumber (const char *option, const std::string &text, std::size_t least, bool has_units)
{
  constexpr std::size_t MOST = 1000000000;
  std::size_t number = 0;
  const char *end = text.data () + text.size ();
  auto [stop, error] = std::from_chars (text.data (), end, number);
  if (error == std::errc () && has_units && stop + 1 == end && number <= MOST)
  {
    const std::size_t unit = *stop == 'k' ? 1000 : *stop == 'M' ? 1000000 : 0;
    stop += unit > 0 ? 1 : 0;
    number *= std::max<std::size_t> (unit, 1);
  }
  if (error != std::errc () || stop != end || number < least || number > MOST)
    throw UsageError (std::string ("--") + option + " " + text + ": give whole numbers, at least " +
                      std::to_string (least));
  return number;
}

std::vector<std::string>
parseShapes (const std::string &text)
{
  const std::vector<std::string> &names = bench::shapeNames ();
  std::vector<std::string> shapes = split (text);
  for (const std::string &shape : shapes)
    if (std::find (names.begin (), names.end (), shape) == names.end ())
      throw UsageError ("--shapes " + shape + ": there is no such shape");
  return shapes;
}

po::options_description
describeOptions ()
{
  const int processors = omp_get_max_threads ();
  const auto word = [] (const char *name) { return po::value<std::string> ()->value_name (name); };
  po::options_description description ("options of erkpa_bench");
  description.add_options ()           //
      ("help", "what is written here") //
      ("shapes", word ("NAMES")->default_value ("torus"),
       "of torus (smooth), box (its sharp planes are given), box_auto (its edges are found), with commas between") //
      ("sizes", word ("N,N,...")->default_value ("10k,100k,1M"), "numbers of points; k and M may follow")          //
      ("threads", word ("N,N,...")->default_value (processors > 1 ? "1," + std::to_string (processors) : "1"),
       "numbers of threads; speed-ups are over the first")                                           //
      ("repeat", word ("N")->default_value ("1"), "how often all is measured; the fastest is shown") //
      ("poisson", po::bool_switch (), "measure pcl::Poisson as well, in turns")                      //
      ("poisson_depth", word ("N")->default_value ("0"),
       "its depth; 0: the one whose finest cells are about as large as the voxels") //
      ("json", word ("FILE"), "also write everything that was measured");
  return description;
}

Plan
makePlan (const po::variables_map &values)
{
  const auto text = [&values] (const char *option) { return values[option].as<std::string> (); };
  Plan plan;
  plan.shapes = parseShapes (text ("shapes"));
  for (const std::string &size : split (text ("sizes")))
    plan.sizes.push_back (parseNumber ("sizes", size, 100, true));
  for (const std::string &threads : split (text ("threads")))
    plan.threads.push_back (static_cast<int> (parseNumber ("threads", threads, 1, false)));
  plan.repeats = static_cast<int> (parseNumber ("repeat", text ("repeat"), 1, false));
  plan.poisson = values["poisson"].as<bool> ();
  plan.poisson_depth = static_cast<int> (parseNumber ("poisson_depth", text ("poisson_depth"), 0, false));
  if (plan.shapes.empty () || plan.sizes.empty () || plan.threads.empty ())
    throw UsageError ("--shapes, --sizes and --threads: give at least one of each");
  if (plan.poisson && !bench::hasPoisson ())
    throw UsageError ("--poisson: built without PCL's component surface");
  return plan;
}

/** \brief Measures and prints all; false where something failed. */
bool
runPlan (const Plan &plan, Json &rows)
{
  bool is_done = true;
  bench::printHead ();
  for (const std::string &shape : plan.shapes)
    for (const std::size_t size : plan.sizes)
      for (const bench::Row &row : bench::measureRows (plan, shape, size))
      {
        bench::printRow (row);
        rows.push_back (bench::toJson (row));
        is_done = is_done && !row.hasFailed ();
      }
  bench::printFoot (plan);
  return is_done;
}

int
run (int argc, char **argv)
{
  const po::options_description description = describeOptions ();
  po::variables_map values;
  using style = po::command_line_style::style_t;
  constexpr int STYLE =
      style::allow_long | style::long_allow_adjacent | style::long_allow_next | style::allow_long_disguise;
  po::store (po::command_line_parser (argc, argv).options (description).style (STYLE).run (), values);
  po::notify (values);
  if (values.count ("help") > 0)
  {
    std::ostringstream help;
    help << description;
    std::printf ("%s", help.str ().c_str ());
    return 0;
  }
  const Plan plan = makePlan (values);
  std::ofstream file;
  if (values.count ("json") > 0)
    file.open (values["json"].as<std::string> ()); // before hours of work, not after them
  if (!file)
    throw UsageError ("--json " + values["json"].as<std::string> () + ": it cannot be written");
  Json json{{"version", ERKPA_VERSION}, {"processor", bench::processorName ()}, {"rows", Json::array ()}};
  const bool is_done = runPlan (plan, json["rows"]);
  if (file.is_open () && !(file << json.dump (2) << "\n" << std::flush))
    throw std::runtime_error (values["json"].as<std::string> () + ": it could not be written");
  return is_done ? 0 : 1;
}

} // namespace

int
main (int argc, char **argv)
{
  erkpa::preferLargePages ();
  try
  {
    return run (argc, argv);
  }
  catch (const UsageError &error)
  {
    std::fprintf (stderr, "erkpa_bench: %s\nerkpa_bench --help says more\n", error.what ());
    return 2;
  }
  catch (const po::error &error)
  {
    std::fprintf (stderr, "erkpa_bench: %s\nerkpa_bench --help says more\n", error.what ());
    return 2;
  }
  catch (const std::exception &error)
  {
    std::fprintf (stderr, "erkpa_bench: %s\n", error.what ());
    return 1;
  }
}
