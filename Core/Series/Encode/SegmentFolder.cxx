// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/SegmentFolder.h"

#include "Base/Error.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <random>

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

namespace banyan
{
namespace
{

const std::string Suffix = ".seg";
const std::string MeshSuffix = ".mesh";
const std::string PointsSuffix = ".points";
const std::string Suffixes[] = { Suffix, MeshSuffix, PointsSuffix };
const std::string PartSuffix = ".part";  // behind one of these
const std::string ListSuffix = ".files"; // of those that a run has written
const std::string Digits = "0123456789abcdef";
constexpr std::size_t RunDigits = 16;

std::string MakeRunId()
{
  static std::atomic<std::uint64_t> runs{ 0 };
  std::random_device device;
  const std::uint64_t parts[] = { device(), device(), static_cast<std::uint64_t>(getpid()), runs++,
    static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count()) };
  char text[17];
  std::snprintf(text, sizeof(text), "%016llx",
    static_cast<unsigned long long>(ShortHashOf(parts, sizeof(parts))));
  return text;
}

std::string NumberOf(int segment)
{
  char number[16];
  std::snprintf(number, sizeof(number), "-%06d", segment);
  return number + Suffix;
}

bool EndsWith(const std::string& text, const std::string& end)
{
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool Contains(const std::vector<std::string>& names, const std::string& name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether a file name is one that `NameOf` makes, of any run.
bool IsSegmentName(const std::string& name)
{
  return name.size() > RunDigits + 1 && name[RunDigits] == '-' &&
         name.find_first_not_of(Digits) == RunDigits && name.find('/') == std::string::npos &&
         std::any_of(std::begin(Suffixes), std::end(Suffixes),
           [&name](const std::string& suffix)
           { return EndsWith(name, suffix) || EndsWith(name, suffix + PartSuffix); });
}

std::vector<std::string> NamesIn(const std::string& folder)
{
  std::vector<std::string> names;
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(opendir(folder.c_str()), closedir);
  while (const dirent* entry = listing ? readdir(listing.get()) : nullptr)
  {
    names.emplace_back(entry->d_name);
  }
  return names;
}

/// Whether a folder is reached through a link and is that of another series, too.
bool IsOfAnother(const std::string& folder)
{
  struct stat status = {};
  const std::unique_ptr<char, void (*)(void*)> real(realpath(folder.c_str(), nullptr), std::free);
  if (lstat(folder.c_str(), &status) != 0 || !S_ISLNK(status.st_mode) || !real)
  {
    return false;
  }
  const std::string path = real.get();
  return EndsWith(path, ".d") && lstat(path.substr(0, path.size() - 2).c_str(), &status) == 0;
}

void RemoveWhere(
  const std::string& folder, const std::function<bool(const std::string&)>& wanted) noexcept
{
  for (const std::string& name : NamesIn(folder))
  {
    if (IsSegmentName(name) && wanted(name))
    {
      (void)unlink((folder + "/" + name).c_str());
    }
  }
}

} // namespace

SegmentFolder::SegmentFolder(const std::string& seriesPath)
  : FolderPath(seriesPath + ".d")
  , Process(getpid())
  , Run(MakeRunId())
{
  if (mkdir(this->FolderPath.c_str(), 0777) == 0)
  {
    this->Made = true;
    return;
  }
  const int code = errno;
  struct stat status = {};
  if (code != EEXIST || stat(this->FolderPath.c_str(), &status) != 0 || !S_ISDIR(status.st_mode))
  {
    throw Error(std::string("The folder of the series cannot be made: ") + std::strerror(code),
      { this->FolderPath });
  }
}

SegmentFolder::~SegmentFolder()
{
  if (!this->Own.empty() && this->Process == getpid())
  {
    (void)unlink(this->ListPath().c_str());
  }
}

std::string SegmentFolder::ListPath() const
{
  return this->FolderPath + "/" + this->Run + ListSuffix;
}

std::string SegmentFolder::TemporaryNameOf(int segment) const
{
  return this->Run + NumberOf(segment);
}

std::string SegmentFolder::FinalNameOf(const Hash128& content)
{
  return this->NameOf(content, Suffix);
}

std::string SegmentFolder::FinalNameOfMesh(const Hash128& content)
{
  return this->NameOf(content, MeshSuffix);
}

PointsPlace SegmentFolder::PlaceOfPoints()
{
  return { this->FolderPath, this->Run + "-" + PointsSuffix,
    [this](const Hash128& head) { return this->NameOf(head, PointsSuffix); } };
}

std::string SegmentFolder::NameOf(const Hash128& content, const std::string& suffix)
{
  const std::string hash = ToHex(content);
  const std::string name = hash.substr(16) + "-" + hash.substr(0, 16) + suffix;
  struct stat status = {};
  if (lstat((this->FolderPath + "/" + name).c_str(), &status) != 0)
  {
    this->Own.push_back(name);
    // Where it cannot be written, neither can the segment, or a killed save leaves files behind.
    std::ofstream(this->ListPath(), std::ios::app) << name << std::endl;
  }
  return name;
}

void SegmentFolder::RemoveOwn(const std::vector<std::string>& names) noexcept
{
  if (this->Process != getpid())
  {
    return; // a copy in a process that was started meanwhile
  }
  RemoveWhere(this->FolderPath,
    [this, &names](const std::string& name)
    {
      const bool own = name.compare(0, RunDigits, this->Run) == 0 || Contains(this->Own, name);
      return own && !Contains(names, name);
    });
  (void)unlink(this->ListPath().c_str());
  if (this->Made)
  {
    (void)rmdir(this->FolderPath.c_str()); // refuses when somebody else put something there
  }
}

void SegmentFolder::RemoveReplaced(
  const std::vector<std::string>& old, const std::vector<std::string>& names) noexcept
{
  if (IsOfAnother(this->FolderPath))
  {
    return;
  }
  RemoveWhere(this->FolderPath,
    [&](const std::string& name) { return Contains(old, name) && !Contains(names, name); });
}

void SegmentFolder::RemoveLeftovers(
  const std::string& folder, const std::optional<std::vector<std::string>>& named) noexcept
{
  std::vector<std::string> lists;
  for (const std::string& name : NamesIn(folder))
  {
    if (EndsWith(name, PartSuffix) && IsSegmentName(name))
    {
      (void)unlink((folder + "/" + name).c_str());
    }
    else if (name.size() == RunDigits + ListSuffix.size() && EndsWith(name, ListSuffix) &&
             name.find_first_not_of(Digits) == RunDigits)
    {
      lists.push_back(folder + "/" + name);
    }
  }
  if (!named || IsOfAnother(folder))
  {
    return;
  }
  for (const std::string& list : lists)
  {
    std::ifstream lines(list);
    for (std::string name; std::getline(lines, name);)
    {
      if (IsSegmentName(name) && !Contains(*named, name))
      {
        (void)unlink((folder + "/" + name).c_str());
      }
    }
    (void)unlink(list.c_str());
  }
}

} // namespace banyan
