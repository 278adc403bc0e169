// SPDX-License-Identifier: BSD-3-Clause
#include "face_tree.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace erkpa
{

namespace
{

/** \brief Who wins for every order of the values: trees that agree in all of them are the same. */
std::vector<int>
signatureOf (const FaceTree &tree)
{
  std::array<double, FaceTree::MAX_FACES> values{};
  std::iota (values.begin (), values.end (), 0.0);
  std::vector<int> winners;
  do
    winners.push_back (tree.winner (values.data ()));
  while (std::next_permutation (values.begin (), values.begin () + tree.faces));
  return winners;
}

void
addTrees (const FaceTree &begun, int step, std::vector<int> left, std::set<std::vector<int>> &known,
          std::vector<FaceTree> &trees)
{
  if (left.size () == 1)
  {
    if (known.insert (signatureOf (begun)).second)
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
        addTrees (tree, step + 1, rest, known, trees);
      }
}

std::vector<FaceTree>
makeTrees (int faces)
{
  std::vector<FaceTree> trees;
  std::vector<int> all (static_cast<std::size_t> (faces));
  std::iota (all.begin (), all.end (), 0);
  std::set<std::vector<int>> known;
  FaceTree tree;
  tree.faces = faces;
  addTrees (tree, 0, all, known, trees);
  return trees;
}

} // namespace

int
FaceTree::winner (const double *values) const
{
  std::array<int, MAX_FACES> best{};
  std::iota (best.begin (), best.end (), 0);
  int last = 0;
  for (int s = 0; s + 1 < faces; ++s)
  {
    const Step &step = steps[static_cast<std::size_t> (s)];
    int &mine = best[static_cast<std::size_t> (step.face)];
    const int other = best[static_cast<std::size_t> (step.other)];
    if ((values[other] > values[mine]) == step.larger)
      mine = other;
    last = step.face;
  }
  return best[static_cast<std::size_t> (last)];
}

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
