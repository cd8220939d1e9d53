// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_PictureTicket_h
#define banyan_Rendering_PictureTicket_h

#include "RendererCamera.h"

#include "Base/Bytes.h"

#include <array>
#include <vector>

namespace banyan
{

/// What a client sends to all ranks of its server: "draw this for me", or "go on with it".
struct PictureTicket
{
  static constexpr int Version = 3;  ///< also in Representations/BanyanRepresentations.xml.in
  static constexpr int Numbers = 29; ///< that it is sent as, besides the depths

  /// In place of a scene: what ParaView has drawn last is to become exact. What is exact is told by
  /// a message without content: Exact if it is to be shown, Same if it is shown.
  static constexpr int OfParaView = 0;

  int Number = 0;      ///< from 1, one more each time
  int Display = 0;     ///< of the client's proxy, for which pictures are meant
  int Scene = 0;       ///< number of the ticket that this one's view came with
  bool Moves = false;  ///< whether somebody moves the camera
  int CoarseEvery = 1; ///< a coarse picture has a pixel for so many rows and columns
  int Credit = 0;      ///< bytes that may be sent in answer
  int Shown = 0;       ///< scene whose exact picture is on the screen; 0 for none
  int Volumes = 1;     ///< whose pictures the client blends
  ScreenView View;

  /// Where other data in the view end rays: depths for the pixels of the coarse picture come with a
  /// view of a moving camera; those of all pixels follow, or are there at once.
  enum Geometries
  {
    Nothing,
    OfCoarse,
    OfAll
  };
  Geometries Others = Nothing;
  Bytes Depths; ///< PackDepths; empty where no depths come with this ticket

  /// Whether it comes with a view that no ticket came with before.
  bool IsNew() const { return this->Scene == this->Number; }

  std::array<double, Numbers> ToNumbers() const;
  /// The depths, at least one word.
  std::vector<unsigned int> DepthWords() const;
  /// @param words as many as DepthWords made, for depths
  static PictureTicket Of(
    const double numbers[Numbers], unsigned int words, const unsigned int* depths);
};

} // namespace banyan

#endif
