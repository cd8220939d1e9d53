// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_GroupNodes_h
#define banyan_Series_Encode_GroupNodes_h

#include "Codec/BlockEncoder.h"
#include "Series/Encode/FieldGroup.h"
#include "Series/Format/Exceptions.h"
#include "Series/Grid/PlaneRegion.h"

#include <vector>

namespace banyan
{

/// Holds what a step decodes to.
struct DecodedStep
{
  std::vector<PlaneNumbers> Planes;
  std::vector<std::vector<BlockExtremes>>
    Extremes; ///< of the blocks of each plane but the coarsest
  /// The steps that these blocks' numbers are those of: their own, or one that they were left as
  /// they are in, which may be StepBefore.
  std::vector<std::vector<int>> Origins;
};

/// Fills the nodes of all steps and levels.
template <class T>
void MakeNodes(const FieldGroup& field, const group::FieldHead& head,
  const std::vector<DecodedStep>& decoded, std::vector<EncodedStep>& steps, ThreadPool& pool);

} // namespace banyan

#endif
