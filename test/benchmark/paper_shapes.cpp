// SPDX-License-Identifier: BSD-3-Clause
//
// Shapes in the place of the paper's models, sampled evenly by area, with exact normals.
#include "paper_models.h"

#include <cmath>
#include <random>
#include <string_view>

namespace paper
{

namespace
{

/** \brief A surface seen from the origin: its distance in the direction u is 1 + Σ a sin (b·u + c). */
class BumpyBall
{
public:
  BumpyBall (int waves, double frequency, double amplitude) : amplitude_ (amplitude / waves), frequency_ (frequency)
  {
    std::uniform_real_distribution<double> phase (0.0, 2.0 * M_PI);
    for (int i = 0; i < waves; ++i)
      waves_.push_back ({frequency * direction (), phase (random_)});
  }

  std::vector<Node>
  sample (std::size_t count)
  {
    const double sum = amplitude_ * static_cast<double> (waves_.size ());
    const double largest = (1.0 + sum) * std::hypot (1.0 + sum, sum * frequency_);
    std::uniform_real_distribution<double> share (0.0, largest);
    std::vector<Node> nodes;
    while (nodes.size () < count)
    {
      const Eigen::Vector3d u = direction ();
      double distance = 1.0;
      Eigen::Vector3d slope = Eigen::Vector3d::Zero ();
      for (const Wave &wave : waves_)
      {
        distance += amplitude_ * std::sin (wave.b.dot (u) + wave.c);
        slope += amplitude_ * std::cos (wave.b.dot (u) + wave.c) * wave.b;
      }
      slope -= slope.dot (u) * u;
      const double area = distance * std::hypot (distance, slope.norm ()); // per solid angle
      if (share (random_) <= area)
        nodes.push_back ({(distance * u).cast<float> (), (distance * u - slope).normalized ().cast<float> ()});
    }
    return nodes;
  }

private:
  struct Wave
  {
    Eigen::Vector3d b;
    double c;
  };

  Eigen::Vector3d
  direction ()
  {
    std::normal_distribution<double> normal;
    Eigen::Vector3d v;
    for (double &coordinate : v)
      coordinate = normal (random_);
    return v.normalized ();
  }

  std::mt19937 random_{11};
  double amplitude_, frequency_;
  std::vector<Wave> waves_;
};

/** \brief A cylinder with a thinner one on it, which two planes cut to a wedge. */
class Screwdriver
{
public:
  std::vector<Node>
  sample (std::size_t count)
  {
    const double handle = 2.0 * M_PI * HANDLE * (NECK - BOTTOM), shaft = 2.0 * M_PI * SHAFT * (TOP - NECK);
    const double cap = M_PI * HANDLE * HANDLE, end = M_PI * SHAFT * SHAFT;
    const double face = 2.0 * SHAFT * (TOP - WEDGE) * std::hypot (1.0, SLOPE);
    std::discrete_distribution<int> piece ({handle, cap, cap, shaft, end, face, face});
    std::vector<Node> nodes;
    while (nodes.size () < count)
    {
      Eigen::Vector3d p, n;
      if (draw (piece (random_), p, n))
        nodes.push_back ({p.cast<float> (), n.cast<float> ()});
    }
    return nodes;
  }

  /** \brief Two planes along the wedge, outward: a little inside its faces, so that there are points beyond them. */
  static std::vector<Eigen::Vector4d>
  planes ()
  {
    const double length = std::hypot (1.0, SLOPE), offset = INSIDE - (SHAFT + SLOPE * WEDGE);
    return {Eigen::Vector4d (0.0, 1.0, SLOPE, offset) / length, Eigen::Vector4d (0.0, -1.0, SLOPE, offset) / length};
  }

private:
  static constexpr double HANDLE = 0.165, SHAFT = 0.025;                        // radii
  static constexpr double BOTTOM = -0.5, NECK = -0.03, WEDGE = 0.17, TOP = 0.5; // heights
  static constexpr double INSIDE = 0.003;
  static constexpr double SLOPE = 0.0606; // by which the wedge gets thinner

  static double
  halfThickness (double z)
  {
    return SHAFT - SLOPE * (z - WEDGE);
  }

  double
  between (double low, double high)
  {
    return std::uniform_real_distribution<double> (low, high) (random_);
  }

  /** \brief A point of a piece of the surface; false where the piece is cut off. */
  bool
  draw (int piece, Eigen::Vector3d &p, Eigen::Vector3d &n)
  {
    const double turn = between (0.0, 2.0 * M_PI);
    const Eigen::Vector3d out (std::cos (turn), std::sin (turn), 0.0), up = Eigen::Vector3d::UnitZ ();
    switch (piece)
    {
      case 0: // side of the handle
        return set (p, HANDLE * out + between (BOTTOM, NECK) * up, n, out);
      case 1: // its bottom
        return set (p, HANDLE * std::sqrt (between (0.0, 1.0)) * out + BOTTOM * up, n, -up);
      case 2: // its top, around the shaft
        return set (p, HANDLE * std::sqrt (between (0.0, 1.0)) * out + NECK * up, n, up) &&
               p.head<2> ().norm () > SHAFT;
      case 3: // side of the shaft
        return set (p, SHAFT * out + between (NECK, TOP) * up, n, out) && std::abs (p[1]) < halfThickness (p[2]);
      case 4: // its end
        return set (p, SHAFT * std::sqrt (between (0.0, 1.0)) * out + TOP * up, n, up) &&
               std::abs (p[1]) < halfThickness (TOP);
      default: // faces of the wedge
        const double side = piece == 5 ? 1.0 : -1.0, z = between (WEDGE, TOP);
        return set (p, {between (-SHAFT, SHAFT), side * halfThickness (z), z}, n,
                    Eigen::Vector3d (0.0, side, SLOPE).normalized ()) &&
               p.head<2> ().norm () < SHAFT;
    }
  }

  static bool
  set (Eigen::Vector3d &p, const Eigen::Vector3d &position, Eigen::Vector3d &n, const Eigen::Vector3d &normal)
  {
    p = position;
    n = normal;
    return true;
  }

  std::mt19937 random_{13};
};

} // namespace

Model
generateModel (const Row &row)
{
  const auto count = static_cast<std::size_t> (row.points);
  const std::string_view file = row.file;
  Model model;
  if (file.find ("screwdriver") != file.npos)
  {
    model.source = "generated: wedge on cylinders";
    model.nodes = Screwdriver ().sample (count);
    if (row.is_sharp)
      model.planes = Screwdriver::planes ();
    return model;
  }
  const bool is_detailed = file.find ("buddha") != file.npos;
  model.source = is_detailed ? "generated: ball of fine bumps" : "generated: ball of bumps";
  model.nodes = BumpyBall (is_detailed ? 40 : 10, is_detailed ? 9.0 : 4.0, is_detailed ? 0.9 : 0.8).sample (count);
  return model;
}

} // namespace paper
