// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_SeriesBrickSource_h
#define banyan_Render_Bricks_SeriesBrickSource_h

#include "Cache/BackgroundDecoder.h"
#include "Cache/BrickCache.h"
#include "Render/Bricks/ArraySamples.h"
#include "Render/Bricks/BrickSource.h"
#include "Series/Decode/SeriesFile.h"

#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace banyan
{

/// Bricks of an encoded series, decoded through a cache when the ray caster asks for them and not
/// before. Macro voxels are served from their node and decode nothing. Points that the series hides
/// are NaN.
class SeriesBrickSource : public BrickSource
{
public:
  /// @param field step, array and level; its component is ignored in favour of `component`
  /// @param component to draw, or SampleArray::Magnitude or Colours of all components
  SeriesBrickSource(std::shared_ptr<const SeriesFile> series, const FieldKey& field, int component,
    BrickCache& cache);

  glm::ivec3 Bricks() const override { return this->Layout.Bricks(); }
  Box CellsOf(std::int64_t brick) const override { return this->Layout.CellsOf(brick); }
  ValueRange RangeOf(std::int64_t brick) const override;
  ValueMask MaskOf(std::int64_t brick) const override;
  /// Not known of magnitudes and colours.
  std::optional<UniformValue> UniformValueOf(std::int64_t brick) const override;
  MaskRange MasksAreOver() const override { return this->Masks; }
  /// Of the identities of what is decoded for it.
  std::optional<Hash128> ContentOf(std::int64_t brick) const override;
  bool HasColours() const override { return this->Component == SampleArray::Colours; }
  double StepOfValues() const override { return this->Step; }
  std::size_t LoadBytes(std::int64_t brick) const override;
  BrickView Load(std::int64_t brick) override;

  /// The same field at another step.
  /// @param level coarser than this one by so many
  std::unique_ptr<SeriesBrickSource> AtStep(int step, int level) const;
  /// FieldKey::Level
  int FieldLevel() const { return this->Field.Level; }

  /// What was loaded of this source and its levels so far, in the order in which it was.
  std::vector<FieldBricks> Loaded() const;
  /// What has to be decoded for bricks of this level.
  std::vector<FieldBricks> Fields(const std::vector<std::int64_t>& bricks) const;

protected:
  std::unique_ptr<BrickSource> MakeLevel(int level, const Box& domain) override;

private:
  /// Bricks by level, in the order in which they were first loaded.
  struct LoadRecord
  {
    struct Level
    {
      std::vector<std::int64_t> Bricks;
      std::vector<bool> Has; ///< by number
    };
    std::map<int, Level> Levels; ///< by FieldKey::Level
    std::mutex Mutex;
  };

  using NodeList = std::shared_ptr<const std::vector<BrickNode>>;

  void Note(std::int64_t brick) const;
  FieldKey KeyOf(std::size_t component) const;
  BrickView LoadComponent(std::int64_t brick, std::size_t component) const;
  BrickView LoadJoined(std::int64_t brick) const;
  bool HidesPointsOf(std::int64_t brick) const;
  BrickView WithoutHidden(std::int64_t brick, const BrickView& view) const;
  ValueRange JoinedRange(std::int64_t brick) const;

  std::shared_ptr<const SeriesFile> Series;
  FieldKey Field;
  int Component; ///< as it was asked for
  BrickCache& Cache;
  BrickLayout Layout;
  MaskRange Masks;
  ScalarType Type;
  bool IsJoined; ///< whether all components are drawn together
  double Step = 0.0;
  std::vector<int> Components; ///< the one drawn, or all of them
  std::vector<NodeList> Nodes; ///< one list per entry of Components
  FieldKey Flags;              ///< of points
  NodeList NodesOfFlags;       ///< null: no point is hidden
  std::shared_ptr<LoadRecord> LoadedBricks =
    std::make_shared<LoadRecord>(); ///< shared with the levels
};

} // namespace banyan

#endif
