// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_CodecMethod_h
#define banyan_Benchmarks_CodecMethod_h

#include "RawSeries.h"

#include "Base/Box.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace banyan::bench
{

struct CodecSettings
{
  int BitsOfAccuracy = 8;
  double ErrorBound = 0;  ///< absolute; BoundRange().Width() / 2^(BitsOfAccuracy + 1)
  std::string WorkFolder; ///< an empty folder of this encoding's own, for methods that need files
};

/// What an encoded series keeps of a series' shape.
struct SeriesShape
{
  glm::ivec3 Samples{ 0 };
  int Steps = 0;

  explicit SeriesShape(const RawSeries& series)
    : Samples(series.Samples())
    , Steps(series.Steps())
  {
  }
  std::size_t VoxelsPerStep() const
  {
    return std::size_t(this->Samples.x) * this->Samples.y * this->Samples.z;
  }
};

/// What a decoder still has of earlier calls when a brick is asked for. Files and tables are at
/// hand anyway.
enum class Decoded
{
  Nothing,
  CoarserPlanes, ///< those that the finest one is predicted from
  All            ///< what fits into its cache
};

/// The outcome of one encoding: in memory, or as files in the work folder.
class EncodedSeries
{
public:
  virtual ~EncodedSeries() = default;

  /// Everything that is needed to decode, in bytes: data, tables, index and headers.
  virtual std::uint64_t Bytes() const = 0;

  /// Brings decoding back to its cold start; called before each pass over all steps.
  virtual void Forget() {}

  /// Steps are asked for in order, starting at 0 after `Forget()`.
  /// @param values receives `[z][y][x]`, x fastest
  virtual void DecodeStep(int step, float* values) = 0;

  /// Whether `DecodeBrick` works without decoding a whole step.
  virtual bool DecodesBricks() const { return false; }

  /// Whether calls leave something behind that later ones need not decode.
  virtual bool KeepsDecoded() const { return false; }

  /// Drops all else that calls left behind.
  virtual void Keep(Decoded) {}

  /// Decodes an aligned brick of at most 16^3 samples by itself, in any order.
  /// @param samples Lo is a multiple of 16; cut at the end of the grid
  /// @param values receives samples.Count() values `[z][y][x]`, x fastest
  virtual void DecodeBrick(int step, const Box& samples, float* values);
};

/// One way to encode a series: ours with some settings, or a peer. Everything works on the calling
/// thread alone.
class CodecMethod
{
public:
  explicit CodecMethod(const std::string& name)
    : MethodName(name)
  {
  }
  virtual ~CodecMethod() = default;

  /// As in the CSV. Ours begin with "banyan" and have to keep the error bound.
  const std::string& Name() const { return this->MethodName; }
  /// Measured only where it is asked for.
  bool ByNameOnly() const { return this->MethodName.rfind("banyan-without-", 0) == 0; }
  bool Ours() const { return this->MethodName.rfind("banyan", 0) == 0; }

  /// Chooses what depends on series and bound; called before `Encode`, and its time is not counted.
  virtual void Prepare(const RawSeries&, const CodecSettings&) {}

  virtual std::unique_ptr<EncodedSeries> Encode(
    const RawSeries& series, const CodecSettings& settings) const = 0;

private:
  std::string MethodName;
};

using MethodList = std::vector<std::unique_ptr<CodecMethod>>;

/// All methods that this program was built with, ours first.
/// @param missing receives the names of the peers that were not installed when it was configured
MethodList AllMethods(std::vector<std::string>& missing);

/// One of these per file `*Methods.cxx`; each appends its methods.
void AppendBanyanMethods(MethodList& methods);
void AppendPaperMethods(MethodList& methods);
void AppendZstdMethods(MethodList& methods);
void AppendZfpMethods(MethodList& methods);
void AppendBitshuffleMethods(MethodList& methods);
void AppendOpenVdbMethods(MethodList& methods);
void AppendNanoVdbMethods(MethodList& methods);

} // namespace banyan::bench

#endif
