// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Communicate/NodeCommunicator.h"

#include "Base/AvailableMemory.h"
#include "Base/Error.h"
#include "Parallel/Communicate/Collective.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace banyan
{
namespace
{

class FileDescriptor
{
public:
  explicit FileDescriptor(int number = -1)
    : Number(number)
  {
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() { this->Take(-1); }
  void Take(int number)
  {
    if (this->Number >= 0)
    {
      close(this->Number);
    }
    this->Number = number;
  }
  int Get() const { return this->Number; }

private:
  int Number;
};

std::string WithReason(const std::string& what)
{
  return what + ": " + std::strerror(errno);
}

std::string Megabytes(std::size_t bytes)
{
  return std::to_string((bytes + (std::size_t{ 1 } << 20) - 1) >> 20) + " MB";
}

/// Sizes are checked before memory is taken: the kernel would give file and process what it has,
/// and then end a process of its choice.
/// @param times so many ranks of this machine take as much each
std::string Shortage(std::size_t bytes, int times)
{
  const std::size_t available = AvailableMemory();
  return bytes <= available / static_cast<std::size_t>(times)
           ? std::string()
           : "There is no memory for " + (times > 1 ? std::to_string(times) + " times " : "") +
               Megabytes(bytes) + " of a mesh: machine or container have " + Megabytes(available) +
               " left";
}

/// Null on failure.
std::shared_ptr<char> Mapped(std::size_t bytes, int flags, int file)
{
  void* const begin = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, flags, file, 0);
  if (begin == MAP_FAILED)
  {
    return nullptr;
  }
  // Fewer misses of the address cache where the machine allows large pages; nothing else changes.
  madvise(begin, bytes, MADV_HUGEPAGE);
  return std::shared_ptr<char>(
    static_cast<char*>(begin), [bytes](char* memory) { munmap(memory, bytes); });
}

/// Tells the others how to open a file without a name, and how to know that it is this one.
struct FileOfLeader
{
  std::int64_t Process = 0;
  std::int64_t Number = -1; ///< -1: there is none
  std::uint64_t Device = 0;
  std::uint64_t Inode = 0;
};

/// Gives a file all its pages, in small parts: many kernels end what takes longer when a signal
/// comes, one of a timer too, and take back what they gave. False, with errno, on failure.
bool MakeRoom(int file, std::size_t bytes)
{
  constexpr std::size_t part = std::size_t{ 2 } << 20;
  for (std::size_t begin = 0; begin < bytes;)
  {
    const std::size_t length = std::min(part, bytes - begin);
    if (fallocate(file, 0, static_cast<off_t>(begin), static_cast<off_t>(length)) == 0)
    {
      begin += length;
    }
    else if (errno != EINTR)
    {
      return false;
    }
  }
  return true;
}

/// All of the file is there when this has succeeded.
/// @return what failed; empty if nothing
std::string MakeFile(std::size_t bytes, FileDescriptor& file, FileOfLeader& place)
{
  // A file beyond the limit would be a signal, and not an error.
  rlimit limit = {};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      bytes > limit.rlim_cur)
  {
    return "A file in memory may not have " + Megabytes(bytes) + " (ulimit -f)";
  }
  file.Take(memfd_create("banyan", MFD_CLOEXEC));
  if (file.Get() < 0)
  {
    return WithReason("A file in memory cannot be made");
  }
  struct stat status = {};
  // Addresses come first: a size that no process can have must not take all memory there is. Then
  // room: pages that are missing later would end the process without a word.
  if (ftruncate(file.Get(), static_cast<off_t>(bytes)) != 0 ||
      !Mapped(bytes, MAP_SHARED, file.Get()) || !MakeRoom(file.Get(), bytes) ||
      fstat(file.Get(), &status) != 0)
  {
    return WithReason("A file in memory cannot have " + Megabytes(bytes));
  }
  place = { getpid(), file.Get(), status.st_dev, status.st_ino };
  return {};
}

/// @return what failed; empty if nothing
std::string OpenFile(const FileOfLeader& place, FileDescriptor& file)
{
  if (place.Number < 0)
  {
    return {}; // the leader says why
  }
  const std::string name =
    "/proc/" + std::to_string(place.Process) + "/fd/" + std::to_string(place.Number);
  file.Take(open(name.c_str(), O_RDWR | O_CLOEXEC));
  struct stat status = {};
  if (file.Get() < 0 || fstat(file.Get(), &status) != 0)
  {
    return WithReason("Memory of another rank cannot be opened as " + name);
  }
  if (status.st_dev != place.Device || status.st_ino != place.Inode)
  {
    return "Memory of another rank is not the one that is seen as " + name;
  }
  return {};
}

} // namespace

