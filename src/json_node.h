// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <boost/property_tree/ptree.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief What is wrong in the text, where, and what to do. */
struct NotReadable : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/** \brief A value of the text, and where it stands. */
class JsonNode
{
public:
  JsonNode (const boost::property_tree::ptree &tree, std::string where) : tree_ (tree), where_ (std::move (where)) {}

  [[noreturn]] void
  fail (const std::string &what) const
  {
    throw NotReadable (where_ + " " + what);
  }

  bool
  has (const char *name) const
  {
    return tree_.find (name) != tree_.not_found ();
  }

  JsonNode
  member (const char *name) const
  {
    const auto found = tree_.find (name);
    if (found == tree_.not_found ())
      fail (std::string ("has no \"") + name + "\": add it");
    return {found->second, where_ + ", \"" + name + "\","};
  }

  /** \brief The values of a list. */
  std::vector<JsonNode>
  list () const
  {
    std::vector<JsonNode> nodes;
    for (const auto &[name, child] : tree_)
    {
      if (!name.empty ())
        fail ("must be a list in [ ]");
      nodes.emplace_back (child, where_ + " " + std::to_string (nodes.size ()));
    }
    if (nodes.empty () && !tree_.data ().empty ())
      fail ("must be a list in [ ]");
    return nodes;
  }

  const std::string &
  word () const
  {
    return tree_.data ();
  }

  template <typename NumberT>
  NumberT
  number () const
  {
    const std::string &text = tree_.data ();
    NumberT number = 0;
    const auto [end, error] = std::from_chars (text.data (), text.data () + text.size (), number);
    if (error != std::errc () || end != text.data () + text.size () || !tree_.empty () ||
        !std::isfinite (static_cast<double> (number)))
      fail ("must be " + std::string (std::is_integral_v<NumberT> ? "a whole number" : "a number in range"));
    return number;
  }

  template <typename NumberT, std::size_t Count>
  std::array<NumberT, Count>
  numbers () const
  {
    const std::string what = "must be a list of " + std::to_string (Count) + " numbers";
    std::array<NumberT, Count> numbers;
    std::size_t i = 0;
    for (const auto &[name, child] : tree_)
    {
      if (!name.empty () || i == Count)
        fail (what);
      numbers[i++] = JsonNode (child, where_).number<NumberT> ();
    }
    if (i != Count)
      fail (what);
    return numbers;
  }

  Eigen::Vector3d
  vector () const
  {
    const auto v = numbers<double, 3> ();
    return {v[0], v[1], v[2]};
  }

  std::vector<Eigen::Vector3d>
  vectors () const
  {
    std::vector<Eigen::Vector3d> vectors;
    for (const JsonNode &node : list ())
      vectors.push_back (node.vector ());
    return vectors;
  }

  /** \brief Refuse members of other names. */
  void
  expectOnly (std::initializer_list<const char *> names) const
  {
    for (const auto &[name, child] : tree_)
      if (std::none_of (names.begin (), names.end (), [&, &known = name] (const char *n) { return known == n; }))
        fail ("has \"" + name + "\", which means nothing there: correct or remove it");
  }

private:
  const boost::property_tree::ptree &tree_;
  std::string where_;
};

} // namespace erkpa
