// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_GenerateOptions_h
#define banyan_Data_GenerateOptions_h

#include <cstdint>
#include <string>
#include <vector>

namespace banyan
{

/// What banyan-generate is asked to do. `GenerateHelp()` explains each one. Once parsed, all are
/// set: what the arguments leave out has the defaults of the series.
struct GenerateOptions
{
  std::string Series; ///< the name of a kind in `SeriesCatalog()`
  std::string Output; ///< folder for .vti files, or empty
  std::string Raw;    ///< file for the first array without a header, or empty
  int Size = 0;
  int Steps = 0;
  std::uint64_t Seed = 1;
  int Threads = 0;
  double Duration = -1.0;
  std::int64_t Cells = 0; ///< of a mesh, about; 0 for series on images
  double Slowest = 0.0;   ///< S waves in the softest sediments, m/s
  std::string Format;     ///< of series on meshes: "exodus" or "vtu"
  bool Voxels = false;    ///< cells of .vtu files are VTK_VOXEL
  std::vector<std::string> Arrays;
  bool Help = false;
};

/// @param arguments without the program's name
/// Throws Error, with a sentence that names the argument, when one is unknown or out of range.
GenerateOptions ParseGenerateOptions(const std::vector<std::string>& arguments);

std::string GenerateHelp();

} // namespace banyan

#endif
