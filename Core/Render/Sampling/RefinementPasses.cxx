// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/RefinementPasses.h"

#include "Base/Hash.h"

#include <algorithm>
#include <vector>

namespace banyan
{
namespace
{

/// A number for all that decides a picture.
class SceneHash
{
public:
  /// @tparam T without padding
  template <class T>
  void Add(const T& value)
  {
    this->Sum = HashOf(&value, sizeof(T), this->Sum).Low;
  }
  template <class T>
  void Add(const std::vector<T>& values)
  {
    this->Add(values.size());
    this->Sum = HashOf(values.data(), values.size() * sizeof(T), this->Sum).Low;
  }

  std::uint64_t Get() const { return this->Sum; }

private:
  std::uint64_t Sum = 0;
};

std::uint64_t NumberOf(const RayScene& scene, std::uint64_t values)
{
  SceneHash hash;
  hash.Add(values);
  hash.Add(scene.Camera.ClipToWorldMatrix());
  hash.Add(scene.Camera.ImageSize());
  hash.Add(scene.Viewport);
  hash.Add(scene.IndexToWorld);
  hash.Add(scene.DomainCells);
  hash.Add(scene.Transfer.Low);
  hash.Add(scene.Transfer.High);
  hash.Add(scene.Transfer.UnitDistance);
  hash.Add(scene.Transfer.Entries);
  hash.Add(scene.Depth);
  hash.Add(scene.Shading.On);
  hash.Add(scene.Shading.Ambient);
  hash.Add(scene.Shading.Diffuse);
  hash.Add(scene.Shading.Specular);
  hash.Add(scene.Shading.SpecularPower);
  for (const ClipPlane& plane : scene.ClipPlanes)
  {
    hash.Add(plane.Normal);
    hash.Add(plane.Offset);
  }
  hash.Add(scene.Interpolation);
  hash.Add(scene.Blend.Mode);
  return hash.Get();
}

/// How much closer a pass is than the one before: it takes about twice as many samples.
constexpr double Step = 0.25;

} // namespace

bool RefinementPasses::SceneChanged(const RayScene& scene, std::uint64_t values)
{
  const std::uint64_t hash = NumberOf(scene, values);
  const bool changed = hash != this->Drawn;
  this->Drawn = hash;
  return changed;
}

double RefinementPasses::ToleranceOf(bool changed, const Wish& wish)
{
  this->Fresh = true;
  if (!wish.Passes)
  {
    this->IsLast = true;
    this->Reached = wish.Still;
    this->AfterInteraction = false;
    return wish.Still;
  }
  if (changed)
  {
    this->Reached = this->AfterInteraction ? wish.Interactive : wish.Still;
  }
  else if (this->Asked)
  {
    this->Reached *= Step;
  }
  this->Asked = false;
  this->AfterInteraction = false;
  this->Reached = std::max(this->Reached, wish.Still);
  this->IsLast = this->Reached <= wish.Still;
  return this->Reached;
}

bool RefinementPasses::Next()
{
  this->Asked = this->Fresh && !this->IsLast;
  this->Fresh = false;
  return this->Asked;
}

} // namespace banyan
