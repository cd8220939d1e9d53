// SPDX-License-Identifier: BSD-3-Clause
#include "Base/AvailableMemory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>

namespace banyan
{
namespace
{

/// The sum of lines "name value" with one of two names; nothing where the first is not there.
std::optional<std::size_t> SumOfLines(
  const std::string& file, const std::string& first, const std::string& second)
{
  std::ifstream lines(file);
  std::optional<std::size_t> found;
  std::size_t other = 0;
  std::string name;
  for (std::size_t value = 0; lines >> name >> value; lines.ignore(64, '\n'))
  {
    if (name == first)
    {
      found = value;
    }
    other += name == second ? value : 0;
  }
  return found ? std::optional<std::size_t>(*found + other) : std::nullopt;
}

/// Returns the bytes that a limit of a control group leaves; nothing where there is no limit.
std::optional<std::size_t> Left(const std::string& group, const std::string& what)
{
  std::size_t most = 0;
  std::size_t used = 0;
  // A group without a limit has the word "max" there.
  if (!(std::ifstream(group + what + ".max") >> most) ||
      !(std::ifstream(group + what + ".current") >> used))
  {
    return std::nullopt;
  }
  return most - std::min(most, used);
}

/// The group of this process below the root of groups, as "/a/b"; empty for the root itself.
std::string OwnGroup(const std::string& root)
{
  std::ifstream groups(root + "/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);)
  {
    // Groups outside of what the process sees begin with "/..".
    if (line.rfind("0::/", 0) == 0 && line.find("/..") == std::string::npos)
    {
      return line.size() == 4 ? std::string() : line.substr(3);
    }
  }
  return {};
}

/// Calls function(folder) for the control groups around the process.
template <class Function>
void ForGroups(const std::string& root, Function&& function)
{
  for (std::string group = OwnGroup(root);; group.resize(group.rfind('/')))
  {
    function(root + "/sys/fs/cgroup" + group + "/");
    if (group.empty())
    {
      return;
    }
  }
}

} // namespace

std::size_t AvailableMemory(const std::string& root)
{
  constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max();
  const std::string machine = root + "/proc/meminfo";
  std::size_t least = unknown;
  if (const auto kilobytes = SumOfLines(machine, "MemAvailable:", "SwapFree:"))
  {
    least = *kilobytes << 10;
  }
  ForGroups(root,
    [&](const std::string& folder)
    {
      if (const auto left = Left(folder, "memory"))
      {
        const std::size_t files =
          SumOfLines(folder + "memory.stat", "inactive_file", "active_file").value_or(0);
        // Without a limit of its own, swap is what the machine has.
        const std::size_t swap =
          Left(folder, "memory.swap")
            .value_or(SumOfLines(machine, "SwapFree:", "").value_or(0) << 10);
        least = std::min(least, *left + files + swap);
      }
    });
  return least;
}

std::size_t MachineMemory(const std::string& root)
{
  std::size_t least = SumOfLines(root + "/proc/meminfo", "MemTotal:", "").value_or(0) << 10;
  ForGroups(root,
    [&](const std::string& folder)
    {
      std::size_t most = 0;
      if (std::ifstream(folder + "memory.max") >> most)
      {
        least = least == 0 ? most : std::min(least, most);
      }
    });
  return least;
}

} // namespace banyan
