#include "Series/SegmentFolder.h"

#include "Base/Error.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
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
const std::string PartSuffix = ".part"; // behind one of these

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

/// Whether a file name is one that `NameOf` makes, of any run.
bool IsSegmentName(const std::string& name)
{
  return name.size() > 17 && name[16] == '-' && name.find_first_not_of("0123456789abcdef") == 16 &&
         (EndsWith(name, Suffix) || EndsWith(name, Suffix + PartSuffix) ||
           EndsWith(name, MeshSuffix) || EndsWith(name, MeshSuffix + PartSuffix));
}

void RemoveWhere(
  const std::string& folder, const std::function<bool(const std::string&)>& wanted) noexcept
{
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(opendir(folder.c_str()), closedir);
  while (const dirent* entry = listing ? readdir(listing.get()) : nullptr)
  {
    const std::string name = entry->d_name;
    if (IsSegmentName(name) && wanted(name))
    {
      (void)unlink((folder + "/" + name).c_str());
    }
  }
}

} // namespace

SegmentFolder::SegmentFolder(const std::string& seriesPath)
  : FolderPath(seriesPath + ".d")
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

std::string SegmentFolder::NameOf(const Hash128& content, const std::string& suffix)
{
  const std::string hash = ToHex(content);
  const std::string name = hash.substr(16) + "-" + hash.substr(0, 16) + suffix;
  struct stat status = {};
  if (lstat((this->FolderPath + "/" + name).c_str(), &status) != 0)
  {
    this->Own.push_back(name);
  }
  return name;
}

void SegmentFolder::RemoveOwn(const std::vector<std::string>& names) noexcept
{
  RemoveWhere(this->FolderPath,
    [this, &names](const std::string& name)
    {
      const bool own = name.compare(0, 16, this->Run) == 0 ||
                       std::find(this->Own.begin(), this->Own.end(), name) != this->Own.end();
      return own && std::find(names.begin(), names.end(), name) == names.end();
    });
  if (this->Made)
  {
    (void)rmdir(this->FolderPath.c_str()); // refuses when somebody else put something there
  }
}

void SegmentFolder::RemoveAllBut(const std::vector<std::string>& names) noexcept
{
  RemoveWhere(this->FolderPath, [&names](const std::string& name)
    { return std::find(names.begin(), names.end(), name) == names.end(); });
}

} // namespace banyan
