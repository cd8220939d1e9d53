// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_SeriesLock_h
#define banyan_Series_Encode_SeriesLock_h

#include <string>

#include <sys/types.h>

namespace banyan
{

/// One save of a series at a time: held from before the first file is written until the last one is
/// there. Where several processes save one series together, one holds it for all.
///
/// It is a lock of the system on a file in the series' folder, of which the file says who holds it.
/// It ends with the process, however that ends; a file that is left behind, and processes that this
/// one started, hold nothing. It also holds between threads of a process. Where the file system has
/// no locks (some network file systems), everybody gets it.
class SeriesLock
{
public:
  /// Makes the folder where it is not there yet, and clears away what saves that were killed have
  /// left in it, apart from what the index of the series names.
  /// @param seriesPath of the index file, which is no link (see FollowLinks)
  /// Throws Error that says who holds the lock, that the folder or the index cannot be written, or
  /// that something other than a file has the name of the series.
  explicit SeriesLock(const std::string& seriesPath);
  /// The folder goes as well if it was made here and is empty.
  ~SeriesLock();
  SeriesLock(const SeriesLock&) = delete;
  SeriesLock& operator=(const SeriesLock&) = delete;

private:
  int OpenFile() const;
  void LockFile(int descriptor);
  bool TryTake();
  void CheckPath() const;
  void ClearLeftovers() const;
  void TryIndex() const;
  void GiveBack();

  std::string Path;
  std::string Folder;
  std::string File;
  bool Made = false;   ///< the folder
  bool Locked = false; ///< not where the file system has no locks
  int Descriptor = -1;
  dev_t Device = 0; ///< these two of the folder
  ino_t Inode = 0;
  pid_t Process;
};

} // namespace banyan

#endif
