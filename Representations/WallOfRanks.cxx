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

/// What this rank's tile shows of a picture as large as all tiles and what is between them.
Display TileOf(vtkRenderer* renderer, int self, int ranks)
{
  auto* const options = vtkRemotingCoreConfiguration::GetInstance();
  vtkRenderWindow* const window = renderer->GetRenderWindow();
  vtkNew<vtkTilesHelper> helper;
  helper->SetTileDimensions(options->GetTileDimensions());
  helper->SetTileMullions(options->GetTileMullions());
  helper->SetTileWindowSize(window->GetActualSize());
  const vtkVector4d viewport(renderer->GetViewport());
  Display mine;
  mine.Window = { window->GetActualSize()[0], window->GetActualSize()[1] };
  glm::ivec2 corner(0);
  renderer->GetTiledSizeAndOrigin(&mine.Shown.x, &mine.Shown.y, &corner.x, &corner.y);
  PixelRect around;
  for (int rank = 0; rank < ranks; ++rank)
  {
    vtkVector2i size;
    vtkVector2i low;
    if (helper->GetTiledSizeAndOrigin(rank, size, low, viewport))
    {
      const glm::ivec2 first(low[0], low[1]);
      const PixelRect rect{ first, first + glm::ivec2(size[0], size[1]) };
      around = Union(around, rect);
      mine.Rect = rank == self ? rect : mine.Rect;
    }
  }
  mine.Rect.Lo -= around.Lo;
  mine.Rect.Hi -= around.Lo;
  mine.View.Size = around.Size();
  vtkCamera* const camera = renderer->GetActiveCamera();
  const double aspect = static_cast<double>(around.Size().x) / std::max(1, around.Size().y);
  mine.View.WorldToClip = ToGlm(camera->GetProjectionTransformMatrix(aspect, -1.0, 1.0)) *
                          ToGlm(camera->GetViewTransformMatrix());
  mine.View.Far = camera->GetClippingRange()[1];
  return mine;
}

/// What ParaView has left of depths when it put the tile together: of a reduced picture while
/// somebody moves the camera.
DepthPicture DepthsOfTile(vtkRenderer* renderer, const PixelRect& rect)
{
  vtkIceTCompositePass* const pass = CompositePassOf(renderer);
  vtkFloatArray* const array = pass ? pass->GetLastRenderedDepths() : nullptr;
  vtkSynchronizedRenderers::vtkRawImage image;
  if (array)
  {
    pass->GetLastRenderedTile(image);
  }
  if (!array || !image.IsValid() || rect.Empty())
  {
    return {};
  }
  const glm::ivec2 from(image.GetWidth(), image.GetHeight());
  const glm::ivec2 to = rect.Size();
  const float* const depths = array->GetPointer(0);
  DepthPicture picture{ {}, rect, {} };
  picture.Depths.reserve(static_cast<std::size_t>(rect.Count()));
  for (int y = 0; y < to.y; ++y)
  {
    const float* const row = depths + static_cast<std::ptrdiff_t>(y) * from.y / to.y * from.x;
    for (int x = 0; x < to.x; ++x)
    {
      picture.Depths.push_back(row[static_cast<std::ptrdiff_t>(x) * from.x / to.x]);
    }
  }
  return picture.Trimmed();
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
/// @param translucent whether ParaView blends pictures of ranks in order
std::string NoteOn(const std::vector<Display>& tiles, bool translucent)
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
  if (translucent)
  {
    tell("Something translucent is shown. ParaView then keeps no depths on tile displays: "
         "surfaces before a Banyan Volume do not hide it. Make all surfaces opaque.");
  }
  return note;
}

WallOfRanks LookAtTiles(vtkPVRenderView* view, vtkMultiProcessController* ranks)
{
  vtkRenderer* const renderer = view->GetRenderer();
  const int self = ranks->GetLocalProcessId();
  const int count = ranks->GetNumberOfProcesses();
  const std::vector<Display> all = AllOf(ranks, TileOf(renderer, self, count));
  WallOfRanks wall{ PicturesOf(all), {}, NoteOn(all, view->GetUseOrderedCompositing()) };
  for (const WallPicture& picture : wall.Pictures)
  {
    for (const PicturePlace& place : picture.Places)
    {
      if (place.Root == self)
      {
        wall.Own = DepthsOfTile(renderer, place.Rect);
      }
    }
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

WallOfRanks LookAtCave(vtkRenderer* renderer, vtkMultiProcessController* ranks)
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
    std::vector<OpaquePixel> pixels;
    framebuffer.Read(renderer, picture.Rect, pixels);
    picture.Depths = DepthsOf(pixels);
  }
  return picture.Depths.empty() ? DepthPicture{} : picture.Trimmed();
}

WallOfRanks LookAtWall(
  vtkPVRenderView* view, vtkMultiProcessController* ranks, const DepthPicture& inCave)
{
  if (!view->InCaveDisplayMode())
  {
    return LookAtTiles(view, ranks);
  }
  WallOfRanks wall = LookAtCave(view->GetRenderer(), ranks);
  wall.Own = inCave;
  return wall;
}

} // namespace banyan
