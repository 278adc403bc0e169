// SPDX-License-Identifier: BSD-3-Clause
#include "face_tree.h"

#include <algorithm>
#include <numeric>

namespace erkpa
{

namespace
{

int
followSteps (const FaceTree &tree, const std::array<int, FaceTree::MAX_FACES> &values)
{
  std::array<std::size_t, FaceTree::MAX_FACES> best{0, 1, 2, 3};
  std::size_t last = 0;
  for (std::size_t s = 0; s + 1 < static_cast<std::size_t> (tree.faces); ++s)
  {
    const FaceTree::Step &step = tree.steps[s];
    last = static_cast<std::size_t> (step.face);
    const std::size_t other = best[static_cast<std::size_t> (step.other)];
    if ((values[other] > values[best[last]]) == step.larger)
      best[last] = other;
  }
  return static_cast<int> (best[last]);
}

/** \brief Who wins for every order of the values: trees that agree in all of them are the same. */
void
findWinners (FaceTree &tree)
{
  std::array<int, FaceTree::MAX_FACES> values{0, 1, 2, 3};
  std::size_t order = 0;
  do
    tree.winners[order++] = static_cast<std::uint8_t> (followSteps (tree, values));
  while (std::next_permutation (values.begin (), values.begin () + tree.faces));
}

void
addTrees (FaceTree begun, int step, const std::vector<int> &left, std::vector<FaceTree> &trees)
{
  if (left.size () == 1)
  {
    findWinners (begun);
    const auto is_same = [&begun] (const FaceTree &tree) { return tree.winners == begun.winners; };
    if (std::none_of (trees.begin (), trees.end (), is_same))
      trees.push_back (begun);
    return;
  }
  for (std::size_t i = 0; i < left.size (); ++i)
    for (std::size_t j = i + 1; j < left.size (); ++j)
      for (const bool larger : {true, false})
      {
        FaceTree tree = begun;
        tree.steps[static_cast<std::size_t> (step)] = {left[i], left[j], larger};
        std::vector<int> rest = left;
        rest.erase (rest.begin () + static_cast<std::ptrdiff_t> (j));
        addTrees (tree, step + 1, rest, trees);
      }
}

std::vector<FaceTree>
makeTrees (int faces)
{
  std::vector<FaceTree> trees;
  std::vector<int> all (static_cast<std::size_t> (faces));
  std::iota (all.begin (), all.end (), 0);
  FaceTree tree;
  tree.faces = faces;
  addTrees (tree, 0, all, trees);
  return trees;
}

} // namespace

bool
FaceTree::takesLarger (int face, int other) const
{
  std::array<unsigned, MAX_FACES> taken{1, 2, 4, 8};
  const unsigned both = 1u << face | 1u << other;
  for (int s = 0; s + 1 < faces; ++s)
  {
    const Step &step = steps[static_cast<std::size_t> (s)];
    unsigned &mine = taken[static_cast<std::size_t> (step.face)];
    mine |= taken[static_cast<std::size_t> (step.other)];
    if ((mine & both) == both)
      return step.larger;
  }
  return true;
}

const std::vector<FaceTree> &
treesOf (int faces)
{
  static const std::array<std::vector<FaceTree>, FaceTree::MAX_FACES + 1> trees{
      std::vector<FaceTree> (), makeTrees (1), makeTrees (2), makeTrees (3), makeTrees (4)};
  return trees[static_cast<std::size_t> (faces)];
}

} // namespace erkpa
