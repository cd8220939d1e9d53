#ifndef banyan_Data_GenerateOptions_h
#define banyan_Data_GenerateOptions_h

#include <cstdint>
#include <string>
#include <vector>

namespace banyan
{

/// What banyan-generate is asked to do. `GenerateHelp()` explains each one.
struct GenerateOptions
{
  std::string Output;
  int Size = 64;
  int Steps = 24;
  std::uint64_t Seed = 1;
  int Threads = 0;
  double Duration = 6.0;
  std::vector<std::string> Arrays = { "temperature" };
  bool Help = false;
};

/// @param arguments without the program's name
/// Throws Error, with a sentence that names the argument, when one is unknown or out of range.
GenerateOptions ParseGenerateOptions(const std::vector<std::string>& arguments);

std::string GenerateHelp();

} // namespace banyan

#endif
