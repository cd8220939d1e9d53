// SPDX-License-Identifier: BSD-3-Clause
// The tests of the simulated ranks again, on real MPI ranks. Every check is collective; each rank
// prints what it finds wrong, and the exit status is that of the worst rank.
#include "CommunicatorCases.h"
#include "CompositingCases.h"

#include "Base/Error.h"
#include "Parallel/Communicate/MpiCommunicator.h"
#include "Parallel/Communicate/NodeCommunicator.h"
#include "Parallel/Fields/SharedMesh.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <functional>

namespace
{

using namespace banyan;
using namespace banyan::testing;

/// Seconds after which a rank that hangs ends itself; below the TIMEOUT of the test.
constexpr unsigned WatchdogSeconds = 75;

std::string CompositeAllCases(Communicator& communicator)
{
  std::string wrong;
  for (int which = 0; which < static_cast<int>(Case::Count); ++which)
  {
    for (const PixelRect& viewport : Viewports())
    {
      wrong += CheckComposite(communicator,
        PreparedCase(static_cast<Case>(which), communicator.Size(), viewport, Combination::Over));
    }
  }
  return wrong;
}

/// As floats and in few bits, with pictures that need several messages.
std::string CompositeLargePictures(Communicator& communicator)
{
  std::string wrong;
  for (const Case which : { Case::BackgroundCorrect, Case::AllOverlap, Case::SparseCopy })
  {
    const PreparedCase prepared(
      which, communicator.Size(), { { -3, 2 }, { 290, 203 } }, Combination::Over);
    for (const PixelTransport transport : { PixelTransport::Floats, PixelTransport::WithinOne })
    {
      CompositeOptions options;
      options.Transport = transport;
      wrong += CheckComposite(communicator, prepared, options);
    }
  }
  return wrong;
}

std::string Nearest(Communicator& communicator)
{
  std::string wrong;
  for (const std::size_t count : { 0, 1, 3, 90000 })
  {
    wrong += CheckNearest(communicator, count);
  }
  return wrong;
}

/// Messages in parts of 64 bytes, as those beyond 1 GiB are sent in parts of 1 GiB.
std::string SmallParts(Communicator&)
{
  const MPI_Comm world = MPI_COMM_WORLD;
  const auto communicator = MakeMpiCommunicator(&world, 64);
  std::string wrong = CheckCommunicator(*communicator);
  wrong += CheckMessages(*communicator, 64);
  wrong += CheckMessages(*communicator, 65);
  wrong += CheckComposite(*communicator, PreparedCase(Case::AllOverlap, communicator->Size(),
                                           { { 0, 0 }, { 31, 17 } }, Combination::Over));
  return wrong;
}

std::string Several(Communicator& first)
{
  const MPI_Comm world = MPI_COMM_WORLD;
  const auto second = MakeMpiCommunicator(&world);
  // The same tag in both: messages must stay in their own communicator.
  const int next = (first.Rank() + 1) % first.Size();
  const int previous = (first.Rank() + first.Size() - 1) % first.Size();
  const int one = 1, two = 2;
  int fromFirst = 0, fromSecond = 0;
  second->Receive(previous, 0, &fromSecond, sizeof(int));
  first.Receive(previous, 0, &fromFirst, sizeof(int));
  first.Send(next, 0, &one, sizeof(int));
  second->Send(next, 0, &two, sizeof(int));
  first.WaitAll();
  second->WaitAll();
  return fromFirst == 1 && fromSecond == 2 ? "" : "messages went to another communicator";
}

/// Errors come as exceptions, and the ranks agree on them.
std::string Errors(Communicator& communicator)
{
  std::string mine;
  try
  {
    if (communicator.Rank() == communicator.Size() - 1)
    {
      char byte = 0;
      communicator.Send(communicator.Size(), 0, &byte, 1);
    }
  }
  catch (const Error& error)
  {
    mine = error.what();
  }
  if (AgreeOnError(communicator, mine).empty())
  {
    return "a message to a rank that does not exist was no error";
  }
  const long long expected = 8;
  long long value = 0;
  const int self = communicator.Rank();
  mine.clear();
  try
  {
    communicator.Receive(self, 1, &value, sizeof(value));
    communicator.Send(self, 1, &expected, 4);
    communicator.WaitAll();
  }
  catch (const Error& error)
  {
    mine = error.what();
  }
  return mine.empty() ? "a message of another size was no error" : "";
}

std::string RanksOfThisNode(Communicator& communicator)
{
  const int ranks = communicator.RanksOnThisNode();
  return ranks == communicator.Size() ? "" : "not all ranks were found on this node";
}

/// Each rank writes its part of memory that all have together, and reads those of the others.
std::string MemoryOfThisMachine(Communicator& communicator)
{
  NodeCommunicator machines(communicator);
  const auto ranks = static_cast<std::size_t>(communicator.Size());
  constexpr std::size_t part = 100'003;
  const std::shared_ptr<char> memory = machines.Allocate(communicator, ranks * part);
  if (!machines.WhyNot().empty())
  {
    return machines.WhyNot();
  }
  const auto self = static_cast<std::size_t>(communicator.Rank());
  std::fill_n(memory.get() + self * part, part, static_cast<char>(self + 1));
  communicator.Barrier();
  for (std::size_t i = 0; i < ranks * part; ++i)
  {
    if (memory.get()[i] != static_cast<char>(i / part + 1))
    {
      return "byte " + std::to_string(i) + " is not what its rank has written";
    }
  }
  return machines.LeaderOf(communicator.Rank()) == 0 ? "" : "the first rank does not lead";
}

/// An octree and a field that the first rank makes, and all of them read. Each rank has a row of
/// cubes.
std::string MeshOfThisMachine(Communicator& communicator)
{
  const auto ranks = static_cast<double>(communicator.Size());
  std::vector<double> points;
  std::vector<double> values;
  std::vector<std::int64_t> ids;
  constexpr int length = 50;
  for (int i = 0; i < 8 * length; ++i)
  {
    const glm::ivec3 at(i / 8 + (i & 1), communicator.Rank() + (i >> 1 & 1), i >> 2 & 1);
    points.insert(points.end(), { double(at.x), double(at.y), double(at.z) });
    values.push_back(at.x + 0.5 * at.y * at.z);
    ids.push_back(i);
  }
  HexMesh piece;
  piece.Points = points.data();
  piece.PointType = ScalarType::Float64;
  piece.PointCount = 8 * length;
  piece.Connectivity = ids.data();
  piece.CellCount = length;
  NodeArray array;
  array.Values = values.data();
  array.Type = ScalarType::Float64;
  const std::int64_t before = ElementOctree::FoundSoFar();
  SharedMesh mesh(communicator, piece, 16, 0.0);
  const std::int64_t found = ElementOctree::FoundSoFar() - before;
  if (AllSum(communicator, static_cast<double>(found)) != 1.0)
  {
    return "not one rank found the octree, but " + std::to_string(found) + " on this one";
  }
  std::string wrong;
  for (int step = 0; step < 3; ++step)
  {
    const auto field = mesh.Field(communicator, array, piece.PointCount, ValuesOn::Points);
    for (int i = 0; i < length * communicator.Size(); ++i)
    {
      const glm::ivec3 at(i % length, i / length, 1);
      if (field->Field().AtPoint(at) != (at.x + 0.5 * at.y) * (1 << step))
      {
        wrong = "a wrong value in step " + std::to_string(step);
      }
    }
    if (field->MasksAreOver().High != (length + 0.5 * ranks) * (1 << step))
    {
      wrong = "not the largest value of all ranks";
    }
    for (double& value : values)
    {
      value *= 2.0;
    }
  }
  const MeshBytes bytes = mesh.Bytes();
  return communicator.Size() == 1 || bytes.Together > bytes.Own ? wrong : "little is shared";
}

struct Check
{
  const char* Name;
  std::function<std::string(Communicator&)> Run;
};

int RunAll(Communicator& communicator)
{
  const Check checks[] = { { "communicator", CheckCommunicator }, { "small parts", SmallParts },
    { "several communicators", Several }, { "ranks of this node", RanksOfThisNode },
    { "memory of this machine", MemoryOfThisMachine },
    { "mesh of this machine", MeshOfThisMachine }, { "compositing", CompositeAllCases },
    { "large pictures", CompositeLargePictures }, { "nearest pixels", Nearest },
    { "errors", Errors } };
  int failed = 0;
  for (const Check& check : checks)
  {
    const std::string wrong = check.Run(communicator);
    if (!wrong.empty())
    {
      ++failed;
      std::fprintf(stderr, "rank %d: %s: %s\n", communicator.Rank(), check.Name, wrong.c_str());
    }
    if (communicator.Rank() == 0)
    {
      std::printf("%s on %d ranks\n", check.Name, communicator.Size());
    }
  }
  return AllMax(communicator, failed) > 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}

} // namespace

/// @param argv[1] the number of ranks there must be, so that a launcher that starts that many
///        separate processes instead is noticed
int main(int argc, char** argv)
{
  alarm(WatchdogSeconds);
  MPI_Init(&argc, &argv);
  int status = EXIT_FAILURE;
  // Outlives MPI on purpose: its destructor must notice.
  std::unique_ptr<banyan::Communicator> communicator;
  try
  {
    const MPI_Comm world = MPI_COMM_WORLD;
    communicator = banyan::MakeMpiCommunicator(&world);
    if (argc > 1 && communicator->Size() == std::atoi(argv[1]))
    {
      status = RunAll(*communicator);
    }
    else
    {
      std::fprintf(
        stderr, "%d ranks are running, not as many as asked for\n", communicator->Size());
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
  }
  MPI_Finalize();
  return status;
}
