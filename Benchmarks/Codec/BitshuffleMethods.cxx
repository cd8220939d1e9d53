// SPDX-License-Identifier: BSD-3-Clause
#include "UniformCodes.h"

#include "Base/Error.h"

#include <blosc.h>

namespace banyan::bench
{
namespace
{

/// Uniform codes, their bits transposed by Blosc and packed with zstd; one chunk per step.
class BitshuffleSeries : public EncodedSeries
{
public:
  BitshuffleSeries(const RawSeries& series, const CodecSettings& settings)
    : Shape(series)
    , Codes(series.BoundRange(), settings.BitsOfAccuracy)
  {
    constexpr int level = 5; // Blosc's default
    constexpr int blockBytesAutomatic = 0;
    constexpr int threads = 1;
    std::vector<std::uint8_t> buffer;
    for (int step = 0; step < this->Shape.Steps; ++step)
    {
      this->Codes.QuantizeToBytes(series.Step(step), this->Shape.VoxelsPerStep(), this->Scratch);
      buffer.resize(this->Scratch.size() + BLOSC_MAX_OVERHEAD);
      const int bytes = blosc_compress_ctx(level, BLOSC_BITSHUFFLE,
        static_cast<std::size_t>(this->Codes.BytesPerCode()), this->Scratch.size(),
        this->Scratch.data(), buffer.data(), buffer.size(), BLOSC_ZSTD_COMPNAME,
        blockBytesAutomatic, threads);
      if (bytes <= 0)
      {
        throw Error("Blosc could not compress a step; was it built with zstd?");
      }
      this->Chunks.emplace_back(buffer.begin(), buffer.begin() + bytes);
    }
  }

  std::uint64_t Bytes() const override
  {
    std::uint64_t bytes = 0;
    for (const auto& chunk : this->Chunks)
    {
      bytes += chunk.size();
    }
    return bytes;
  }

  void DecodeStep(int step, float* values) override
  {
    constexpr int threads = 1;
    const int bytes = blosc_decompress_ctx(this->Chunks[static_cast<std::size_t>(step)].data(),
      this->Scratch.data(), this->Scratch.size(), threads);
    if (bytes != static_cast<int>(this->Scratch.size()))
    {
      throw Error("Blosc could not decompress a step.");
    }
    this->Codes.RestoreFromBytes(this->Scratch, values);
  }

private:
  SeriesShape Shape;
  UniformCodes Codes;
  std::vector<std::vector<std::uint8_t>> Chunks;
  std::vector<std::uint8_t> Scratch;
};

class BitshuffleMethod : public CodecMethod
{
public:
  using CodecMethod::CodecMethod;

  std::unique_ptr<EncodedSeries> Encode(
    const RawSeries& series, const CodecSettings& settings) const override
  {
    return std::make_unique<BitshuffleSeries>(series, settings);
  }
};

} // namespace

void AppendBitshuffleMethods(MethodList& methods)
{
  methods.push_back(std::make_unique<BitshuffleMethod>("bitshuffle-8bit"));
}

} // namespace banyan::bench
