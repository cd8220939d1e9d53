// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_SeriesFiles_h
#define banyan_Benchmarks_SeriesFiles_h

#include "Base/Error.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

namespace banyan::bench
{

/// The description of a series and all files beside it.
inline std::vector<std::filesystem::path> FilesOf(const std::string& series)
{
  std::vector<std::filesystem::path> files{ series };
  for (const auto& entry : std::filesystem::directory_iterator(series + ".d"))
  {
    files.push_back(entry.path());
  }
  return files;
}

inline double BytesOf(const std::string& series)
{
  double bytes = 0.0;
  for (const std::filesystem::path& path : FilesOf(series))
  {
    bytes += static_cast<double>(std::filesystem::file_size(path));
  }
  return bytes;
}

/// Calls function(descriptor) for each file of a series.
template <class Function>
void ForFilesOf(const std::string& series, const Function& function)
{
  for (const std::filesystem::path& path : FilesOf(series))
  {
    const int file = open(path.c_str(), O_RDONLY);
    if (file < 0)
    {
      throw Error("The file cannot be read.", { path.string() });
    }
    function(file);
    close(file);
  }
}

/// Brings all of a series to the disk: only that can be dropped from the system's cache later.
inline void BringToDisk(const std::string& series)
{
  ForFilesOf(series, [](int file) { fsync(file); });
}

inline void DropFromCache(const std::string& series)
{
  ForFilesOf(series, [](int file) { posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED); });
}

} // namespace banyan::bench

#endif
