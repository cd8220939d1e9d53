// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_VerifyTesting_h
#define banyan_Testing_VerifyTesting_h

#include "Base/Error.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Format/IndexText.h"
#include "Series/SeriesTesting.h"
#include "Verification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace banyan::testing
{

/// Steps of `Encoded`.
constexpr int StepCount = 5;

/// Steps that are in memory.
class MemorySource : public SourceSteps
{
public:
  struct Step
  {
    SourceStep Description;
    std::vector<std::vector<std::uint8_t>> Values;
  };
  std::vector<Step> Steps;

  bool Next(SourceStep& step) override
  {
    if (this->Position == this->Steps.size())
    {
      return false;
    }
    step = this->Steps[this->Position++].Description;
    return true;
  }

  void ReadValues(std::size_t array, std::vector<std::uint8_t>& values) override
  {
    values = this->Steps[this->Position - 1].Values[array];
  }

private:
  std::size_t Position = 0;
};

template <class T>
std::vector<std::uint8_t> BytesFrom(const std::vector<T>& values)
{
  std::vector<std::uint8_t> bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// A grid that is nothing's default.
inline Grid OddGrid()
{
  Grid grid;
  grid.Extent = { { -3, 5, 0 }, { 17, 20, 9 } };
  grid.Origin = { 1.5, -2, 0 };
  grid.Spacing = { 0.1, 0.2, 3 };
  return grid;
}

/// An encoded series with NaN in it, and the source that it was made from.
struct Encoded
{
  TemporaryFolder Folder;
  std::string Path = Folder / "series.banyan";
  Steps<float> Original;
  MemorySource Source;

  explicit Encoded(double bound = 1.0 / 512)
  {
    this->Original = Sample<float>(OddGrid(), StepCount,
      [](int x, int y, int z, int step)
      { return x == 3 && y == 4 ? std::nan("") : Wavy<float>(x, y, z, step); });
    EncodeOptions options;
    options.ErrorBound = bound;
    Encode(this->Path, OddGrid(), this->Original, options);
    for (int step = 0; step < StepCount; ++step)
    {
      const SourceStep description{ static_cast<double>(step), OddGrid(), OddGrid().Samples(),
        { { "values", ScalarType::Float32, 1 } } };
      this->Source.Steps.push_back(
        { description, { BytesFrom(this->Original[static_cast<std::size_t>(step)]) } });
    }
  }

  float& At(int step, std::size_t voxel)
  {
    return reinterpret_cast<float*>(
      this->Source.Steps[static_cast<std::size_t>(step)].Values[0].data())[voxel];
  }

  Verification Run(const VerificationChoice& choice = {})
  {
    return Verify(*SeriesFile::Open(this->Path), this->Source, choice);
  }

  /// Lets the index say something else, with the right checksum.
  template <class Change>
  void ChangeIndex(Change&& change)
  {
    SeriesIndex index = IndexFromText(ReadWholeFile(this->Path, GreatestIndexBytes), this->Path);
    change(index);
    WriteFileAtomically(this->Path, IndexToText(index));
  }

  /// Verifying must be refused with a sentence that says `phrase`.
  void ExpectRefusal(const std::string& phrase, const VerificationChoice& choice = {})
  {
    try
    {
      this->Run(choice);
      ADD_FAILURE() << "nothing was refused, and it should have been: " << phrase;
    }
    catch (const Error& error)
    {
      EXPECT_NE(std::string(error.what()).find(phrase), std::string::npos) << error.what();
    }
  }
};

} // namespace banyan::testing

#endif
