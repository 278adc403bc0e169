// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

/** \brief The fit of FieldFit at many evaluation points at once, one in each lane of the processor's vectors.
 *
 * LocalField is the definition, in double precision and for one point; this is the same in float for points that share
 * a gathered neighbourhood. What is here sees neither Eigen nor PCL, only arrays of
 * floats: the sources behind it are compiled once for each instruction set, and memory of a class that aligns to the
 * instruction set must not pass between such units.
 *
 * All lengths are in one unit, about the support radius, with the middle of the neighbourhood as origin: then nothing
 * over- or underflows, whatever the unit of the cloud.
 */
namespace erkpa::lanes
{

/** \brief Points are taken in groups of at most this many; arrays of points must be readable up to a multiple of it. */
constexpr std::size_t MAX_WIDTH = 16;

enum class Basis
{
  CONSTANT,
  LINEAR,
  SPHERICAL,
  QUADRATIC
};

enum class Constraint
{
  HERMITE,   ///< values and gradients
  VALUES,    ///< values
  FUNCTIONAL ///< eq. (2)
};

enum class Kernel
{
  PAPER,
  WENDLAND_C2,
  WENDLAND_C4,
  GAUSSIAN
};

/** \brief What is asked for, the same for all points. */
struct Settings
{
  Basis basis;
  Constraint constraint;
  Kernel kernel;
  int k;             ///< ε(x) = distance to the k-th nearest node; 0: Points::radius says it
  bool limited;      ///< where fewer than k nodes lie within Points::radius, that is ε(x)
  float stretch;     ///< 1/F² - 1, where supports reach a share F of ε along the normals of nodes; 0: as far
  bool gradients;    ///< ∇f, border offsets and attributes as well
  float reach;       ///< a point is in reach of the data where a quarter of its nodes lie within reach · ε + offset,
  float offset;      ///< or ...
  float near_enough; ///< ... the nearest one within this distance
  int min_nodes;     ///< fewer nodes in the support leave f undefined
};

/** \brief The gathered value points, in an order that does not depend on what they were gathered for; positions must be
 * readable up to a multiple of MAX_WIDTH. */
struct Nodes
{
  std::size_t count;
  std::size_t on_surface; ///< the first ones are nodes; off-surface points follow
  const float *x, *y, *z;
  const float *nx, *ny, *nz;
  const float *lambda;     ///< null: all zero
  const float *confidence; ///< null: all one
  const float *attributes; ///< channel after channel, count values each
  std::size_t channels;
};

/** \brief The evaluation points. */
struct Points
{
  std::size_t count;
  const float *x, *y, *z;
  const float *radius;    ///< ε(x); with k > 0 a bound: where it is exceeded, State::SHORT
  const float *guess;     ///< with k > 0: about ε(x); of the first points, the others follow these
  const float *growth[3]; ///< ∇ε(x) where Points::radius is ε(x); null: zero
  std::size_t stride;     ///< from a point's attribute or coefficient to its next one
};

/** \brief At most so many sharp surfaces, and corners, enrich the points of one vector; others are State::UNSETTLED. */
constexpr std::size_t MAX_SURFACES = 6, MAX_PENCILS = 4;

/** \brief A sharp surface, and θ and ∇θ of it. */
struct Surface
{
  const float *theta, *gradient[3];       ///< at the value points
  const float *theta_at, *gradient_at[3]; ///< at the evaluation points
  const float *theta_seen;                ///< where these are seen from; null: from where they are
  bool is_plane;                          ///< |θ| is a distance, and a kink may be seen from either side
  const float *distance_at, *away_at[3];  ///< of a limited one: from its extent, and ∇ of it; null otherwise
  float fade;                             ///< of a limited one: SharpSurfaceParts::fade
};

/** \brief Three surfaces that meet in a corner: see erkpa::Pencil. */
struct Pencil
{
  int surfaces[3];
  float scale_a, scale_b;
};

/** \brief Those that pass near the points; not with Constraint::VALUES. */
struct SharpSurfaces
{
  static constexpr std::size_t MOST = 30; ///< of either
  static_assert (MOST <= 32, "Samples::active has a bit for each");

