// SPDX-License-Identifier: BSD-3-Clause
#include "CodecMethod.h"

#include "Base/Error.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/Prune.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace banyan::bench
{
namespace
{

using Dense = openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ>;

/// Float grids scaled to [0, 1]: background where values are near the minimum, constant nodes
/// fused, then written with OpenVDB's own means: half precision where it is exact enough, Blosc.
class OpenVdbSeries : public EncodedSeries
{
public:
  OpenVdbSeries(const RawSeries& series, double bound)
    : Shape(series)
    , Low(series.BoundRange().Low)
    , Width(std::max(series.BoundRange().Width(), 1e-300))
    , Domain(openvdb::Coord(0, 0, 0), openvdb::Coord(this->Shape.Samples.x - 1,
                                        this->Shape.Samples.y - 1, this->Shape.Samples.z - 1))
    , Scratch(this->Shape.VoxelsPerStep())
  {
    const double relative = bound / this->Width;
    const double largest = (series.FullRange().High - this->Low) / this->Width;
    // Half precision has 11 significant bits: it rounds by 2^-12 of the next power of two.
    const double halfRounding = std::exp2(std::ceil(std::log2(std::max(largest, 1e-6))) - 12);
    const bool half = halfRounding < relative;
    // A voxel can be fused twice: into its leaf's value and then with other leaves.
    const double tolerance = 0.5 * (half ? relative - halfRounding : relative);
    for (int step = 0; step < this->Shape.Steps; ++step)
    {
      this->Files.push_back(this->Write(series.Step(step), static_cast<float>(tolerance), half));
    }
  }

  std::uint64_t Bytes() const override
  {
    std::uint64_t bytes = 0;
    for (const std::string& file : this->Files)
    {
      bytes += file.size();
    }
    return bytes;
  }

  void DecodeStep(int step, float* values) override
  {
    std::istringstream stream(this->Files[static_cast<std::size_t>(step)], std::ios::binary);
    openvdb::io::Stream reader(stream, false);
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(reader.getGrids()->at(0));
    Dense dense(this->Domain, values);
    openvdb::tools::copyToDense(grid->tree(), dense, true);
    const auto low = static_cast<float>(this->Low);
    const auto width = static_cast<float>(this->Width);
    std::transform(values, values + this->Shape.VoxelsPerStep(), values,
      [=](float value) { return value * width + low; });
  }

private:
  std::string Write(const float* values, float tolerance, bool half)
  {
    const auto low = static_cast<float>(this->Low);
    const auto inverse = static_cast<float>(1 / this->Width);
    std::transform(values, values + this->Scratch.size(), this->Scratch.begin(),
      [=](float value) { return (value - low) * inverse; });
    const auto grid = openvdb::FloatGrid::create(0.0f);
    const Dense dense(this->Domain, this->Scratch.data());
    openvdb::tools::copyFromDense(dense, grid->tree(), tolerance, true);
    openvdb::tools::prune(grid->tree(), tolerance, false);
    grid->setSaveFloatAsHalf(half);
    std::ostringstream stream(std::ios::binary);
    openvdb::io::Stream writer(stream);
    writer.setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    writer.setGridStatsMetadataEnabled(false);
    writer.write(openvdb::GridCPtrVec{ grid });
    return stream.str();
  }

  SeriesShape Shape;
  double Low;
  double Width;
  openvdb::CoordBBox Domain;
  std::vector<float> Scratch;
  std::vector<std::string> Files;
};

class OpenVdbMethod : public CodecMethod
{
public:
  using CodecMethod::CodecMethod;

  std::unique_ptr<EncodedSeries> Encode(
    const RawSeries& series, const CodecSettings& settings) const override
  {
    const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
    return std::make_unique<OpenVdbSeries>(series, settings.ErrorBound);
  }
};

} // namespace

void AppendOpenVdbMethods(MethodList& methods)
{
  openvdb::initialize();
  methods.push_back(std::make_unique<OpenVdbMethod>("openvdb"));
}

} // namespace banyan::bench
