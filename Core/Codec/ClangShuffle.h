// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_ClangShuffle_h
#define banyan_Codec_ClangShuffle_h

/// Clang does not have GCC's `__builtin_shuffle` for lanes that are chosen while running: where it
/// compiles Core, this file comes before all others. Not a function: it would be compiled for other
/// instructions than those who call it, and must not be given their vectors then.
#ifdef __cplusplus
namespace banyan
{

template <class Vector, class Numbers>
struct LanesToShuffle
{
  Vector From;
  Numbers Lanes;
};
template <class Vector, class Numbers>
LanesToShuffle(Vector, Numbers) -> LanesToShuffle<Vector, Numbers>;

} // namespace banyan

#define __builtin_shuffle(...)                                                                     \
  (__extension__({                                                                                 \
    const ::banyan::LanesToShuffle shuffle{ __VA_ARGS__ };                                         \
    auto shuffled = shuffle.From;                                                                  \
    constexpr int shuffledCount = sizeof(shuffled) / sizeof(shuffled[0]);                          \
    for (int lane = 0; lane < shuffledCount; ++lane)                                               \
    {                                                                                              \
      shuffled[lane] = shuffle.From[shuffle.Lanes[lane] & (shuffledCount - 1)];                    \
    }                                                                                              \
    shuffled;                                                                                      \
  }))
#endif

#endif
