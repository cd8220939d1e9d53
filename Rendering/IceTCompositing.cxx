#include "IceTCompositing.h"

#include "vtkMPI.h"
#include "vtkMPICommunicator.h"
#include "vtkMultiProcessController.h"

#include <IceT.h>
#include <IceTMPI.h>

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// A context of our own: ParaView's compositor, which is at work around us, keeps its settings.
class ScopedContext
{
public:
  explicit ScopedContext(MPI_Comm ranks)
    : Before(icetGetContext())
    , Communicator(icetCreateMPICommunicator(ranks))
    , Own(icetCreateContext(this->Communicator))
  {
  }
  ~ScopedContext()
  {
    icetDestroyContext(this->Own);
    icetDestroyMPICommunicator(this->Communicator);
    if (this->Before)
    {
      icetSetContext(this->Before);
    }
  }
  ScopedContext(const ScopedContext&) = delete;
  ScopedContext& operator=(const ScopedContext&) = delete;

private:
  IceTContext Before;
  IceTCommunicator Communicator;
  IceTContext Own;
};

std::vector<IceTUByte> ToBytes(const FloatImage& image, const PixelRect& viewport)
{
  std::vector<IceTUByte> bytes(4 * static_cast<std::size_t>(viewport.Count()), 0);
  for (int y = image.Rect.Lo.y; y < image.Rect.Hi.y; ++y)
  {
    const glm::ivec2 at = glm::ivec2(image.Rect.Lo.x, y) - viewport.Lo;
    IceTUByte* to = bytes.data() + 4 * (static_cast<std::size_t>(at.y) * viewport.Size().x + at.x);
    for (int x = image.Rect.Lo.x; x < image.Rect.Hi.x; ++x)
    {
      for (int c = 0; c < 4; ++c)
      {
        const float value = std::clamp(image.At(x, y)[c], 0.0f, 1.0f);
        *to++ = static_cast<IceTUByte>(std::lround(255.0f * value));
      }
    }
  }
  return bytes;
}

FloatImage CompositeByIceT(MPI_Comm ranks, bool root, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, CompositeStatistics& statistics)
{
  const ScopedContext context(ranks);
  icetSetColorFormat(ICET_IMAGE_COLOR_RGBA_UBYTE);
  icetSetDepthFormat(ICET_IMAGE_DEPTH_NONE);
  icetCompositeMode(ICET_COMPOSITE_MODE_BLEND);
  icetEnable(ICET_ORDERED_COMPOSITE);
  icetResetTiles();
  icetAddTile(0, 0, viewport.Size().x, viewport.Size().y, 0);
  icetStrategy(ICET_STRATEGY_SEQUENTIAL);
  icetSingleImageStrategy(ICET_SINGLE_IMAGE_STRATEGY_RADIXK);
  icetCompositeOrder(frontToBack.data());
  const glm::ivec2 low = mine.Rect.Empty() ? glm::ivec2(0) : mine.Rect.Lo - viewport.Lo;
  const IceTInt valid[] = { low.x, low.y, mine.Rect.Size().x, mine.Rect.Size().y };
  const IceTFloat background[] = { 0.0f, 0.0f, 0.0f, 0.0f };
  const std::vector<IceTUByte> bytes = ToBytes(mine, viewport);
  const IceTImage image =
    icetCompositeImage(bytes.data(), nullptr, valid, nullptr, nullptr, background);
  IceTInt sent = 0;
  icetGetIntegerv(ICET_BYTES_SENT, &sent);
  statistics.BytesSent += static_cast<std::uint64_t>(sent);
  FloatImage picture;
  if (root)
  {
    picture.Rect = viewport;
    picture.Pixels.resize(static_cast<std::size_t>(viewport.Count()));
    const IceTUByte* from = icetImageGetColorcub(image);
    for (glm::vec4& pixel : picture.Pixels)
    {
      pixel = glm::vec4(from[0], from[1], from[2], from[3]) / 255.0f;
      from += 4;
    }
  }
  return picture;
}

} // namespace

CompositeOptions::Compositor IceTRadixK(vtkMultiProcessController* controller)
{
  vtkMPICommunicator* mpi =
    controller ? vtkMPICommunicator::SafeDownCast(controller->GetCommunicator()) : nullptr;
  if (!mpi)
  {
    return [](Communicator&, const FloatImage& mine, const std::vector<int>&,
             const PixelRect& viewport, CompositeStatistics&)
    {
      FloatImage picture{ viewport,
        std::vector<glm::vec4>(static_cast<std::size_t>(viewport.Count()), glm::vec4(0.0f)) };
      for (int y = mine.Rect.Lo.y; y < mine.Rect.Hi.y && !mine.Rect.Empty(); ++y)
      {
        const glm::vec4* row = &mine.At(mine.Rect.Lo.x, y);
        std::copy(row, row + mine.Rect.Size().x, &picture.At(mine.Rect.Lo.x, y));
      }
      return picture;
    };
  }
  const MPI_Comm ranks = *mpi->GetMPIComm()->GetHandle();
  return
    [ranks](Communicator& communicator, const FloatImage& mine, const std::vector<int>& frontToBack,
      const PixelRect& viewport, CompositeStatistics& statistics)
  {
    return CompositeByIceT(
      ranks, communicator.Rank() == 0, mine, frontToBack, viewport, statistics);
  };
}

} // namespace banyan
