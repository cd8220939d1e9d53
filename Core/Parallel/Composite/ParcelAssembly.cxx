// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/ParcelAssembly.h"

#include "Base/Error.h"

#include <cstring>
#include <utility>

namespace banyan
{

std::optional<PictureParcel> ParcelAssembly::HeadOf(const void* message, std::size_t bytes)
{
  PictureParcel head;
  if (bytes < sizeof(head))
  {
    return std::nullopt;
  }
  std::memcpy(&head, message, sizeof(head));
  return head.Version == PictureParcel::ThisVersion ? std::optional<PictureParcel>(head)
                                                    : std::nullopt;
}

std::optional<ParcelAssembly::Whole> ParcelAssembly::Take(const void* message, std::size_t bytes)
{
  const PictureParcel head = *HeadOf(message, bytes);
  const auto* const content = static_cast<const std::uint8_t*>(message) + sizeof(head);
  const std::size_t more = bytes - sizeof(head);
  if (head.Begin == 0)
  {
    this->Begun.clear();
  }
  if (head.Begin != this->Begun.size() || more > head.Bytes - head.Begin)
  {
    this->Begun.clear();
    throw Error("A part of a picture from the server is missing.");
  }
  this->Begun.insert(this->Begun.end(), content, content + more);
  if (this->Begun.size() < head.Bytes)
  {
    return std::nullopt;
  }
  return Whole{ head, std::exchange(this->Begun, {}) };
}

} // namespace banyan
