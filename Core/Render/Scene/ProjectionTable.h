// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_ProjectionTable_h
#define banyan_Render_Scene_ProjectionTable_h

#include "Render/Scene/FloatImage.h"
#include "Render/Scene/RayScene.h"
#include "Series/Quantize/ValueRange.h"

namespace banyan
{

/// RayBlend, made ready for one scene that is not composited.
///
/// Until FinishPicture, a pixel holds what its ray has met, in such a way that nothing is 0, and
/// that parts of a picture combine by maximum or by sum (Combination), in any order:
/// - Maximum and Minimum: the rank of the best entry of the transfer function, from 1 up; a maximum
///   ranks high entries high, a minimum low ones. Ranks are whole numbers, so bricks, threads and
///   processes change no bit.
/// - Average: the sum of value times opacity; the whole samples; and what partial samples count
///   for. The sum is in float, so processes change about its last bit.
class ProjectionTable
{
public:
  /// @param steps of the same scene: how values find their entry
  /// Throws Error when the blend mode is not one, or its values are not usable.
  ProjectionTable(const RayScene& scene, const StepTable& steps);

  bool Averages() const { return this->Mode == BlendMode::Average; }

  /// The rank of an entry, 0 for the transparent one.
  float RankOf(int entry) const
  {
    const int last = static_cast<int>(this->Opacities.size()) - 1;
    const int rank = this->Mode == BlendMode::Minimum ? last - entry : entry + 1;
    return static_cast<float>(entry < last ? rank : 0);
  }

  /// The highest rank that values in a range may have; 0 when there are none or nothing is visible.
  /// Conservative. For averages 1 where a value may count.
  float HighestRank(const ValueRange& range) const;

  /// Whether all values of a range count for an average, and none of them is visible: then only
  /// their number is wanted.
  bool OnlyCounts(const ValueRange& range) const;

  /// What an average takes of values; `Relative` ones are those from which `Low` was subtracted.
  struct Scale
  {
    TableLookup Lookup;
    float Black = 0;
    float PerValue = 0;
    float LowestCounted = 0;
    float HighestCounted = 0;
  };
  const Scale& ScaleOf(bool relative) const { return relative ? this->Relative : this->Absolute; }

  /// Opacity per entry, and 0 for the transparent one.
  const float* OpacityOfEntries() const { return this->Opacities.data(); }
  int Transparent() const { return static_cast<int>(this->Opacities.size()) - 1; }

  bool Nearest() const { return this->NearestSamples; }
  double Low() const { return this->RelativeTo; }
  BlendMode Blend() const { return this->Mode; }

private:
  Scale MakeScale(const RayBlend& blend, const TableLookup& lookup, double relativeTo) const;

  BlendMode Mode;
  bool NearestSamples;
  bool NothingVisible = true;
  double RelativeTo;
  std::vector<float> Opacities;
  VisibleValues Visible;
  double LowestCounted;
  double HighestCounted;
  Scale Absolute;
  Scale Relative;
};

/// How pictures of parts of a volume become that of the whole.
enum class Combination
{
  Over,    ///< front over back: composited pixels, premultiplied
  Largest, ///< of each number, whatever the order
  Sum      ///< of each number, whatever the order
};
Combination CombinationOf(const RayBlend& blend);

/// Makes premultiplied colours of what the rays of all parts together have met; composited pixels
/// are that already.
void FinishPicture(const RayScene& scene, FloatImage& picture);

} // namespace banyan

#endif
