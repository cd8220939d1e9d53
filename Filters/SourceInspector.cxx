// SPDX-License-Identifier: BSD-3-Clause
#include "SourceInspector.h"

namespace banyan
{
namespace
{

std::unique_ptr<SourceInspector>& Installed()
{
  static std::unique_ptr<SourceInspector> inspector;
  return inspector;
}

} // namespace

const SourceInspector* SourceInspector::Get()
{
  return Installed().get();
}

void SourceInspector::Set(std::unique_ptr<SourceInspector> inspector)
{
  Installed() = std::move(inspector);
}

} // namespace banyan
