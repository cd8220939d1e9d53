// SPDX-License-Identifier: BSD-3-Clause
#include "UniformCodes.h"

#include "Papers/PaperOctree.h"

namespace banyan::bench
{
namespace
{

/// The study's own method: uniform codes in an octree, fused, and merged with the step before.
class PaperSeries : public EncodedSeries
{
public:
  PaperSeries(const RawSeries& series, const CodecSettings& settings)
    : Shape(series)
    , Bits(settings.BitsOfAccuracy)
    , Codes(series.BoundRange(), settings.BitsOfAccuracy)
    , Present(this->Shape.VoxelsPerStep())
  {
    std::vector<std::uint16_t> previous(this->Present.size());
    for (int step = 0; step < this->Shape.Steps; ++step)
    {
      this->Codes.Quantize(series.Step(step), this->Present.size(), this->Present.data());
      this->Streams.push_back(EncodePaperOctree(this->Present.data(),
        step == 0 ? nullptr : previous.data(), this->Shape.Samples, this->Bits)
                                .Stream);
      this->Present.swap(previous);
    }
  }

  std::uint64_t Bytes() const override
  {
    std::uint64_t bytes = 0;
    for (const banyan::Bytes& stream : this->Streams)
    {
      bytes += stream.size();
    }
    return bytes;
  }

  /// In place: merged subtrees stay what they are.
  void DecodeStep(int step, float* values) override
  {
    std::uint16_t* codes = this->Present.data();
    DecodePaperOctree(this->Streams[static_cast<std::size_t>(step)], step == 0 ? nullptr : codes,
      this->Shape.Samples, this->Bits, codes);
    this->Codes.Restore(codes, this->Present.size(), values);
  }

private:
  SeriesShape Shape;
  int Bits;
  UniformCodes Codes;
  std::vector<std::uint16_t> Present;
  std::vector<banyan::Bytes> Streams;
};

class PaperMethod : public CodecMethod
{
public:
  using CodecMethod::CodecMethod;

  std::unique_ptr<EncodedSeries> Encode(
    const RawSeries& series, const CodecSettings& settings) const override
  {
    return std::make_unique<PaperSeries>(series, settings);
  }
};

} // namespace

void AppendPaperMethods(MethodList& methods)
{
  methods.push_back(std::make_unique<PaperMethod>("paper"));
}

} // namespace banyan::bench
