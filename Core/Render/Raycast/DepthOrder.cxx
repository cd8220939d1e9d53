// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/DepthOrder.h"

#include "Base/ThreadPool.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace banyan
{
namespace
{

/// Bodies that overlap by less than this part of the smaller one's size count as side by side:
/// far more than rounding, far less than a voxel.
constexpr double Touching = 1e-6;

/// Directions closer to each other than this have no normal.
constexpr double LeastSine = 1e-9;

struct Interval
{
  double Low;
  double High;
};

Interval Along(const glm::dvec3& direction, const PlacedBox& box)
{
  const double corner = glm::dot(direction, box.Corner);
  Interval interval{ corner, corner };
  for (const glm::dvec3& edge : box.Edges)
  {
    const double length = glm::dot(direction, edge);
    (length < 0.0 ? interval.Low : interval.High) += length;
  }
  return interval;
}

double SizeOf(const PlacedBox& box)
{
  double size = 0.0;
  for (const glm::dvec3& edge : box.Edges)
  {
    size += glm::length(edge);
  }
  return size;
}

/// The direction in which two boxes are farthest apart.
struct Gap
{
  double Width = -std::numeric_limits<double>::infinity(); ///< negative if they overlap
  glm::dvec3 Direction{ 0.0 };                             ///< unit, from the first to the second
  double FirstEnds = 0.0;                                  ///< along it
  double SecondBegins = 0.0;

  void Try(const PlacedBox& first, const PlacedBox& second, glm::dvec3 direction)
  {
    for (int side = 0; side < 2; ++side, direction = -direction)
    {
      const double ends = Along(direction, first).High;
      const double begins = Along(direction, second).Low;
      if (begins - ends > this->Width)
      {
        *this = { begins - ends, direction, ends, begins };
      }
    }
  }

  void TryNormal(
    const PlacedBox& first, const PlacedBox& second, const glm::dvec3& a, const glm::dvec3& b)
  {
    const glm::dvec3 normal = glm::cross(a, b);
    const double length = glm::length(normal);
    if (length > LeastSine * glm::length(a) * glm::length(b))
    {
      this->Try(first, second, normal / length);
    }
  }
};

/// A flat box has the normals of a thin one.
PlacedBox Thickened(const PlacedBox& box)
{
  PlacedBox thick = box;
  for (int i = 0; i < 3; ++i)
  {
    const glm::dvec3& a = box.Edges[(i + 1) % 3];
    const glm::dvec3& b = box.Edges[(i + 2) % 3];
    const glm::dvec3 normal = glm::cross(a, b);
    if (glm::dot(box.Edges[i], box.Edges[i]) == 0.0 && glm::dot(normal, normal) > 0.0)
    {
      thick.Edges[i] = glm::normalize(normal) * (LeastSine * SizeOf(box));
    }
  }
  return thick;
}

Gap WidestGap(const PlacedBox& flatFirst, const PlacedBox& flatSecond)
{
  // Convex bodies with flat faces are apart in the direction of a normal of a face, or of one that
  // is perpendicular to an edge of each.
  const PlacedBox first = Thickened(flatFirst);
  const PlacedBox second = Thickened(flatSecond);
  Gap gap;
  for (int i = 0; i < 3; ++i)
  {
    gap.TryNormal(first, second, first.Edges[i], first.Edges[(i + 1) % 3]);
    gap.TryNormal(first, second, second.Edges[i], second.Edges[(i + 1) % 3]);
    for (const glm::dvec3& edge : second.Edges)
    {
      gap.TryNormal(first, second, first.Edges[i], edge);
    }
  }
  return gap;
}

DepthRelation RelationAcross(const Gap& gap, const RayCamera& camera)
{
  if (camera.Parallel())
  {
    const double forward = glm::dot(gap.Direction, camera.ViewDirection());
    if (std::abs(forward) < LeastSine)
    {
      return DepthRelation::Apart;
    }
    return forward > 0.0 ? DepthRelation::FirstNearer : DepthRelation::SecondNearer;
  }
  const double eye = glm::dot(gap.Direction, camera.Eye());
  if (eye <= std::min(gap.FirstEnds, gap.SecondBegins))
  {
    return DepthRelation::FirstNearer;
  }
  return eye >= std::max(gap.FirstEnds, gap.SecondBegins) ? DepthRelation::SecondNearer
                                                          : DepthRelation::Apart;
}

/// How far the middle of a body is from the eye.
double DistanceOf(const PlacedBody& body, const RayCamera& camera)
{
  const PlacedBox& box = body.front();
  const glm::dvec3 middle = box.Corner + 0.5 * (box.Edges[0] + box.Edges[1] + box.Edges[2]);
  return camera.Parallel() ? glm::dot(middle, camera.ViewDirection())
                           : glm::distance(middle, camera.Eye());
}

/// Blends what pictures show at one pixel.
/// @param shown the pictures that show something there; is emptied
glm::vec4 BlendPixel(const std::vector<std::shared_ptr<const FloatImage>>& pictures,
  const DepthOrder& order, int x, int y, std::vector<int>& shown)
{
  glm::vec4 sum(0.0f);
  while (!shown.empty())
  {
    const auto isNearest = [&](int one)
    {
      return std::none_of(
        shown.begin(), shown.end(), [&](int other) { return order.Nearer(other, one); });
    };
    auto nearest = std::find_if(shown.begin(), shown.end(), isNearest);
    nearest = nearest == shown.end() ? shown.begin() : nearest;
    sum += (1.0f - sum.a) * pictures[static_cast<std::size_t>(*nearest)]->At(x, y);
    shown.erase(nearest);
  }
  return sum;
}

} // namespace

PlacedBox PlaceBox(const glm::dvec3& low, const glm::dvec3& high, const glm::dmat4& toWorld)
{
  PlacedBox box;
  box.Corner = glm::dvec3(toWorld * glm::dvec4(low, 1.0));
  for (int axis = 0; axis < 3; ++axis)
  {
    box.Edges[axis] = glm::dvec3(toWorld[axis]) * (high[axis] - low[axis]);
  }
  return box;
}

DepthRelation RelationInDepth(
  const PlacedBody& first, const PlacedBody& second, const RayCamera& camera)
{
  Gap widest;
  double size = std::numeric_limits<double>::infinity();
  for (const PlacedBox& one : first)
  {
    for (const PlacedBox& other : second)
    {
      const Gap gap = WidestGap(one, other);
      widest = gap.Width > widest.Width ? gap : widest;
      size = std::min({ size, SizeOf(one), SizeOf(other) });
    }
  }
  return widest.Width >= -Touching * size ? RelationAcross(widest, camera) : DepthRelation::Unknown;
}

DepthOrder::DepthOrder(const std::vector<PlacedBody>& bodies, const RayCamera& camera)
  : Count(bodies.size())
  , Before(bodies.size() * bodies.size(), 0)
{
  const int count = static_cast<int>(bodies.size());
  for (int i = 0; i < count; ++i)
  {
    for (int j = i + 1; j < count; ++j)
    {
      const PlacedBody& first = bodies[static_cast<std::size_t>(i)];
      const PlacedBody& second = bodies[static_cast<std::size_t>(j)];
      const DepthRelation relation = RelationInDepth(first, second, camera);
      bool nearer = relation == DepthRelation::FirstNearer;
      bool farther = relation == DepthRelation::SecondNearer;
      if (relation == DepthRelation::Unknown)
      {
        this->UnknownPairs.push_back({ i, j });
        nearer = DistanceOf(first, camera) < DistanceOf(second, camera);
        farther = !nearer;
      }
      this->Before[this->Place(i, j)] = nearer ? 1 : 0;
      this->Before[this->Place(j, i)] = farther ? 1 : 0;
    }
  }
}

std::vector<std::vector<int>> GroupsThatMix(const DepthOrder& order, const std::vector<bool>& mixes)
{
  const int count = static_cast<int>(mixes.size());
  std::vector<int> first(mixes.size()); // of each body's group
  std::iota(first.begin(), first.end(), 0);
  const auto at = [&](int body) -> int& { return first[static_cast<std::size_t>(body)]; };
  const auto mayMix = [&](int body) { return mixes[static_cast<std::size_t>(body)]; };
  const auto join = [&](int one, int other)
  {
    const auto [low, high] = std::minmax(at(one), at(other));
    std::replace(first.begin(), first.end(), int{ high }, int{ low });
  };
  for (const std::array<int, 2>& pair : order.Unknown())
  {
    if (mayMix(pair[0]) && mayMix(pair[1]))
    {
      join(pair[0], pair[1]);
    }
  }
  const auto isBetween = [&](int body, int one, int other)
  {
    return mayMix(body) && at(one) == at(other) && at(body) != at(one) &&
           order.Nearer(body, one) != order.Nearer(body, other);
  };
  // Each turn makes at least two groups one.
  for (bool grows = true; grows;)
  {
    grows = false;
    for (int i = 0; i < count * count * count; ++i)
    {
      const int body = i % count;
      const int one = i / count % count;
      if (isBetween(body, one, i / count / count))
      {
        join(one, body);
        grows = true;
      }
    }
  }
  std::vector<std::vector<int>> groups(mixes.size());
  for (int body = 0; body < count; ++body)
  {
    groups[static_cast<std::size_t>(at(body))].push_back(body);
  }
  groups.erase(std::remove_if(groups.begin(), groups.end(),
                 [](const std::vector<int>& group) { return group.empty(); }),
    groups.end());
  return groups;
}

FloatImage BlendInDepth(const std::vector<std::shared_ptr<const FloatImage>>& pictures,
  const DepthOrder& order, const PixelRect& rect)
{
  FloatImage blended;
  blended.Rect = rect;
  blended.Pixels.assign(static_cast<std::size_t>(rect.Count()), glm::vec4(0.0f));
  ThreadPool::Process().ParallelFor(rect.Size().y,
    [&](std::int64_t row)
    {
      const int y = rect.Lo.y + static_cast<int>(row);
      std::vector<int> shown;
      for (int x = rect.Lo.x; x < rect.Hi.x; ++x)
      {
        for (std::size_t i = 0; i < pictures.size(); ++i)
        {
          const PixelRect own = pictures[i] ? pictures[i]->Rect : PixelRect();
          if (x >= own.Lo.x && x < own.Hi.x && y >= own.Lo.y && y < own.Hi.y &&
              pictures[i]->At(x, y).a > 0.0f)
          {
            shown.push_back(static_cast<int>(i));
          }
        }
        if (!shown.empty())
        {
          blended.At(x, y) = BlendPixel(pictures, order, x, y, shown);
        }
      }
    });
  return blended;
}

} // namespace banyan
