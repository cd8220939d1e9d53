// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_TileOwnerCompositor_h
#define banyan_Parallel_Composite_TileOwnerCompositor_h

#include "Parallel/Composite/Compositing.h"
#include "Parallel/Composite/TileOwnerMessages.h"

#include <memory>

namespace banyan
{

/// The compositor for one frame of one rank, chunk by chunk, as these have been drawn. It descends
/// from SLIC: tiles have owners, which blend what others send. Collective: all ranks
/// make one, `Add` each chunk once, and `Finish`. Several may be under way at once:
/// CompositeTogether.
class TileOwnerCompositor
{
public:
  /// Everything referred to must stay. The arguments are those of Composite, which have been
  /// checked, footprints among them.
  /// @param chunksBefore of pictures that are under way at the same time, on all ranks alike
  TileOwnerCompositor(Communicator& communicator, const std::vector<int>& frontToBack,
    const PixelRect& viewport, const CompositeOptions& options, CompositeStatistics& statistics,
    int chunksBefore = 0);
  TileOwnerCompositor(const TileOwnerCompositor&) = delete;
  TileOwnerCompositor& operator=(const TileOwnerCompositor&) = delete;
  ~TileOwnerCompositor();

  const CompositePlan& GetPlan() const { return this->Plan; }

  /// From now on messages may come.
  /// @param postedBefore calls of `ReceiveWhole` for other pictures that are under way
  void Begin(std::size_t postedBefore = 0);
  /// How many messages this rank gets, once it has begun.
  std::size_t Posted() const { return this->Expected.size(); }

  /// Sends what others need of this rank's pixels in a chunk.
  /// @param mine its pixels; those of other chunks are not read, and these only now. Null when they
  /// could not be drawn: others then get empty messages in the place of pixels, so that nobody
  /// waits for them. Ranks have to agree on the error afterwards; the picture is no good
  void Add(int chunk, const FloatImage* mine);

  /// Takes what has come, and passes on what is complete, without waiting. Nothing else is under
  /// way.
  void Poll();
  /// Takes a message that has come, unless it is another picture's.
  void Take(const Communicator::Arrival& arrival);

  /// Waits for the rest. @return as Composite
  FloatImage Finish();

private:
  using Kind = CompositePlan::Kind;

  struct Message
  {
    int From;
    TileMessage Sort;
    int Chunk;
    std::unique_ptr<std::uint8_t[]> Data; ///< not cleared: most of it is never touched
    std::size_t Bytes;                    ///< 0 when the sender has failed
    bool Here;
  };

  /// Tiles of a chunk that this rank owns: what lies before the root's pixels (or all, where it has
  /// none), and what lies behind.
  struct Halves
  {
    FloatImage Before;
    FloatImage Behind;
  };

  /// Says what has become of a chunk.
  struct Part
  {
    bool Added = false;
    bool Failed = false;           ///< here, or on a rank whose pixels this owner needs
    bool Passed = false;           ///< this owner has sent the result
    int Missing = -1;              ///< messages under way for this owner; -1: not an owner
    std::vector<std::uint8_t> Own; ///< this owner's pixels, as those that others send it
  };

  bool Owns(int rank, int tile) const { return this->Plan.Tiles[tile].Owner == rank; }
  bool BeforeRoot(int rank) const { return this->Position[rank] < this->Position[this->Plan.Root]; }
  bool IsRoot() const { return this->Ranks.Rank() == this->Plan.Root; }
  FragmentFormat DirectFormat(Kind kind) const
  {
    return kind == Kind::Final ? FormatOfFinal(this->Options) : FormatFor(this->Options, 1, 1);
  }
  FragmentFormat SharedFormat(Kind kind, int tile) const
  {
    return FormatFor(this->Options, this->Plan.Tiles[tile].Meeting, kind == Kind::Final ? 1 : 2);
  }
  FragmentFormat ResultFormat(Kind kind) const
  {
    return kind == Kind::Final ? FormatOfFinal(this->Options)
                               : FormatFor(this->Options, kind == Kind::Split ? 2 : 1, 2);
  }

  template <typename Action>
  void ForEachPart(int from, int to, TileMessage sort, int chunk, const Action& action)
  {
    ForEachRegion(this->Plan, from, to, sort, chunk, this->Region, action);
  }
  int TagOf(TileMessage sort, int chunk) const
  {
    return banyan::TagOf(sort, this->ChunksBefore + chunk);
  }
  bool Expect(int from, TileMessage sort, int chunk);
  void ExpectAsOwner();
  template <typename Write>
  void Send(int to, TileMessage sort, int chunk, bool failed, const Write& write);
  void SendDirect(int chunk, const FloatImage* mine);
  void SendShared(int chunk, const FloatImage* mine);
  void KeepOwn(int chunk, const FloatImage& mine);
  void SendResults();
  void SendResult(int chunk);
  void BlendAtRoot(Message& message);
  void CopyOwn(int chunk, const FloatImage& mine);
  std::vector<Halves> BlendTiles(int chunk);
  void BlendFrom(
    int from, int chunk, const std::uint8_t* data, std::size_t bytes, std::vector<Halves>& tiles);

  Communicator& Ranks;
  const std::vector<int>& Order;
  const CompositeOptions& Options;
  CompositeStatistics& Statistics;
  const int ChunksBefore;
  const bool Ordered;
  const bool Pack;
  const std::shared_ptr<const CompositePlan> SharedPlan;
  const CompositePlan& Plan; ///< this one
  std::vector<int> Position; ///< of each rank in the visibility order
  FloatImage Picture;
  std::vector<Message> Expected;
  std::size_t Open = 0;         ///< of these
  std::size_t PostedBefore = 0; ///< and before these
  std::vector<Part> Parts;      ///< per chunk
  std::vector<std::vector<std::uint8_t>> Outgoing;
  bool Finished = false; ///< no message is under way
  std::vector<std::size_t> IndexOfTile;
  CompositePlan::Region Region;
};

} // namespace banyan

#endif
