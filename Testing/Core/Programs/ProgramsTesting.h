// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_ProgramsTesting_h
#define banyan_Testing_ProgramsTesting_h

#include "Series/SeriesTesting.h"

#include <cstdio>
#include <string>

#include <sys/wait.h>

namespace banyan::testing
{

/// What a program printed and how it ended.
struct ProgramResult
{
  int Status = -1; ///< exit status; -1 when it ended in another way
  std::string Output;
};

/// Runs a command of the shell; error messages come back among the output.
inline ProgramResult RunProgram(const std::string& command)
{
  ProgramResult result;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe)
  {
    return result;
  }
  char buffer[4096];
  for (std::size_t n; (n = fread(buffer, 1, sizeof(buffer), pipe)) > 0;)
  {
    result.Output.append(buffer, n);
  }
  const int status = pclose(pipe);
  result.Status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

/// A field that is rough in one corner, still in another, and empty elsewhere: macro voxels,
/// unchanged bricks and changing ones of an 80 x 48 x 34 grid with bricks of 16 cells.
inline double CornersAt(int x, int y, int z, int step)
{
  if (x < 28 && y < 28 && z < 28)
  {
    return 10.0 + std::sin(0.7 * x + 0.3 * step) * std::cos(0.9 * y - 0.2 * z);
  }
  if (x > 48 && y > 28)
  {
    return 3.0 + std::sin(1.3 * x) * std::cos(0.8 * y + z); // does not change
  }
  return step < 3 ? 0.0 : 1.0; // empty, and changes once
}

inline Grid CornersGrid()
{
  return GridOf(80, 48, 34);
}

inline EncodeOptions CornersOptions()
{
  EncodeOptions options;
  options.BrickCells = 16;
  options.KeyframeInterval = 3;
  return options;
}

} // namespace banyan::testing

#endif
