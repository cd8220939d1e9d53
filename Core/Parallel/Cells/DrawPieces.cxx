// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/DrawPieces.h"

#include "Base/StopFlag.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
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
    , Picture(communicator)
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
    Attempt(failure, [this] { this->Picture.Clear(this->Scene.Viewport); });
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
    if (this->Scene.Segments)
    {
      ThrowTogether(this->Ranks, failure);
      return {};
    }
    return this->Picture.Gather(this->Ranks, root, failure, this->Statistics.Sent);
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
      .DrawTiles(this->Picture.Pixels(), nullptr, this->Picture.Share());
    this->Statistics.DrawSeconds += timer.Seconds();
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
          PutRuns(
            messages[static_cast<std::size_t>(this->Picture.Share().OwnerOf(runs.Position))], runs);
          this->Statistics.Runs += asked ? 0 : static_cast<std::int64_t>(runs.Runs.size());
          this->Statistics.Raw += asked ? 0 : static_cast<std::int64_t>(runs.Raw.size());
        }
        this->Statistics.DrawSeconds += timer.Seconds();
      });
    const std::vector<Bytes> from =
      ExchangeCounted(this->Ranks, std::move(messages), failure, this->Statistics.Sent);
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
    const LevelSampling& sampling = *level.Samplings.at(number);
    const SlabBlend blend = this->Caster->BlendOf(sampling);
    if (this->Scene.Segments)
    {
      TileSegments segments{ position, {} };
      merger.MergeToSegments(blend, sampling.Distance, segments.Segments);
      // Where ranks do not agree the tile is merged again.
      if (agree)
      {
        this->Scene.Segments->Add(std::move(segments));
      }
      return;
    }
    const auto pixels = std::make_unique<TilePixels>();
    merger.Merge(blend, level.TransmittanceLimit(), *pixels);
    this->Picture.Set(position, pixels->data());
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
    const std::vector<Bytes> from =
      ExchangeCounted(this->Ranks, std::move(messages), failure, this->Statistics.Sent);
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

  Communicator& Ranks;
  const RayScene& Scene;
  CellSource& Source;
  ThreadPool& Pool;
  PieceStatistics& Statistics;
  TilePicture Picture; ///< of the viewport
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
