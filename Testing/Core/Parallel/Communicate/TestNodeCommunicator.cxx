// SPDX-License-Identifier: BSD-3-Clause
// Memory that ranks of a machine have together.
#include "Base/AvailableMemory.h"
#include "Base/Error.h"
#include "Parallel/Communicate/NodeCommunicator.h"
#include "Parallel/FilesInMemory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iterator>

namespace
{

using namespace banyan;
using files_in_memory::FilesInMemory;
using files_in_memory::LongestFile;

std::ptrdiff_t OpenFiles()
{
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

TEST(NodeCommunicator, MemoryIsThereOncePerMachine)
{
  const std::ptrdiff_t openBefore = OpenFiles();
  for (const int ranks : { 2, 3, 5, 8 })
  {
    for (const int perMachine : { 1, 2, 3, 8 })
    {
      const int machineCount = (ranks + perMachine - 1) / perMachine;
      const bool lastAlone = (ranks - 1) % perMachine == 0;
      RunOnSimulatedRanks(ranks,
        [&](Communicator& communicator)
        {
          const int self = communicator.Rank();
          NodeCommunicator machines(communicator, std::to_string(self / perMachine));
          EXPECT_EQ(machines.Shares(), machineCount < ranks);
          EXPECT_EQ(machines.Leads(), self % perMachine == 0);
          EXPECT_EQ(machines.Leaders().size(), static_cast<std::size_t>(machineCount));
          const auto bytes = static_cast<std::size_t>(ranks);
          const std::shared_ptr<char> memory = machines.Allocate(communicator, bytes);
          ASSERT_TRUE(memory);
          EXPECT_EQ(std::count(memory.get(), memory.get() + bytes, 0), ranks);
          communicator.Barrier();
          memory.get()[self] = static_cast<char>(self + 1);
          communicator.Barrier();
          // One rank alone has memory of its own, which is no file.
          const int files = perMachine == 1 ? 0 : machineCount - (lastAlone ? 1 : 0);
          EXPECT_EQ(FilesInMemory().size(), static_cast<std::size_t>(files));
          for (int rank = 0; rank < ranks; ++rank)
          {
            EXPECT_EQ(memory.get()[rank], rank / perMachine == self / perMachine ? rank + 1 : 0);
          }
          communicator.Barrier();
        });
      EXPECT_TRUE(FilesInMemory().empty()) << "memory is given back";
      EXPECT_EQ(OpenFiles(), openBefore) << "files are closed";
    }
  }
}

TEST(NodeCommunicator, RanksWithoutANameAreOnTheirOwn)
{
  RunOnSimulatedRanks(3,
    [](Communicator& communicator)
    {
      const NodeCommunicator machines(communicator, "");
      EXPECT_FALSE(machines.Shares());
      EXPECT_TRUE(machines.Leads());
      const NodeCommunicator named(communicator);
      EXPECT_TRUE(named.Shares());
      EXPECT_EQ(named.LeaderOf(communicator.Rank()), 0);
    });
}

TEST(NodeCommunicator, WhatCannotBeHadTogetherEachRankHasForItself)
{
  const LongestFile limit(4096);
  RunOnSimulatedRanks(4,
    [](Communicator& communicator)
    {
      NodeCommunicator machines(communicator, std::to_string(communicator.Rank() / 2));
      const std::shared_ptr<char> small = machines.Allocate(communicator, 4096);
      EXPECT_TRUE(machines.Shares());
      const std::shared_ptr<char> memory = machines.Allocate(communicator, 5000);
      EXPECT_FALSE(machines.Shares());
      EXPECT_TRUE(machines.Leads());
      EXPECT_NE(machines.WhyNot().find("ulimit -f"), std::string::npos) << machines.WhyNot();
      memory.get()[4999] = static_cast<char>(communicator.Rank() + 1);
      communicator.Barrier();
      EXPECT_EQ(memory.get()[4999], communicator.Rank() + 1);
    });
}

TEST(NodeCommunicator, WhatEachRankOfAMachineHasForItselfIsTakenSoManyTimes)
{
  // Enough for one, and not for three; nobody takes it: a file of that size is not allowed.
  const std::size_t bytes = AvailableMemory() / 2;
  const LongestFile limit(4096);
  std::atomic<int> refused{ 0 };
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      NodeCommunicator machines(communicator);
      try
      {
        machines.Allocate(communicator, bytes);
      }
      catch (const Error& error)
      {
        refused +=
          std::string(error.what()).find("no memory for 3 times ") != std::string::npos ? 1 : 0;
      }
    });
  EXPECT_EQ(refused, 3);
}

TEST(NodeCommunicator, TooMuchIsAnErrorOnAllRanks)
{
  std::atomic<int> refused{ 0 };
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      NodeCommunicator machines(communicator);
      try
      {
        machines.Allocate(communicator, std::size_t{ 1 } << 52);
      }
      catch (const Error& error)
      {
        refused +=
          std::string(error.what()).find("no memory for 4294967296 MB") != std::string::npos ? 1
                                                                                             : 0;
      }
    });
  EXPECT_EQ(refused, 3);
}

} // namespace