  std::size_t count; ///< 0: none, and no enrichment
  bool jumps;        ///< the field jumps across them: functional values only
  Surface surfaces[MOST];
  std::size_t pencil_count;
  Pencil pencils[MOST];
};

enum class State : std::uint8_t
{
  DEFINED,
  UNDEFINED, ///< too few nodes: value and gradient are NaN
  UNSETTLED, ///< it takes terms or digits that are not there: ask LocalField
  SHORT      ///< fewer than k nodes lie within Points::radius
};

/** \brief What is found, one per point. Gradients and what follows may be null where they are not asked for. */
struct Samples
{
  float *value, *radius;
  std::uint8_t *in_reach; ///< see Settings::reach
  State *state;
  std::uint32_t *nearest;  ///< place of the nearest node; null: not wanted, like the next ones
  float *nearest_distance; ///< from it
  float *aside;            ///< |centroid of the weighted nodes - x|, in ε
  float *coefficients;     ///< of the terms in u = (y - x) / ε, times ε: term after term; where sharp surfaces add
                           ///< others, value and slope of the piece that holds at x stand for theirs
  std::uint32_t *support;  ///< number of nodes in the support
  std::uint32_t *active;   ///< the sharp surfaces that count there, as bits
  float *gradient[3];
  float *radius_gradient[3]; ///< ∇ε; null: not wanted
  float *border_offset;
  float *attributes; ///< channel after channel
};

/** \brief Memory for one call. */
struct Scratch
{
  static constexpr std::size_t COLUMNS = 8; ///< what a node has: position, normal, λ, confidence

  std::uint32_t *list; ///< MAX_WIDTH more places than there are nodes
  float *near;         ///< COLUMNS times as many
  float *rows;         ///< rows of MAX_WIDTH floats, as many as nodes; best at the start of a cache line
};

/** \brief Points among which is searched. */
struct Cloud
{
  const float *x, *y, *z;
};

/** \brief The points from one place on to before another. */
struct Stretch
{
  std::uint32_t first, last;
};

/** \brief Places of points, and their squared distances from a center. */
struct Found
{
  std::uint32_t *places;
  float *squared;
};

/** \brief Positions and, where they are wanted, normals of points, as arrays. */
struct Table
{
  static constexpr std::size_t COLUMNS = 6;

  const float *columns[COLUMNS];
};

/** \brief The same of some of them, their places, and squared distances from a center where there is an array for them.
 */
struct Copies
{
  std::uint32_t *places;
  float *columns[Table::COLUMNS];
  float *squared;
};

/** \brief A search, for the neighbourhood that evaluation points share. */
struct Search
{
  /** \brief Finds those points of stretches whose squared distance from a center is at most a limit.
   * \param[out] found has room for all points of the stretches and MAX_WIDTH more
   * \return how many, in their order
   */
  std::size_t (*findWithin) (const Cloud &cloud, const Stretch *stretches, std::size_t count, const float *center,
                             float limit, const Found &found);

  /** \brief Copies them: positions about the center, times a scale.
   * \param[out] copies have as much room
   */
  std::size_t (*copyWithin) (const Table &table, const Stretch *stretches, std::size_t count, const float *center,
                             float limit, float scale, const Copies &copies);

  /** \brief How many are within a limit. */
  std::size_t (*countWithin) (const float *squared, std::size_t count, float limit);
};

/** \brief A box of points of a lattice, and sums there: see erkpa::MomentLattice. Lengths are in ε. */
struct Lattice
{
  static constexpr std::size_t MOST = 12; ///< points along an axis

