// SPDX-License-Identifier: BSD-3-Clause
#include "WallOfRanks.h"

#include "FramebufferExchange.h"
#include "PixelsBehind.h"

#include "vtkCamera.h"
#include "vtkCameraPass.h"
#include "vtkDisplayConfiguration.h"
#include "vtkFloatArray.h"
#include "vtkIceTCompositePass.h"
#include "vtkImageProcessingPass.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPVRenderView.h"
#include "vtkRemotingCoreConfiguration.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkTilesHelper.h"
#include "vtkVector.h"

#include <algorithm>
#include <utility>

namespace banyan
{
namespace
{

/// A rank's display, as it is told to the others. Plain numbers: it is sent as it is.
struct Display
{
  ScreenView View; ///< of the picture that it shows a part of
  PixelRect Rect;  ///< the part; empty where it shows nothing
  glm::ivec2 Window{ 0 };
  glm::ivec2 Shown{ 0 }; ///< pixels of the window that ParaView puts the part into
};

std::vector<Display> AllOf(vtkMultiProcessController* ranks, const Display& mine)
{
  std::vector<Display> all(static_cast<std::size_t>(ranks->GetNumberOfProcesses()));
  ranks->AllGather(reinterpret_cast<const char*>(&mine), reinterpret_cast<char*>(all.data()),
    static_cast<vtkIdType>(sizeof(Display)));
  return all;
}

/// The pass of ParaView that puts pictures of ranks together; null where it has none.
vtkIceTCompositePass* CompositePassOf(vtkRenderer* renderer)
{
  vtkRenderPass* pass = renderer->GetPass();
  while (pass && !vtkIceTCompositePass::SafeDownCast(pass))
  {
    auto* const processing = vtkImageProcessingPass::SafeDownCast(pass);
    auto* const camera = vtkCameraPass::SafeDownCast(pass);
    pass = processing ? processing->GetDelegatePass()
           : camera   ? camera->GetDelegatePass()
                      : nullptr;
  }
  return vtkIceTCompositePass::SafeDownCast(pass);
}

/// Where tiles are in a picture of all that is shown on them, with what is between them.
struct Tiles
{
  std::vector<PixelRect> Rects; ///< of each rank; empty where it shows nothing
  glm::ivec2 Size{ 0 };
};

/// @param every so many columns and rows of a tile are one; gaps stay as they are
Tiles TilesOf(vtkRenderer* renderer, int ranks, int every)
{
  auto* const options = vtkRemotingCoreConfiguration::GetInstance();
  const int* const window = renderer->GetRenderWindow()->GetActualSize();
  const int size[2] = { window[0] / every, window[1] / every };
  vtkNew<vtkTilesHelper> helper;
  helper->SetTileDimensions(options->GetTileDimensions());
  helper->SetTileMullions(options->GetTileMullions());
  helper->SetTileWindowSize(size);
  const vtkVector4d viewport(renderer->GetViewport());
  Tiles tiles;
  PixelRect around;
  for (int rank = 0; rank < ranks; ++rank)
  {
    vtkVector2i part;
    vtkVector2i low;
    PixelRect rect;
    if (helper->GetTiledSizeAndOrigin(rank, part, low, viewport))
    {
      rect.Lo = { low[0], low[1] };
      rect.Hi = rect.Lo + glm::ivec2(part[0], part[1]);
    }
    tiles.Rects.push_back(rect);
    around = Union(around, rect);
  }
  for (PixelRect& rect : tiles.Rects)
  {
    rect = rect.Empty() ? PixelRect{} : Moved(rect, -around.Lo);
  }
  tiles.Size = around.Size();
  return tiles;
}

/// As ParaView puts pictures of ranks together: smaller ones while somebody moves the camera.
Tiles CompositedTiles(vtkRenderer* renderer, int ranks)
{
  vtkIceTCompositePass* const pass = CompositePassOf(renderer);
  return TilesOf(renderer, ranks, pass ? std::max(1, pass->GetImageReductionFactor()) : 1);
}

/// As they are drawn: in all pixels where ParaView's picture has the same parts, else as in that.
Tiles DrawnTiles(const Tiles& composited, const Tiles& full)
{
  const auto isSame = [&](const PixelRect& small, const PixelRect& large)
  {
    return small.Lo * full.Size == large.Lo * composited.Size &&
           small.Hi * full.Size == large.Hi * composited.Size;
  };
  const bool all = std::equal(
    composited.Rects.begin(), composited.Rects.end(), full.Rects.begin(), full.Rects.end(), isSame);
  return all ? full : composited;
}

ScreenView ViewOfAll(vtkRenderer* renderer, const Tiles& tiles)
{
  vtkCamera* const camera = renderer->GetActiveCamera();
  const double aspect = static_cast<double>(tiles.Size.x) / std::max(1, tiles.Size.y);
  ScreenView view;
  view.Size = tiles.Size;
  view.WorldToClip = ToGlm(camera->GetProjectionTransformMatrix(aspect, -1.0, 1.0)) *
                     ToGlm(camera->GetViewTransformMatrix());
  view.Far = camera->GetClippingRange()[1];
  return view;
}

/// What this rank's tile shows of a picture as large as all tiles and what is between them.
Display TileOf(vtkRenderer* renderer, const Tiles& tiles, int self)
{
  const int* const window = renderer->GetRenderWindow()->GetActualSize();
  Display mine;
  mine.View = ViewOfAll(renderer, tiles);
  mine.Rect = tiles.Rects.at(static_cast<std::size_t>(self));
  mine.Window = { window[0], window[1] };
  glm::ivec2 corner(0);
  renderer->GetTiledSizeAndOrigin(&mine.Shown.x, &mine.Shown.y, &corner.x, &corner.y);
  return mine;
}

/// Depths in as many pixels as a rectangle has.
/// @param size of what `depths` are of, `[y][x]`
DepthPicture Enlarged(const float* depths, const glm::ivec2& size, const PixelRect& rect)
{
  const glm::ivec2 to = rect.Size();
  DepthPicture picture{ {}, rect, {} };
  picture.Depths.reserve(static_cast<std::size_t>(rect.Count()));
  for (int y = 0; y < to.y; ++y)
  {
    const float* const row = depths + static_cast<std::ptrdiff_t>(y) * size.y / to.y * size.x;
    for (int x = 0; x < to.x; ++x)
    {
      picture.Depths.push_back(row[static_cast<std::ptrdiff_t>(x) * size.x / to.x]);
    }
  }
  return picture.Trimmed();
}

/// What ParaView has left of depths when it put the tile together.
DepthPicture DepthsOfTile(vtkRenderer* renderer, const PixelRect& rect)
{
  vtkIceTCompositePass* const pass = CompositePassOf(renderer);
  vtkFloatArray* const array = pass ? pass->GetLastRenderedDepths() : nullptr;
  vtkSynchronizedRenderers::vtkRawImage image;
  if (array)
  {
    pass->GetLastRenderedTile(image);
  }
  return array && image.IsValid() && !rect.Empty()
           ? Enlarged(array->GetPointer(0), { image.GetWidth(), image.GetHeight() }, rect)
           : DepthPicture{};
}

/// The pixel of a picture that the first one of a part is.
/// @param part of the same picture in the same scale: x' = s x + t w in coordinates of clip space
glm::ivec2 CornerOf(const ScreenView& part, const ScreenView& whole)
{
  glm::dvec2 corner(0.0);
  for (int axis = 0; axis < 2; ++axis)
  {
    const double scale = static_cast<double>(whole.Size[axis]) / part.Size[axis];
    double moved = 0.0;
    double weight = 0.0;
    for (int column = 0; column < 4; ++column)
    {
      const double w = whole.WorldToClip[column][3];
      moved += (part.WorldToClip[column][axis] - scale * whole.WorldToClip[column][axis]) * w;
      weight += w * w;
    }
    corner[axis] = 0.5 * (whole.Size[axis] - (1.0 + moved / weight) * part.Size[axis]);
  }
  return glm::ivec2(glm::round(corner));
}

/// A part of a view as a picture of its own, in so many pixels.
ScreenView PartOf(const ScreenView& view, const PixelRect& rect, const glm::ivec2& pixels)
{
  const glm::dvec2 size(view.Size);
  const glm::dvec2 scale = size / glm::dvec2(rect.Size());
  const glm::dvec2 middle = 0.5 * glm::dvec2(rect.Lo + rect.Hi);
  glm::dmat4 part(1.0);
  part[0][0] = scale.x;
  part[1][1] = scale.y;
  part[3][0] = scale.x * (1.0 - 2.0 * middle.x / size.x);
  part[3][1] = scale.y * (1.0 - 2.0 * middle.y / size.y);
  return { part * view.WorldToClip, pixels, view.Far };
}

/// The pictures of tiles: parts of one. Where there are gaps between them ParaView puts a part into
/// fewer pixels than it has; each then is a picture of its own.
std::vector<WallPicture> PicturesOf(const std::vector<Display>& tiles)
{
  const bool asOne = std::all_of(tiles.begin(), tiles.end(),
    [](const Display& tile) { return tile.Rect.Empty() || tile.Shown == tile.Rect.Size(); });
  std::vector<WallPicture> pictures;
  for (std::size_t rank = 0; rank < tiles.size(); ++rank)
  {
    const Display& tile = tiles[rank];
    if (tile.Rect.Empty())
    {
      continue;
    }
    if (!asOne)
    {
      pictures.push_back({ PartOf(tiles.front().View, tile.Rect, tile.Shown),
        { { { glm::ivec2(0), tile.Shown }, static_cast<int>(rank), {} } } });
      continue;
    }
    if (pictures.empty())
    {
      pictures.push_back({ tiles.front().View, {} });
    }
    pictures.front().Places.push_back({ tile.Rect, static_cast<int>(rank), {} });
  }
  return pictures;
}

/// What is not as it should be on a tile display, in sentences.
std::string NoteOn(const std::vector<Display>& tiles)
{
  std::string note;
  const auto tell = [&note](const std::string& sentences)
  { note += note.empty() ? sentences : " " + sentences; };
  const auto other = std::find_if(tiles.begin(), tiles.end(),
    [&](const Display& tile) { return tile.Window != tiles.front().Window; });
  if (other != tiles.end())
  {
    tell("The windows of rank 0 and rank " + std::to_string(other - tiles.begin()) +
         " have different sizes: ParaView's picture does not fit together on this tile display. "
         "Set them by PV_SHARED_WINDOW_SIZE, or by the displays of the ranks.");
  }
  const int* const counts = vtkRemotingCoreConfiguration::GetInstance()->GetTileDimensions();
  if (counts[0] * counts[1] > static_cast<int>(tiles.size()))
  {
    tell("The tile display has " + std::to_string(counts[0] * counts[1]) +
         " tiles, and the server " + std::to_string(tiles.size()) +
         " ranks: tiles without a rank stay blank. Start as many ranks as tiles.");
  }
  return note;
}

/// At which depths this rank has drawn other data in a picture of tiles.
/// @param drawn in the picture that is put together
DepthPicture DepthsIn(
  const WallPicture& picture, const Tiles& composited, const DepthPicture& drawn)
{
  std::vector<DepthPicture> parts;
  for (const PicturePlace& place : picture.Places)
  {
    const PixelRect& tile = composited.Rects.at(static_cast<std::size_t>(place.Root));
    const std::vector<float> depths = drawn.In(tile);
    if (!depths.empty())
    {
      parts.push_back(Enlarged(depths.data(), tile.Size(), place.Rect));
    }
  }
  return NearestOf(parts);
}

WallOfRanks LookAtTiles(
  vtkPVRenderView* view, vtkMultiProcessController* ranks, const std::vector<DrawnPart>& drawn)
{
  vtkRenderer* const renderer = view->GetRenderer();
  const int self = ranks->GetLocalProcessId();
  const int count = ranks->GetNumberOfProcesses();
  const Tiles composited = CompositedTiles(renderer, count);
  const Tiles tiles = DrawnTiles(composited, TilesOf(renderer, count, 1));
  const std::vector<Display> all = AllOf(ranks, TileOf(renderer, tiles, self));
  WallOfRanks wall{ PicturesOf(all), {}, NoteOn(all) };
  std::vector<DepthPicture> parts;
  for (const DrawnPart& part : drawn)
  {
    parts.push_back(part.Depths);
    parts.back().Rect =
      Moved(part.Depths.Rect, CornerOf(part.View, ViewOfAll(renderer, composited)));
  }
  const DepthPicture nearest = NearestOf(parts);
  for (const WallPicture& picture : wall.Pictures)
  {
    const auto own = std::find_if(picture.Places.begin(), picture.Places.end(),
      [self](const PicturePlace& place) { return place.Root == self; });
    // ParaView keeps no depths where it blends pictures of ranks in order.
    const bool kept = !view->GetUseOrderedCompositing();
    wall.Own.push_back(!kept                         ? DepthsIn(picture, composited, nearest)
                       : own != picture.Places.end() ? DepthsOfTile(renderer, own->Rect)
                                                     : DepthPicture{});
  }
  return wall;
}

/// Whether this rank has one of the displays of a CAVE.
bool HasDisplay(int rank)
{
  const vtkDisplayConfiguration* const displays =
    vtkRemotingCoreConfiguration::GetInstance()->GetDisplayConfiguration();
  return displays && rank < displays->GetNumberOfDisplays();
}

WallOfRanks LookAtCave(
  vtkRenderer* renderer, vtkMultiProcessController* ranks, const DepthPicture& own)
{
  Display mine;
  if (HasDisplay(ranks->GetLocalProcessId()))
  {
    mine.View = ViewOf(renderer);
    mine.Rect = { glm::ivec2(0), mine.View.Size };
  }
  WallOfRanks wall;
  const std::vector<Display> all = AllOf(ranks, mine);
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    if (!all[rank].Rect.Empty())
    {
      wall.Pictures.push_back(
        { all[rank].View, { { all[rank].Rect, static_cast<int>(rank), {} } } });
      const bool shows = static_cast<int>(rank) == ranks->GetLocalProcessId();
      wall.Own.push_back(shows ? own : DepthPicture{});
    }
  }
  return wall;
}

} // namespace

