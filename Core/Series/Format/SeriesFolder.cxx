// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/SeriesFolder.h"

#include "Base/Error.h"
#include "Series/Format/AtomicFile.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <vector>

#include <dirent.h>
#include <sys/stat.h>

namespace banyan
{
namespace
{

const std::string Suffix = ".d";

/// Sizes of the files that an index names, by name.
std::map<std::string, std::uint64_t> FilesOf(const SeriesIndex& index)
{
  std::map<std::string, std::uint64_t> files;
  for (const SegmentIndex& segment : index.Segments)
  {
    files[segment.File] = segment.Bytes;
  }
  if (index.Mesh)
  {
    files[index.Mesh->File] = index.Mesh->Bytes;
  }
  for (const PointsFile& points : index.FilesOfPoints())
  {
    files[points.File] = points.Bytes;
  }
  return files;
}

std::string NameOf(const std::string& path)
{
  return path.substr(path.find_last_of('/') + 1);
}

/// How much of a series a folder has.
struct Holding
{
  std::string Folder;
  std::size_t Present = 0; ///< files
  std::size_t Whole = 0;   ///< of these, files of the right size
  std::string Missing;     ///< the first file that cannot be seen
  int Code = 0;            ///< and why
};

Holding Look(const std::string& folder, const std::map<std::string, std::uint64_t>& files)
{
  Holding holding;
  holding.Folder = folder;
  for (const auto& [name, bytes] : files)
  {
    struct stat status = {};
    if (stat((folder + "/" + name).c_str(), &status) != 0)
    {
      holding.Code = holding.Code == 0 ? errno : holding.Code;
      holding.Missing = holding.Missing.empty() ? name : holding.Missing;
      continue;
    }
    ++holding.Present;
    holding.Whole += static_cast<std::uint64_t>(status.st_size) == bytes ? 1 : 0;
  }
  return holding;
}

/// Where the links of a path lead to in the end; the path itself when that cannot be found out.
std::string TargetOf(const std::string& path)
{
  const std::unique_ptr<char, void (*)(void*)> target(realpath(path.c_str(), nullptr), std::free);
  return target ? target.get() : path;
}

/// The folders `*.d` beside a file that have at least one file of the series.
void LookAround(const std::string& path, const std::map<std::string, std::uint64_t>& files,
  std::vector<Holding>& found)
{
  const std::string place = FolderOf(path);
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(opendir(place.c_str()), closedir);
  while (const dirent* entry = listing ? readdir(listing.get()) : nullptr)
  {
    const std::string name = entry->d_name;
    if (name.size() <= Suffix.size() ||
        name.compare(name.size() - Suffix.size(), Suffix.size(), Suffix) != 0)
    {
      continue;
    }
    const Holding holding = Look(place + "/" + name, files);
    if (holding.Present > 0)
    {
      found.push_back(holding);
    }
  }
}

/// Several names of one folder, through links, are one.
void DropRepeated(std::vector<Holding>& found)
{
  std::sort(found.begin(), found.end(),
    [](const Holding& a, const Holding& b) { return a.Folder < b.Folder; });
  std::vector<std::string> seen;
  const auto repeated = [&seen](const Holding& holding)
  {
    const std::string target = TargetOf(holding.Folder);
    const bool known = std::find(seen.begin(), seen.end(), target) != seen.end();
    seen.push_back(target);
    return known;
  };
  found.erase(std::remove_if(found.begin(), found.end(), repeated), found.end());
}

/// " (nor beside TARGET, which it is a link to)", or nothing.
std::string BesideTarget(const std::string& path)
{
  const std::string target = TargetOf(path);
  const bool linked = target != TargetOf(FolderOf(path)) + "/" + NameOf(path);
  return linked ? " (nor beside " + target + ", which it is a link to)" : "";
}

[[noreturn]] void Refuse(const std::string& path, const Holding& best, std::size_t files,
  const std::vector<Holding>& others)
{
  const std::string wanted = NameOf(path) + Suffix;
  std::string sentence;
  if (best.Code != 0 && best.Code != ENOENT)
  {
    sentence =
      "The folder " + best.Folder + " of the series cannot be read: " + std::strerror(best.Code);
  }
  else if (best.Present > 0)
  {
    sentence = "In the folder " + best.Folder + " " + std::to_string(files - best.Present) +
               " of the " + std::to_string(files) +
               " files of the series cannot be found, the first one is " + best.Missing +
               ": copy the folder again, whole";
  }
  else
  {
    struct stat status = {};
    const bool there = stat(best.Folder.c_str(), &status) == 0;
    const std::string segments = std::to_string(files) + (files == 1 ? " segment" : " segments");
    sentence = "The folder " + wanted +
               (there ? " has none of the " + segments + " of the series"
                      : " is missing beside " + NameOf(path) + BesideTarget(path) +
                          ": it holds the " + segments + " of the series") +
               ". A series is its file and its folder: copy or move both";
  }
  for (const Holding& other : others)
  {
    sentence += (&other == others.data() ? ". There is " : ", and ") + other.Folder + " with " +
                std::to_string(other.Present) + " of them";
  }
  sentence += others.empty() ? "" : ": if it is the right one, rename it to " + wanted;
  throw Error(sentence, { path });
}

} // namespace

bool BeginsInFolder(const std::string& folder, const SeriesIndex& index)
{
  const auto has = [&folder](const std::string& name)
  {
    struct stat status = {};
    return stat((folder + "/" + name).c_str(), &status) == 0;
  };
  return (index.Segments.empty() || has(index.Segments.front().File)) &&
         (!index.Mesh || has(index.Mesh->File)) &&
         (!index.Points || index.Points->Files.empty() || has(index.Points->Files.front().File));
}

void RefuseFolder(const std::string& path)
{
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0 || !S_ISDIR(status.st_mode))
  {
    return;
  }
  const std::string folder = path.substr(0, path.find_last_not_of('/') + 1);
  const std::string stem = folder.substr(0, folder.size() - std::min(folder.size(), Suffix.size()));
  const bool ofSeries = stem + Suffix == folder && stat(stem.c_str(), &status) == 0;
  throw Error("This is a folder: open the file of the series" +
                (ofSeries ? ", " + NameOf(stem) + " beside it" : std::string(", name.banyan")),
    { path });
}

std::string FindSeriesFolder(const std::string& path, const SeriesIndex& index)
{
  const std::map<std::string, std::uint64_t> files = FilesOf(index);
  const Holding beside = Look(path + Suffix, files);
  if (beside.Whole == files.size())
  {
    return beside.Folder;
  }
  const std::string target = TargetOf(path);
  const Holding beyond = Look(target + Suffix, files);
  if (beyond.Whole == files.size())
  {
    return beyond.Folder;
  }
  std::vector<Holding> others;
  LookAround(path, files, others);
  LookAround(target, files, others);
  DropRepeated(others);
  std::vector<Holding> whole;
  std::copy_if(others.begin(), others.end(), std::back_inserter(whole),
    [&files](const Holding& holding) { return holding.Whole == files.size(); });
  if (whole.size() == 1)
  {
    return whole[0].Folder;
  }
  for (const Holding* named : { &beside, &beyond })
  {
    if (named->Present == files.size())
    {
      return named->Folder;
    }
  }
  const Holding& best = beyond.Present > beside.Present ? beyond : beside;
  const auto same = [&best](const Holding& holding)
  { return TargetOf(holding.Folder) == TargetOf(best.Folder); };
  others.erase(std::remove_if(others.begin(), others.end(), same), others.end());
  Refuse(path, best, files.size(), whole.empty() ? others : whole);
}

} // namespace banyan
