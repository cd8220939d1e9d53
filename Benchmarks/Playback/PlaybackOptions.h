// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_PlaybackOptions_h
#define banyan_Benchmarks_PlaybackOptions_h

#include <string>
#include <vector>

namespace banyan::bench
{

/// How a series is played.
enum class PlayMode
{
  Play,    ///< all steps, one after the other
  Loop,    ///< twice; the second round is measured
  Rest,    ///< one step, again and again
  Turn,    ///< one step, while the camera goes round
  Function ///< one step, while the transfer function changes a little from frame to frame
};

struct PlaybackOptions
{
  std::string Encode; ///< description of a raw series that is to be encoded; empty to play
  std::string Paper;  ///< description of the raw series of the study's experiment; empty without
  std::string Series;
  std::string Name; ///< in the table
  std::string Output;
  std::string Function = "ramp";
  std::string Pictures; ///< folder for what was drawn, as raw floats; empty for none
  PlayMode Mode = PlayMode::Play;
  int Picture = 512;
  int Frames = 50;
  int Rounds = 1;
  int BrickCells = 16;    ///< of the study's experiment
  double Tolerance = 8.0; ///< in 1/255; 0: a sample per voxel
  bool Shaded = false;
  bool Count = false; ///< what of each picture is as before, in place of times
  bool Truth = false; ///< whether errors are measured, against samples 1/8 of a voxel apart
  bool Cold = false;  ///< files are dropped from the system's cache before each pass
  int Passes = 3;
  double ShownMilliseconds = 0.0; ///< in which a picture is shown, and nobody draws
  int BudgetMiB = -1;             ///< of the caches; -1: the process's own
  double Bound = 1.0 / 512.0;     ///< of the range, to encode
  std::vector<bool> Reuse{ false, true };
  bool Help = false;
};

extern const char* const PlaybackHelp;

/// Throws Error with a sentence for the user.
PlaybackOptions ParsePlaybackOptions(const std::vector<std::string>& arguments);

} // namespace banyan::bench

#endif
