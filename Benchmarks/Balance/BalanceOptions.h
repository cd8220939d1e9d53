// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_BalanceOptions_h
#define banyan_Benchmarks_BalanceOptions_h

#include <string>
#include <vector>

namespace banyan::bench
{

/// How zones follow what frames cost.
enum class BalanceMode
{
  Off,
  SliceStep,   ///< RebalanceSliceStep
  MeasuredCost ///< LoadBalancer
};

struct BalanceOptions
{
  std::string Series;       ///< description of a raw series; none draws the standard scene S2
  std::string Scene = "S2"; ///< of standard scenes
  std::string Path = "zoom";
  std::string Output;        ///< CSV; none prints
  std::string RankTimes;     ///< CSV of each rank's times; none
  std::string BrickTimes;    ///< CSV of what each brick of the first frame took; none
  std::string BestDivisions; ///< CSV of the best that planes can do for the views; none
  int Size = 256;            ///< samples per axis of the standard scene
  int Picture = 512;
  int Frames = 60;
  int PlaneStep = 1; ///< cells
  std::vector<int> Ranks{ 2, 4, 8, 16 };
  std::vector<BalanceMode> Modes{ BalanceMode::Off, BalanceMode::SliceStep,
    BalanceMode::MeasuredCost };
  bool Turns = true;           ///< whether measured cost may choose axes
  bool Counted = false;        ///< work in place of processor time
  int TurnPercent = 15;        ///< by which frames must be expected to be faster for that
  bool CompositeAfter = false; ///< real ranks composite odd frames after the last ray
  bool Append = false;
  bool Mpi = false;    ///< on the ranks of this job in place of simulated ones
  bool Pieces = false; ///< with Mpi: each rank holds an equal block of the volume, and nothing else
  bool Exchange = false; ///< with Mpi: only what it takes to fetch a brick
  std::string Disk;      ///< with Exchange: a series, read from the disk as well; none
  bool Help = false;
};

extern const char* const BalanceHelp;

/// Throws Error with a sentence.
BalanceOptions ParseBalanceOptions(const std::vector<std::string>& arguments);

/// As in the column `mode`.
const char* NameOf(BalanceMode mode);

} // namespace banyan::bench

#endif
