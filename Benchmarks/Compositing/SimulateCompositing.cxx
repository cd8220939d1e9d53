// SPDX-License-Identifier: BSD-3-Clause
// Composites one recorded frame by all methods on simulated ranks, and prints lines of the table.
//
//   smpirun ... banyan-simulate-compositing FRAME SCENE CAMERA NETWORK BYTES_PER_SECOND [METHODS]
//
// Built by compositing.sh with the simulator's compiler. Every picture is compared with the one
// that one rank would blend; a wrong one ends the run.
#include "FrameFile.h"
#include "Peers/IceTMethods.h"
#include "Peers/PeerFrame.h"

#include "Base/Error.h"
#include "Parallel/Communicate/MpiCommunicator.h"
#include "Parallel/Composite/Compositing.h"
#include "Parallel/Composite/FragmentMessage.h"

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace
{

using namespace banyan;
using namespace banyan::bench;

struct Measured
{
  double Seconds = 0;
  CompositeStatistics Statistics;
  double WorstError = 0; ///< of the root's picture, in 1/255
};

std::vector<glm::vec4> BlendedSerially(FrameReader& frame)
{
  const PixelRect& viewport = frame.Head().Viewport;
  std::vector<glm::vec4> picture(static_cast<std::size_t>(viewport.Count()), glm::vec4(0.0f));
  for (const int rank : frame.Head().Order)
  {
    const FloatImage image = frame.ImageOf(rank);
    for (int y = image.Rect.Lo.y; y < image.Rect.Hi.y && !image.Rect.Empty(); ++y)
    {
      for (int x = image.Rect.Lo.x; x < image.Rect.Hi.x; ++x)
      {
        const glm::ivec2 at = glm::ivec2(x, y) - viewport.Lo;
        glm::vec4& pixel = picture[static_cast<std::size_t>(at.y) * viewport.Size().x + at.x];
        pixel = Combined(pixel, image.At(x, y), Combination::Over);
      }
    }
  }
  return picture;
}

int Rounded(float value)
{
  return static_cast<int>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

/// The compositor: `banyan` in few bits, packed; `banyan-raw` in few bits; `banyan-floats`, which
/// is the default.
CompositeOptions OptionsOf(const std::string& method, const FrameHead& head, double bytesPerSecond)
{
  CompositeOptions options;
  options.Footprints = head.Footprints;
  options.Agreed = true;
  options.Costs.BytesPerSecond = bytesPerSecond;
  options.Transport =
    method == "banyan-floats" ? PixelTransport::Floats : PixelTransport::WithinOne;
  options.Packing = method == "banyan" ? PixelPacking::Always : PixelPacking::Never;
  return options;
}

/// The peers travel in 8 bits, whatever that does to the picture.
FloatImage CompositeAsPeer(const std::string& method, Communicator& communicator,
  const FloatImage& mine, const FrameHead& head, CompositeStatistics& statistics)
{
  FragmentFormat bytes;
  bytes.Kind = FragmentFormat::Bytes;
  const PeerFrame frame{ mine, head.Order, head.Viewport, head.Footprints, bytes };
  return method == "slic-published" ? CompositeSlicAsPublished(communicator, frame, statistics)
         : method == "direct-send"  ? CompositeDirectSend(communicator, frame, statistics)
                                    : CompositeBinarySwap(communicator, frame, statistics);
}

bool IsOurs(const std::string& method)
{
  return method.rfind("banyan", 0) == 0;
}

class Simulation
{
public:
  Simulation(const std::string& path, double bytesPerSecond)
    : Frame(path)
    , BytesPerSecond(bytesPerSecond)
  {
    const MPI_Comm world = MPI_COMM_WORLD;
    // Simulated time stands still while a rank looks whether a message has come.
    MpiTimeout timeout;
    timeout.Seconds = 0;
    this->Ranks = MakeMpiCommunicator(&world, std::size_t{ 1 } << 30, timeout);
    if (static_cast<std::size_t>(this->Ranks->Size()) != this->Frame.Head().Order.size())
    {
      throw Error("The frame was recorded for another number of ranks.");
    }
    this->Mine = this->Frame.ImageOf(this->Ranks->Rank());
    if (this->Ranks->Rank() == 0)
    {
      this->Reference = BlendedSerially(this->Frame);
    }
  }

  Measured Run(const std::string& method)
  {
    const std::string floats = "icet-floats-";
    return method.rfind(floats, 0) == 0    ? this->RunIceT(method.substr(floats.size()), true)
           : method.rfind("icet-", 0) == 0 ? this->RunIceT(method.substr(5), false)
                                           : this->RunOwn(method);
  }

  Communicator& World() { return *this->Ranks; }

private:
  /// On the root: from when all may begin to when the picture is there.
  template <typename Action>
  double Timed(const Action& action)
  {
    this->Ranks->Barrier();
    const double begin = MPI_Wtime();
    action();
    return MPI_Wtime() - begin;
  }

  Measured RunOwn(const std::string& method)
  {
    Measured measured;
    const FrameHead& head = this->Frame.Head();
    const CompositeOptions options = OptionsOf(method, head, this->BytesPerSecond);
    FloatImage picture;
    measured.Seconds = this->Timed(
      [&]
      {
        picture = IsOurs(method)
                    ? Composite(*this->Ranks, this->Mine, head.Order, head.Viewport, options,
                        measured.Statistics)
                    : CompositeAsPeer(method, *this->Ranks, this->Mine, head, measured.Statistics);
      });
    for (std::size_t i = 0; i < picture.Pixels.size(); ++i)
    {
      for (int c = 0; c < 4; ++c)
      {
        const int error = Rounded(picture.Pixels[i][c]) - Rounded(this->Reference[i][c]);
        measured.WorstError = std::max<double>(measured.WorstError, std::abs(error));
      }
    }
    return measured;
  }

  Measured RunIceT(const std::string& strategy, bool floats)
  {
    Measured measured;
    if (!this->IceT || this->IceTFloats != floats)
    {
      this->Picture = std::make_unique<IceTPicture>(this->Frame.Head().Viewport, floats);
      this->Picture->Put(this->Mine, this->Mine.Rect);
      this->IceT = std::make_unique<IceTCompositor>(floats);
      this->IceTFloats = floats;
    }
    bool isHere = false;
    measured.Seconds = this->Timed(
      [&]
      {
        const FrameHead& head = this->Frame.Head();
        isHere = this->IceT->Composite(
          strategy, *this->Picture, head.Order, { { head.Viewport, 0, {} } }, measured.Statistics);
      });
    for (std::size_t i = 0; isHere && i < this->Reference.size(); ++i)
    {
      for (int c = 0; c < 4; ++c)
      {
        const double error =
          std::round(this->IceT->Channel(4 * i + c)) - Rounded(this->Reference[i][c]);
        measured.WorstError = std::max(measured.WorstError, std::abs(error));
      }
    }
    return measured;
  }

  FrameReader Frame;
  double BytesPerSecond;
  std::unique_ptr<Communicator> Ranks;
  FloatImage Mine;
  std::vector<glm::vec4> Reference;
  std::unique_ptr<IceTPicture> Picture;
  std::unique_ptr<IceTCompositor> IceT;
  bool IceTFloats = false;
};

void Report(Simulation& simulation, const std::string& method, const Measured& measured,
  const std::string& scene, const std::string& camera, const std::string& network)
{
  Communicator& ranks = simulation.World();
  const double bytes = AllSum(ranks, static_cast<double>(measured.Statistics.BytesSent));
  const double messages = AllSum(ranks, static_cast<double>(measured.Statistics.MessagesSent));
  const double largest = AllMax(ranks, static_cast<double>(measured.Statistics.BytesReceived));
  if (ranks.Rank() != 0)
  {
    return;
  }
  std::printf("%s,%s,%d,%s,%s,%.4f,%.0f,%.0f,%.0f\n", scene.c_str(), camera.c_str(), ranks.Size(),
    network.c_str(), method.c_str(), 1e3 * measured.Seconds, bytes, messages, largest);
  std::fflush(stdout);
  const double allowed = IsOurs(method) ? 1.0 : ranks.Size() + 1.0;
  if (measured.WorstError > allowed)
  {
    throw Error(
      "The picture of " + method + " is off by " + std::to_string(measured.WorstError) + "/255.");
  }
}

void Run(int argc, char** argv)
{
  if (argc < 6)
  {
    throw Error("A frame, the names of scene, camera and network, and a bandwidth are needed.");
  }
  std::vector<std::string> methods{ "banyan", "banyan-raw", "banyan-floats", "slic-published",
    "direct-send", "binary-swap" };
  for (const char* const pixels : { "icet-", "icet-floats-" })
  {
    for (const std::string& strategy : IceTStrategies())
    {
      methods.push_back(pixels + strategy);
    }
  }
  if (argc > 6)
  {
    methods.clear();
    std::istringstream list(argv[6]);
    for (std::string method; std::getline(list, method, ',');)
    {
      methods.push_back(method);
    }
  }
  Simulation simulation(argv[1], std::atof(argv[5]));
  for (const std::string& method : methods)
  {
    Report(simulation, method, simulation.Run(method), argv[2], argv[3], argv[4]);
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
