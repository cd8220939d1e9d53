// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_SeriesPath_h
#define banyan_Series_Format_SeriesPath_h

#include <string>

namespace banyan
{

/// Where a file lies that is reached through symbolic links, as a path beside which the folder of
/// its series belongs: the path itself where it is no link. The last link's target need not
/// exist. Throws Error when links lead in a circle.
std::string FollowLinks(const std::string& path);

} // namespace banyan

#endif
