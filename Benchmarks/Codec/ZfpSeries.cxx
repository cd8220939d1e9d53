// SPDX-License-Identifier: BSD-3-Clause
#include "ZfpSeries.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>

namespace banyan::bench
{
namespace
{

constexpr int BrickSamplesPerAxis = 16;
constexpr int BlockSamplesPerAxis = 4;
/// Pieces of a line are as long as those of volumes are large.
constexpr int PieceSamplesOfLine = BrickSamplesPerAxis * BrickSamplesPerAxis * BrickSamplesPerAxis;

/// Calls `block(offset, size)` for each block of 4^3 of a brick, with the offset of its first value
/// in an array of the given strides and the number of its values per axis.
template <class Function>
void ForEachBlock(const glm::ivec3& size, std::ptrdiff_t sy, std::ptrdiff_t sz, Function&& block)
{
  constexpr int edge = BlockSamplesPerAxis;
  for (int z = 0; z < size.z; z += edge)
  {
    for (int y = 0; y < size.y; y += edge)
    {
      for (int x = 0; x < size.x; x += edge)
      {
        block(z * sz + y * sy + x, glm::min(size - glm::ivec3(x, y, z), glm::ivec3(edge)));
      }
    }
  }
}

bool IsWhole(const glm::ivec3& block)
{
  return block == glm::ivec3(BlockSamplesPerAxis);
}

void EncodeBrick(zfp_stream* zfp, const float* values, const glm::ivec3& size, std::ptrdiff_t sy,
  std::ptrdiff_t sz)
{
  ForEachBlock(size, sy, sz,
    [&](std::ptrdiff_t offset, const glm::ivec3& n)
    {
      IsWhole(n) ? zfp_encode_block_strided_float_3(zfp, values + offset, 1, sy, sz)
                 : zfp_encode_partial_block_strided_float_3(zfp, values + offset,
                     static_cast<std::size_t>(n.x), static_cast<std::size_t>(n.y),
                     static_cast<std::size_t>(n.z), 1, sy, sz);
    });
}

void DecodeBrickBlocks(
  zfp_stream* zfp, float* values, const glm::ivec3& size, std::ptrdiff_t sy, std::ptrdiff_t sz)
{
  ForEachBlock(size, sy, sz,
    [&](std::ptrdiff_t offset, const glm::ivec3& n)
    {
      IsWhole(n) ? zfp_decode_block_strided_float_3(zfp, values + offset, 1, sy, sz)
                 : zfp_decode_partial_block_strided_float_3(zfp, values + offset,
                     static_cast<std::size_t>(n.x), static_cast<std::size_t>(n.y),
                     static_cast<std::size_t>(n.z), 1, sy, sz);
    });
}

/// Blocks of 4 values: the code of zfp's one-dimensional fields.
void EncodeLine(zfp_stream* zfp, const float* values, int count)
{
  for (int x = 0; x < count; x += BlockSamplesPerAxis)
  {
    const int n = std::min(count - x, BlockSamplesPerAxis);
    n == BlockSamplesPerAxis
      ? zfp_encode_block_float_1(zfp, values + x)
      : zfp_encode_partial_block_strided_float_1(zfp, values + x, static_cast<std::size_t>(n), 1);
  }
}

void DecodeLine(zfp_stream* zfp, float* values, int count)
{
  for (int x = 0; x < count; x += BlockSamplesPerAxis)
  {
    const int n = std::min(count - x, BlockSamplesPerAxis);
    n == BlockSamplesPerAxis
      ? zfp_decode_block_float_1(zfp, values + x)
      : zfp_decode_partial_block_strided_float_1(zfp, values + x, static_cast<std::size_t>(n), 1);
  }
}

glm::ivec3 BrickSizeOf(const glm::ivec3& samples)
{
  return ZfpCoder::IsLine(samples) ? glm::ivec3(PieceSamplesOfLine, 1, 1)
                                   : glm::ivec3(BrickSamplesPerAxis);
}

} // namespace

std::uint64_t ZfpStep::Bytes() const
{
  std::uint64_t longest = 0;
  for (std::size_t i = 1; i < this->BitOffsets.size(); ++i)
  {
    longest = std::max(longest, this->BitOffsets[i] - this->BitOffsets[i - 1]);
  }
  const std::uint64_t bytesPerLength = longest < (1u << 16) ? 2 : 4;
  return (this->BitOffsets.back() + 7) / 8 + bytesPerLength * (this->BitOffsets.size() - 1);
}

ZfpCoder::ZfpCoder(const glm::ivec3& samples, double tolerance, bool exact)
  : Samples(samples)
  , BrickSize(BrickSizeOf(samples))
  , Bricks((samples + this->BrickSize - 1) / this->BrickSize)
  , Zfp(zfp_stream_open(nullptr))
{
  if (exact && tolerance > 0)
  {
    int exponent = 0;
    const double mantissa = std::frexp(tolerance, &exponent); // in [0.5, 1)
    exponent -= mantissa > 0.5 ? 0 : 1;
    const double powerOfTwo = std::ldexp(1.0, exponent); // not below the tolerance
    this->Factor = powerOfTwo / tolerance;
    tolerance = powerOfTwo;
  }
  zfp_stream_set_accuracy(this->Zfp, tolerance);
  const auto nx = static_cast<std::size_t>(samples.x);
  zfp_field* field =
    IsLine(samples) ? zfp_field_1d(nullptr, zfp_type_float, nx)
                    : zfp_field_3d(nullptr, zfp_type_float, nx, static_cast<std::size_t>(samples.y),
                        static_cast<std::size_t>(samples.z));
  const std::size_t bytes = zfp_stream_maximum_size(this->Zfp, field);
  zfp_field_free(field);
  this->Buffer.resize(bytes / sizeof(std::uint64_t) + 2);
  this->Stream = stream_open(this->Buffer.data(), this->Buffer.size() * sizeof(std::uint64_t));
  zfp_stream_set_bit_stream(this->Zfp, this->Stream);
}

ZfpCoder::~ZfpCoder()
{
  zfp_stream_close(this->Zfp);
  stream_close(this->Stream);
}

std::int64_t ZfpCoder::BrickCount() const
{
  return std::int64_t{ this->Bricks.x } * this->Bricks.y * this->Bricks.z;
}

Box ZfpCoder::BrickSamples(std::int64_t brick) const
{
  const auto x = static_cast<int>(brick % this->Bricks.x);
  const auto y = static_cast<int>(brick / this->Bricks.x % this->Bricks.y);
  const auto z = static_cast<int>(brick / this->Bricks.x / this->Bricks.y);
  const glm::ivec3 low = this->BrickSize * glm::ivec3(x, y, z);
  return { low, glm::min(low + this->BrickSize, this->Samples) };
}

void ZfpCoder::Scale(float* values, std::int64_t count) const
{
  if (this->Factor != 1.0)
  {
    const auto inverse = static_cast<float>(1.0 / this->Factor);
    std::transform(values, values + count, values, [=](float value) { return value * inverse; });
  }
}

ZfpStep ZfpCoder::Encode(const float* values)
{
  const std::ptrdiff_t sy = this->Samples.x;
  const std::ptrdiff_t sz = sy * this->Samples.y;
  if (this->Factor != 1.0)
  {
    const auto factor = static_cast<float>(this->Factor);
    this->Scaled.resize(static_cast<std::size_t>(sz) * this->Samples.z);
    std::transform(values, values + this->Scaled.size(), this->Scaled.begin(),
      [=](float value) { return value * factor; });
    values = this->Scaled.data();
  }
  ZfpStep step;
  stream_rewind(this->Stream);
  for (std::int64_t brick = 0; brick < this->BrickCount(); ++brick)
  {
    const Box box = this->BrickSamples(brick);
    step.BitOffsets.push_back(stream_wtell(this->Stream));
    const float* const first = values + box.Lo.x + box.Lo.y * sy + box.Lo.z * sz;
    IsLine(this->Samples) ? EncodeLine(this->Zfp, first, box.Size().x)
                          : EncodeBrick(this->Zfp, first, box.Size(), sy, sz);
  }
  step.BitOffsets.push_back(stream_wtell(this->Stream));
  stream_flush(this->Stream);
  const std::size_t words = stream_size(this->Stream) / sizeof(std::uint64_t) + 1;
  step.Words.assign(
    this->Buffer.begin(), this->Buffer.begin() + static_cast<std::ptrdiff_t>(words));
  return step;
}

bitstream* ZfpCoder::OpenStream(const std::vector<std::uint64_t>& words)
{
  // zfp's interface takes a buffer that may be written to; decoding only reads it.
  return stream_open(
    const_cast<std::uint64_t*>(words.data()), words.size() * sizeof(std::uint64_t));
}

void ZfpCoder::Decode(const ZfpStep& step, float* values)
{
  const std::ptrdiff_t sy = this->Samples.x;
  const std::ptrdiff_t sz = sy * this->Samples.y;
  bitstream* stream = this->OpenStream(step.Words);
  zfp_stream_set_bit_stream(this->Zfp, stream);
  for (std::int64_t brick = 0; brick < this->BrickCount(); ++brick)
  {
    const Box box = this->BrickSamples(brick);
    float* const first = values + box.Lo.x + box.Lo.y * sy + box.Lo.z * sz;
    IsLine(this->Samples) ? DecodeLine(this->Zfp, first, box.Size().x)
                          : DecodeBrickBlocks(this->Zfp, first, box.Size(), sy, sz);
  }
  zfp_stream_set_bit_stream(this->Zfp, this->Stream);
  stream_close(stream);
  this->Scale(values, sz * this->Samples.z);
}

void ZfpCoder::DecodeBrick(const ZfpStep& step, const Box& samples, float* values)
{
  const glm::ivec3 size = samples.Size();
  const glm::ivec3 brick = samples.Lo / BrickSamplesPerAxis;
  const auto index = (std::size_t(brick.z) * this->Bricks.y + brick.y) * this->Bricks.x + brick.x;
  bitstream* stream = this->OpenStream(step.Words);
  zfp_stream_set_bit_stream(this->Zfp, stream);
  stream_rseek(stream, step.BitOffsets[index]);
  DecodeBrickBlocks(this->Zfp, values, size, size.x, std::ptrdiff_t{ size.x } * size.y);
  zfp_stream_set_bit_stream(this->Zfp, this->Stream);
  stream_close(stream);
  this->Scale(values, samples.Count());
}

} // namespace banyan::bench
