#ifndef banyan_Codec_ClangShuffle_h
#define banyan_Codec_ClangShuffle_h

/// Clang does not have GCC's `__builtin_shuffle` for lanes that are chosen while running: where it
/// compiles Core, this file comes before all others.
#ifdef __cplusplus
namespace banyan
{

template <class Vector, class Lanes>
inline __attribute__((always_inline)) Vector ShuffledLanes(Vector from, Lanes lanes)
{
  Vector result{};
  constexpr int count = sizeof(Vector) / sizeof(from[0]);
  for (int i = 0; i < count; ++i)
  {
    result[i] = from[lanes[i] & (count - 1)];
  }
  return result;
}

} // namespace banyan

#define __builtin_shuffle(from, ...) ::banyan::ShuffledLanes(from, __VA_ARGS__)
#endif

#endif
