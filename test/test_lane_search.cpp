// SPDX-License-Identifier: BSD-3-Clause
//
// The search in lanes, and the links that are found with it.
#include "field_tests.h"

#include "lanes/lanes.h"
#include "node_table.h"
#include "smooth_links.h"

#include <erkpa/point_layout.h>

#include <algorithm>
#include <array>

TEST (LaneSearch, FindsThePointsWithinADistanceWithEveryInstructionSet)
{
  constexpr std::size_t COUNT = 1000;
  std::array<std::vector<float>, 3> x;
  for (std::vector<float> &coordinates : x)
    for (std::size_t i = 0; i < COUNT; ++i)
      coordinates.push_back (static_cast<float> (randomPoint (1.0)[0]));
  const std::vector<erkpa::lanes::Stretch> stretches{{3, 4}, {10, 27}, {32, 32}, {64, 96}, {100, 999}};
  const std::array<float, 3> center{0.1f, -0.2f, 0.3f};
  std::size_t engines = 0;
  const erkpa::lanes::Engine *const *engine = erkpa::lanes::engines (engines);
  for (std::size_t e = 0; e < engines; ++e)
    for (const float limit : {0.0f, 0.2f, 0.7f, 100.0f})
    {
      std::vector<std::uint32_t> places (COUNT + erkpa::lanes::MAX_WIDTH), expected;
      std::vector<float> squared (places.size ());
      const erkpa::lanes::Found found{places.data (), squared.data ()};
      const std::size_t kept =
          engine[e]->search->findWithin ({x[0].data (), x[1].data (), x[2].data ()}, stretches.data (),
                                         stretches.size (), center.data (), limit, found);
      for (const erkpa::lanes::Stretch &stretch : stretches)
        for (std::uint32_t i = stretch.first; i < stretch.last; ++i)
        {
          const Vector3d way (x[0][i] - center[0], x[1][i] - center[1], x[2][i] - center[2]);
          if (way.squaredNorm () <= static_cast<double> (limit))
            expected.push_back (i);
        }
      EXPECT_EQ (std::vector<std::uint32_t> (places.begin (), places.begin () + static_cast<long> (kept)), expected)
          << engine[e]->name << " within " << limit;
      const std::size_t within = engine[e]->search->countWithin (squared.data (), kept, 0.5f * limit);
      EXPECT_EQ (std::count_if (squared.begin (), squared.begin () + static_cast<long> (kept),
                                [&] (float s) { return s <= 0.5f * limit; }),
                 static_cast<long> (within))
          << engine[e]->name;
      std::array<std::vector<float>, 6> copied;
      std::vector<std::uint32_t> copied_places (places.size ());
      erkpa::lanes::Table table{};
      std::vector<float> copied_squared (places.size ());
      erkpa::lanes::Copies copies{copied_places.data (), {}, copied_squared.data ()};
      for (std::size_t a = 0; a < copied.size (); ++a)
      {
        copied[a].resize (places.size ());
        table.columns[a] = x[a % 3].data (); // normals: whatever
        copies.columns[a] = copied[a].data ();
      }
      ASSERT_EQ (engine[e]->search->copyWithin (table, stretches.data (), stretches.size (), center.data (), limit,
                                                2.0f, copies),
                 kept)
          << engine[e]->name;
      EXPECT_TRUE (std::equal (squared.begin (), squared.begin () + static_cast<long> (kept), copied_squared.begin ()));
      for (std::size_t i = 0; i < kept; ++i)
        for (std::size_t a = 0; a < 3; ++a)
        {
          EXPECT_EQ (copied_places[i], places[i]);
          EXPECT_EQ (copied[a][i], (x[a][places[i]] - center[a]) * 2.0f) << engine[e]->name;
          EXPECT_EQ (copied[3 + a][i], x[a][places[i]]) << engine[e]->name;
        }
      std::fill_n (table.columns + 3, 3, nullptr);
      copies.squared = nullptr;
      const std::array<std::vector<float>, 6> before = copied;
      for (std::size_t a = 0; a < 3; ++a)
        std::fill (copied[a].begin (), copied[a].end (), 0.0f);
      ASSERT_EQ (engine[e]->search->copyWithin (table, stretches.data (), stretches.size (), center.data (), limit,
                                                2.0f, copies),
                 kept)
          << engine[e]->name;
      for (std::size_t a = 0; a < 6; ++a)
        EXPECT_TRUE (std::equal (copied[a].begin (), copied[a].begin () + static_cast<long> (kept), before[a].begin ()))
            << engine[e]->name << " without normals and squares";
    }
}