  std::size_t sides[3]; ///< points along the axes, x first
  float first[3];       ///< position of the lowest one
  float spacing;        ///< from one to the next
  const float *sums;    ///< a record for each point, all about the origin
  std::size_t record;   ///< its length
  std::size_t channels; ///< of attributes, the last ones in a record
};

/** \brief Moments that are summed up at the points of a lattice only, and interpolated between these. */
struct LatticeMethods
{
  /** \brief How many sums there are, but for those of attributes. The basis is linear or spherical. */
  std::size_t (*columns) (const Settings &settings);

  /** \brief Sum up what nodes bring to points of the lattice, about the origin.
   * \param[out] sums column after column, those of attributes as well; has room for a multiple of MAX_WIDTH points
   * \param[in] stride from a column to the next one
   */
  void (*sum) (const Settings &settings, const Nodes &nodes, const Points &points, const Scratch &scratch,
               std::size_t stride, float *sums);

  /** \brief Bring sums to another origin, and to records.
   * \param[in] steps to the new origin, of each point; readable up to a multiple of MAX_WIDTH, as the sums are
   */
  void (*shift) (const Settings &settings, std::size_t channels, const float *const *steps, const float *sums,
                 std::size_t count, std::size_t stride, float *records);

  /** \brief What evaluate () finds, from interpolated sums. Whatever stays open here is State::UNSETTLED: ask the
   * nodes. Each point has the four points of the lattice around it along each axis in the box. */
  void (*interpolate) (const Settings &settings, const Lattice &lattice, const Points &points, const Samples &samples);
};

/** \brief Nodes that vote on how faces combine: see FaceVote. Arrays must be readable up to a multiple of MAX_WIDTH,
 * with weights of zero there. */
struct Voters
{
  std::size_t count;
  const float *u[3]; ///< (x_i - x) / ε
  const float *weight;
};

/** \brief The fits to the faces. */
struct FaceFits
{
  static constexpr std::size_t MAX = 4;

  std::size_t count;
  Basis basis;
  const float *coefficients[MAX]; ///< of the terms in u · scale
  float scale[MAX];
};

/** \brief Ways to combine as many faces: see FaceTree. */
struct Trees
{
  struct Step
  {
    std::uint8_t face, other;
    bool larger;
  };

  static constexpr std::size_t MAX = 52;

  std::size_t count;
  const Step (*steps)[FaceFits::MAX - 1]; ///< of each, one less than there are faces
};

/** \brief What neighbours on one smooth surface agree in: see SmoothnessTest. */
struct Smoothness
{
  float chord;          ///< a step across the normals is never larger, ...
  float bend, far_bend; ///< ... or it is such a share of the distance at most
  float cosine;         ///< least one of the angle between the normals
  float far_cosine;     ///< the same of neighbours that are farther apart than ...
  float squared_reach;  ///< ... this, squared
};

/** \brief One instruction set. */
struct Engine
{
  const char *name;
  std::size_t width; ///< points per vector
  const Search *search;
  const LatticeMethods *lattice;
  void (*evaluate) (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
                    const Scratch &scratch, const Samples &samples);

  /** \brief The sum of weight · |value| at the voters for each tree. */
  void (*measureTrees) (const Voters &voters, const FaceFits &fits, const Trees &trees, float *distances);

  /** \brief The places of those nodes that fit to one: to itself as well, where it is among them.
   * \param[in] nodes positions and normals of \a count nodes
   * \param[in] node those of the one, x y z nx ny nz
   * \param[in] most,close squared distances
   * \param[out] linked places of those within \a most that fit; has room for all and MAX_WIDTH more
   * \param[out] has_others whether some within \a close do not fit
   * \return how many are linked
   */
  std::size_t (*linkSmooth) (const Smoothness &smoothness, const Table &nodes, std::size_t count, const float *node,
                             float most, float close, std::uint32_t *linked, bool &has_others);
};

/** \brief The engines this processor can run, the widest last; never empty. */
const Engine *const *
engines (std::size_t &count);

/** \brief The widest of them. */
const Engine &
bestEngine ();

} // namespace erkpa::lanes
