// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_PropertyNumber_h
#define banyan_Base_PropertyNumber_h

#include <string>

namespace banyan
{

/// Returns how messages call a property: by its label in ParaView's panel and by its name in
/// scripts, as "'Error Bound' (ErrorBound)". A name of one word, or one with blanks, stays as it
/// is.
std::string CalledInMessages(const std::string& property);

/// Says what is wrong with the number that a property was set to: NaN, infinite or, where it may
/// not be, negative. A sentence that names both, or nothing.
std::string ProblemOfNumber(const std::string& property, double value, bool mayBeNegative = false);

/// The same as an Error.
void RequireNumber(const std::string& property, double value, bool mayBeNegative = false);

} // namespace banyan

#endif
