// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/SeriesLock.h"

#include "Base/Error.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Encode/SeriesAssembly.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Format/IndexText.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace banyan
{
namespace
{

/// Locks of the system are those of processes. These are of one: folders, and who holds them.
struct Holders
{
  struct Holder
  {
    pid_t Process; ///< of what was copied when this one was started, another one
    std::string Who;
  };
  std::mutex Mutex;
  std::map<std::pair<dev_t, ino_t>, Holder> ByFolder;
};

Holders& OfProcess()
{
  static Holders* const holders =
    new Holders; // never destroyed: saves may last as long as the process
  return *holders;
}

std::string Me()
{
  char host[256] = "";
  (void)gethostname(host, sizeof(host) - 1);
  const std::time_t now = std::time(nullptr);
  std::tm parts = {};
  char time[32] = "";
  std::strftime(time, sizeof(time), "%Y-%m-%d %H:%M:%S UTC", gmtime_r(&now, &parts));
  return "process " + std::to_string(getpid()) + " on " + host + ", since " + time;
}

/// The text in the file of a lock. Its holder may not have written it yet.
std::string HolderIn(int descriptor)
{
  char text[512];
  ssize_t length = 0;
  for (int attempt = 0; attempt < 20 && length <= 0; ++attempt)
  {
    if (attempt > 0)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    length = pread(descriptor, text, sizeof(text), 0);
  }
  std::string who(text, static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
  who.erase(
    std::find_if(who.begin(), who.end(), [](char c) { return c < ' ' || c > '~'; }), who.end());
  return who.empty() ? "another process" : who;
}

[[noreturn]] void Refuse(const std::string& who, const std::string& path)
{
  throw Error("Another save of this series is under way (" + who +
                "). Wait until it has ended, or choose another name",
    { path });
}

[[noreturn]] void Fail(const std::string& folder, int code)
{
  throw Error(
    std::string("The folder of the series cannot be written: ") + std::strerror(code), { folder });
}

bool HasNoLocks(int code)
{
  return code == ENOLCK || code == ENOSYS || code == ENOTSUP || code == EOPNOTSUPP ||
         code == EINVAL;
}

} // namespace

SeriesLock::SeriesLock(const std::string& seriesPath)
  : Path(seriesPath)
  , Folder(seriesPath + ".d")
  , File(Folder + "/saving.lock")
  , Process(getpid())
{
  this->CheckPath();
  Holders& holders = OfProcess();
  // Nobody else of this process may open the file meanwhile: to close it again would end the lock.
  std::lock_guard<std::mutex> lock(holders.Mutex);
  constexpr int attempts = 1000;
  for (int attempt = 0; attempt < attempts; ++attempt)
  {
    this->Made = mkdir(this->Folder.c_str(), 0777) == 0 || this->Made;
    const int code = errno;
    struct stat status = {};
    if (stat(this->Folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode))
    {
      if (code == EEXIST && lstat(this->Folder.c_str(), &status) != 0)
      {
        continue; // it went meanwhile
      }
      const std::string why =
        code == EEXIST ? "a file, or a link that leads nowhere, has its name" : std::strerror(code);
      throw Error("The folder of the series cannot be made: " + why, { this->Folder });
    }
    this->Device = status.st_dev;
    this->Inode = status.st_ino;
    const auto found = holders.ByFolder.find({ this->Device, this->Inode });
    if (found != holders.ByFolder.end() && found->second.Process == this->Process)
    {
      Refuse(found->second.Who, this->Path);
    }
    if (this->TryTake())
    {
      holders.ByFolder[{ this->Device, this->Inode }] = { this->Process, Me() };
      this->ClearLeftovers();
      try
      {
        this->TryIndex();
      }
      catch (const Error&)
      {
        this->GiveBack();
        throw;
      }
      return;
    }
  }
  throw Error(
    "The series cannot be written: other programs write it again and again. Wait until they have "
    "ended, or choose another name",
    { this->Path });
}

/// Finds out early what would otherwise fail when everything is encoded.
void SeriesLock::CheckPath() const
{
  struct stat status = {};
  if (stat(this->Path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
  {
    throw Error(S_ISDIR(status.st_mode) ? "The series cannot be written: a folder has its name. "
                                          "Choose another name"
                                        : "The series cannot be written: something other than a "
                                          "file has its name. Choose another name",
      { this->Path });
  }
}

/// @return the descriptor of the file of the lock, or -1 when somebody has just removed its folder
int SeriesLock::OpenFile() const
{
  struct stat folder = {};
  const int descriptor =
    open(this->File.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  if (descriptor < 0)
  {
    const int code = errno;
    if (code == ENOENT && stat(this->Folder.c_str(), &folder) != 0)
    {
      return -1;
    }
    if (this->Made)
    {
      (void)rmdir(this->Folder.c_str());
    }
    if (code == EISDIR || code == ELOOP)
    {
      throw Error(
        "The lock of the series cannot be made: a folder or a link has its name. Remove that",
        { this->File });
    }
    Fail(this->Folder, code);
  }
  // Whoever may write into the folder may lock it.
  if (stat(this->Folder.c_str(), &folder) == 0)
  {
    (void)fchmod(descriptor, folder.st_mode & 0666);
  }
  return descriptor;
}

/// Locks the file, where the file system has locks. Closes it before it throws.
void SeriesLock::LockFile(int descriptor)
{
  struct flock whole = {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  if (fcntl(descriptor, F_SETLK, &whole) != 0)
  {
    const int code = errno;
    if (code == EAGAIN || code == EACCES)
    {
      const std::string who = HolderIn(descriptor);
      (void)close(descriptor);
      Refuse(who, this->Path);
    }
    if (!HasNoLocks(code))
    {
      (void)close(descriptor);
      Fail(this->Folder, code);
    }
  }
  else
  {
    this->Locked = true;
  }
}

/// @return false when the file is that of somebody who has just ended
bool SeriesLock::TryTake()
{
  const int descriptor = this->OpenFile();
  if (descriptor < 0)
  {
    return false;
  }
  this->LockFile(descriptor);
  struct stat mine = {}, named = {};
  if (fstat(descriptor, &mine) != 0 || lstat(this->File.c_str(), &named) != 0 ||
      mine.st_dev != named.st_dev || mine.st_ino != named.st_ino)
  {
    (void)close(descriptor);
    this->Locked = false;
    return false;
  }
  this->Descriptor = descriptor;
  const std::string me = Me() + "\n";
  // Where the disk is full, others hear less.
  (void)!ftruncate(descriptor, 0);
  (void)!pwrite(descriptor, me.data(), me.size(), 0);
  return true;
}

void SeriesLock::ClearLeftovers() const
{
  if (this->Locked)
  {
    SegmentFolder::RemoveLeftovers(this->Folder, FilesOfIndex(this->Path));
  }
}

/// Finds out early, too: the index comes last, into another folder, and may have a name too long.
void SeriesLock::TryIndex() const
{
  if (!this->Locked)
  {
    return;
  }
  const std::string part = AtomicFile::PartOf(this->Path);
  struct stat status = {};
  if (lstat(part.c_str(), &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0 &&
      !BeginsAsSeries(part))
  {
    throw Error("A file that is no series has the name that the new index has while it is written. "
                "Move it, or give it another name",
      { part });
  }
  const AtomicFile index(this->Path); // and goes
}

SeriesLock::~SeriesLock()
{
  if (this->Process != getpid())
  {
    (void)close(this->Descriptor); // a copy, which holds nothing
    return;
  }
  std::lock_guard<std::mutex> lock(OfProcess().Mutex);
  this->GiveBack();
}

/// The mutex of the holders is locked.
void SeriesLock::GiveBack()
{
  (void)unlink(this->File.c_str()); // while it is held: nobody takes one that has no name
  (void)close(this->Descriptor);
  if (this->Made)
  {
    (void)rmdir(this->Folder.c_str());
  }
  OfProcess().ByFolder.erase({ this->Device, this->Inode });
}

} // namespace banyan
