// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_Interruption_h
#define banyan_Base_Interruption_h

#include "Base/Error.h"

namespace banyan
{

/// Work was stopped as somebody wished. Work of several ranks is stopped on all of them together.
class Interruption : public Error
{
public:
  using Error::Error;
};

} // namespace banyan

#endif
