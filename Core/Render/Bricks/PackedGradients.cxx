// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/PackedBrick.h"

#include <cmath>

namespace banyan
{
namespace
{

/// The difference over the neighbours on both sides, or over the one that is usable.
/// @param before, after null where there is none
float Difference(const float* before, float here, const float* after)
{
  const bool hasBefore = before && std::isfinite(*before);
  const bool hasAfter = after && std::isfinite(*after);
  const float low = hasBefore ? *before : here;
  const float high = hasAfter ? *after : here;
  return (high - low) * (hasBefore && hasAfter ? 0.5f : 1.0f);
}

} // namespace

void PackedBrick::PlaceGradientRow(const Dense& dense, int y, int z, float scale, float* out) const
{
  const Box& have = dense.Samples;
  const int first = this->Whole.Lo.x;
  const int count = this->Whole.Size().x + 1;
  const float* row = dense.At(first, y, z);
  const float* below = y > have.Lo.y ? dense.At(first, y - 1, z) : nullptr;
  const float* above = y + 1 < have.Hi.y ? dense.At(first, y + 1, z) : nullptr;
  const float* before = z > have.Lo.z ? dense.At(first, y, z - 1) : nullptr;
  const float* behind = z + 1 < have.Hi.z ? dense.At(first, y, z + 1) : nullptr;
  const auto place = [&](int x)
  {
    const float* left = first + x > have.Lo.x ? row + x - 1 : nullptr;
    const float* right = first + x + 1 < have.Hi.x ? row + x + 1 : nullptr;
    out[4 * x] = row[x];
    out[4 * x + 1] = Difference(left, row[x], right) * scale;
    out[4 * x + 2] =
      Difference(below ? below + x : nullptr, row[x], above ? above + x : nullptr) * scale;
    out[4 * x + 3] =
      Difference(before ? before + x : nullptr, row[x], behind ? behind + x : nullptr) * scale;
  };
  if (this->HasSpecial || !below || !above || !before || !behind)
  {
    for (int x = 0; x < count; ++x)
    {
      place(x);
    }
    return;
  }
  // The same without questions.
  place(0);
  const float half = 0.5f;
  for (int x = 1; x + 1 < count; ++x)
  {
    out[4 * x] = row[x];
    out[4 * x + 1] = (row[x + 1] - row[x - 1]) * half * scale;
    out[4 * x + 2] = (above[x] - below[x]) * half * scale;
    out[4 * x + 3] = (behind[x] - before[x]) * half * scale;
  }
  place(count - 1);
}

void PackedBrick::PlaceGradients(const Dense& dense, float scale)
{
  for (int z = 0; z <= this->Whole.Size().z; ++z)
  {
    for (int y = 0; y <= this->Whole.Size().y; ++y)
    {
      this->PlaceGradientRow(dense, this->Whole.Lo.y + y, this->Whole.Lo.z + z, scale,
        this->Samples.data() + z * this->Slice + y * this->Row);
    }
  }
}

} // namespace banyan
