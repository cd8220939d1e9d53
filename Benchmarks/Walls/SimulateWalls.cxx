// SPDX-License-Identifier: BSD-3-Clause
// Brings the pixels of a recorded wall to its tiles on simulated ranks, and prints lines of a
// table: `volume,megapixels,ranks,view,method,network,ms,bytes,max_bytes_in,max_difference`.
//
//   smpirun ... banyan-simulate-walls FOLDER VOLUME MEGAPIXELS TILES VIEW GIGABITS METHODS
//
// Built by walls.sh with the simulator's compiler. Each tile is compared with what one rank would
// blend; a wrong one ends the run.
#include "FrameFile.h"
#include "Peers/IceTMethods.h"
#include "Wall.h"

#include "Base/Error.h"
#include "Parallel/Communicate/MpiCommunicator.h"
#include "Parallel/Composite/Compositing.h"
#include "Parallel/Composite/FragmentMessage.h"

#include <mpi.h>

#include <cstdio>
#include <cstdlib>
#include <deque>
#include <functional>
#include <sstream>

namespace
{

using namespace banyan;
using namespace banyan::bench;

struct Measured
{
  double Seconds = 0;
  CompositeStatistics Statistics;
  double WorstError = 0; ///< of this rank's tile, in 1/255
};

int Rounded(float value)
{
  return static_cast<int>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

/// What one rank would blend.
std::vector<glm::vec4> BlendedSerially(FrameReader& frame, const PixelRect& rect)
{
  std::vector<glm::vec4> picture(static_cast<std::size_t>(rect.Count()), glm::vec4(0.0f));
  for (const int rank : frame.Head().Order)
  {
    const FloatImage image = frame.ImageOf(rank);
    const PixelRect part = Intersection(image.Rect, rect);
    for (int y = part.Lo.y; y < part.Hi.y; ++y)
    {
      for (int x = part.Lo.x; x < part.Hi.x; ++x)
      {
        const glm::ivec2 at = glm::ivec2(x, y) - rect.Lo;
        glm::vec4& pixel = picture[static_cast<std::size_t>(at.y) * rect.Size().x + at.x];
        pixel = Combined(pixel, image.At(x, y), Combination::Over);
      }
    }
  }
  return picture;
}

/// A channel of a pixel of this rank's tile, in 1/255.
using ChannelOf = std::function<double(int x, int y, int channel)>;

class Simulation
{
public:
  Simulation(const std::string& folder, const Wall& wall, double bytesPerSecond)
    : Folder(folder)
    , Screens(wall)
    , BytesPerSecond(bytesPerSecond)
  {
    const MPI_Comm world = MPI_COMM_WORLD;
    // Simulated time stands still while a rank looks whether a message has come.
    MpiTimeout timeout;
    timeout.Seconds = 0;
    this->Ranks = MakeMpiCommunicator(&world, std::size_t{ 1 } << 30, timeout);
  }

  /// @param method a division, `-few-bits` behind it or not, or `icet-reduce`, with floats or not
  Measured Run(const std::string& method)
  {
    return method.rfind("icet-", 0) == 0 ? this->RunIceT(method) : this->RunOwn(method);
  }

  Communicator& World() { return *this->Ranks; }

private:
  FrameReader Frame(const std::string& division, const PicturePlace& tile) const
  {
    return FrameReader(this->Folder + "/" + division + "/" + std::to_string(tile.Root) + ".frame");
  }

  const PicturePlace* MyTile() const
  {
    const auto self = static_cast<std::size_t>(this->Ranks->Rank());
    return self < this->Screens.Tiles.size() ? &this->Screens.Tiles[self] : nullptr;
  }

  double ErrorOf(const std::string& division, const ChannelOf& channel) const
  {
    const PicturePlace& tile = *this->MyTile();
    FrameReader frame = this->Frame(division, tile);
    const std::vector<glm::vec4> expected = BlendedSerially(frame, tile.Rect);
    double worst = 0.0;
    std::size_t i = 0;
    for (int y = tile.Rect.Lo.y; y < tile.Rect.Hi.y; ++y)
    {
      for (int x = tile.Rect.Lo.x; x < tile.Rect.Hi.x; ++x, ++i)
      {
        for (int c = 0; c < 4; ++c)
        {
          worst = std::max(worst, std::abs(channel(x, y, c) - Rounded(expected[i][c])));
        }
      }
    }
    return worst;
  }

  /// All tiles at once, as DrawDistributed has them.
  Measured RunOwn(const std::string& method)
  {
    const std::string few = "-few-bits";
    const auto at = method.find(few);
    const std::string division = method.substr(0, at);
    CompositeOptions options;
    options.Agreed = true;
    options.Costs.BytesPerSecond = this->BytesPerSecond;
    options.Transport =
      at == std::string::npos ? PixelTransport::Floats : PixelTransport::WithinOne;
    std::deque<FloatImage> drawn; // referred to
    std::vector<PictureOfRanks> pictures;
    for (const PicturePlace& tile : this->Screens.Tiles)
    {
      FrameReader frame = this->Frame(division, tile);
      const FrameHead& head = frame.Head();
      options.Footprints = head.Footprints;
      options.Root = tile.Root;
      const FloatImage& own = drawn.emplace_back(frame.ImageOf(this->Ranks->Rank()));
      pictures.push_back({ own, head.Order, head.Viewport, options });
    }
    Measured measured;
    this->Ranks->Barrier();
    const double begin = MPI_Wtime();
    const std::vector<FloatImage> tiles =
      CompositeTogether(*this->Ranks, pictures, measured.Statistics);
    measured.Seconds = MPI_Wtime() - begin;
    if (this->MyTile())
    {
      const FloatImage& mine = tiles.at(static_cast<std::size_t>(this->Ranks->Rank()));
      measured.WorstError =
        this->ErrorOf(division, [&](int x, int y, int c) { return Rounded(mine.At(x, y)[c]); });
    }
    return measured;
  }

  Measured RunIceT(const std::string& method)
  {
    const bool floats = method.rfind("icet-floats-", 0) == 0;
    const std::string strategy = method.substr(floats ? 12 : 5);
    IceTPicture picture({ glm::ivec2(0), this->Screens.Size }, floats);
    std::vector<int> order;
    for (const PicturePlace& tile : this->Screens.Tiles)
    {
      FrameReader frame = this->Frame("by-data", tile);
      picture.Put(frame.ImageOf(this->Ranks->Rank()), tile.Rect);
      order = frame.Head().Order;
    }
    IceTCompositor compositor(floats);
    Measured measured;
    this->Ranks->Barrier();
    const double begin = MPI_Wtime();
    compositor.Composite(strategy, picture, order, this->Screens.Tiles, measured.Statistics);
    measured.Seconds = MPI_Wtime() - begin;
    if (const PicturePlace* const tile = this->MyTile())
    {
      const auto channel = [&](int x, int y, int c)
      {
        const glm::ivec2 at = glm::ivec2(x, y) - tile->Rect.Lo;
        const std::size_t pixel = static_cast<std::size_t>(at.y) * tile->Rect.Size().x + at.x;
        return std::round(compositor.Channel(4 * pixel + static_cast<std::size_t>(c)));
      };
      measured.WorstError = this->ErrorOf("by-data", channel);
    }
    return measured;
  }

  const std::string Folder;
  const Wall Screens;
  const double BytesPerSecond;
  std::unique_ptr<Communicator> Ranks;
};

void Run(int argc, char** argv)
{
  if (argc != 8)
  {
    throw Error("A folder, volume, megapixels, tiles, view, gigabits and methods are needed.");
  }
  const double gigabits = std::atof(argv[6]);
  Simulation simulation(argv[1], Wall(std::atof(argv[3]), std::atoi(argv[4])), 1.25e8 * gigabits);
  Communicator& ranks = simulation.World();
  std::istringstream list(argv[7]);
  for (std::string method; std::getline(list, method, ',');)
  {
    const Measured measured = simulation.Run(method);
    const double seconds = AllMax(ranks, measured.Seconds);
    const double bytes = AllSum(ranks, static_cast<double>(measured.Statistics.BytesSent));
    const double most = AllMax(ranks, static_cast<double>(measured.Statistics.BytesReceived));
    const double worst = AllMax(ranks, measured.WorstError);
    // IceT's 8 bits are rounded wherever two pixels are blended.
    const double allowed = method.rfind("icet-", 0) == 0 ? ranks.Size() + 1.0 : 1.0;
    if (worst > allowed)
    {
      throw Error("The picture of " + method + " is off by " + std::to_string(worst) + "/255.");
    }
    if (ranks.Rank() == 0)
    {
      std::printf("%s,%g,%d,%s,%s,%g,%.4f,%.0f,%.0f,%.0f\n", argv[2], std::atof(argv[3]),
        ranks.Size(), argv[5], method.c_str(), gigabits, 1e3 * seconds, bytes, most, worst);
      std::fflush(stdout);
    }
  }
}

} // namespace

int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  try
  {
    Run(argc, argv);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
  }
  MPI_Finalize();
  return EXIT_SUCCESS;
}
