// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_CameraPath_h
#define banyan_Render_Scene_CameraPath_h

#include <glm/mat4x4.hpp>

#include <array>

namespace banyan
{

/// Where a moving camera will be: as its last two places say.
class CameraPath
{
public:
  /// Forgets all places.
  void Begin() { this->Count = 0; }
  /// The camera has moved.
  /// @param worldToEye rigid
  /// @param seconds by any clock, later than at the place before
  void Add(const glm::dmat4& worldToEye, double seconds);

  /// The place that follows if the last move repeats itself, as often as fits into a time: exact
  /// for a camera that turns about an axis, or goes along a line, at an even pace. The last place
  /// where there is none before, or the last move took more than a quarter of a second.
  /// @param seconds after the last place, at least 0; more than 16 moves count as 16
  glm::dmat4 After(double seconds) const;

private:
  struct Place
  {
    glm::dmat4 WorldToEye{ 1.0 };
    double Seconds = 0.0;
  };
  std::array<Place, 2> Last; ///< the newer one is the second
  int Count = 0;
};

} // namespace banyan

#endif
