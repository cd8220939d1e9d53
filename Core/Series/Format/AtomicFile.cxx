// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/AtomicFile.h"

#include "Base/Error.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace banyan
{
namespace
{

/// Makes a rename survive a power cut. Some file systems refuse; the data is safe there all the
/// same as far as they can tell, so that is not an error.
void SyncFolder(const std::string& folder)
{
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0)
  {
    (void)fsync(descriptor);
    (void)close(descriptor);
  }
}

} // namespace

std::string FolderOf(const std::string& path)
{
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

std::string AtomicFile::PartOf(const std::string& path)
{
  return path + ".part";
}

AtomicFile::AtomicFile(const std::string& path)
  : Path(path)
  , PartPath(PartOf(path))
{
  // Leftovers of a killed process go; the target of a link of that name stays.
  (void)unlink(this->PartPath.c_str());
  this->Descriptor = open(this->PartPath.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (this->Descriptor < 0)
  {
    throw Error(
      std::string("The file cannot be created: ") + std::strerror(errno), { this->PartPath });
  }
}

AtomicFile::~AtomicFile()
{
  this->Discard();
}

void AtomicFile::Discard() noexcept
{
  if (this->Descriptor >= 0)
  {
    (void)close(this->Descriptor);
    this->Descriptor = -1;
    (void)unlink(this->PartPath.c_str());
  }
}

void AtomicFile::Fail(const std::string& what, int code)
{
  this->Discard();
  throw Error(what + ": " + std::strerror(code), { this->Path });
}

void AtomicFile::Append(const void* data, std::size_t bytes)
{
  this->Overwrite(this->Written, data, bytes);
  this->Written += bytes;
}

void AtomicFile::Overwrite(std::uint64_t offset, const void* data, std::size_t bytes)
{
  if (this->Descriptor < 0)
  {
    throw Error("The file was given up after an error", { this->Path });
  }
  const char* from = static_cast<const char*>(data);
  while (bytes > 0)
  {
    const ssize_t done = pwrite(this->Descriptor, from, bytes, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR)
    {
      continue;
    }
    if (done <= 0)
    {
      this->Fail("The file cannot be written", done < 0 ? errno : ENOSPC);
    }
    from += done;
    offset += static_cast<std::uint64_t>(done);
    bytes -= static_cast<std::size_t>(done);
  }
}

void AtomicFile::Commit()
{
  if (this->Descriptor < 0)
  {
    throw Error("The file was given up after an error", { this->Path });
  }
  if (fsync(this->Descriptor) != 0 && errno != EINVAL && errno != EROFS)
  {
    this->Fail("The file cannot be brought to the disk", errno);
  }
  const int descriptor = this->Descriptor;
  this->Descriptor = -1;
  if (close(descriptor) != 0)
  {
    const int code = errno;
    (void)unlink(this->PartPath.c_str());
    this->Fail("The file cannot be closed", code);
  }
  if (std::rename(this->PartPath.c_str(), this->Path.c_str()) != 0)
  {
    const int code = errno;
    (void)unlink(this->PartPath.c_str());
    this->Fail("The file cannot take its name", code);
  }
  SyncFolder(FolderOf(this->Path));
}

void AtomicFile::CommitAs(const std::string& path)
{
  this->Path = path;
  this->Commit();
}

void WriteFileAtomically(const std::string& path, const std::string& content)
{
  AtomicFile file(path);
  file.Append(content.data(), content.size());
  file.Commit();
}

std::string ReadWholeFile(const std::string& path, std::uint64_t limit)
{
  // Not blocking: a pipe of that name must not hang the caller.
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat status = {};
  if (descriptor < 0 || fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode))
  {
    const std::string why = descriptor < 0 ? std::strerror(errno) : "it is not an ordinary file";
    if (descriptor >= 0)
    {
      (void)close(descriptor);
    }
    throw Error("The file cannot be read: " + why, { path });
  }
  const std::uint64_t size = static_cast<std::uint64_t>(status.st_size);
  if (size > limit)
  {
    (void)close(descriptor);
    throw Error("The file is too large to be an index", { path, {}, size, limit });
  }
  std::string content(static_cast<std::size_t>(size), '\0');
  std::size_t position = 0;
  while (position < content.size())
  {
    const ssize_t got = read(descriptor, content.data() + position, content.size() - position);
    if (got < 0 && errno == EINTR)
    {
      continue;
    }
    if (got <= 0)
    {
      break; // shorter than it was a moment ago; whoever parses the content will notice
    }
    position += static_cast<std::size_t>(got);
  }
  (void)close(descriptor);
  content.resize(position);
  return content;
}

} // namespace banyan
