// SPDX-License-Identifier: BSD-3-Clause
#include "shapes.h"
#include "sliver_removal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

using Eigen::Vector3d;
using erkpa::SurfaceVertices;
using erkpa::VertexPair;
using Triangle = std::array<int, 3>;

namespace
{

constexpr double VOXEL = 0.1;

/** \brief A mesh in the making, as removeSlivers takes it. */
struct Patch
{
  SurfaceVertices vertices;
  erkpa::LargeVector<Triangle> triangles;
  std::vector<VertexPair> creases;

  int
  add (const Vector3d &position, const Vector3d &normal)
  {
    vertices.positions.push_back (position);
    vertices.normals.push_back (normal);
    vertices.border_offsets.push_back (0.0);
    vertices.faces.push_back (-1);
    return static_cast<int> (vertices.positions.size ()) - 1;
  }

  void
  removeSlivers ()
  {
    erkpa::removeSlivers (VOXEL, creases, triangles, vertices);
  }

  Vector3d
  at (int v) const
  {
    return vertices.positions[static_cast<std::size_t> (v)];
  }

  Vector3d
  area (const Triangle &t) const
  {
    return (at (t[1]) - at (t[0])).cross (at (t[2]) - at (t[0])) / 2.0;
  }

  std::size_t
  narrow () const
  {
    const auto is_narrow = [this] (const Triangle &t)
    {
      std::array<double, 3> lengths{(at (t[1]) - at (t[0])).norm (), (at (t[2]) - at (t[1])).norm (),
                                    (at (t[0]) - at (t[2])).norm ()};
      std::sort (lengths.begin (), lengths.end ());
      return 2.0 * area (t).norm () < std::sin (5.0 * M_PI / 180.0) * lengths[1] * lengths[2];
    };
    return static_cast<std::size_t> (std::count_if (triangles.begin (), triangles.end (), is_narrow));
  }

  erkpa::TriangleMesh
  mesh () const
  {
    erkpa::TriangleMesh result;
    for (const Vector3d &p : vertices.positions)
      result.vertices.emplace_back (p.cast<float> ());
    for (const Vector3d &n : vertices.normals)
      result.normals.emplace_back (n.cast<float> ());
    result.triangles = triangles;
    erkpa::removeUnusedVertices (result);
    return result;
  }

  /** \brief V - E + F. */
  int
  euler () const
  {
    std::set<int> used;
    std::set<VertexPair> edges;
    for (const Triangle &t : triangles)
      for (std::size_t i = 0; i < 3; ++i)
      {
        used.insert (t[i]);
        edges.insert (erkpa::orderedPair (t[i], t[(i + 1) % 3]));
      }
    return static_cast<int> (used.size ()) - static_cast<int> (edges.size ()) + static_cast<int> (triangles.size ());
  }
};

/** \brief Uneven steps over 0..1: some much shorter than a voxel of what they are stretched to. */
std::vector<double>
unevenSteps (int count, unsigned seed)
{
  std::mt19937 random (seed);
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  std::vector<double> steps{0.0};
  for (int i = 0; i < count; ++i)
    steps.push_back (steps.back () + (i % 3 == 1 ? 0.02 + 0.1 * unit (random) : 0.8 + 0.4 * unit (random)));
  for (double &step : steps)
    step /= steps.back ();
  return steps;
}

/** \brief A grid of rows and columns, each joined end to end where the last step shall be the first. */
struct Grid
{
  std::vector<double> rows, columns;
  bool rows_joined = false, columns_joined = false;

