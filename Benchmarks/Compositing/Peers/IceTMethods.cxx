// SPDX-License-Identifier: BSD-3-Clause
#include "IceTMethods.h"

#include "Base/Error.h"

#include <IceT.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <deque>

namespace banyan::bench
{
namespace
{

/// What the struct of functions has behind it. Ranks of a subset share the statistics.
struct Link
{
  MPI_Comm Handle;
  CompositeStatistics* Statistics;
  std::deque<MPI_Request> Requests; ///< addresses stay
};

Link& LinkOf(IceTCommunicator self)
{
  return *static_cast<Link*>(self->data);
}

std::size_t SizeOf(IceTEnum type)
{
  switch (type)
  {
    case ICET_BOOLEAN:
    case ICET_BYTE:
      return 1;
    case ICET_SHORT:
      return 2;
    case ICET_DOUBLE:
      return 8;
    default:
      return 4;
  }
}
int BytesOf(int count, IceTEnum type)
{
  return static_cast<int>(static_cast<std::size_t>(count) * SizeOf(type));
}
bool InPlace(const void* buffer)
{
  // As IceT's own communicator has it, in a header that is not installed.
  return buffer == reinterpret_cast<const void*>(-1);
}

IceTCommunicator Make(MPI_Comm handle, CompositeStatistics* statistics);

IceTCommunicator Duplicate(IceTCommunicator self)
{
  MPI_Comm copy;
  MPI_Comm_dup(LinkOf(self).Handle, &copy);
  return Make(copy, LinkOf(self).Statistics);
}
void Destroy(IceTCommunicator self)
{
  MPI_Comm_free(&LinkOf(self).Handle);
  delete &LinkOf(self);
  delete self;
}
IceTCommunicator Subset(IceTCommunicator self, int count, const IceTInt32* ranks)
{
  MPI_Group all;
  MPI_Group some;
  MPI_Comm_group(LinkOf(self).Handle, &all);
  MPI_Group_incl(all, count, ranks, &some);
  MPI_Comm subset;
  MPI_Comm_create(LinkOf(self).Handle, some, &subset);
  MPI_Group_free(&all);
  MPI_Group_free(&some);
  return subset == MPI_COMM_NULL ? nullptr : Make(subset, LinkOf(self).Statistics);
}
void Barrier(IceTCommunicator self)
{
  MPI_Barrier(LinkOf(self).Handle);
}
int Comm_size(IceTCommunicator self)
{
  int size = 0;
  MPI_Comm_size(LinkOf(self).Handle, &size);
  return size;
}
int Comm_rank(IceTCommunicator self)
{
  int rank = 0;
  MPI_Comm_rank(LinkOf(self).Handle, &rank);
  return rank;
}
void CountReceived(IceTCommunicator self, int bytes)
{
  LinkOf(self).Statistics->BytesReceived += static_cast<std::uint64_t>(bytes);
}
void Send(IceTCommunicator self, const void* data, int count, IceTEnum type, int to, int tag)
{
  MPI_Send(data, BytesOf(count, type), MPI_BYTE, to, tag, LinkOf(self).Handle);
  LinkOf(self).Statistics->Sent(BytesOf(count, type));
}
void CountStatus(IceTCommunicator self, MPI_Status* status)
{
  int bytes = 0;
  MPI_Get_count(status, MPI_BYTE, &bytes);
  CountReceived(self, bytes);
}
void Recv(IceTCommunicator self, void* data, int count, IceTEnum type, int from, int tag)
{
  MPI_Status status;
  MPI_Recv(data, BytesOf(count, type), MPI_BYTE, from, tag, LinkOf(self).Handle, &status);
  CountStatus(self, &status);
}
void Sendrecv(IceTCommunicator self, const void* sent, int sentCount, IceTEnum sentType, int to,
  int sentTag, void* received, int receivedCount, IceTEnum receivedType, int from, int receivedTag)
{
  MPI_Status status;
  MPI_Sendrecv(sent, BytesOf(sentCount, sentType), MPI_BYTE, to, sentTag, received,
    BytesOf(receivedCount, receivedType), MPI_BYTE, from, receivedTag, LinkOf(self).Handle,
    &status);
  LinkOf(self).Statistics->Sent(BytesOf(sentCount, sentType));
  CountStatus(self, &status);
}
/// Everybody but the root sends one message; what the root has of its own stays.
void CountGathered(IceTCommunicator self, int bytes, int all, int root)
{
  if (Comm_rank(self) != root)
  {
    LinkOf(self).Statistics->Sent(static_cast<std::size_t>(bytes));
  }
  else
  {
    CountReceived(self, all);
  }
}
void Gather(
  IceTCommunicator self, const void* sent, int count, IceTEnum type, void* received, int root)
{
  const int bytes = BytesOf(count, type);
  MPI_Gather(InPlace(sent) ? MPI_IN_PLACE : sent, bytes, MPI_BYTE, received, bytes, MPI_BYTE, root,
    LinkOf(self).Handle);
  CountGathered(self, bytes, bytes * (Comm_size(self) - 1), root);
}
void Gatherv(IceTCommunicator self, const void* sent, int count, IceTEnum type, void* received,
  const int* counts, const int* offsets, int root)
{
  std::vector<int> byteCounts;
  std::vector<int> byteOffsets;
  int others = 0;
  for (int rank = 0; rank < Comm_size(self) && Comm_rank(self) == root; ++rank)
  {
    byteCounts.push_back(BytesOf(counts[rank], type));
    byteOffsets.push_back(BytesOf(offsets[rank], type));
    others += rank == root ? 0 : byteCounts.back();
  }
  MPI_Gatherv(InPlace(sent) ? MPI_IN_PLACE : sent, BytesOf(count, type), MPI_BYTE, received,
    byteCounts.data(), byteOffsets.data(), MPI_BYTE, root, LinkOf(self).Handle);
  CountGathered(self, BytesOf(count, type), others, root);
}
/// As if everybody sent to everybody; these are a few numbers only.
void CountAll(IceTCommunicator self, int bytes)
{
  for (int peer = 1; peer < Comm_size(self); ++peer)
  {
    LinkOf(self).Statistics->Sent(static_cast<std::size_t>(bytes));
    CountReceived(self, bytes);
  }
}
void Allgather(IceTCommunicator self, const void* sent, int count, IceTEnum type, void* received)
{
  const int bytes = BytesOf(count, type);
  MPI_Allgather(InPlace(sent) ? MPI_IN_PLACE : sent, bytes, MPI_BYTE, received, bytes, MPI_BYTE,
    LinkOf(self).Handle);
  CountAll(self, bytes);
}
void Alltoall(IceTCommunicator self, const void* sent, int count, IceTEnum type, void* received)
{
  const int bytes = BytesOf(count, type);
  MPI_Alltoall(sent, bytes, MPI_BYTE, received, bytes, MPI_BYTE, LinkOf(self).Handle);
  CountAll(self, bytes);
}

IceTCommRequest Wrapped(MPI_Request request)
{
  auto* wrapped = new IceTCommRequestStruct;
  wrapped->magic_number = 0;
  wrapped->internals = new MPI_Request(request);
  return wrapped;
}
MPI_Request& RequestOf(IceTCommRequest request)
{
  return *static_cast<MPI_Request*>(request->internals);
}
void Release(IceTCommRequest* request)
{
  delete &RequestOf(*request);
  delete *request;
  *request = ICET_COMM_REQUEST_NULL;
}
IceTCommRequest Isend(
  IceTCommunicator self, const void* data, int count, IceTEnum type, int to, int tag)
{
  MPI_Request request;
  MPI_Isend(data, BytesOf(count, type), MPI_BYTE, to, tag, LinkOf(self).Handle, &request);
  LinkOf(self).Statistics->Sent(BytesOf(count, type));
  return Wrapped(request);
}
IceTCommRequest Irecv(
  IceTCommunicator self, void* data, int count, IceTEnum type, int from, int tag)
{
  MPI_Request request;
  MPI_Irecv(data, BytesOf(count, type), MPI_BYTE, from, tag, LinkOf(self).Handle, &request);
  return Wrapped(request);
}
/// Of sends, the status has nothing that counts.
void CountDone(IceTCommunicator self, MPI_Status* status)
{
  if (status->MPI_SOURCE >= 0 && status->MPI_SOURCE != Comm_rank(self))
  {
    CountStatus(self, status);
  }
}
void Wait(IceTCommunicator self, IceTCommRequest* request)
{
  if (*request)
  {
    MPI_Status status;
    status.MPI_SOURCE = -1;
    MPI_Wait(&RequestOf(*request), &status);
    CountDone(self, &status);
    Release(request);
  }
}
int Waitany(IceTCommunicator self, int count, IceTCommRequest* requests)
{
  std::vector<MPI_Request> handles;
  for (int i = 0; i < count; ++i)
  {
    handles.push_back(requests[i] ? RequestOf(requests[i]) : MPI_REQUEST_NULL);
  }
  int index = 0;
  MPI_Status status;
  status.MPI_SOURCE = -1;
  MPI_Waitany(count, handles.data(), &index, &status);
  CountDone(self, &status);
  Release(&requests[index]);
  return index;
}

IceTCommunicator Make(MPI_Comm handle, CompositeStatistics* statistics)
{
  return new IceTCommunicatorStruct{ Duplicate, Destroy, Subset, Barrier, Send, Recv, Sendrecv,
    Gather, Gatherv, Allgather, Alltoall, Isend, Irecv, Wait, Waitany, Comm_size, Comm_rank,
    new Link{ handle, statistics, {} } };
}

struct Strategy
{
  const char* Name;
  IceTEnum Whole;
  IceTEnum Single;
};
const Strategy Strategies[] = {
  { "direct", ICET_STRATEGY_DIRECT, ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC },
  { "reduce", ICET_STRATEGY_REDUCE, ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC },
  { "tree", ICET_STRATEGY_SEQUENTIAL, ICET_SINGLE_IMAGE_STRATEGY_TREE },
  { "bswap", ICET_STRATEGY_SEQUENTIAL, ICET_SINGLE_IMAGE_STRATEGY_BSWAP },
  { "bswap-folding", ICET_STRATEGY_SEQUENTIAL, ICET_SINGLE_IMAGE_STRATEGY_BSWAP_FOLDING },
  { "radixk", ICET_STRATEGY_SEQUENTIAL, ICET_SINGLE_IMAGE_STRATEGY_RADIXK },
  { "radixkr", ICET_STRATEGY_SEQUENTIAL, ICET_SINGLE_IMAGE_STRATEGY_RADIXKR },
};

} // namespace

struct IceTCompositor::Internals
{
  IceTCommunicator Communicator = nullptr;
  IceTContext Context = nullptr;
  CompositeStatistics Statistics;
  bool Floats = false;
  const std::uint8_t* PictureBytes = nullptr; ///< IceT's, until it is called again
  const float* PictureFloats = nullptr;
};

std::vector<std::string> IceTStrategies()
{
  std::vector<std::string> names;
  for (const Strategy& strategy : Strategies)
  {
    names.emplace_back(strategy.Name);
  }
  return names;
}

IceTPicture::IceTPicture(const PixelRect& viewport, bool floats)
  : Viewport(viewport)
  , Floats(floats)
  , Pixels(std::calloc(static_cast<std::size_t>(viewport.Count()), floats ? 16 : 4), std::free)
{
  if (!this->Pixels)
  {
    throw Error("There is no memory for a picture of IceT.");
  }
}

void IceTPicture::Put(const FloatImage& image, const PixelRect& part)
{
  const PixelRect drawn = ActiveRect(image, Intersection(part, image.Rect));
  this->Active = Union(this->Active, drawn);
  for (int y = drawn.Lo.y; y < drawn.Hi.y; ++y)
  {
    const glm::ivec2 at = glm::ivec2(drawn.Lo.x, y) - this->Viewport.Lo;
    std::size_t to = 4 * (static_cast<std::size_t>(at.y) * this->Viewport.Size().x + at.x);
    for (int x = drawn.Lo.x; x < drawn.Hi.x; ++x)
    {
      for (int c = 0; c < 4; ++c, ++to)
      {
        const float value = image.At(x, y)[c];
        if (this->Floats)
        {
          static_cast<float*>(this->Pixels.get())[to] = value;
        }
        else
        {
          static_cast<std::uint8_t*>(this->Pixels.get())[to] =
            static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
        }
      }
    }
  }
}

IceTCompositor::IceTCompositor(bool floats)
  : Self(new Internals)
{
  MPI_Comm copy;
  MPI_Comm_dup(MPI_COMM_WORLD, &copy);
  this->Self->Floats = floats;
  this->Self->Communicator = Make(copy, &this->Self->Statistics);
  this->Self->Context = icetCreateContext(this->Self->Communicator);
  icetDiagnostics(ICET_DIAG_ERRORS | ICET_DIAG_WARNINGS);
  icetSetColorFormat(floats ? ICET_IMAGE_COLOR_RGBA_FLOAT : ICET_IMAGE_COLOR_RGBA_UBYTE);
  icetSetDepthFormat(ICET_IMAGE_DEPTH_NONE);
  icetCompositeMode(ICET_COMPOSITE_MODE_BLEND);
  icetEnable(ICET_ORDERED_COMPOSITE);
}

IceTCompositor::~IceTCompositor()
{
  icetDestroyContext(this->Self->Context);
  delete this->Self;
}

bool IceTCompositor::Composite(const std::string& strategy, const IceTPicture& mine,
  const std::vector<int>& frontToBack, const std::vector<PicturePlace>& tiles,
  CompositeStatistics& statistics)
{
  const auto found = std::find_if(std::begin(Strategies), std::end(Strategies),
    [&](const Strategy& known) { return strategy == known.Name; });
  if (found == std::end(Strategies))
  {
    throw Error("IceT has no strategy '" + strategy + "'.");
  }
  icetSetContext(this->Self->Context);
  icetResetTiles();
  bool root = false;
  for (const PicturePlace& tile : tiles)
  {
    const glm::ivec2 at = tile.Rect.Lo - mine.Viewport.Lo;
    icetAddTile(at.x, at.y, tile.Rect.Size().x, tile.Rect.Size().y, tile.Root);
    root = root || tile.Root == Comm_rank(this->Self->Communicator);
  }
  icetStrategy(found->Whole);
  icetSingleImageStrategy(found->Single);
  icetCompositeOrder(frontToBack.data());
  const glm::ivec2 low = mine.Active.Lo - mine.Viewport.Lo;
  const IceTInt valid[] = { mine.Active.Empty() ? 0 : low.x, mine.Active.Empty() ? 0 : low.y,
    mine.Active.Size().x, mine.Active.Size().y };
  const IceTFloat background[] = { 0.0f, 0.0f, 0.0f, 0.0f };
  const IceTImage image =
    icetCompositeImage(mine.Pixels.get(), nullptr, valid, nullptr, nullptr, background);
  if (root && this->Self->Floats)
  {
    this->Self->PictureFloats = icetImageGetColorcf(image);
  }
  else if (root)
  {
    this->Self->PictureBytes = icetImageGetColorcub(image);
  }
  statistics = this->Self->Statistics;
  this->Self->Statistics = {};
  return root;
}

double IceTCompositor::Channel(std::size_t index) const
{
  return this->Self->Floats ? 255.0 * std::clamp(this->Self->PictureFloats[index], 0.0f, 1.0f)
                            : this->Self->PictureBytes[index];
}

} // namespace banyan::bench
