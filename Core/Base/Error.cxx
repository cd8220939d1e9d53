// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"

namespace banyan
{
namespace
{

std::string Compose(const std::string& sentence, const ErrorPlace& place)
{
  std::string details;
  const auto add = [&details](const std::string& part)
  { details += details.empty() ? part : ", " + part; };
  if (!place.File.empty())
  {
    add("file '" + place.File + "'");
  }
  if (place.Offset)
  {
    add("offset " + std::to_string(*place.Offset));
  }
  if (place.Found)
  {
    add("found " + std::to_string(*place.Found));
  }
  if (place.Allowed)
  {
    add("expected or allowed " + std::to_string(*place.Allowed));
  }
  return details.empty() ? sentence : sentence + " (" + details + ")";
}

} // namespace

Error::Error(const std::string& sentence, ErrorPlace place)
  : std::runtime_error(Compose(sentence, place))
  , Where(std::move(place))
{
}

} // namespace banyan
