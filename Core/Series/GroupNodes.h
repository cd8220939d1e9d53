#ifndef banyan_Series_GroupNodes_h
#define banyan_Series_GroupNodes_h

#include "Codec/BlockEncoder.h"
#include "Series/Exceptions.h"
#include "Series/FieldGroupEncoder.h"

#include <algorithm>
#include <vector>

namespace banyan
{

/// Samples of a brick as the planes of the codec hold them: every `Stride`-th of a plane, axes in
/// the codec's order.
struct PlaneRegion
{
  int Plane = 0;
  int Stride = 1;
  glm::ivec3 Low{ 0 };   ///< in samples of the plane
  glm::ivec3 Count{ 1 }; ///< samples taken
  glm::ivec3 Last{ 0 };  ///< the plane's last sample, which stands for what would lie beyond it
  /// The blocks that hold them, half-open.
  glm::ivec3 FirstBlock{ 0 }, EndBlock{ 1 };

  /// @param box samples of a brick of a level, as BrickLayout has them, axes as the data has them
  /// @param samples of the plane, axes in the codec's order
  PlaneRegion(int level, const Box& box, const std::array<std::uint8_t, 3>& axes,
    const glm::ivec3& samples, int edge);

  /// Sample of the plane that is taken at a place of the region, along an axis.
  int SampleAt(int axis, int place) const
  {
    return std::min(this->Low[axis] + place * this->Stride, this->Last[axis]);
  }
};

/// Replaces samples of a region by what its exceptions say.
/// @param block position of the block that the list belongs to
/// @param values `[z][y][x]` of the region
template <class T>
void PlaceExceptions(const PlaneRegion& region, int edge, const glm::ivec3& block, const ExceptionList<T>& list, T* values);

/// Fills the nodes of all steps and levels.
/// @param decoded per step: all planes
template <class T>
void MakeNodes(const FieldGroup& field, const group::FieldHead& head,
  const std::vector<const std::vector<PlaneNumbers>*>& decoded, std::vector<EncodedStep>& steps,
  ThreadPool& pool);

} // namespace banyan

#endif
