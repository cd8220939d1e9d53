// SPDX-License-Identifier: BSD-3-Clause
#include "IceTCompositing.h"

#include "Base/Error.h"

#include "vtkMPI.h"
#include "vtkMPICommunicator.h"
#include "vtkMultiProcessController.h"

#include <IceT.h>
#include <IceTMPI.h>

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

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

/// The picture of the whole viewport, transparent where a rank has not drawn.
FloatImage Framed(const FloatImage& image, const PixelRect& viewport)
{
  FloatImage framed{ viewport,
    PixelVector(static_cast<std::size_t>(viewport.Count()), glm::vec4(0.0f)) };
  for (int y = image.Rect.Lo.y; y < image.Rect.Hi.y && !image.Rect.Empty(); ++y)
  {
    const glm::vec4* row = &image.At(image.Rect.Lo.x, y);
    std::copy(row, row + image.Rect.Size().x, &framed.At(image.Rect.Lo.x, y));
  }
  return framed;
}

/// What IceT complained of first since it was asked last, in a sentence; empty if of nothing.
std::string ComplaintOfIceT()
{
  const IceTEnum error = icetGetError();
  const auto because = [](const char* reason)
  { return "IceT could not composite: " + std::string(reason); };
  switch (error)
  {
    case ICET_NO_ERROR:
      return "";
    case ICET_OUT_OF_MEMORY:
      return because("memory ran out.");
    case ICET_INVALID_VALUE:
    case ICET_INVALID_ENUM:
    case ICET_BAD_CAST:
      return because("it was given a value that it does not take.");
    case ICET_INVALID_OPERATION:
      return because("it was called when it may not be.");
    default:
      return because("it found itself in a wrong state.");
  }
}

/// Throws Error, the same on all ranks, when IceT complains on one of them.
FloatImage CompositeByIceT(Communicator& communicator, MPI_Comm ranks, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, CompositeStatistics& statistics)
{
  if (viewport.Empty())
  {
    return communicator.Rank() == 0 ? FloatImage{ viewport, {} } : FloatImage{};
  }
  // One variable keeps complaints of all contexts: an old one, of ParaView's compositor, is not
  // ours.
  (void)icetGetError();
  const ScopedContext context(ranks);
  icetSetColorFormat(ICET_IMAGE_COLOR_RGBA_FLOAT);
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
  FloatImage picture = Framed(mine, viewport);
  const IceTImage image =
    icetCompositeImage(picture.Pixels.data(), nullptr, valid, nullptr, nullptr, background);
  IceTInt sent = 0;
  icetGetIntegerv(ICET_BYTES_SENT, &sent);
  statistics.BytesSent += static_cast<std::uint64_t>(sent);
  const std::string complaint = AgreeOnError(communicator, ComplaintOfIceT());
  if (!complaint.empty())
  {
    throw Error(complaint);
  }
  if (communicator.Rank() != 0)
  {
    return {};
  }
  const IceTFloat* from = icetImageGetColorcf(image);
  for (glm::vec4& pixel : picture.Pixels)
  {
    pixel = glm::make_vec4(from);
    from += 4;
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
             const PixelRect& viewport, CompositeStatistics&) { return Framed(mine, viewport); };
  }
  const MPI_Comm ranks = *mpi->GetMPIComm()->GetHandle();
  return
    [ranks](Communicator& communicator, const FloatImage& mine, const std::vector<int>& frontToBack,
      const PixelRect& viewport, CompositeStatistics& statistics)
  { return CompositeByIceT(communicator, ranks, mine, frontToBack, viewport, statistics); };
}

} // namespace banyan
