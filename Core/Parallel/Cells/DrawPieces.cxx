// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/DrawPieces.h"

#include "Base/StopFlag.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Base/Varint.h"
#include "Parallel/Cells/ExchangeBytes.h"
#include "Parallel/Cells/PieceLattice.h"
#include "Parallel/Cells/PieceMeans.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"
#include "Render/Cells/CellCaster.h"
#include "Render/Cells/RunMerger.h"
#include "Render/Cells/RunMessage.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace banyan
{
namespace
{

struct ByPosition
{
  bool operator()(const glm::ivec2& a, const glm::ivec2& b) const
  {
    return std::tie(a.y, a.x) < std::tie(b.y, b.x);
  }
};

/// A tile that this rank merges.
struct OwnTile
{
  struct Part
  {
    int Rank;
    TileRuns Runs;
  };
  std::vector<Part> Parts;
  std::vector<std::vector<AskedIntervals>> Asked; ///< by rank; none where ranks agree
};
using OwnTiles = std::map<glm::ivec2, OwnTile, ByPosition>;

/// One picture.
class PiecePicture
{
public:
  PiecePicture(Communicator& communicator, const RayScene& scene, CellSource& source,
    ThreadPool& pool, PieceStatistics& statistics)
    : Ranks(communicator)
    , Scene(scene)
    , Source(source)
    , Pool(pool)
    , Statistics(statistics)
    , Share{ communicator.Rank(), communicator.Size() }
  {
  }

  FloatImage Draw(int root)
  {
    const bool shaded = this->Scene.Shading.On && this->Scene.Blend.Mode == BlendMode::Composite;
    std::string failure;
    std::set<int> levels{ 0 };
    Attempt(failure, [&] { levels = SampledLevels(this->Scene); }); // alike on all ranks
    if (shaded)
    {
      GivePieceGradients(this->Ranks, this->Source, this->Pool);
    }
    if (*levels.rbegin() > 0)
    {
      GivePieceLattice(this->Ranks, this->Source, shaded, this->Pool);
    }
    Attempt(failure,
      [this]
      {
        this->Picture.Rect = this->Scene.Viewport;
        this->Picture.Pixels.assign(
          static_cast<std::size_t>(this->Picture.Rect.Count()), glm::vec4(0.0f));
      });
    for (const int level : levels)
    {
      if (level == 0)
      {
        this->DrawCells(failure);
      }
      else
      {
        Attempt(failure, [this, level, shaded] { this->DrawLattice(level, shaded); });
      }
    }
    return this->Gather(root, failure);
  }

private:
  /// Collective: draws the tiles that show cells.
  void DrawCells(std::string& failure)
  {
    Attempt(failure,
      [this]
      {
        this->Caster = std::make_unique<CellCaster>(
          this->Scene, this->Source, this->Source, nullptr, this->Pool, this->Statistics.Rays);
      });
    this->Send(nullptr, failure);
    Attempt(failure, [this] { this->Merge(false); });
    this->AskAgain(failure);
  }

  /// Draws this rank's tiles that show a coarser level.
  void DrawLattice(int level, bool shaded)
  {
    const Timer timer;
    BrickSource* const at = this->Source.AtLevel(level, this->Scene.DomainCells);
    if (!at)
    {
      throw Error("There is no level " + std::to_string(level) + " of the mesh");
    }
    CellCaster(this->Scene, this->Source, *at, this->Source.LatticeOf(level, shaded, this->Pool),
      this->Pool, this->Statistics.Rays)
      .DrawTiles(this->Picture, nullptr, this->Share);
    this->Statistics.DrawSeconds += timer.Seconds();
  }

  std::vector<Bytes> Exchange(std::vector<Bytes> messages, std::string& failure)
  {
    for (std::size_t rank = 0; rank < messages.size(); ++rank)
    {
      const bool mine = rank == static_cast<std::size_t>(this->Ranks.Rank());
      this->Statistics.Bytes += mine ? 0 : messages[rank].size();
      this->Statistics.Messages += mine || messages[rank].empty() ? 0 : 1;
    }
    return ExchangeBytes(this->Ranks, std::move(messages), failure);
  }

  std::vector<Bytes> NoMessages() const
  {
    return std::vector<Bytes>(static_cast<std::size_t>(this->Ranks.Size()));
  }

  /// Draws this rank's cells, and brings what all have to the owners of tiles.
  /// @param asked null in the first round
  void Send(const std::vector<AskedTile>* asked, std::string& failure)
  {
    std::vector<Bytes> messages = this->NoMessages();
    Attempt(failure,
      [&]
      {
        const Timer timer;
        for (const TileRuns& runs : this->Caster->DrawRuns(asked))
        {
          PutRuns(messages[static_cast<std::size_t>(this->Share.OwnerOf(runs.Position))], runs);
          this->Statistics.Runs += asked ? 0 : static_cast<std::int64_t>(runs.Runs.size());
          this->Statistics.Raw += asked ? 0 : static_cast<std::int64_t>(runs.Raw.size());
        }
        this->Statistics.DrawSeconds += timer.Seconds();
      });
    const std::vector<Bytes> from = this->Exchange(std::move(messages), failure);
    Attempt(failure,
      [&]
      {
        const Timer timer;
        for (std::size_t rank = 0; rank < from.size(); ++rank)
        {
          for (TileRuns& runs : TakeRuns(from[rank].data(), from[rank].size()))
          {
            const glm::ivec2 position = runs.Position;
            this->Tiles[position].Parts.push_back({ static_cast<int>(rank), std::move(runs) });
          }
        }
        this->Statistics.MergeSeconds += timer.Seconds();
      });
  }

  /// Makes the pixels of tiles.
  /// @param anew those alone that something was asked of
  void Merge(bool anew)
  {
    const Timer timer;
    std::vector<std::pair<glm::ivec2, OwnTile*>> tiles;
    for (auto& [position, tile] : this->Tiles)
    {
      if (!anew || !tile.Asked.empty())
      {
        tiles.emplace_back(position, &tile);
      }
    }
    std::vector<std::unique_ptr<RunMerger>> mergers(static_cast<std::size_t>(this->Pool.Width()));
    const std::function<void(std::int64_t, int)> merge = [&](std::int64_t number, int worker)
    {
      std::unique_ptr<RunMerger>& mine = mergers[static_cast<std::size_t>(worker)];
      mine = mine ? std::move(mine) : std::make_unique<RunMerger>();
      this->MergeTile(tiles[static_cast<std::size_t>(number)].first,
        *tiles[static_cast<std::size_t>(number)].second, *mine);
    };
    this->Pool.ParallelFor(static_cast<std::int64_t>(tiles.size()), merge);
    this->Statistics.MergeSeconds += timer.Seconds();
  }

  void MergeTile(const glm::ivec2& position, OwnTile& tile, RunMerger& merger)
  {
    if (this->Scene.Stop)
    {
      this->Scene.Stop->Check();
    }
    const LevelScene& level = this->Caster->Drawn();
    const TileSamplings* const samplings = this->Scene.Samplings.get();
    const auto number = static_cast<std::size_t>(samplings ? samplings->NumberAt(position) : 0);
    for (const OwnTile::Part& part : tile.Parts)
    {
      merger.Add(part.Rank, part.Runs);
    }
    std::vector<std::vector<AskedIntervals>> asked(static_cast<std::size_t>(this->Ranks.Size()));
    const bool agree = merger.Agree(asked);
    tile.Asked = agree ? std::vector<std::vector<AskedIntervals>>() : std::move(asked);
    const auto pixels = std::make_unique<TilePixels>();
    merger.Merge(
      this->Caster->BlendOf(*level.Samplings.at(number)), level.TransmittanceLimit(), *pixels);
    const PixelRect rect = this->RectOf(position);
    for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
    {
      const glm::ivec2 at = glm::ivec2(rect.Lo.x, y) - position * RayTile::Edge;
      std::copy_n(pixels->data() + at.y * RayTile::Edge + at.x, rect.Size().x,
        &this->Picture.At(rect.Lo.x, y));
    }
  }

  /// The second round: what ranks have to give raw, they give. All ranks know when none has to.
  void AskAgain(std::string& failure)
  {
    std::vector<Bytes> messages;
    bool any = false;
    Attempt(failure,
      [&]
      {
        messages = this->NoMessages();
        for (auto& [position, tile] : this->Tiles)
        {
          for (std::size_t rank = 0; rank < tile.Asked.size(); ++rank)
          {
            if (!tile.Asked[rank].empty())
            {
              AskedTile asked{ position, std::move(tile.Asked[rank]) };
              SortAsked(asked.Intervals);
              PutAsked(messages[rank], asked);
              any = true;
              RemoveAskedOf(tile, static_cast<int>(rank), asked);
            }
          }
        }
      });
    // Who has failed takes all others along: Exchange agrees on it.
    if (AllMax(this->Ranks, any || !failure.empty() ? 1.0 : 0.0) == 0.0)
    {
      return;
    }
    const std::vector<Bytes> from = this->Exchange(std::move(messages), failure);
    std::vector<AskedTile> asked;
    Attempt(failure,
      [&]
      {
        for (const Bytes& message : from)
        {
          for (AskedTile& tile : TakeAsked(message.data(), message.size()))
          {
            this->Statistics.Asked += static_cast<std::int64_t>(tile.Intervals.size());
            asked.push_back(std::move(tile));
          }
        }
      });
    this->Send(&asked, failure);
    Attempt(failure, [this] { this->Merge(true); });
  }

  static void RemoveAskedOf(OwnTile& tile, int rank, const AskedTile& asked)
  {
    for (OwnTile::Part& part : tile.Parts)
    {
      if (part.Rank == rank)
      {
        RemoveAsked(asked, part.Runs);
      }
    }
  }

  PixelRect RectOf(const glm::ivec2& tile) const
  {
    const glm::ivec2 low = tile * RayTile::Edge;
    return Intersection({ low, low + RayTile::Edge }, this->Scene.Viewport);
  }

  /// Calls function(position) for this rank's tiles.
  template <class Function>
  void ForMyTiles(Function&& function) const
  {
    const PixelRect& all = this->Scene.Viewport;
    const glm::ivec2 first = all.Lo / RayTile::Edge;
    const glm::ivec2 end = (all.Hi + (RayTile::Edge - 1)) / RayTile::Edge;
    for (int y = first.y; y < end.y; ++y)
    {
      for (int x = first.x; x < end.x; ++x)
      {
        if (this->Share.Has({ x, y }))
        {
          function(glm::ivec2(x, y));
        }
      }
    }
  }

  /// Pixels with anything, as runs of them in rows of the picture.
  void PutPixels(Bytes& message, const PixelRect& rect) const
  {
    for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
    {
      int begin = rect.Lo.x;
      int end = rect.Hi.x;
      const auto isNothing = [&](int x) { return this->Picture.At(x, y) == glm::vec4(0.0f); };
      for (; begin < end && isNothing(begin); ++begin)
      {
      }
      for (; begin < end && isNothing(end - 1); --end)
      {
      }
      if (begin < end)
      {
        const int head[3] = { begin, y, end - begin };
        const auto pixels = static_cast<std::size_t>(end - begin) * sizeof(glm::vec4);
        const std::size_t at = message.size();
        message.resize(at + sizeof(head) + pixels);
        std::memcpy(message.data() + at, head, sizeof(head));
        std::memcpy(message.data() + at + sizeof(head), &this->Picture.At(begin, y), pixels);
      }
    }
  }

  void TakePixels(const Bytes& message)
  {
    ByteReader in(message.data(), message.size());
    while (in.Left() > 0)
    {
      const int x = in.Number<int>();
      const int y = in.Number<int>();
      const auto pixels = static_cast<std::size_t>(in.Number<int>()) * sizeof(glm::vec4);
      std::memcpy(&this->Picture.At(x, y), in.Skip(pixels), pixels);
    }
  }

  /// Collective: brings all tiles to the root, or to all ranks.
  FloatImage Gather(int root, std::string& failure)
  {
    Bytes mine;
    Attempt(failure,
      [&] {
        this->ForMyTiles(
          [&](const glm::ivec2& tile) { this->PutPixels(mine, this->RectOf(tile)); });
      });
    std::vector<Bytes> from;
    if (root == EveryRank)
    {
      const auto others = static_cast<std::uint64_t>(this->Ranks.Size() - 1);
      this->Statistics.Bytes += mine.size() * others;
      this->Statistics.Messages += mine.empty() ? 0 : others;
      from = AllGatherBytes(this->Ranks, std::move(mine), failure);
    }
    else
    {
      std::vector<Bytes> messages = this->NoMessages();
      messages[static_cast<std::size_t>(root)] = std::move(mine);
      from = this->Exchange(std::move(messages), failure);
    }
    if (root != EveryRank && root != this->Ranks.Rank())
    {
      return {};
    }
    for (const Bytes& message : from)
    {
      this->TakePixels(message);
    }
    return std::move(this->Picture);
  }

  Communicator& Ranks;
  const RayScene& Scene;
  CellSource& Source;
  ThreadPool& Pool;
  PieceStatistics& Statistics;
  const TileShare Share;
  FloatImage Picture; ///< of the viewport: this rank's tiles
  std::unique_ptr<CellCaster> Caster;
  OwnTiles Tiles;
};

} // namespace

FloatImage DrawPieces(Communicator& communicator, const RayScene& scene, CellSource& source,
  ThreadPool& pool, int root, PieceStatistics& statistics)
{
  return PiecePicture(communicator, scene, source, pool, statistics).Draw(root);
}

} // namespace banyan