bool IsWall(vtkPVRenderView* view)
{
  return view && (view->InTileDisplayMode() || view->InCaveDisplayMode());
}

DepthPicture DepthsInCave(vtkPVRenderView* view, FramebufferExchange& framebuffer)
{
  vtkRenderer* const renderer = view->GetRenderer();
  DepthPicture picture;
  if (view->InCaveDisplayMode())
  {
    picture.Size = ViewOf(renderer).Size;
    picture.Rect = { glm::ivec2(0), picture.Size };
    OpaquePixels pixels;
    framebuffer.Read(renderer, picture.Rect, pixels);
    picture.Depths = DepthsOf(pixels);
  }
  return picture.Depths.empty() ? DepthPicture{} : picture.Trimmed();
}

bool NeedsDrawnParts(vtkPVRenderView* view)
{
  return view->InTileDisplayMode() && view->GetUseOrderedCompositing();
}

DrawnPart DepthsOfCall(vtkRenderer* renderer, FramebufferExchange& framebuffer)
{
  const int* const window = renderer->GetRenderWindow()->GetActualSize();
  DrawnPart part{ ViewOf(renderer), {} };
  part.View.Size = { window[0], window[1] };
  const PixelRect all{ glm::ivec2(0), part.View.Size };
  OpaquePixels pixels;
  framebuffer.Read(renderer, all, pixels);
  std::vector<float> depths = DepthsOf(pixels);
  if (!depths.empty())
  {
    part.Depths = DepthPicture{ part.View.Size, all, std::move(depths) }.Trimmed();
  }
  return part;
}

WallOfRanks LookAtWall(vtkPVRenderView* view, vtkMultiProcessController* ranks,
  const DepthPicture& inCave, const std::vector<DrawnPart>& drawn)
{
  return view->InCaveDisplayMode() ? LookAtCave(view->GetRenderer(), ranks, inCave)
                                   : LookAtTiles(view, ranks, drawn);
}

} // namespace banyan
