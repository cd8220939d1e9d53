// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_GoldenCases_h
#define banyan_Testing_GoldenCases_h

#include "Base/Bytes.h"
#include "Series/Encode/SeriesEncoder.h"

#include <cstdint>
#include <string>
#include <vector>

namespace banyan::testing
{

/// What the numbers of a golden array look like.
enum class GoldenPattern
{
  Constant, ///< 0 everywhere
  Bumps,    ///< smooth: a sum of three parabolas that repeat, and move with the steps
  Noise,    ///< independent, even over 2^Bits numbers
  Picks,    ///< independent, one of three numbers far apart: prediction from neighbours does harm
  Fates,    ///< every 8 samples along x are best predicted in a way of their own
  Hidden    ///< flags: a wall that moves along x with the steps, and single ones
};

/// One array of a golden series. A sample is number = Low + Factor * pattern, all in integers; of a
/// real type its value is number * 2^Exponent, of an integer type the number modulo the type. So
/// the values are the same bits on every machine.
struct GoldenArray
{
  std::string Name;
  ScalarType Type = ScalarType::Float32;
  GoldenPattern Pattern = GoldenPattern::Bumps;
  std::vector<std::string> Components = { "" };
  std::int64_t Low = 0;
  std::int64_t Factor = 1;
  int Exponent = 0;
  int Bits = 8;           ///< of Noise
  int QuietBelow = 0;     ///< samples with x below have pattern 0: macro voxels
  int Hold = 1;           ///< steps for which values stay as they are: unchanged bricks
  int NonFiniteOneIn = 0; ///< of real types: one sample in so many is NaN or infinite; 0: none
  int SpecialOneIn = 0;   ///< one sample in so many has the value Special; 0: none
  double Special = 0;
  std::int64_t Rise = 0;               ///< added per step to the number
  unsigned Seed = 1;                   ///< arrays with equal numbers and seeds share their payloads
  bool Promised = true;                ///< whether the encoder is told the range beforehand
  ArrayFlags Flags = ArrayFlags::None; ///< of pattern Hidden
  std::string CellArray; ///< on a mesh: its name among the arrays of cells, if it is one
};

/// One golden series: everything that the encoder is given.
struct GoldenCase
{
  std::string Name;
  Grid Domain;
  EncodeOptions Options;
  int Steps = 1;
  std::vector<GoldenArray> Arrays;
  bool OnMesh = false;  ///< values are those of the points or cells of GoldenMesh
  bool OnCells = false; ///< the same of GoldenCells
};

/// The list; it does not depend on the version of the format.
std::vector<GoldenCase> GoldenCases();

/// More of them: groups of steps, all ways of prediction, quantizers.
std::vector<GoldenCase> GoldenGroupCases();

/// One for each feature of the format.
std::vector<GoldenCase> GoldenFeatureCases();

/// Values of one array at a step, `[z][y][x][component]`, as bytes; on a mesh `[point][component]`
/// or `[cell][component]`.
Bytes GoldenValues(const GoldenCase& series, const GoldenArray& array, int step);

/// As the encoder wants it; the range of a promised array is that of its values.
ArrayDescription GoldenDescription(const GoldenCase& series, const GoldenArray& array);

/// Irregular and exact in binary.
double GoldenTime(int step);

} // namespace banyan::testing

#endif
