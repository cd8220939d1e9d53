// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Dice_h
#define banyan_Testing_Dice_h

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <random>

/// Random numbers and places, the same ones for each seed.
class Dice
{
public:
  explicit Dice(unsigned seed)
    : Engine(seed)
  {
  }
  double In(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(this->Engine);
  }
  /// From `low` to `high`, both included.
  int Whole(int low, int high)
  {
    return std::uniform_int_distribution<int>(low, high)(this->Engine);
  }
  glm::dvec3 Point(double size) { return { In(-size, size), In(-size, size), In(-size, size) }; }
  glm::dvec3 Direction()
  {
    const glm::dvec3 point = this->Point(1.0);
    const double length = glm::length(point);
    return length > 0.1 && length < 1.0 ? point / length : this->Direction();
  }

private:
  std::mt19937 Engine;
};

#endif
