// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_RayCastOptions_h
#define banyan_Benchmarks_RayCastOptions_h

#include "RayCastMeasure.h"

#include <string>
#include <vector>

namespace banyan::bench
{

/// What the program is asked to do. `RayCastHelp()` explains each one.
struct RayCastOptions
{
  std::vector<std::string> Descriptions; ///< JSON files, see RealScene
  std::string Output;
  bool Append = false;
  int Size = 256;
  int Picture = 1024;
  double ReferenceStep = 1.0 / 16.0;
  std::vector<std::string> Scenes;    ///< none means all
  std::vector<std::string> Renderers; ///< none means all
  std::string References;             ///< folder
  RayCastMeasuring Measuring;
  bool Help = false;
};

/// @param arguments without the program's name
/// Throws Error, with a sentence that names the argument, when one is unknown or out of range.
RayCastOptions ParseRayCastOptions(const std::vector<std::string>& arguments);

std::string RayCastHelp();

} // namespace banyan::bench

#endif