namespace
{

erkpa::SegmentationOptions
segmentationFor (double spacing)
{
  erkpa::SegmentationOptions options;
  options.spacing = spacing;
  options.separation_reach = 2.5 * spacing;
  options.chord = 0.02 * spacing;
  return options;
}

float
squaredDistance (const erkpa::OrientedPoints &points, int i, int j)
{
  return (points.positions[static_cast<std::size_t> (j)] - points.positions[static_cast<std::size_t> (i)])
      .squaredNorm ();
}

} // namespace

TEST (LaneLinks, LinksWhatTheSmoothnessTestDoesWithEveryInstructionSet)
{
  constexpr int COUNT = 403;
  constexpr float MOST = 0.5f, CLOSE = 0.2f;
  erkpa::OrientedPoints points;
  std::array<std::vector<float>, 6> columns;
  for (int i = 0; i < COUNT; ++i)
  {
    points.positions.push_back (randomPoint (0.5).cast<float> ());
    points.normals.push_back ((Vector3d (0.0, 0.0, 1.0) + randomPoint (0.5)).normalized ().cast<float> ());
    for (std::size_t a = 0; a < 3; ++a)
    {
      columns[a].push_back (points.positions.back ()[static_cast<Eigen::Index> (a)]);
      columns[3 + a].push_back (points.normals.back ()[static_cast<Eigen::Index> (a)]);
    }
  }
  erkpa::lanes::Table table{};
  for (std::size_t c = 0; c < columns.size (); ++c)
    table.columns[c] = columns[c].data ();
  const erkpa::SmoothnessTest test (segmentationFor (0.12));
  std::size_t engines = 0, fitting = 0;
  const erkpa::lanes::Engine *const *engine = erkpa::lanes::engines (engines);
  for (std::size_t e = 0; e < engines; ++e)
    for (int node = 0; node < COUNT; ++node)
    {
      std::vector<std::uint32_t> linked (COUNT + erkpa::lanes::MAX_WIDTH), expected;
      bool has_others = false, expects_others = false;
      for (int j = 0; j < COUNT; ++j)
      {
        const float squared = squaredDistance (points, node, j);
        const bool is_linked = test.areLinked (points, node, j, squared);
        if (is_linked && squared <= MOST)
          expected.push_back (static_cast<std::uint32_t> (j));
        expects_others = expects_others || (!is_linked && squared <= CLOSE);
      }
      std::array<float, 6> own{};
      for (std::size_t c = 0; c < own.size (); ++c)
        own[c] = columns[c][static_cast<std::size_t> (node)];
      linked.resize (
          engine[e]->linkSmooth (test.limits (), table, COUNT, own.data (), MOST, CLOSE, linked.data (), has_others));
      EXPECT_EQ (linked, expected) << engine[e]->name;
      EXPECT_EQ (has_others, expects_others) << engine[e]->name;
      fitting += expected.size ();
    }
  EXPECT_GT (fitting, 3 * engines * COUNT) << "some fit";
  EXPECT_LT (fitting, engines * COUNT * COUNT / 3) << "others do not";
}

