// SPDX-License-Identifier: BSD-3-Clause
// What is left of memory, by what files in /proc and /sys say: of made-up machines, and of this
// one.
#include "Base/AvailableMemory.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace
{

using namespace banyan;

class AvailableMemoryOf : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Root = testing::TempDir() + "banyan-memory-" + std::to_string(getpid());
    std::filesystem::remove_all(this->Root);
  }
  void TearDown() override { std::filesystem::remove_all(this->Root); }

  void Write(const std::string& name, const std::string& text) const
  {
    const std::filesystem::path file = this->Root + name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  void WriteMachine(const std::string& swapKilobytes) const
  {
    this->Write(
      "/proc/meminfo", "MemTotal:       9000 kB\nMemFree:         10 kB\nMemAvailable:    5000 kB\n"
                       "HugePages_Total:       0\nSwapFree:        " +
                         swapKilobytes + " kB\n");
  }
  void WriteGroup(const std::string& group, const std::string& most, const std::string& used) const
  {
    this->Write("/sys/fs/cgroup" + group + "/memory.max", most + "\n");
    this->Write("/sys/fs/cgroup" + group + "/memory.current", used + "\n");
  }

  std::string Root;
};

TEST_F(AvailableMemoryOf, AMachineThatSaysNothingHasNoLimit)
{
  EXPECT_EQ(AvailableMemory(this->Root), std::numeric_limits<std::size_t>::max());
}

TEST_F(AvailableMemoryOf, AMachineIsWhatIsAvailableAndSwap)
{
  this->WriteMachine("7");
  EXPECT_EQ(AvailableMemory(this->Root), std::size_t{ 5007 } * 1024);
}

TEST_F(AvailableMemoryOf, AContainerHasWhatItMayTakeMore)
{
  this->WriteMachine("0");
  this->WriteGroup("", "1000000", "300000");
  EXPECT_EQ(AvailableMemory(this->Root), 700000u);
  // Pages of files are dropped when room is needed; those of files in memory are not.
  this->Write("/sys/fs/cgroup/memory.stat",
    "anon 1\nfile 250000\nshmem 50000\ninactive_file 150000\nactive_file 40000\n");
  EXPECT_EQ(AvailableMemory(this->Root), 890000u);
  this->WriteMachine("1");
  EXPECT_EQ(AvailableMemory(this->Root), 891024u);
  this->Write("/sys/fs/cgroup/memory.swap.max", "500\n");
  this->Write("/sys/fs/cgroup/memory.swap.current", "400\n");
  EXPECT_EQ(AvailableMemory(this->Root), 890100u);
  this->WriteGroup("", "100", "300000");
  EXPECT_EQ(AvailableMemory(this->Root), 190100u) << "beyond its limit nothing is left but files";
  this->WriteGroup("", "max", "300000");
  EXPECT_EQ(AvailableMemory(this->Root), std::size_t{ 5001 } * 1024);
  this->WriteGroup("", "900000000", "0");
  EXPECT_EQ(AvailableMemory(this->Root), std::size_t{ 5001 } * 1024) << "no more than the machine";
}

TEST_F(AvailableMemoryOf, TheTightestOfGroupsInGroupsCounts)
{
  this->WriteMachine("0");
  this->Write("/proc/self/cgroup", "4:memory:/other\n0::/job/step\n");
  this->WriteGroup("/job/step", "max", "100");
  this->WriteGroup("/job", "2000", "500");
  EXPECT_EQ(AvailableMemory(this->Root), 1500u);
  this->WriteGroup("/job/step", "1200", "100");
  EXPECT_EQ(AvailableMemory(this->Root), 1100u);
  this->WriteGroup("", "1700", "1000");
  EXPECT_EQ(AvailableMemory(this->Root), 700u);
  this->Write("/proc/self/cgroup", "0::/../job\n");
  this->WriteGroup("", "1700", "10");
  EXPECT_EQ(AvailableMemory(this->Root), 1690u) << "a group that is not seen";
}

TEST_F(AvailableMemoryOf, AllOfAMachineIsWhatItHasOrTheTightestGroupMay)
{
  EXPECT_EQ(MachineMemory(this->Root), 0u) << "nothing says";
  this->WriteMachine("7");
  EXPECT_EQ(MachineMemory(this->Root), std::size_t{ 9000 } * 1024);
  this->Write("/proc/self/cgroup", "0::/job/step\n");
  this->WriteGroup("/job/step", "max", "100");
  EXPECT_EQ(MachineMemory(this->Root), std::size_t{ 9000 } * 1024);
  this->WriteGroup("/job", "2000", "1900");
  EXPECT_EQ(MachineMemory(this->Root), 2000u) << "whatever is in use";
}

TEST(AvailableMemory, OfThisMachineIsSomething)
{
  EXPECT_GT(AvailableMemory(), std::size_t{ 1 } << 20);
  EXPECT_LT(AvailableMemory(), std::size_t{ 1 } << 50);
}

} // namespace