std::string NodeCommunicator::ThisMachine()
{
  const char* const allowed = std::getenv("BANYAN_SHARED_MEMORY");
  if (allowed && std::strcmp(allowed, "0") == 0)
  {
    return {};
  }
  std::string kernel;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> kernel;
  char processes[64] = {};
  const ssize_t length = readlink("/proc/self/ns/pid", processes, sizeof(processes));
  if (kernel.empty() || length <= 0)
  {
    return {};
  }
  return kernel + " " + std::string(processes, static_cast<std::size_t>(length)) + " " +
         std::to_string(geteuid());
}

NodeCommunicator::NodeCommunicator(Communicator& communicator, const std::string& machine)
  : Self(communicator.Rank())
{
  const std::vector<std::string> machines = AllGatherStrings(communicator, machine);
  this->LeaderOfRank.resize(machines.size());
  this->RanksOfMachine.resize(machines.size());
  for (std::size_t rank = 0; rank < machines.size(); ++rank)
  {
    const auto same = std::find(machines.begin(), machines.end(), machines[rank]);
    const auto leader =
      machines[rank].empty() ? rank : static_cast<std::size_t>(same - machines.begin());
    this->LeaderOfRank[rank] = static_cast<int>(leader);
    this->RanksOfMachine[rank] =
      machines[rank].empty()
        ? 1
        : static_cast<int>(std::count(machines.begin(), machines.end(), machines[rank]));
    if (leader == rank)
    {
      this->AllLeaders.push_back(static_cast<int>(rank));
    }
  }
  this->Sharing = this->AllLeaders.size() < machines.size();
}

void NodeCommunicator::BeAlone()
{
  this->Sharing = false;
  this->AllLeaders.clear();
  for (std::size_t rank = 0; rank < this->LeaderOfRank.size(); ++rank)
  {
    this->LeaderOfRank[rank] = static_cast<int>(rank);
    this->AllLeaders.push_back(static_cast<int>(rank));
  }
}

std::shared_ptr<char> NodeCommunicator::Allocate(Communicator& communicator, std::size_t bytes)
{
  bytes = std::max<std::size_t>(bytes, 1);
  if (this->Sharing)
  {
    ThrowTogether(communicator, Shortage(bytes, 1));
    if (std::shared_ptr<char> memory = this->TogetherOrNull(communicator, bytes))
    {
      return memory;
    }
    this->BeAlone();
  }
  ThrowTogether(
    communicator, Shortage(bytes, this->RanksOfMachine[static_cast<std::size_t>(this->Self)]));
  const std::shared_ptr<char> own = Mapped(bytes, MAP_PRIVATE | MAP_ANONYMOUS, -1);
  ThrowTogether(communicator,
    own ? std::string() : "There is no memory for " + Megabytes(bytes) + " of a mesh");
  return own;
}

/// Null on all ranks when it fails on one.
std::shared_ptr<char> NodeCommunicator::TogetherOrNull(
  Communicator& communicator, std::size_t bytes)
{
  FileDescriptor file;
  FileOfLeader place;
  std::string failure;
  const bool several = this->RanksOfMachine[static_cast<std::size_t>(this->Self)] > 1;
  if (several && this->Leads())
  {
    failure = MakeFile(bytes, file, place);
  }
  std::vector<FileOfLeader> places(this->LeaderOfRank.size());
  communicator.AllGather(&place, sizeof(place), places.data());
  if (several && !this->Leads())
  {
    failure = OpenFile(places[static_cast<std::size_t>(this->LeaderOf(this->Self))], file);
  }
  std::shared_ptr<char> memory;
  if (failure.empty() && (!several || file.Get() >= 0))
  {
    memory = several ? Mapped(bytes, MAP_SHARED, file.Get())
                     : Mapped(bytes, MAP_PRIVATE | MAP_ANONYMOUS, -1);
    if (!memory)
    {
      failure = WithReason("No addresses are left for " + Megabytes(bytes));
    }
  }
  // The leader's file stays open until all have opened it.
  const std::string agreed = AgreeOnError(communicator, failure);
  if (!agreed.empty())
  {
    this->Reason = agreed;
    return nullptr;
  }
  return memory;
}

} // namespace banyan