namespace
{

/** \brief Expects the links of a node to lead to all nodes that fit to it within \a sure, and to none that do not fit
 * or are beyond \a most; and the node to be a suspect where others lie within the separation reach. */
void
expectLinks (const erkpa::OrientedPoints &points, const erkpa::SegmentationOptions &options,
             const erkpa::NodeLinks::List &links, int node, bool is_suspect)
{
  constexpr double LESS = 0.9999, MORE = 1.0001;
  const double most = options.bridge_reach * options.spacing, apart = options.separation_reach;
  const double sure = is_suspect ? most : std::min (most, apart);
  const erkpa::SmoothnessTest test (options);
  std::vector<int> found (links.begin (), links.end ());
  std::sort (found.begin (), found.end ());
  int others = 0, perhaps = 0;
  for (int j = 0; j < static_cast<int> (points.size ()); ++j)
  {
    if (j == node)
      continue;
    const float squared = squaredDistance (points, node, j);
    const bool fits = test.areLinked (points, node, j, squared);
    const bool is_found = std::binary_search (found.begin (), found.end (), j);
    const auto distance = std::sqrt (static_cast<double> (squared));
    EXPECT_FALSE (is_found && (!fits || distance > MORE * most)) << node << " and " << j;
    EXPECT_FALSE (!is_found && fits && distance < LESS * sure) << node << " and " << j;
    others += !fits && distance < LESS * apart ? 1 : 0;
    perhaps += !fits && distance < MORE * apart ? 1 : 0;
  }
  EXPECT_TRUE (is_suspect ? perhaps > 0 : others == 0) << node;
}

/** \brief See linkNeighbors (); for any number of threads. */
void
expectLinksOfBox (const erkpa::SegmentationOptions &options, const erkpa::OrientedPoints &points,
                  const erkpa::PointLayout &layout)
{
  std::vector<char> is_suspect, are_suspect;
  const erkpa::NodeLinks links = erkpa::linkNeighbors (points, *layout.grid, options, 2, is_suspect);
  const erkpa::NodeLinks same = erkpa::linkNeighbors (points, *layout.grid, options, 1, are_suspect);
  EXPECT_EQ (is_suspect, are_suspect);
  const auto count = static_cast<int> (points.size ());
  int suspects = 0;
  for (int i = 0; i < count; ++i)
  {
    const auto node = static_cast<std::size_t> (i);
    expectLinks (points, options, links[node], i, is_suspect[node] != 0);
    EXPECT_TRUE (std::equal (links[node].begin (), links[node].end (), same[node].begin (), same[node].end ()));
    suspects += is_suspect[node];
  }
  EXPECT_GT (suspects, count / 10) << "along the edges";
  EXPECT_LT (suspects, 9 * count / 10);
}

} // namespace

TEST (SmoothLinks, LeadToAllNeighborsOnTheSameFaceAndToNoOthers)
{
  const auto points = shapes::points (shapes::box (4000, {1.0, 0.6, 0.4}));
  const erkpa::PointLayout layout (*points, 0);
  expectLinksOfBox (segmentationFor (layout.spacing), *points, layout);
}

TEST (SmoothLinks, AreNoLongerThanBridgesWhereNodesSeeEachOtherFartherOff)
{
  const auto points = shapes::points (shapes::box (4000, {1.0, 0.6, 0.4}));
  const erkpa::PointLayout layout (*points, 0);
  erkpa::SegmentationOptions options = segmentationFor (layout.spacing);
  options.separation_reach = 1.3 * options.bridge_reach * options.spacing;
  expectLinksOfBox (options, *points, layout);
}

TEST (GridSearch, FindsTheNearestPointsWhateverWasAskedBefore)
{
  const auto cloudOf = [] (float size)
  {
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 900; ++i)
      points.emplace_back (size * randomPoint (1.0).cast<float> ());
    for (int i = 0; i < 100; ++i)
      points.push_back (points[static_cast<std::size_t> (3 * i)] + Eigen::Vector3f (size, 0.0f, 0.0f)); // equally far
    return points;
  };
  const std::array<std::vector<Eigen::Vector3f>, 2> clouds{cloudOf (1.0f), cloudOf (500.0f)};
  const std::array<erkpa::NeighborSearch::ConstPtr, 2> searches{erkpa::makeGridSearch (clouds[0], 1),
                                                                erkpa::makeGridSearch (clouds[1], 1)};
  const std::array<int, 4> counts{1, 12, 200, 2000};
  std::vector<int> found;
  std::vector<float> squared;
  for (std::size_t query = 0; query < 200; ++query)
  {
    const std::size_t c = query / 3 % 2;
    const int k = counts[query % counts.size ()];
    const Eigen::Vector3f x = clouds[c][query * 4];
    searches[c]->nearestK (x, k, found, squared);
    std::vector<float> all;
    for (const Eigen::Vector3f &p : clouds[c])
      all.push_back ((p - x).squaredNorm ());
    std::sort (all.begin (), all.end ());
    std::sort (squared.begin (), squared.end ());
    ASSERT_EQ (found.size (), std::min<std::size_t> (static_cast<std::size_t> (k), all.size ()));
    for (std::size_t i = 0; i < squared.size (); ++i)
      ASSERT_NEAR (squared[i], all[i], 1e-5f * (1.0f + all[i])) << query;
  }
}
