#include "Series/MappedSegment.h"

#include "Base/Error.h"
#include "Series/SegmentFormat.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace banyan
{

MappedSegment::MappedSegment(const std::string& folder, const SegmentIndex& index)
  : FilePath(folder + "/" + index.File)
  , Size(index.Bytes)
{
  const int descriptor = open(this->FilePath.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0)
  {
    throw Error(std::string("A segment of the series cannot be opened: ") + std::strerror(errno),
      { this->FilePath });
  }
  struct stat status = {};
  const bool plain = fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  const std::uint64_t size = plain ? static_cast<std::uint64_t>(status.st_size) : 0;
  if (size != this->Size || size < segment::HeaderBytes)
  {
    (void)close(descriptor);
    throw Error("A segment of the series does not have the size that the index says: it is cut "
                "short, or not of this series",
      { this->FilePath, {}, size, this->Size });
  }
  void* data = mmap(nullptr, static_cast<std::size_t>(size), PROT_READ, MAP_SHARED, descriptor, 0);
  const int code = errno;
  (void)close(descriptor);
  if (data == MAP_FAILED)
  {
    throw Error(std::string("A segment of the series cannot be mapped: ") + std::strerror(code),
      { this->FilePath });
  }
  this->First = static_cast<const std::uint8_t*>(data);
}

MappedSegment::~MappedSegment()
{
  munmap(const_cast<std::uint8_t*>(this->First), static_cast<std::size_t>(this->Size));
}

void MappedSegment::LetGo() const
{
  (void)madvise(
    const_cast<std::uint8_t*>(this->First), static_cast<std::size_t>(this->Size), MADV_DONTNEED);
}

} // namespace banyan
