// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_ProcessCores_h
#define banyan_Base_ProcessCores_h

namespace banyan
{

/// Processors that this process may run on (its launcher may have bound it to some); at least 1.
int ProcessCores();

} // namespace banyan

#endif
