// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_LinePrefetcher_h
#define banyan_Codec_LinePrefetcher_h

#include <cstddef>

namespace banyan
{

/// Memory that will be read soon, and what the block at hand will be written to, asked for a few
/// lines of the cache at a time while something else is computed: a processor takes only some dozen
/// lines at once and waits where it is asked for more. Nothing is read, so that memory may be gone
/// by then.
class LinePrefetcher
{
public:
  /// Forgets all that was added before.
  void Clear() { this->Begin = this->End = 0; }

  /// @param bytes those that do not fit any more are left out
  void Add(const void* first, std::size_t bytes)
  {
    if (this->End < MostParts)
    {
      const char* const at = static_cast<const char*>(first);
      this->Parts[this->End++] = { at, at + bytes };
    }
  }

  /// Sets the memory that will be written, in place of the last one; null for none.
  void Write(const void* first, std::size_t bytes)
  {
    const char* const at = static_cast<const char*>(first);
    this->Written = { at, at + bytes };
  }

  /// Asks for some lines of each.
  void Ask(int lines)
  {
    for (int line = 0; line < lines && this->Written.At < this->Written.End; ++line)
    {
      __builtin_prefetch(this->Written.At, 1, 3);
      this->Written.At += Line;
    }
    while (this->Begin < this->End)
    {
      Part& part = this->Parts[this->Begin];
      for (; part.At < part.End; part.At += Line)
      {
        if (lines-- <= 0)
        {
          return;
        }
        __builtin_prefetch(part.At, 0, 2);
      }
      ++this->Begin;
    }
  }

private:
  static constexpr int MostParts = 32;
  static constexpr int Line = 64;

  struct Part
  {
    const char* At;
    const char* End;
  };
  Part Parts[MostParts];
  Part Written{ nullptr, nullptr };
  int Begin = 0, End = 0;
};

} // namespace banyan

#endif
