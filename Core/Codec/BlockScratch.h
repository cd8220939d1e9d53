#ifndef banyan_Codec_BlockScratch_h
#define banyan_Codec_BlockScratch_h

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace banyan::block
{

/// A unit of a block is what is left of it between what is known: its three edges (one dimension),
/// its three faces (two) and its interior (three). This is a unit as the passes see it: axes in
/// order, unused ones of size 1.
template <int B>
struct Unit
{
  std::int32_t* W; ///< sample (0, 0, 0); samples 0 to B per axis
  std::uint8_t* M; ///< magnitudes of residuals, samples 0 to B - 1 per axis, zeros around rows
  glm::ivec3 Limit; ///< greatest position per axis that carries residuals
};

/// Memory of one unit of D dimensions. Rows have room on both sides, because predictions of whole
/// vectors read (and ignore) lanes beyond the ends; so have magnitudes, with zeros in it.
template <int B, int D>
struct Scratch
{
  static constexpr int N = B + 1;
  static constexpr int RowW = B + 8;
  static constexpr int RowM = B + 8;
  static constexpr int RowsW = D == 1 ? 1 : D == 2 ? N : N * N;
  // Distances between rows (of samples and of magnitudes) and slices.
  static constexpr std::ptrdiff_t Pitch = D > 1 ? RowW : 0;
  static constexpr std::ptrdiff_t SliceW = D > 2 ? N * RowW : 0;
  static constexpr std::ptrdiff_t SliceM = D > 2 ? B * RowM : 0;
  // Rows before the first one are read as the neighbours of the first ones that are predicted.
  static constexpr int RowsM = D == 1 ? 1 : D == 2 ? B : B * B;

  alignas(64) std::int32_t Samples[RowsW * RowW + 32];
  alignas(64) std::uint8_t Magnitudes[RowsM * RowM + 32];

  std::int32_t* W() { return this->Samples + 8; }
  std::uint8_t* M() { return this->Magnitudes + 8; }

  Scratch()
  {
    std::memset(this->Samples, 0, sizeof this->Samples);
    std::memset(this->Magnitudes, 0, sizeof this->Magnitudes);
  }

  void ClearMagnitudes() { std::memset(this->Magnitudes, 0, sizeof this->Magnitudes); }

  Unit<B> Whole()
  {
    return { this->W(), this->M(), glm::ivec3(B) };
  }
};

} // namespace banyan::block

#endif