  Patch
  mesh (const std::function<void (double, double, Vector3d &, Vector3d &)> &surface) const
  {
    Patch patch;
    const std::size_t height = rows.size () - (rows_joined ? 1 : 0), width = columns.size () - (columns_joined ? 1 : 0);
    for (std::size_t i = 0; i < height; ++i)
      for (std::size_t j = 0; j < width; ++j)
      {
        Vector3d position, normal;
        surface (rows[i], columns[j], position, normal);
        patch.add (position, normal);
      }
    const auto vertex = [&] (std::size_t i, std::size_t j)
    { return static_cast<int> (i % height * width + j % width); };
    for (std::size_t i = 0; i + 1 < rows.size (); ++i)
      for (std::size_t j = 0; j + 1 < columns.size (); ++j)
      {
        patch.triangles.push_back ({vertex (i, j), vertex (i + 1, j), vertex (i + 1, j + 1)});
        patch.triangles.push_back ({vertex (i, j), vertex (i + 1, j + 1), vertex (i, j + 1)});
      }
    return patch;
  }
};

/** \brief A torus around z of radii 1 and 0.5. */
Patch
torus ()
{
  const Grid grid{unevenSteps (90, 1), unevenSteps (45, 2), true, true};
  return grid.mesh (
      [] (double row, double column, Vector3d &position, Vector3d &normal)
      {
        const double u = 2.0 * M_PI * row, v = 2.0 * M_PI * column;
        const Vector3d out (std::cos (u), std::sin (u), 0.0);
        normal = std::cos (v) * out + std::sin (v) * Vector3d::UnitZ ();
        position = out + 0.5 * normal;
      });
}

/** \brief A sphere of radius 1 by longitude and latitude: needles around the poles. */
Patch
sphere ()
{
  const int rows = 40, columns = 120;
  Patch patch;
  const auto add = [&patch] (const Vector3d &n) { return patch.add (n, n); };
  const int top = add (Vector3d::UnitZ ()), bottom = add (-Vector3d::UnitZ ());
  for (int i = 1; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
    {
      const double polar = M_PI * i / rows, turn = 2.0 * M_PI * j / columns;
      add ({std::sin (polar) * std::cos (turn), std::sin (polar) * std::sin (turn), std::cos (polar)});
    }
  const auto vertex = [&] (int i, int j) {
    return i == 0 ? top : i == rows ? bottom : 2 + (i - 1) * columns + j % columns;
  };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
    {
      if (i + 1 < rows)
        patch.triangles.push_back ({vertex (i, j), vertex (i + 1, j), vertex (i + 1, j + 1)});
      if (i > 0)
        patch.triangles.push_back ({vertex (i, j), vertex (i + 1, j + 1), vertex (i, j + 1)});
    }
  return patch;
}

/** \brief A sheet over -1..1 that is curved a little. */
Patch
sheet ()
{
  const Grid grid{unevenSteps (30, 3), unevenSteps (30, 4)};
  return grid.mesh (
      [] (double row, double column, Vector3d &position, Vector3d &normal)
      {
        const double x = 2.0 * row - 1.0, y = 2.0 * column - 1.0;
        position = {x, y, 0.2 * x * y};
        normal = Vector3d (-0.2 * y, -0.2 * x, 1.0).normalized ();
      });
}

/** \brief The cube over -1..1 with its twelve edges as creases. */
Patch
cube ()
{
  std::vector<double> steps = unevenSteps (30, 5);
  for (double &step : steps)
    step = 2.0 * step - 1.0;
  steps.back () = 1.0;
  Patch patch;
  std::map<std::array<double, 3>, int> found;
  const auto vertex = [&] (const Vector3d &p)
  {
    Vector3d outside = Vector3d::Zero ();
    for (int axis = 0; axis < 3; ++axis)
      outside[axis] = std::abs (p[axis]) == 1.0 ? p[axis] : 0.0;
    const auto [entry, is_new] =
        found.try_emplace ({p[0], p[1], p[2]}, static_cast<int> (patch.vertices.positions.size ()));
    if (is_new)
      patch.add (p, outside.normalized ());
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      for (std::size_t i = 0; i + 1 < steps.size (); ++i)
        for (std::size_t j = 0; j + 1 < steps.size (); ++j)
        {
          const auto corner = [&] (std::size_t a, std::size_t b)
          {
            Vector3d p;
            p[axis] = side;
            p[(axis + 1) % 3] = steps[side > 0.0 ? a : b];
            p[(axis + 2) % 3] = steps[side > 0.0 ? b : a];
            return vertex (p);
          };
          patch.triangles.push_back ({corner (i, j), corner (i + 1, j), corner (i + 1, j + 1)});
          patch.triangles.push_back ({corner (i, j), corner (i + 1, j + 1), corner (i, j + 1)});
        }
  std::set<VertexPair> creases;
  for (const Triangle &t : patch.triangles)
    for (std::size_t i = 0; i < 3; ++i)
    {
      const Vector3d middle = (patch.at (t[i]) + patch.at (t[(i + 1) % 3])) / 2.0;
      if ((middle.array ().abs () == 1.0).count () > 1)
        creases.insert (erkpa::orderedPair (t[i], t[(i + 1) % 3]));
    }
  patch.creases.assign (creases.begin (), creases.end ());
  return patch;
}

/** \brief The largest angle in degrees between a triangle and a direction at its middle. */
double
largestTurn (const Patch &patch, const std::function<Vector3d (const Vector3d &)> &direction)
{
  double largest = 0.0;
  for (const Triangle &t : patch.triangles)
  {
    const Vector3d middle = (patch.at (t[0]) + patch.at (t[1]) + patch.at (t[2])) / 3.0, area = patch.area (t);
    const Vector3d towards = direction (middle);
    largest = std::max (largest, std::atan2 (area.cross (towards).norm (), area.dot (towards)) * 180.0 / M_PI);
  }
  return largest;
}

/** \brief The border's vertices, from each to the next. */
std::map<int, int>
borderOf (const Patch &patch)
{
  std::set<VertexPair> directed;
  for (const Triangle &t : patch.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      directed.insert ({t[i], t[(i + 1) % 3]});
  std::map<int, int> border;
  for (const auto &[a, b] : directed)
    if (directed.count ({b, a}) == 0)
      border[a] = b;
  return border;
}

} // namespace

TEST (SliverRemoval, LeavesATorusATorusOfTheSameVolume)
{
  Patch patch = torus ();
  const double volume = shapes::volume (patch.mesh ());
  const std::size_t count = patch.triangles.size (), narrow = patch.narrow ();
  EXPECT_GT (narrow, count / 20);
  patch.removeSlivers ();
  EXPECT_LT (patch.narrow (), narrow / 50);
  EXPECT_LT (patch.triangles.size (), count);
  EXPECT_EQ (patch.euler (), 0);
  EXPECT_MESH_CONTRACT (patch.mesh (), true);
  EXPECT_NEAR (shapes::volume (patch.mesh ()), volume, 0.004 * volume);
  const auto outside = [] (const Vector3d &p) -> Vector3d { return p - Vector3d (p[0], p[1], 0.0).normalized (); };
  EXPECT_LT (largestTurn (patch, outside), 20.0) << "a fold";
}

TEST (SliverRemoval, DoesNotDependOnTheNumberOfThreads)
{
  for (const bool has_creases : {false, true})
  {
    Patch one = has_creases ? cube () : torus (), many = one;
    erkpa::removeSlivers (VOXEL, one.creases, one.triangles, one.vertices, 1);
    erkpa::removeSlivers (VOXEL, many.creases, many.triangles, many.vertices, 5);
    EXPECT_EQ (one.triangles, many.triangles);
    EXPECT_EQ (one.creases, many.creases);
  }
}

TEST (SliverRemoval, ThinsOutTheNeedlesAroundTheTipOfAFan)
{
  Patch patch = sphere ();
  const double volume = shapes::volume (patch.mesh ());
  const std::size_t narrow = patch.narrow ();
  EXPECT_GE (narrow, 480u);
  patch.removeSlivers ();
  EXPECT_EQ (patch.narrow (), 0u);
  EXPECT_EQ (patch.euler (), 2);
  EXPECT_MESH_CONTRACT (patch.mesh (), true);
  EXPECT_NEAR (shapes::volume (patch.mesh ()), volume, 0.004 * volume);
  EXPECT_LT (largestTurn (patch, [] (const Vector3d &p) { return p; }), 20.0) << "a fold";
}

TEST (SliverRemoval, KeepsTheEdgesAndCornersOfACube)
{
  Patch patch = cube ();
  const std::size_t narrow = patch.narrow (), creases = patch.creases.size ();
  EXPECT_GT (narrow, 50u);
  patch.removeSlivers ();
  EXPECT_LT (patch.narrow (), narrow / 50);
  EXPECT_LT (patch.creases.size (), creases);
  EXPECT_EQ (patch.euler (), 2);
  EXPECT_MESH_CONTRACT (patch.mesh (), true);
  EXPECT_NEAR (shapes::volume (patch.mesh ()), 8.0, 1e-5);
  EXPECT_NEAR (shapes::area (patch.mesh ()), 24.0, 1e-4) << "a fold";
}

TEST (SliverRemoval, LeavesCreasesWholeAndAlongTheMesh)
{
  Patch patch = cube ();
  patch.removeSlivers ();
  std::set<VertexPair> edges;
  for (const Triangle &t : patch.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      edges.insert (erkpa::orderedPair (t[i], t[(i + 1) % 3]));
  double length = 0.0;
  std::map<int, int> degrees;
  for (const VertexPair &crease : patch.creases)
  {
    EXPECT_EQ (edges.count (crease), 1u);
    length += (patch.at (crease.first) - patch.at (crease.second)).norm ();
    ++degrees[crease.first];
    ++degrees[crease.second];
  }
  EXPECT_NEAR (length, 24.0, 1e-9);
  EXPECT_TRUE (std::is_sorted (patch.creases.begin (), patch.creases.end ()));
  int corners = 0;
  for (const auto &[vertex, degree] : degrees)
  {
    corners += degree == 3;
    EXPECT_TRUE (degree == 2 || degree == 3) << degree;
  }
  EXPECT_EQ (corners, 8);
}

TEST (SliverRemoval, LeavesTheBorderOfASheetAlone)
{
  Patch patch = sheet ();
  const std::map<int, int> border = borderOf (patch);
  const std::size_t count = patch.triangles.size ();
  patch.removeSlivers ();
  EXPECT_LT (patch.triangles.size (), count);
  EXPECT_EQ (borderOf (patch), border);
  EXPECT_EQ (patch.euler (), 1);
  EXPECT_MESH_CONTRACT (patch.mesh (), false);
  EXPECT_LT (largestTurn (patch, [] (const Vector3d &p) { return Vector3d (-0.2 * p[1], -0.2 * p[0], 1.0); }), 20.0);
}

TEST (SliverRemoval, KeepsTheEndOfACrease)
{
  Patch patch = sheet (); // a crease from the middle of a row to its third quarter
  const int width = 31, row = 15 * width;
  for (int j = 15; j < 23; ++j)
    patch.creases.emplace_back (row + j, row + j + 1);
  patch.removeSlivers ();
  ASSERT_FALSE (patch.creases.empty ());
  std::map<int, int> degrees;
  for (const VertexPair &crease : patch.creases)
  {
    ++degrees[crease.first];
    ++degrees[crease.second];
  }
  EXPECT_EQ (degrees[row + 15], 1);
  EXPECT_EQ (degrees[row + 23], 1);
  EXPECT_EQ (degrees.size (), patch.creases.size () + 1) << "one chain";
}

TEST (SliverRemoval, DropsCreasesThatAreNoEdges)
{
  Patch patch = sheet ();
  patch.creases = {{0, 40}, {100, 900}};
  patch.removeSlivers ();
  EXPECT_TRUE (patch.creases.empty ());
}

TEST (SliverRemoval, LeavesWellShapedMeshesAlone)
{
  std::vector<double> steps;
  for (int i = 0; i <= 20; ++i)
    steps.push_back (i / 20.0);
  Patch patch = Grid{steps, steps}.mesh (
      [] (double row, double column, Vector3d &position, Vector3d &normal)
      {
        position = {2.0 * row, 2.0 * column, 0.0};
        normal = Vector3d::UnitZ ();
      });
  const erkpa::LargeVector<Triangle> before = patch.triangles;
  patch.removeSlivers ();
  EXPECT_EQ (patch.triangles, before);
}

TEST (SliverRemoval, FlipsTheLongSideOfACap)
{
  Patch patch; // 4 is nearly on the side 0 1 of a square, outside it the square's lower half
  const std::array<Vector3d, 6> positions{Vector3d (-1.0, 0.0, 0.0), Vector3d (1.0, 0.0, 0.0),
                                          Vector3d (1.0, 1.0, 0.0),  Vector3d (-1.0, 1.0, 0.0),
                                          Vector3d (0.0, 0.01, 0.0), Vector3d (0.0, -1.0, 0.0)};
  for (const Vector3d &p : positions)
    patch.add (VOXEL * p, Vector3d::UnitZ ());
  patch.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 5, 1}};
  patch.removeSlivers ();
  EXPECT_EQ (patch.narrow (), 0u);
  EXPECT_EQ (patch.triangles.size (), 5u);
  EXPECT_MESH_CONTRACT (patch.mesh (), false);
  patch.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 5, 1}};
  patch.creases = {{0, 1}};
  patch.removeSlivers ();
  EXPECT_EQ (patch.narrow (), 1u) << "not across a crease";
  EXPECT_EQ (patch.creases, (std::vector<VertexPair>{{0, 1}}));
}

TEST (SliverRemoval, DoesNotFillTheHoleOfATubeOneNeedleThick)
{
  Patch patch; // a triangular tube as thin as a short edge, open at both ends
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const Vector3d out (std::cos (2.0 * M_PI * j / 3), std::sin (2.0 * M_PI * j / 3), 0.0);
      patch.add (VOXEL * (0.1 * out + i * Vector3d::UnitZ ()), out);
    }
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const int a = 3 * i + j, b = 3 * i + (j + 1) % 3;
      patch.triangles.push_back ({a, b, b + 3});
      patch.triangles.push_back ({a, b + 3, a + 3});
    }
  patch.removeSlivers ();
  EXPECT_EQ (patch.euler (), 0);
  EXPECT_MESH_CONTRACT (patch.mesh (), false);
}
