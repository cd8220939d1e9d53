// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_ScalarStepTable_h
#define banyan_Testing_ScalarStepTable_h

#include "Series/Format/GroupFormat.h"

namespace banyan::testing
{

/// Reads the table of a step as Documentation/format.md says, one bit after the other, without any
/// code of the real reader. For valid tables only.
group::StepTable ReadStepTable(const Bytes& bytes, const group::TableShape& shape, int step,
  const group::TableReference& reference);

} // namespace banyan::testing

#endif
