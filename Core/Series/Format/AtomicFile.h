// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_AtomicFile_h
#define banyan_Series_Format_AtomicFile_h

#include <cstddef>
#include <cstdint>
#include <string>

namespace banyan
{

/// A file under a temporary name that takes its own name when it is whole. Every write is checked.
/// Destroyed before `Commit()`, it leaves nothing behind.
class AtomicFile
{
public:
  /// The temporary name: `path + ".part"`.
  static std::string PartOf(const std::string& path);
  /// Creates it; one that was there goes. Throws Error when it cannot.
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends. Throws Error (disk full, quota, ...), which names the file.
  void Append(const void* data, std::size_t bytes);
  /// Overwrites bytes that were appended before.
  void Overwrite(std::uint64_t offset, const void* data, std::size_t bytes);
  /// Bytes appended so far.
  std::uint64_t Size() const { return this->Written; }

  /// Brings everything to the disk and renames. Throws Error.
  void Commit();

  /// Does the same as Commit, under another name (in the same folder) than the one given at first.
  void CommitAs(const std::string& path);

private:
  void Discard() noexcept;
  [[noreturn]] void Fail(const std::string& what, int code);

  std::string Path;
  std::string PartPath;
  int Descriptor = -1;
  std::uint64_t Written = 0;
};

/// Replaces a file by a new content: either the old or the new one is there at any time.
void WriteFileAtomically(const std::string& path, const std::string& content);

/// Reads a whole file. Throws Error when it cannot be read or is larger than `limit` bytes (checked
/// before memory is taken).
std::string ReadWholeFile(const std::string& path, std::uint64_t limit);

/// The folder part of a path ("." when there is none).
std::string FolderOf(const std::string& path);

} // namespace banyan

#endif
