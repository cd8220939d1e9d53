// SPDX-License-Identifier: BSD-3-Clause
#include "CodecMethod.h"

#include "Base/Error.h"

#include <nanovdb/util/GridBuilder.h>
#include <tbb/global_control.h>

#include <algorithm>

namespace banyan::bench
{
namespace
{

using Handle = nanovdb::GridHandle<nanovdb::HostBuffer>;

/// One grid per step, its leaves quantised with as many bits as the bound needs in each. The grid
/// in memory is the compressed form: any voxel can be read from it.
class NanoVdbSeries : public EncodedSeries
{
public:
  NanoVdbSeries(const RawSeries& series, double bound)
    : Shape(series)
    , Background(static_cast<float>(series.BoundRange().Low))
  {
    const glm::ivec3 n = this->Shape.Samples;
    const nanovdb::CoordBBox domain(
      nanovdb::Coord(0, 0, 0), nanovdb::Coord(n.x - 1, n.y - 1, n.z - 1));
    for (int step = 0; step < this->Shape.Steps; ++step)
    {
      const float* values = series.Step(step);
      // A grid without a single value beside the background cannot be quantised by NanoVDB.
      if (std::all_of(values, values + series.VoxelsPerStep(),
            [=](float value) { return value == this->Background; }))
      {
        this->Grids.emplace_back();
        continue;
      }
      nanovdb::GridBuilder<float, nanovdb::FpN> builder(this->Background);
      builder.setStats(nanovdb::StatsMode::Disable);
      builder.setChecksum(nanovdb::ChecksumMode::Disable);
      builder([=](const nanovdb::Coord& p)
        { return values[(std::ptrdiff_t{ p[2] } * n.y + p[1]) * n.x + p[0]]; },
        domain);
      this->Grids.push_back(builder.getHandle<nanovdb::AbsDiff>(
        1.0, nanovdb::Vec3d(0.0), "", nanovdb::AbsDiff(static_cast<float>(bound))));
    }
  }

  std::uint64_t Bytes() const override
  {
    std::uint64_t bytes = 0;
    for (const Handle& grid : this->Grids)
    {
      bytes += grid.size();
    }
    return bytes;
  }

  void DecodeStep(int step, float* values) override
  {
    this->Read(step, { glm::ivec3(0), this->Shape.Samples }, values);
  }

  bool DecodesBricks() const override { return true; }

  void DecodeBrick(int step, const Box& samples, float* values) override
  {
    this->Read(step, samples, values);
  }

private:
  /// Leaf by leaf, which is much quicker than asking for single voxels. Lo is a multiple of 8.
  void Read(int step, const Box& samples, float* values) const
  {
    constexpr int edge = 8;
    const glm::ivec3 n = samples.Size();
    const auto* grid = this->Grids[static_cast<std::size_t>(step)].grid<nanovdb::FpN>();
    if (grid == nullptr)
    {
      std::fill_n(values, samples.Count(), this->Background);
      return;
    }
    const auto accessor = grid->getAccessor();
    for (int z = 0; z < n.z; z += edge)
    {
      for (int y = 0; y < n.y; y += edge)
      {
        for (int x = 0; x < n.x; x += edge)
        {
          const glm::ivec3 low(x, y, z);
          const glm::ivec3 size = glm::min(n - low, glm::ivec3(edge));
          const glm::ivec3 p = samples.Lo + low;
          const nanovdb::Coord corner(p.x, p.y, p.z);
          float* target = values + (std::ptrdiff_t{ z } * n.y + y) * n.x + x;
          ReadLeaf(accessor, corner, size, target, n.x, std::ptrdiff_t{ n.x } * n.y);
        }
      }
    }
  }

  template <class Accessor>
  static void ReadLeaf(const Accessor& accessor, const nanovdb::Coord& corner,
    const glm::ivec3& size, float* target, std::ptrdiff_t sy, std::ptrdiff_t sz)
  {
    const auto* leaf = accessor.probeLeaf(corner);
    const float tile = leaf == nullptr ? accessor.getValue(corner) : 0.0f;
    for (int z = 0; z < size.z; ++z)
    {
      for (int y = 0; y < size.y; ++y)
      {
        float* row = target + z * sz + y * sy;
        for (int x = 0; x < size.x; ++x)
        {
          // In a leaf, z is fastest.
          row[x] = leaf == nullptr
                     ? tile
                     : leaf->getValue(static_cast<std::uint32_t>(x << 6 | y << 3 | z));
        }
      }
    }
  }

  SeriesShape Shape;
  float Background;
  std::vector<Handle> Grids; ///< an empty one stands for nothing but background
};

class NanoVdbMethod : public CodecMethod
{
public:
  using CodecMethod::CodecMethod;

  std::unique_ptr<EncodedSeries> Encode(
    const RawSeries& series, const CodecSettings& settings) const override
  {
    const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
    return std::make_unique<NanoVdbSeries>(series, settings.ErrorBound);
  }
};

} // namespace

void AppendNanoVdbMethods(MethodList& methods)
{
  methods.push_back(std::make_unique<NanoVdbMethod>("nanovdb-fpn"));
}

} // namespace banyan::bench
