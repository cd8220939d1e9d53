// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_VerifyReport_h
#define banyan_Programs_VerifyReport_h

#include "Verification.h"

#include <string>

namespace banyan
{

/// The result for people: a table, one sentence per component that failed, and the verdict.
std::string VerificationToText(const Verification& result, const std::string& file);

/// The result as a JSON object; Documentation/howto/how-good.md explains its members. Numbers that
/// do not exist, infinite ones among them, are null.
std::string VerificationToJson(const Verification& result, const std::string& file);

} // namespace banyan

#endif
