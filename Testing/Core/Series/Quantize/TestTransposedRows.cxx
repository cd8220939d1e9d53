// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/TransposedRows.h"
#include "Targets.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace banyan
{
namespace
{

template <class Number>
void ExpectSheets()
{
  constexpr int fromRow = 37, toRow = 41, most = 33;
  std::vector<Number> from(fromRow * most);
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    from[i] = static_cast<Number>(i * 2654435761u);
  }
  for (const int rows : { 1, 2, 7, 8, 9, 15, 16, 17, 32, 33 })
  {
    for (const int count : { 1, 3, 8, 11, 16, 24, 33 })
    {
      std::vector<Number> to(toRow * most, Number{ 77 });
      CopyTransposed(from.data(), fromRow, rows, count, to.data(), toRow);
      for (int j = 0; j < most; ++j)
      {
        for (int i = 0; i < toRow; ++i)
        {
          const bool inside = i < rows && j < count;
          ASSERT_EQ(to[static_cast<std::size_t>(j * toRow + i)],
            inside ? from[static_cast<std::size_t>(i * fromRow + j)] : Number{ 77 })
            << i << ", " << j << " of " << rows << " x " << count;
        }
      }
    }
  }
}

TEST(TransposedRows, RowsBecomeColumnsAndNothingElseChanges)
{
  for (const std::int64_t target : targets::OfThisMachine())
  {
    SCOPED_TRACE(hwy::TargetName(target));
    const targets::OnlyTarget only(target);
    ExpectSheets<std::int16_t>();
    ExpectSheets<std::int32_t>();
  }
}

} // namespace
} // namespace banyan
