// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Parallel_FilesInMemory_h
#define banyan_Testing_Core_Parallel_FilesInMemory_h

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace files_in_memory
{

/// The files in memory that this process has mapped: each is memory once, however often mapped.
inline std::set<std::string> FilesInMemory()
{
  std::set<std::string> inodes;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
  {
    std::istringstream words(line);
    std::string addresses, rights, offset, device, inode, name;
    words >> addresses >> rights >> offset >> device >> inode >> name;
    if (name.rfind("/memfd:banyan", 0) == 0)
    {
      inodes.insert(inode);
    }
  }
  return inodes;
}

/// No file of this process may be longer while an object of this class lives.
class LongestFile
{
public:
  explicit LongestFile(rlim_t bytes)
  {
    EXPECT_EQ(getrlimit(RLIMIT_FSIZE, &this->Before), 0);
    rlimit low = this->Before;
    low.rlim_cur = bytes;
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &low), 0);
  }
  ~LongestFile() { EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &this->Before), 0); }

private:
  rlimit Before = {};
};

} // namespace files_in_memory

#endif
