// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Render_RandomMaps_h
#define banyan_Testing_Core_Render_RandomMaps_h

#include "Render/Scene/TabulateFunction.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace scenes
{

/// A function of the kinds that ParaView has, with what the test has to know of it.
struct Map
{
  banyan::FunctionOfValue Of;
  std::vector<double> Corners;
  bool Jumps = false;
};

class RandomMaps
{
public:
  explicit RandomMaps(unsigned seed)
    : Random(seed)
  {
  }

  double Unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(this->Random); }
  int Below(int n) { return static_cast<int>(this->Random() % static_cast<unsigned>(n)); }

  glm::dvec4 Entry()
  {
    const double opacity = this->Below(3) == 0 ? 0.0 : std::pow(10.0, -3.0 * this->Unit());
    return { this->Unit(), this->Unit(), this->Unit(), opacity };
  }

  /// Entries at nodes, linear between them (or in their logarithm), or steps that begin at nodes.
  Map Nodes(std::vector<double> at, bool steps, bool logarithmic)
  {
    std::sort(at.begin(), at.end());
    std::vector<glm::dvec4> entries;
    for (std::size_t i = 0; i < at.size(); ++i)
    {
      entries.push_back(this->Entry());
    }
    Map map;
    map.Corners = at;
    map.Jumps = steps;
    map.Of = [=](double value)
    {
      const auto above = std::upper_bound(at.begin(), at.end(), value);
      const auto i = static_cast<std::size_t>(above - at.begin());
      if (i == 0 || i == at.size() || steps)
      {
        return entries[i == 0 ? 0 : i - 1];
      }
      const double part = logarithmic ? std::log(value / at[i - 1]) / std::log(at[i] / at[i - 1])
                                      : (value - at[i - 1]) / (at[i] - at[i - 1]);
      return glm::mix(entries[i - 1], entries[i], part);
    };
    return map;
  }

  /// Colours of their own below and above the corners.
  Map Beyond(Map map)
  {
    const glm::dvec4 below = this->Entry();
    const glm::dvec4 above = this->Entry();
    const double low = *std::min_element(map.Corners.begin(), map.Corners.end());
    const double high = *std::max_element(map.Corners.begin(), map.Corners.end());
    const banyan::FunctionOfValue inside = map.Of;
    map.Of = [=](double value) {
      return value < low ? below : value > high ? above : inside(value);
    };
    map.Jumps = true;
    return map;
  }

  /// Whole numbers with an entry each, and one for all other values.
  Map Labels(int count, int gap)
  {
    std::vector<double> labels;
    double label = this->Below(2) * -1000.0;
    for (int i = 0; i < count; ++i)
    {
      labels.push_back(label);
      label += 1 + (gap > 1 ? this->Below(gap) : 0);
    }
    std::vector<glm::dvec4> entries;
    for (int i = 0; i <= count; ++i)
    {
      entries.push_back(this->Entry());
    }
    Map map;
    map.Corners = labels;
    map.Jumps = true;
    map.Of = [=](double value)
    {
      const auto at = std::lower_bound(labels.begin(), labels.end(), value);
      return at != labels.end() && *at == value
               ? entries[static_cast<std::size_t>(at - labels.begin())]
               : entries.back();
    };
    return map;
  }

  Map Any()
  {
    std::vector<double> at;
    const int nodes = 2 + this->Below(12);
    // Calls of Random stand apart: compilers differ in the order within an expression.
    const double off = this->Unit() - 0.5;
    const double low = off * std::pow(10.0, this->Below(9) - 2);
    const double width = std::pow(10.0, this->Below(8) - 3);
    const double decades = 1 + this->Below(12);
    const int kind = this->Below(6);
    for (int i = 0; i < nodes; ++i)
    {
      // Some are close to each other.
      const double part = this->Below(3) == 0 && i > 0 ? 1e-6 * this->Unit() : this->Unit();
      at.push_back(
        kind < 4 ? static_cast<float>(low + width * part) : std::pow(10.0, decades * (part - 0.5)));
    }
    switch (kind)
    {
      case 0:
        return this->Nodes(at, false, false);
      case 1:
        return this->Nodes(at, true, false);
      case 2:
        return this->Beyond(this->Nodes(at, this->Below(2) == 0, false));
      case 3:
      {
        const int gap = 1 + this->Below(1000);
        return this->Labels(1 + this->Below(60), gap);
      }
      case 4:
        return this->Nodes(at, false, true);
      default:
        return this->Beyond(this->Nodes(at, false, true));
    }
  }

  /// Values near and on the corners, between and beyond them.
  double ValueFor(const Map& map)
  {
    const auto count = static_cast<int>(map.Corners.size());
    const double corner = map.Corners[static_cast<std::size_t>(this->Below(count))];
    const double other = map.Corners[static_cast<std::size_t>(this->Below(count))];
    switch (this->Below(6))
    {
      case 0:
        return corner;
      case 1:
        return std::nextafter(static_cast<float>(corner), this->Below(2) == 0 ? -1e30f : 1e30f);
      case 2:
        return corner + (other - corner) * this->Unit();
      case 3:
        return corner * (1.0 + 1e-3 * (this->Unit() - 0.5));
      case 4:
        return std::round(corner + 3.0 * (this->Unit() - 0.5));
      default:
        return corner + (other - corner) * (3.0 * this->Unit() - 1.5);
    }
  }

private:
  std::mt19937 Random;
};

} // namespace scenes

#endif
