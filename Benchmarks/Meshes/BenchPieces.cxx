// SPDX-License-Identifier: BSD-3-Clause
// Meshes whose cells are dealt to ranks, which are simulated: one thread each, in processor time.
#include "Base/Error.h"
#include "OptionValues.h"
#include "Parallel/PieceCases.h"

#include <glm/gtc/constants.hpp>

#include <cstdio>
#include <ctime>
#include <exception>
#include <map>
#include <numeric>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using piececases::Case;
using piececases::Deal;

const std::map<std::string, Cut> Shapes{ { "hexahedra", Cut::Hexahedra },
  { "tetrahedra", Cut::FiveTetrahedra }, { "mixed", Cut::Mixed } };
const std::map<std::string, Deal> Deals{ { "one-by-one", Deal::OneByOne },
  { "jagged", Deal::Jagged }, { "morton", Deal::Morton }, { "slabs", Deal::Slabs } };

struct Options
{
  int Cubes = 100; ///< along each axis
  std::string Shape = "hexahedra";
  std::vector<std::string> Deals{ "morton", "jagged" };
  std::vector<std::string> Ranks{ "1", "2", "4", "8", "16", "32", "64" };
  std::vector<std::string> Pixels{ "512", "1024" };
  std::vector<std::string> Levels{ "0", "1" };
  int Views = 6;
};

constexpr float DefaultOpacityLimit = 0.999f;

constexpr const char* Usage =
  "banyan-bench-pieces [--cubes N] [--shape S] [--deals LIST] [--ranks LIST] [--pixels LIST]\n"
  "                    [--levels LIST] [--views N]\n"
  "  --cubes N      of a warped cube, along each axis (100)\n"
  "  --shape S      they are cut into: hexahedra, tetrahedra, mixed\n"
  "  --deals LIST   of one-by-one, jagged, morton, slabs (morton,jagged)\n"
  "  --ranks LIST   1 draws the whole mesh (1,2,4,8,16,32,64)\n"
  "  --pixels LIST  per side (512,1024)\n"
  "  --levels LIST  0: cells; from 1 on: lattices (0,1)\n"
  "  --views N      around the mesh (6)\n"
  "Writes a table to standard output.\n";

/// The value of a name, or an Error that lists all.
template <class Value>
Value ValueOf(const std::map<std::string, Value>& values, const std::string& name)
{
  const auto found = values.find(name);
  if (found == values.end())
  {
    std::string names;
    for (const auto& [other, value] : values)
    {
      names += (names.empty() ? "" : ", ") + other;
    }
    throw Error("There is no '" + name + "': choose of " + names);
  }
  return found->second;
}

