#include "Backdrop.h"

#include "PixelsBehind.h"

#include "Parallel/Communicator.h"

#include "vtkCollection.h"
#include "vtkProp.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkWindow.h"

#include <algorithm>

namespace banyan
{
namespace
{

constexpr OpaquePixel Blank{ 1.0f, { 0, 0, 0, 0 } };

} // namespace

bool ShowsOthers(vtkRenderer* renderer, vtkProp* self)
{
  vtkPropCollection* const props = renderer->GetViewProps();
  vtkCollectionSimpleIterator at;
  props->InitTraversal(at);
  while (vtkProp* const prop = props->GetNextProp(at))
  {
    if (prop != self && prop->GetVisibility())
    {
      return true;
    }
  }
  return false;
}

void Backdrop::Read(Communicator& communicator, vtkRenderer* renderer, vtkProp* self,
  const PixelRect& rect, const std::vector<int>& rankOrder, CompositeStatistics& statistics)
{
  this->Rect = rect;
  this->BehindRect = {};
  // Of several ranks the first may have its background before props are drawn. One pixel tells.
  const bool alone = communicator.Size() == 1;
  const bool shows =
    ShowsOthers(renderer, self) ||
    (!alone && communicator.Rank() == 0 && this->Framebuffer.Coloured(renderer, rect.Lo));
  this->Shows = AllMax(communicator, shows ? 1.0 : 0.0) > 0.0;
  if (this->Shows)
  {
    this->Framebuffer.Read(renderer, rect, this->Pixels);
    this->BehindRect = CombineBehind(communicator, rankOrder, rect, this->Pixels, statistics);
  }
}

std::vector<float> Backdrop::Depths() const
{
  return this->Shows ? DepthsOf(this->Pixels) : std::vector<float>();
}

void Backdrop::Write(
  const Communicator& communicator, vtkRenderer* renderer, const FloatImage& picture)
{
  // On several ranks the background comes last: the compositor blends the picture over it in 8 bit.
  // A single rank does the same, for the same picture to the last bit.
  const bool alone = communicator.Size() == 1;
  const bool first = communicator.Rank() == 0;
  if (!first && !this->Shows)
  {
    return; // blank as it is
  }
  if (!first || !this->Shows)
  {
    this->Pixels.assign(static_cast<std::size_t>(this->Rect.Count()), Blank);
  }
  else if (alone)
  {
    ClearWithoutGeometry(this->Pixels);
  }
  if (first)
  {
    BlendOver(picture, this->Pixels);
  }
  this->Framebuffer.Write(renderer, this->Rect, this->Pixels, /*blend=*/alone);
}

void Backdrop::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Framebuffer.ReleaseGraphicsResources(window);
}

} // namespace banyan
