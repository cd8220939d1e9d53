// SPDX-License-Identifier: BSD-3-Clause
#include "UniformCodes.h"

#include "Base/Error.h"

#include <zstd.h>

namespace banyan::bench
{
namespace
{

/// One zstd frame of uniform codes per step, x fastest.
class ZstdSeries : public EncodedSeries
{
public:
  ZstdSeries(const RawSeries& series, const CodecSettings& settings, int level)
    : Shape(series)
    , Codes(series.BoundRange(), settings.BitsOfAccuracy)
    , Context(ZSTD_createDCtx(), ZSTD_freeDCtx)
  {
    const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(
      ZSTD_createCCtx(), ZSTD_freeCCtx);
    std::vector<std::uint8_t> buffer;
    for (int step = 0; step < this->Shape.Steps; ++step)
    {
      this->Codes.QuantizeToBytes(series.Step(step), this->Shape.VoxelsPerStep(), this->Scratch);
      buffer.resize(ZSTD_compressBound(this->Scratch.size()));
      const std::size_t bytes = ZSTD_compressCCtx(context.get(), buffer.data(), buffer.size(),
        this->Scratch.data(), this->Scratch.size(), level);
      if (ZSTD_isError(bytes))
      {
        throw Error(std::string("zstd could not compress: ") + ZSTD_getErrorName(bytes));
      }
      this->Frames.emplace_back(
        buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(bytes));
    }
  }

  std::uint64_t Bytes() const override
  {
    std::uint64_t bytes = 0;
    for (const auto& frame : this->Frames)
    {
      bytes += frame.size();
    }
    return bytes;
  }

  void DecodeStep(int step, float* values) override
  {
    const auto& frame = this->Frames[static_cast<std::size_t>(step)];
    const std::size_t bytes = ZSTD_decompressDCtx(
      this->Context.get(), this->Scratch.data(), this->Scratch.size(), frame.data(), frame.size());
    if (bytes != this->Scratch.size())
    {
      throw Error("zstd could not decompress a step.");
    }
    this->Codes.RestoreFromBytes(this->Scratch, values);
  }

private:
  SeriesShape Shape;
  UniformCodes Codes;
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> Context;
  std::vector<std::vector<std::uint8_t>> Frames;
  std::vector<std::uint8_t> Scratch;
};

class ZstdMethod : public CodecMethod
{
public:
  ZstdMethod(const std::string& name, int level)
    : CodecMethod(name)
    , Level(level)
  {
  }

  std::unique_ptr<EncodedSeries> Encode(
    const RawSeries& series, const CodecSettings& settings) const override
  {
    return std::make_unique<ZstdSeries>(series, settings, this->Level);
  }

private:
  int Level;
};

} // namespace

void AppendZstdMethods(MethodList& methods)
{
  methods.push_back(std::make_unique<ZstdMethod>("zstd-8bit", 3));
  methods.push_back(std::make_unique<ZstdMethod>("zstd-8bit-19", 19));
}

} // namespace banyan::bench
