// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/HashedQuestions.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Communicate/ExchangeBytes.h"

#include <utility>

namespace banyan
{

HashedQuestions::HashedQuestions(int ranks, std::size_t bytes)
  : Size(bytes)
  , Messages(static_cast<std::size_t>(ranks))
{
}

std::uint8_t* HashedQuestions::Add(std::uint64_t hash)
{
  const std::uint64_t rank = hash % this->Messages.size();
  this->Ranks.push_back(static_cast<std::uint32_t>(rank));
  Bytes& message = this->Messages[rank];
  message.resize(message.size() + this->Size);
  return message.data() + message.size() - this->Size;
}

Bytes HashedQuestions::Ask(
  Communicator& communicator, std::size_t bytes, const Answer& answer, std::string failure)
{
  const std::vector<Bytes> asked =
    ExchangeBytes(communicator, std::move(this->Messages), std::move(failure));
  failure.clear();
  std::vector<Bytes> answers;
  Attempt(failure, [&] { answers = answer(asked); });
  const std::vector<Bytes> from = ExchangeBytes(communicator, std::move(answers), failure);
  Bytes all;
  Attempt(failure,
    [&]
    {
      all.resize(this->Ranks.size() * bytes);
      std::vector<std::size_t> taken(from.size(), 0);
      for (std::size_t i = 0; i < this->Ranks.size(); ++i)
      {
        std::size_t& at = taken[this->Ranks[i]];
        std::memcpy(all.data() + i * bytes, from[this->Ranks[i]].data() + at, bytes);
        at += bytes;
      }
    });
  ThrowTogether(communicator, failure);
  return all;
}

} // namespace banyan
