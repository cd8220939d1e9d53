// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_AvailableMemory_h
#define banyan_Base_AvailableMemory_h

#include <cstddef>
#include <string>

namespace banyan
{

/// Bytes that this process can still be given before the kernel ends processes: the least of what
/// the machine has left, with swap, and of what each control group around the process is allowed
/// (version 2; pages of files that the kernel can drop count as free). An estimate, true for a
/// moment.
/// @param root where proc and sys are, without a slash at its end; for tests
/// @return the largest number where nothing says
std::size_t AvailableMemory(const std::string& root = {});

/// Bytes of memory, without swap, that this process may have at most: the least of what the machine
/// has and of what each control group around the process is allowed (version 2), whatever of them
/// is in use. The same from start to end.
/// @param root as above
/// @return 0 where nothing says
std::size_t MachineMemory(const std::string& root = {});

} // namespace banyan

#endif
