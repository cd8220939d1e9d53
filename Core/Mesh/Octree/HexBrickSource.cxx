// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/HexBrickSource.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

HexBrickSource::HexBrickSource(
  std::shared_ptr<const HexBricks> bricks, const NodeArray& values, ThreadPool& pool)
  // The octree belongs to the bricks, which stay.
  : HexBrickSource(bricks,
      NodalField(std::shared_ptr<const ElementOctree>(bricks, &bricks->Tree()), values, pool), pool)
{
}

HexBrickSource::HexBrickSource(
  std::shared_ptr<const HexBricks> bricks, NodalField values, ThreadPool& pool)
  : Cut(std::move(bricks))
  , Values(std::move(values))
  , Summary(HexBrickSummary::Of(*this->Cut, this->Values, pool))
{
}

HexBrickSource::HexBrickSource(
  std::shared_ptr<const HexBricks> bricks, NodalField values, HexBrickSummary summary)
  : Cut(std::move(bricks))
  , Values(std::move(values))
  , Summary(std::move(summary))
{
}

std::unique_ptr<BrickSource> HexBrickSource::MakeLevel(int level, const Box&)
{
  ThreadPool& pool = ThreadPool::Process();
  const HexBricks::Level& coarser = this->Cut->AtLevel(level, pool);
  const std::shared_ptr<const HexBricks>& bricks = coarser.Bricks;
  NodalField values(std::shared_ptr<const ElementOctree>(bricks, &bricks->Tree()), this->Values,
    coarser.NodeOfPoint);
  this->BytesOfLevels += values.Bytes();
  return std::unique_ptr<BrickSource>(new HexBrickSource(bricks, std::move(values), pool));
}

glm::ivec3 HexBrickSource::Bricks() const
{
  return { static_cast<int>(this->Cut->List().size()), 1, 1 };
}

std::optional<UniformValue> HexBrickSource::UniformValueOf(std::int64_t brick) const
{
  const ValueRange& range = this->Summary.Ranges[Index(brick)];
  if (range.Empty() || range.Low != range.High || this->Summary.Special[Index(brick)] != 0)
  {
    return std::nullopt;
  }
  return UniformValue{ range.Low, this->Values.Type() };
}

std::size_t HexBrickSource::LoadBytes(std::int64_t brick) const
{
  const Box cells = this->CellsOf(brick);
  return static_cast<std::size_t>(Box{ cells.Lo, cells.Hi + 1 }.Count()) *
         SizeOf(this->Values.Type());
}

BrickView HexBrickSource::Load(std::int64_t brick)
{
  const Box cells = this->CellsOf(brick);
  return this->Sampled(this->Brick(brick), { cells.Lo, cells.Hi + 1 });
}

BrickView HexBrickSource::LoadAround(std::int64_t brick, Box& samples)
{
  const Box cells = this->CellsOf(brick);
  samples = { cells.Lo - 1, cells.Hi + 2 };
  return this->Sampled(this->Brick(brick), samples);
}

BrickView HexBrickSource::Sampled(const HexBrick& brick, const Box& samples) const
{
  const auto bytes = std::make_shared<std::vector<double>>(
    (static_cast<std::size_t>(samples.Count()) * SizeOf(this->Values.Type()) + sizeof(double) - 1) /
    sizeof(double));
  const auto fill = [&](auto* out)
  {
    this->FillAround(brick, samples, out);
    this->Values.ForCorners(brick.FirstLeaf, brick.EndLeaf,
      [&](std::int64_t leaf, const double(&corners)[8])
      { this->FillLeaf(brick, leaf, corners, samples, out); });
  };
  if (this->Values.Type() == ScalarType::Float32)
  {
    fill(reinterpret_cast<float*>(bytes->data()));
  }
  else
  {
    fill(bytes->data());
  }
  BrickView view;
  view.Values = bytes->data();
  view.Type = this->Values.Type();
  view.Stride[1] = samples.Size().x;
  view.Stride[2] = std::ptrdiff_t{ samples.Size().x } * samples.Size().y;
  view.Owner = std::shared_ptr<const void>(bytes, bytes->data());
  return view;
}

/// The samples that an element of the brick touches.
template <class Out>
void HexBrickSource::FillLeaf(const HexBrick& brick, std::int64_t leaf, const double (&corners)[8],
  const Box& samples, Out* out) const
{
  const ElementOctree& tree = this->Values.Tree();
  const int edge = 1 << (tree.LevelOfLeaf(leaf) - brick.Level);
  const glm::ivec3 first = tree.CornerOfLeaf(leaf) / (1 << brick.Level) - samples.Lo;
  const glm::ivec3 size = samples.Size();
  for (int z = 0; z <= edge; ++z)
  {
    for (int y = 0; y <= edge; ++y)
    {
      Out* const row =
        out + (static_cast<std::ptrdiff_t>(first.z + z) * size.y + first.y + y) * size.x + first.x;
      for (int x = 0; x <= edge; ++x)
      {
        row[x] = static_cast<Out>(
          edge == 1 ? corners[x + 2 * y + 4 * z]
                    : NodalField::Interpolate(corners, glm::dvec3(x, y, z) / double(edge)));
      }
    }
  }
}

/// The samples outside of the brick; NaN where there is no element.
template <class Out>
void HexBrickSource::FillAround(const HexBrick& brick, const Box& samples, Out* out) const
{
  const Box own{ brick.Cells.Lo, brick.Cells.Hi + 1 };
  if (own == samples)
  {
    return;
  }
  for (int z = samples.Lo.z; z < samples.Hi.z; ++z)
  {
    for (int y = samples.Lo.y; y < samples.Hi.y; ++y)
    {
      for (int x = samples.Lo.x; x < samples.Hi.x; ++x, ++out)
      {
        const glm::ivec3 at(x, y, z);
        if (!own.Contains(at))
        {
          *out = static_cast<Out>(this->Values.AtPoint(at * (1 << brick.Level)));
        }
      }
    }
  }
}

} // namespace banyan
