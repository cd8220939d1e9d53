// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_RayTile_h
#define banyan_Render_Raycast_RayTile_h

#include "Render/Bricks/BrickPrefetcher.h"
#include "Render/Scene/FloatImage.h"
#include "Render/Scene/RayLattice.h"
#include "Render/Scene/RayPacket.h"

#include <cstdint>

namespace banyan
{

class SegmentLog;

/// The rays of a rectangle of pixels while bricks are drawn front to back.
///
/// Rays stand in slots, packet by packet: a packet has the rays of 4 x 4 pixels, row by row, so
/// that rays that are drawn together stay together. Slots without a pixel have an empty ray. Where
/// only every n-th pixel has a ray, these are as close together as if there were no others.
struct RayTile
{
  static constexpr int Edge = 32; ///< pixels: rays (about 200 kB) and a brick share the L2 cache
  static constexpr int PacketEdge = RayPacket::Edge;
  static constexpr int PacketSize = RayPacket::Size;
  static constexpr int PacketsPerRow = Edge / PacketEdge;
  static constexpr int Slots = Edge * Edge;
  /// Cells that a step may go along an axis for packets to be drawn; see PackedBrick::LargestEdge.
  static constexpr int LongestStep = 16;

  /// @param x, y pixel of the picture that has a ray, inside Rect
  int SlotOf(int x, int y) const
  {
    const int column = (x - this->Corner.x) / this->Stride;
    const int row = (y - this->Corner.y) / this->Stride;
    const int packet = row / PacketEdge * PacketsPerRow + column / PacketEdge;
    return packet * PacketSize + row % PacketEdge * PacketEdge + column % PacketEdge;
  }

  /// The pixel of a slot, which may lie beyond Rect.
  glm::ivec2 PixelAt(int slot) const
  {
    const int packet = slot / PacketSize;
    const int within = slot % PacketSize;
    return this->Corner +
           this->Stride * glm::ivec2(packet % PacketsPerRow * PacketEdge + within % PacketEdge,
                            packet / PacketsPerRow * PacketEdge + within / PacketEdge);
  }

  /// Calls function(slot) for the pixels of a rectangle inside Rect that have rays.
  template <class Function>
  void ForSlotsUnder(const PixelRect& pixels, Function&& function) const
  {
    const glm::ivec2 first = (pixels.Lo + (this->Stride - 1)) / this->Stride * this->Stride;
    for (int y = first.y; y < pixels.Hi.y; y += this->Stride)
    {
      for (int x = first.x; x < pixels.Hi.x; x += this->Stride)
      {
        function(this->SlotOf(x, y));
      }
    }
  }

  /// The packets under some pixels inside Rect: from Lo to below Hi in rows of PacketsPerRow.
  PixelRect PacketsUnder(const PixelRect& pixels) const
  {
    const int edge = PacketEdge * this->Stride;
    return { (pixels.Lo - this->Corner) / edge, (pixels.Hi - this->Corner + edge - 1) / edge };
  }

  /// Places the rays of a rectangle of at most Edge x Edge pixels, and takes up what they have met
  /// so far. The samples are those of RayLattice::SamplesOf, bit for bit and on every processor;
  /// rays that have ended are left empty.
  /// @param picture premultiplied colour, and the *transmittance* (1 - opacity) in the fourth
  ///        component, so that stopping and going on with the next batch changes no bit
  /// @param stride RaySampling::PixelStride
  /// @param begun false when rays have met nothing so far, whatever the picture says
  /// @param drawn rays of other pixels are left empty, and the pixels as they are
  /// @param cast blocks whose rays are cast (ReusedRays), if none has begun: others have ended
  /// Throws Error as RayLattice::SamplesOf does.
  void Open(const RayLattice& lattice, const PixelRect& rect, const FloatImage& picture,
    float limit, int stride, bool begun, const PixelRect& drawn,
    std::uint64_t cast = ~std::uint64_t{ 0 });
  void Open(
    const RayLattice& lattice, const PixelRect& rect, const FloatImage& picture, float limit)
  {
    this->Open(lattice, rect, picture, limit, 1, true, rect);
  }

  /// Puts what the rays have met back into the picture: only pixels that have one change.
  void Close(FloatImage& picture) const;

  /// The samples of one ray, in cells of the brick that is drawn.
  RaySamples RayOf(int slot) const;

  bool IsEmpty(int slot) const
  {
    return this->Count[slot] == 0 && this->Head.Fraction[slot] == 0.0f &&
           this->Tail.Fraction[slot] == 0.0f;
  }

  /// Premultiplied colour and transmittance.
  glm::vec4 PixelOf(int slot) const
  {
    return { this->Color[0][slot], this->Color[1][slot], this->Color[2][slot],
      this->Transmittance[slot] };
  }
  void SetPixel(int slot, const glm::vec4& pixel)
  {
    this->Color[0][slot] = pixel.r;
    this->Color[1][slot] = pixel.g;
    this->Color[2][slot] = pixel.b;
    this->Transmittance[slot] = pixel.a;
  }

  PixelRect Rect;
  int Stride = 1;                ///< pixels from ray to ray
  glm::ivec2 Corner{ 0 };        ///< pixel of slot 0, at most Stride - 1 pixels outside of Rect
  float TransmittanceLimit = 0;  ///< a ray ends when its transmittance is not above this
  std::int64_t ActiveRays = 0;   ///< rays with samples that have not ended
  std::int64_t SamplesTaken = 0; ///< since Open
  bool PacketsFit = true;        ///< no ray steps further than LongestStep, in the finest cells
  BrickPrefetcher Ahead;         ///< the brick that is drawn next, if it is to be asked for
  SegmentLog* Log = nullptr;     ///< where kernels note each composited sample; null for nowhere

  /// The brick that is being drawn has cells 2^BrickShift times as short as the index space that
  /// rays are made in, and the box of it that is drawn counts in cells 2^CellShift times as short.
  /// Rays are made for the largest cells, so that a position in smaller ones is the same bits,
  /// moved up: all bricks agree on where a sample is.
  int BrickShift = 0;
  int CellShift = 0;

  /// First or last samples of rays, which stand for less than a whole interval.
  struct Ends
  {
    alignas(64) std::int32_t Cell[3][Slots];
    alignas(64) std::uint32_t Position[3][Slots]; ///< fixed-point, modulo 256 cells
    alignas(64) float Fraction[Slots];            ///< 0 where there is none
  };

  // Axis by axis, slot by slot.
  alignas(64) std::uint32_t Base[3][Slots]; ///< position of whole sample 0, modulo 256 cells
  alignas(64) std::uint32_t Step[3][Slots]; ///< modulo 256 cells
  alignas(64) double WholeStep[3][Slots];   ///< fixed-point
  alignas(64) double Start[3][Slots];       ///< in cells; never a whole number where Step is 0
  alignas(64) double Inverse[3][Slots];     ///< samples per cell; infinite where Step is 0
  alignas(64) std::int32_t Count[Slots];
  alignas(64) double Number[Slots]; ///< of whole sample 0 along its ray, counted from t = 0
  alignas(
    64) float Direction[3][Slots]; ///< LatticeSetup::ShadingScale times cells per world length
  Ends Head;
  Ends Tail;
  alignas(64) float Color[3][Slots];
  alignas(64) float Transmittance[Slots];
};

} // namespace banyan

#endif
