// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/SeriesPath.h"

#include "Base/Error.h"
#include "Series/Format/AtomicFile.h"

#include <climits>

#include <unistd.h>

namespace banyan
{

std::string FollowLinks(const std::string& path)
{
  constexpr int most = 40; // as the system does
  std::string at = path;
  for (int links = 0; links < most; ++links)
  {
    char target[PATH_MAX];
    const ssize_t length = readlink(at.c_str(), target, sizeof(target));
    if (length < 0)
    {
      return at; // no link, or nothing
    }
    const std::string next(target, static_cast<std::size_t>(length));
    at = next[0] == '/' ? next : FolderOf(at) + "/" + next;
  }
  throw Error("The symbolic links of the series lead in a circle", { path });
}

} // namespace banyan
