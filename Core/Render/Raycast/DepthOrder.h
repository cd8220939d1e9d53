// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_DepthOrder_h
#define banyan_Render_Raycast_DepthOrder_h

#include "Render/Scene/FloatImage.h"
#include "Render/Scene/RayCamera.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <memory>
#include <vector>

namespace banyan
{

/// A box that may be turned, scaled and sheared: a corner and the three edges that meet there.
/// Edges may be 0.
struct PlacedBox
{
  glm::dvec3 Corner{ 0.0 };
  std::array<glm::dvec3, 3> Edges{};
};

/// @param toWorld affine
PlacedBox PlaceBox(const glm::dvec3& low, const glm::dvec3& high, const glm::dmat4& toWorld);

/// Something that lies in each of these boxes; at least one.
using PlacedBody = std::vector<PlacedBox>;

/// Which of two bodies hides the other one.
enum class DepthRelation
{
  Apart,       ///< no ray meets both
  FirstNearer, ///< on each ray that meets both
  SecondNearer,
  Unknown ///< no plane separates them
};

/// Exact for boxes: two of them lie on two sides of a plane, or have points in common. Boxes that
/// overlap by less than a millionth of the smaller one's size count as side by side.
/// @param camera in the space of the bodies
DepthRelation RelationInDepth(
  const PlacedBody& first, const PlacedBody& second, const RayCamera& camera);

/// Which of several bodies are before which, as a camera sees them.
class DepthOrder
{
public:
  DepthOrder(const std::vector<PlacedBody>& bodies, const RayCamera& camera);

  /// Whether a body is before another one. Where no plane separates them, the one whose middle is
  /// nearer is; where both are at one place, the later one.
  bool Nearer(int body, int other) const { return this->Before[this->Place(body, other)] != 0; }

  /// Whether some pair of bodies is not separated by a plane.
  bool SomeUnknown() const { return !this->UnknownPairs.empty(); }
  /// Pairs that are not.
  const std::vector<std::array<int, 2>>& Unknown() const { return this->UnknownPairs; }

private:
  std::size_t Place(int body, int other) const
  {
    return static_cast<std::size_t>(body) * this->Count + static_cast<std::size_t>(other);
  }

  std::size_t Count;
  std::vector<char> Before;
  std::vector<std::array<int, 2>> UnknownPairs;
};

/// Groups of bodies that are to be drawn as one, since they share space: the numbers of all bodies,
/// group by group, each in ascending order, and groups by their first ones. A body that is not
/// before all of a group, nor behind all of it, belongs to it.
/// @param mixes by body, whether it may be drawn as one with others
std::vector<std::vector<int>> GroupsThatMix(
  const DepthOrder& order, const std::vector<bool>& mixes);

/// Blends pictures of bodies over each other, at each pixel in the order of those that show there:
/// so that bodies of which each hides a part of the next one, in a circle, are right as well.
/// @param pictures premultiplied; one per body, null and empty ones are left out
/// @param rect of the result; holds all pictures
FloatImage BlendInDepth(const std::vector<std::shared_ptr<const FloatImage>>& pictures,
  const DepthOrder& order, const PixelRect& rect);

} // namespace banyan

#endif
