// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/SegmentFile.h"

#include "Base/Error.h"
#include "Series/Format/SegmentFormat.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace banyan
{

struct SegmentFile::Descriptor
{
  explicit Descriptor(int number)
    : Number(number)
  {
  }
  ~Descriptor() { (void)close(this->Number); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int Number;
};

/// The files that are open, of all series of the process.
struct SegmentFile::Pool
{
  std::mutex Mutex;
  std::vector<const SegmentFile*> Files;
  std::uint64_t Clock = 0;

  /// Closes the file that was read least recently, once nobody reads it. @return false: there is
  /// none
  bool CloseOne()
  {
    const auto oldest = std::min_element(this->Files.begin(), this->Files.end(),
      [](const SegmentFile* a, const SegmentFile* b) { return a->Used < b->Used; });
    if (oldest == this->Files.end())
    {
      return false;
    }
    (*oldest)->Kept.reset();
    this->Files.erase(oldest);
    return true;
  }

  void Keep(const SegmentFile& file, std::shared_ptr<const Descriptor> descriptor)
  {
    file.Kept = std::move(descriptor);
    this->Files.push_back(&file);
  }
};

SegmentFile::Pool& SegmentFile::Open()
{
  // Never destroyed: series that are closed while the process ends still come here.
  static Pool* const pool = new Pool;
  return *pool;
}

std::size_t SegmentFile::MostOpen()
{
  struct rlimit limit = {};
  const bool known = getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  // Sockets of ParaView must have numbers below 1024, whatever the limit.
  return known ? std::min<std::size_t>(256, limit.rlim_cur / 4) : 256;
}

SegmentFile::SegmentFile(const std::string& folder, const SegmentIndex& index)
  : FilePath(folder + "/" + index.File)
  , Size(index.Bytes)
{
  std::shared_ptr<const Descriptor> descriptor = this->OpenNow();
  Pool& pool = Open();
  std::lock_guard<std::mutex> lock(pool.Mutex);
  if (pool.Files.size() < MostOpen())
  {
    pool.Keep(*this, std::move(descriptor));
  }
}

SegmentFile::~SegmentFile()
{
  Pool& pool = Open();
  std::lock_guard<std::mutex> lock(pool.Mutex);
  pool.Files.erase(std::remove(pool.Files.begin(), pool.Files.end(), this), pool.Files.end());
}

std::shared_ptr<const SegmentFile::Descriptor> SegmentFile::OpenNow() const
{
  // Not blocking: a pipe of that name must not hang the caller.
  const auto attempt = [this]
  { return open(this->FilePath.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); };
  int number = attempt();
  while (number < 0 && (errno == EMFILE || errno == ENFILE))
  {
    Pool& pool = Open();
    std::lock_guard<std::mutex> lock(pool.Mutex);
    if (!pool.CloseOne())
    {
      errno = EMFILE;
      break;
    }
    number = attempt();
  }
  if (number < 0)
  {
    const int code = errno;
    throw Error(
      std::string("A segment of the series cannot be opened: ") + std::strerror(code) +
        (code == ENOENT ? ". If the series was replaced or moved meanwhile, open it again" : ""),
      { this->FilePath });
  }
  auto descriptor = std::make_shared<const Descriptor>(number);
  struct stat status = {};
  const bool plain = fstat(number, &status) == 0 && S_ISREG(status.st_mode);
  const std::uint64_t size = plain ? static_cast<std::uint64_t>(status.st_size) : 0;
  if (size != this->Size || size < segment::HeaderBytes)
  {
    throw Error("A segment of the series does not have the size that the index says: it is cut "
                "short, or not of this series",
      { this->FilePath, {}, size, this->Size });
  }
  return descriptor;
}

std::shared_ptr<const SegmentFile::Descriptor> SegmentFile::Opened() const
{
  Pool& pool = Open();
  {
    std::lock_guard<std::mutex> lock(pool.Mutex);
    this->Used = ++pool.Clock;
    if (this->Kept)
    {
      return this->Kept;
    }
  }
  std::shared_ptr<const Descriptor> descriptor = this->OpenNow();
  std::lock_guard<std::mutex> lock(pool.Mutex);
  if (!this->Kept)
  {
    while (pool.Files.size() >= std::max<std::size_t>(1, MostOpen()) && pool.CloseOne())
    {
    }
    pool.Keep(*this, descriptor);
  }
  return descriptor;
}

void SegmentFile::Read(std::uint64_t offset, void* to, std::size_t bytes) const
{
  const std::shared_ptr<const Descriptor> descriptor = this->Opened();
  char* next = static_cast<char*>(to);
  while (bytes > 0)
  {
    const ssize_t got = pread(descriptor->Number, next, bytes, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR)
    {
      continue;
    }
    if (got <= 0)
    {
      throw Error(got < 0
                    ? std::string("A segment of the series cannot be read: ") + std::strerror(errno)
                    : "A segment of the series was cut short while it was open",
        { this->FilePath, offset });
    }
    next += got;
    offset += static_cast<std::uint64_t>(got);
    bytes -= static_cast<std::size_t>(got);
  }
}

Bytes SegmentFile::Read(std::uint64_t offset, std::size_t bytes) const
{
  banyan::Bytes content(bytes);
  this->Read(offset, content.data(), bytes);
  return content;
}

void SegmentFile::Expect(std::uint64_t offset, std::uint64_t bytes) const
{
  (void)posix_fadvise(this->Opened()->Number, static_cast<off_t>(offset), static_cast<off_t>(bytes),
    POSIX_FADV_WILLNEED);
}

} // namespace banyan
