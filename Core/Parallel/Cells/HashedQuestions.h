// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Cells_HashedQuestions_h
#define banyan_Parallel_Cells_HashedQuestions_h

#include "Base/Bytes.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace banyan
{

class Communicator;

/// Something that ranks have in common is found by its hash: each sends what it has to the rank
/// that the hash names, which sees all of it, and gets an answer for each record.
class HashedQuestions
{
public:
  /// @param ranks of the communicator
  /// @param bytes of a record
  HashedQuestions(int ranks, std::size_t bytes);

  /// The next record, to be filled in. Its address holds until the next call.
  std::uint8_t* Add(std::uint64_t hash);

  /// What a rank answers: by rank, one answer for each of its records, one after the other.
  using Answer = std::function<std::vector<Bytes>(const std::vector<Bytes>& asked)>;

  /// Collective, once: all answers, in the order of records.
  /// @param bytes of an answer
  /// @param failure of this rank so far
  /// Throws CollectiveError.
  Bytes Ask(
    Communicator& communicator, std::size_t bytes, const Answer& answer, std::string failure);

private:
  std::size_t Size;
  std::vector<Bytes> Messages; ///< by rank
  std::vector<std::uint32_t> Ranks;
};

/// Calls function(begin, end) for groups of records that are equal.
/// @param sorted so that equal ones follow each other
template <class Entry, class Equal, class Function>
void ForGroups(const std::vector<Entry>& sorted, Equal&& equal, Function&& function)
{
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end)
  {
    for (end = begin + 1; end < sorted.size() && equal(sorted[begin], sorted[end]);)
    {
      ++end;
    }
    function(begin, end);
  }
}

/// A record that a rank asks about.
template <class Key>
struct AskedRecord
{
  static_assert(std::is_trivially_copyable_v<Key>, "sent as it is");
  Key Of;
  std::size_t Rank;
  std::size_t Index; ///< of the rank's records
};

/// All records, rank by rank.
/// @param bytes of a record, which begins with its key
template <class Key>
std::vector<AskedRecord<Key>> RecordsOf(const std::vector<Bytes>& asked, std::size_t bytes)
{
  std::vector<AskedRecord<Key>> records;
  for (std::size_t rank = 0; rank < asked.size(); ++rank)
  {
    for (std::size_t i = 0; i < asked[rank].size() / bytes; ++i)
    {
      records.push_back({ LoadNumber<Key>(asked[rank].data() + i * bytes), rank, i });
    }
  }
  return records;
}

} // namespace banyan

#endif
