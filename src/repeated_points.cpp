// SPDX-License-Identifier: BSD-3-Clause
#include "repeated_points.h"

#include "parallel_collect.h"

#include <erkpa/large_pages.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace erkpa
{

namespace
{

/** \brief A position by its digest: equal positions have the same. */
struct Digest
{
  std::uint32_t bits;
  int place;
};

std::uint32_t
digestOf (const Eigen::Vector3f &position)
{
  std::uint64_t mixed = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const float value = position[axis] + 0.0f; // -0 becomes 0
    std::uint32_t bits = 0;
    std::memcpy (&bits, &value, sizeof (bits));
    mixed = (mixed ^ bits) * 0x9e3779b97f4a7c15u;
    mixed ^= mixed >> 29;
  }
  return static_cast<std::uint32_t> (mixed >> 32) ^ static_cast<std::uint32_t> (mixed);
}

/** \brief Digests in groups by their last bits, within each in the order of the positions. */
class DigestGroups
{
public:
  DigestGroups (const std::vector<Eigen::Vector3f> &positions, int threads)
  {
    constexpr std::size_t OF_GROUP = 4096, STRETCH = 65536;
    while (groups_ < 4096 && groups_ * OF_GROUP < positions.size ())
      groups_ *= 2;
    const std::size_t stretches = (positions.size () + STRETCH - 1) / STRETCH;
    std::vector<std::vector<std::size_t>> places (stretches, std::vector<std::size_t> (groups_, 0));
    const auto for_stretches = [&] (auto visit)
    {
      parallelFor (
          stretches, threads, [] { return 0; },
          [&] (int, std::size_t s)
          {
            for (std::size_t i = s * STRETCH; i < std::min (positions.size (), (s + 1) * STRETCH); ++i)
              visit (places[s], i, digestOf (positions[i]));
          });
    };
    for_stretches ([this] (auto &counts, std::size_t, std::uint32_t bits) { ++counts[bits & (groups_ - 1)]; });
    firsts_.assign (1, 0);
    for (std::size_t group = 0, sum = 0; group < groups_; ++group)
    {
      for (std::vector<std::size_t> &counts : places)
      {
        const std::size_t count = counts[group];
        counts[group] = sum;
        sum += count;
      }
      firsts_.push_back (sum);
    }
    digests_.resize (positions.size ());
    for_stretches (
        [this] (auto &next, std::size_t i, std::uint32_t bits) {
          digests_[next[bits & (groups_ - 1)]++] = {bits, static_cast<int> (i)};
        });
  }

  std::size_t
  size () const
  {
    return groups_;
  }

  const Digest *
  begin (std::size_t group) const
  {
    return digests_.data () + firsts_[group];
  }

  const Digest *
  end (std::size_t group) const
  {
    return digests_.data () + firsts_[group + 1];
  }

private:
  std::size_t groups_ = 1;
  std::vector<std::size_t> firsts_;
  LargeVector<Digest> digests_;
};

/** \brief Finds the positions of a group that repeat an earlier one. */
class RepeatFinder
{
public:
  explicit RepeatFinder (const std::vector<Eigen::Vector3f> &positions) : positions_ (positions) {}

  void
  find (const Digest *first, const Digest *last, std::vector<int> &repeated)
  {
    std::size_t slots = 16;
    while (slots < 2 * static_cast<std::size_t> (last - first))
      slots *= 2;
    table_.assign (slots, {0, -1});
    for (const Digest *digest = first; digest != last; ++digest)
    {
      std::size_t slot = (digest->bits >> 12) & (slots - 1);
      while (table_[slot].place >= 0 && !isSame (table_[slot], *digest))
        slot = (slot + 1) & (slots - 1);
      if (table_[slot].place >= 0)
        repeated.push_back (digest->place);
      else
        table_[slot] = *digest;
    }
  }

private:
  bool
  isSame (const Digest &a, const Digest &b) const
  {
    return a.bits == b.bits &&
           positions_[static_cast<std::size_t> (a.place)] == positions_[static_cast<std::size_t> (b.place)];
  }

  const std::vector<Eigen::Vector3f> &positions_;
  std::vector<Digest> table_; // open addressing: a digest stands at the first free slot from its own on
};

} // namespace

std::vector<int>
findRepeated (const std::vector<Eigen::Vector3f> &positions, int threads)
{
  const DigestGroups groups (positions, threads);
  std::vector<std::vector<int>> parts (groups.size ());
  parallelFor (
      parts.size (), threads, [&] { return RepeatFinder (positions); },
      [&] (RepeatFinder &finder, std::size_t g) { finder.find (groups.begin (g), groups.end (g), parts[g]); });
  std::vector<int> repeated = joinParts (std::move (parts), threads);
  std::sort (repeated.begin (), repeated.end ());
  return repeated;
}

} // namespace erkpa