double ProcessorSeconds()
{
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The mesh turned about the axis that is upright in the picture.
RayScene Turned(RayScene scene, double angle)
{
  const glm::dvec3 middle(
    scene.IndexToWorld *
    glm::dvec4(0.5 * glm::dvec3(scene.DomainCells.Lo + scene.DomainCells.Hi), 1.0));
  glm::dmat4 turn = glm::translate(glm::dmat4(1.0), middle);
  turn = glm::rotate(turn, angle, glm::dvec3(0.0, 0.0, 1.0));
  scene.IndexToWorld = glm::translate(turn, -middle) * scene.IndexToWorld;
  return scene;
}

/// What a rank took.
struct RankTook
{
  double SetUp = 0.0; ///< seconds of processor time
  double First = 0.0;
  double Frames = 0.0; ///< all others
  double Bytes = 0.0;  ///< that it holds
  PieceStatistics Statistics;
};

/// A rank's cells, drawn from all views.
class RankFrames
{
public:
  RankFrames(const Case& is, const Options& options)
    : Is(is)
    , Views(options.Views)
  {
  }

  /// Collective.
  RankTook Draw(Communicator& ranks, const std::vector<int>& rankOf) const
  {
    const bool alone = ranks.Size() == 1;
    const cellmeshes::OwnedCellMesh piece =
      alone ? this->Is.Mesh : piececases::PieceOf(this->Is.Mesh, rankOf, ranks.Rank(), false);
    ThreadPool pool(1);
    RankTook took;
    CellFacts facts;
    double since = ProcessorSeconds();
    const std::shared_ptr<const DrawnCells> cells =
      alone ? DrawnCells::Of(piece.View(), facts, pool)
            : DrawnPiece(ranks, piece.View(), facts, pool);
    CellSource source({ cells, piece.Values, 0.0, false, {} }, pool);
    took.SetUp = ProcessorSeconds() - since;
    for (int view = 0; view <= this->Views; ++view)
    {
      const RayScene scene =
        Turned(this->Is.Scene, view * glm::two_pi<double>() / (this->Views + 1));
      since = ProcessorSeconds();
      PieceStatistics statistics;
      if (alone)
      {
        CastViewport(scene, source, scene.DomainCells, ~std::uint64_t{ 0 }, pool, statistics.Rays);
      }
      else
      {
        DrawPieces(ranks, scene, source, pool, 0, statistics);
      }
      (view == 0 ? took.First : took.Frames) += ProcessorSeconds() - since;
      took.Statistics = statistics;
    }
    took.Bytes = static_cast<double>(cells->Bytes() + source.SeenBytes() + source.LatticeBytes() +
                                     piece.Points.size() * sizeof(piece.Points[0]) +
                                     piece.Ids.size() * sizeof(piece.Ids[0]) +
                                     piece.Values.size() * sizeof(float));
    return took;
  }

private:
  const Case& Is;
  const int Views;
};

void WriteRow(const Options& options, const Case& is, const std::string& deal, int ranks,
  const std::string& level)
{
  const std::vector<int> rankOf =
    ranks > 1 ? piececases::Dealt(is.Mesh, ValueOf(Deals, deal), ranks) : std::vector<int>();
  std::vector<RankTook> all(static_cast<std::size_t>(ranks));
  const RankFrames frames(is, options);
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      all[static_cast<std::size_t>(communicator.Rank())] = frames.Draw(communicator, rankOf);
      communicator.Barrier();
    });
  const auto largest = [&](auto&& of)
  {
    double most = 0.0;
    for (const RankTook& took : all)
    {
      most = std::max(most, static_cast<double>(of(took)));
    }
    return most;
  };
  const auto sum = [&](auto&& of)
  {
    return std::accumulate(all.begin(), all.end(), 0.0,
      [&](double before, const RankTook& took) { return before + static_cast<double>(of(took)); });
  };
  const double rays = static_cast<double>(is.Scene.Viewport.Count());
  const auto frame = [&](const RankTook& took) { return 1e3 * took.Frames / options.Views; };
  std::printf("%s,%lld,%s,%d,%d,%s,%.1f,%.1f,%.2f,%.2f,%.2f,%.2f,%.3f,%.1f,%.1f\n",
    options.Shape.c_str(), static_cast<long long>(is.Mesh.CellCount()), deal.c_str(), ranks,
    is.Scene.Viewport.Size().x, level.c_str(),
    1e3 * largest([](const RankTook& took) { return took.SetUp; }),
    1e3 * largest([](const RankTook& took) { return took.First; }), largest(frame),
    sum(frame) / ranks, sum([](const RankTook& took) { return took.Statistics.Runs; }) / rays,
    sum([](const RankTook& took) { return took.Statistics.Raw; }) / rays,
    sum([](const RankTook& took) { return took.Statistics.Asked; }) / rays,
    sum([](const RankTook& took) { return took.Statistics.Sent.Bytes; }) / rays,
    largest([](const RankTook& took) { return took.Bytes; }) / 1e6);
  std::fflush(stdout);
}

void WriteTable(const Options& options)
{
  std::puts("shape,cells,deal,ranks,pixels,level,setup_ms,first_ms,frame_ms,mean_ms,runs_per_ray,"
            "raw_per_ray,asked_per_ray,bytes_per_ray,mb_per_rank");
  const cellmeshes::OwnedCellMesh mesh =
    piececases::Cube(options.Cubes, ValueOf(Shapes, options.Shape), 0.05);
  for (const std::string& pixels : options.Pixels)
  {
    const int edge = bench::CountIn("--pixels", pixels, 16, 8192);
    Case is(mesh, { edge, edge }, 1.0);
    is.Scene.OpacityLimit = DefaultOpacityLimit;
    for (const std::string& level : options.Levels)
    {
      is.Scene.Samplings = std::make_shared<const TileSamplings>(is.Scene.Camera.ImageSize(),
        std::vector{
          RaySampling{ bench::CountIn("--levels", level, 0, 4), is.Scene.SampleDistance } });
      for (const std::string& deal : options.Deals)
      {
        for (const std::string& ranks : options.Ranks)
        {
          WriteRow(options, is, deal, bench::CountIn("--ranks", ranks, 1, 256), level);
        }
      }
    }
  }
}

Options OptionsOf(const std::vector<std::string>& arguments)
{
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string& name = arguments[i];
    const std::string& value = bench::ValueBehind(arguments, i);
    if (name == "--cubes")
    {
      options.Cubes = bench::CountIn(name, value, 2, 400);
    }
    else if (name == "--views")
    {
      options.Views = bench::CountIn(name, value, 1, 1000);
    }
    else if (name == "--shape")
    {
      options.Shape = value;
    }
    else if (name == "--deals")
    {
      options.Deals = bench::SplitAtCommas(value);
    }
    else if (name == "--ranks")
    {
      options.Ranks = bench::SplitAtCommas(value);
    }
    else if (name == "--pixels")
    {
      options.Pixels = bench::SplitAtCommas(value);
    }
    else if (name == "--levels")
    {
      options.Levels = bench::SplitAtCommas(value);
    }
    else
    {
      throw Error("There is no option '" + name + "'");
    }
  }
  return options;
}

} // namespace

int main(int argc, char** argv)
{
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments == std::vector<std::string>{ "--help" })
  {
    std::fputs(Usage, stdout);
    return 0;
  }
  try
  {
    WriteTable(OptionsOf(arguments));
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-pieces: %s\n%s", error.what(), Usage);
    return 1;
  }
  return 0;
}
