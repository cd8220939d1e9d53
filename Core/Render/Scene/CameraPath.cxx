// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/CameraPath.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace banyan
{

void CameraPath::Add(const glm::dmat4& worldToEye, double seconds)
{
  this->Last = { this->Last[1], { worldToEye, seconds } };
  this->Count = std::min(this->Count + 1, 2);
}

glm::dmat4 CameraPath::After(double seconds) const
{
  constexpr double rest = 0.25; // seconds
  constexpr double most = 16.0; // moves
  const auto& [before, now] = this->Last;
  const double step = now.Seconds - before.Seconds;
  if (this->Count < 2 || !(step > 0.0) || step > rest)
  {
    return now.WorldToEye;
  }
  const glm::dmat4 move = glm::inverse(before.WorldToEye) * now.WorldToEye;
  glm::dmat4 then = now.WorldToEye;
  for (int moves = static_cast<int>(std::lround(std::min(seconds / step, most))); moves > 0;
       --moves)
  {
    then *= move;
  }
  return then;
}

} // namespace banyan
