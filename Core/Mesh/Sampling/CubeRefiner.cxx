// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Sampling/CubeRefiner.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Mesh/Sampling/BlockPoints.h"
#include "Mesh/Sampling/CubeDeviation.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>

namespace banyan
{
namespace
{

using Cube = SampledCubes::Cube;

/// Says what becomes of a cube.
enum class Fate : std::uint8_t
{
  Drop,
  Keep,
  Split,   ///< because it is too coarse for the cells
  Improve, ///< to come closer to the field: kept where there are too many cubes
};

struct Judgement
{
  Fate What = Fate::Drop;
  bool InMesh = false; ///< its middle
  double Deviation = 0.0;

  static constexpr double NotMeasured = -1.0;
};

class Refiner
{
public:
  Refiner(const CellShapes& shapes, const MeshSampling& sampling, ThreadPool& pool)
    : Shapes(shapes)
    , Sampling(sampling)
    , Pool(pool)
  {
  }

  SampledCubes Refine();

private:
  struct Scratch
  {
    explicit Scratch(const CellShapes& shapes)
      : Points(shapes)
      , Deviation(shapes)
    {
    }
    BlockPoints Points;
    CubeDeviation Deviation;
  };

  template <class Body>
  void ForCubes(const Body& body);
  void Report(std::size_t cubes);
  void Judge();
  void MeasureDenied();
  Judgement JudgeOne(const Cube& cube, Scratch& own) const;
  double Thinnest(const Cube& cube) const;
  double Measure(const Cube& cube, Scratch& own) const;
  glm::ivec3 PointOf(const Cube& cube, int number) const;
  void Settle();
  void Halve();
  void HalveOne(
    const Cube& cube, std::vector<Cube>& cubes, std::vector<std::uint32_t>& cells) const;

  const CellShapes& Shapes;
  MeshSampling Sampling;
  ThreadPool& Pool;
  double Looked = 0.0; ///< cubes that were judged
  int Level = 0;
  bool Measuring = false;   ///< cubes that may have to stay as they are, for there are too many
  std::vector<Cube> Active; ///< of this level
  std::vector<std::uint32_t> Cells;
  std::vector<Judgement> Judgements;
  SampledCubes Result;
};

CellList CellsOf(const Cube& cube, const std::vector<std::uint32_t>& cells)
{
  return { cells.data() + cube.First, cells.data() + cube.First + cube.Count };
}

/// One of the 27 points of a cube, in halves of cubes.
glm::ivec3 Refiner::PointOf(const Cube& cube, int number) const
{
  return PositionOfKey(cube.Key >> 3 * this->Level) * 2 +
         glm::ivec3(number % 3, number / 3 % 3, number / 9);
}

/// The smallest height of the cells that a cube has a part of; infinite where there is none.
double Refiner::Thinnest(const Cube& cube) const
{
  const CellList cells = CellsOf(cube, this->Cells);
  // Cells that only touch the cube say nothing of what is in it.
  const glm::dvec3 low = glm::dvec3(PositionOfKey(cube.Key)) + 1e-3;
  const glm::dvec3 high = low + ((1 << this->Level) - 2e-3);
  double thinnest = std::numeric_limits<double>::infinity();
  for (const std::uint32_t* cell = cells.Begin; cell != cells.End; ++cell)
  {
    if (glm::all(glm::lessThan(this->Shapes.Low(*cell), high)) &&
        glm::all(glm::greaterThan(this->Shapes.High(*cell), low)))
    {
      thinnest = std::min(thinnest, this->Shapes.Height(*cell));
    }
  }
  return thinnest;
}

double Refiner::Measure(const Cube& cube, Scratch& own) const
{
  const CellList cells = CellsOf(cube, this->Cells);
  CubePlaces places;
  for (int i = 0; i < 27; ++i)
  {
    const bool corner = i % 3 != 1 && i / 3 % 3 != 1 && i / 9 != 1;
    const glm::ivec3 at = this->PointOf(cube, i);
    places[static_cast<std::size_t>(i)] =
      corner || own.Points.Inside(at, cells) ? own.Points.At(at, cells) : nullptr;
  }
  return own.Deviation.Of(places);
}

Judgement Refiner::JudgeOne(const Cube& cube, Scratch& own) const
{
  const CellList cells = CellsOf(cube, this->Cells);
  const double edge = 1 << this->Level;
  const double thinnest = this->Thinnest(cube);
  Judgement judgement;
  if (std::isinf(thinnest))
  {
    return judgement;
  }
  if (edge > thinnest && this->Level > 0)
  {
    judgement.What = Fate::Split;
    return judgement;
  }
  constexpr int middle = 13;
  judgement.InMesh = own.Points.Inside(this->PointOf(cube, middle), cells);
  const bool large = std::ldexp(edge, MeshSampling::BorderPart) > thinnest && this->Level > 0;
  bool inside = judgement.InMesh;
  bool outside = !inside;
  for (int i = 0; i < 27 && !(large && inside && outside); ++i)
  {
    (own.Points.Inside(this->PointOf(cube, i), cells) ? inside : outside) = true;
  }
  if (!inside)
  {
    return judgement;
  }
  const bool border = outside && large;
  if (border)
  {
    judgement.What = Fate::Improve;
    judgement.Deviation = Judgement::NotMeasured;
    if (!this->Measuring || !judgement.InMesh)
    {
      return judgement;
    }
  }
  judgement.Deviation = this->Measure(cube, own);
  const bool far = judgement.Deviation > this->Sampling.Tolerance &&
                   std::ldexp(edge, MeshSampling::FinestPart) > thinnest;
  judgement.What = border || (far && this->Level > 0) ? Fate::Improve
                   : judgement.InMesh                 ? Fate::Keep
                                                      : Fate::Drop;
  return judgement;
}

/// Calls body(number of a cube, Scratch) for all of this level, those of a block on one thread.
template <class Body>
void Refiner::ForCubes(const Body& body)
{
  const int shift = std::min(63, 3 * (this->Level + BlockPoints::Levels));
  const auto blockOf = [&](std::size_t i) { return this->Active[i].Key >> shift; };
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < this->Active.size(); ++i)
  {
    if (i == 0 || blockOf(i) != blockOf(i - 1))
    {
      begins.push_back(i);
    }
  }
  begins.push_back(this->Active.size());
  std::vector<std::unique_ptr<Scratch>> scratch(static_cast<std::size_t>(this->Pool.Width()));
  const auto look = [&](std::size_t block, int worker)
  {
    std::unique_ptr<Scratch>& own = scratch[static_cast<std::size_t>(worker)];
    own = own ? std::move(own) : std::make_unique<Scratch>(this->Shapes);
    const glm::ivec3 first = PositionOfKey(blockOf(begins[block])) * (2 << BlockPoints::Levels);
    own->Points.Begin(first, this->Level);
    for (std::size_t i = begins[block]; i < begins[block + 1]; ++i)
    {
      body(i, *own);
    }
  };
  // Between runs of blocks, which take about a tenth of a second, somebody may look and stop it.
  const std::size_t blocks = begins.size() - 1;
  const std::size_t run = 32 * static_cast<std::size_t>(this->Pool.Width());
  for (std::size_t from = 0; from < blocks; from += run)
  {
    const std::size_t to = std::min(blocks, from + run);
    this->Pool.ParallelFor(static_cast<std::int64_t>(to - from), [&](std::int64_t block, int worker)
      { look(from + static_cast<std::size_t>(block), worker); });
    this->Report(begins[to] - begins[from]);
  }
}

/// A mesh that takes as many cubes as it may has about twice as many looked at; most take fewer.
void Refiner::Report(std::size_t cubes)
{
  this->Looked += static_cast<double>(cubes);
  const double part = this->Looked / (2.0 * static_cast<double>(this->Sampling.MostCubes));
  if (this->Sampling.Watch && !this->Sampling.Watch(0.9 * std::min(1.0, part))) // then come points
  {
    throw Interruption("Sampling the mesh at boxes was stopped");
  }
}

void Refiner::Judge()
{
  // About half of the cubes at the border are in the mesh, and half of their halves stay.
  const auto expected =
    static_cast<std::int64_t>(this->Result.Cubes.size() + 2 * this->Active.size());
  this->Measuring = expected > this->Sampling.MostCubes;
  this->Judgements.assign(this->Active.size(), {});
  this->ForCubes([&](std::size_t i, Scratch& own)
    { this->Judgements[i] = this->JudgeOne(this->Active[i], own); });
}

/// Measures the deviation of cubes that stay whole because there are too many.
void Refiner::MeasureDenied()
{
  this->ForCubes(
    [&](std::size_t i, Scratch& own)
    {
      Judgement& judgement = this->Judgements[i];
      if (judgement.InMesh && judgement.Deviation == Judgement::NotMeasured)
      {
        judgement.Deviation = this->Measure(this->Active[i], own);
      }
    });
}

/// Takes the cubes that stay, and leaves those that are to be halved.
void Refiner::Settle()
{
  std::int64_t halved = 0;
  for (const Judgement& judgement : this->Judgements)
  {
    halved += judgement.What == Fate::Split || judgement.What == Fate::Improve ? 1 : 0;
  }
  const auto kept = static_cast<std::int64_t>(this->Result.Cubes.size());
  // About half of the eight halves of a cube at the border stay.
  const bool full = kept + 8 * halved > this->Sampling.MostCubes;
  if (full && !this->Measuring)
  {
    this->MeasureDenied();
  }
  std::vector<Cube> rest;
  for (std::size_t i = 0; i < this->Active.size(); ++i)
  {
    Judgement& judgement = this->Judgements[i];
    if (judgement.What == Fate::Improve && full)
    {
      judgement.What = judgement.InMesh ? Fate::Keep : Fate::Drop;
      ++this->Result.Denied;
    }
    if (judgement.What == Fate::Keep)
    {
      Cube cube = this->Active[i];
      const CellList cells = CellsOf(cube, this->Cells);
      cube.First = static_cast<std::uint32_t>(this->Result.Cells.size());
      this->Result.Cells.insert(this->Result.Cells.end(), cells.Begin, cells.End);
      this->Result.Cubes.push_back(cube);
      this->Result.Deviation = std::max(this->Result.Deviation, judgement.Deviation);
      this->Result.Above += judgement.Deviation > this->Sampling.Tolerance ? 1 : 0;
    }
    else if (judgement.What != Fate::Drop)
    {
      rest.push_back(this->Active[i]);
    }
  }
  this->Active.swap(rest);
}

void Refiner::HalveOne(
  const Cube& cube, std::vector<Cube>& cubes, std::vector<std::uint32_t>& cells) const
{
  const CellList all = CellsOf(cube, this->Cells);
  const int half = 1 << (cube.Level - 1);
  for (int child = 0; child < 8; ++child)
  {
    const glm::dvec3 low(
      PositionOfKey(cube.Key) + half * glm::ivec3(child & 1, child >> 1 & 1, child >> 2));
    // Cells that only touch it have to be there: points on faces are in all cells around.
    const glm::dvec3 high = low + (half + 1e-3);
    Cube part;
    part.First = static_cast<std::uint32_t>(cells.size());
    for (const std::uint32_t* cell = all.Begin; cell != all.End; ++cell)
    {
      if (glm::all(glm::lessThanEqual(this->Shapes.Low(*cell), high)) &&
          glm::all(glm::greaterThanEqual(this->Shapes.High(*cell), low - 1e-3)) &&
          this->Shapes.MayTouch(*cell, low + 0.5 * half, 0.5 * half + 1e-3))
      {
        cells.push_back(*cell);
      }
    }
    part.Count = static_cast<std::uint32_t>(cells.size()) - part.First;
    if (part.Count > 0)
    {
      part.Level = cube.Level - 1;
      part.Key = cube.Key + static_cast<std::uint64_t>(child) * CubeKeys(part.Level);
      cubes.push_back(part);
    }
  }
}

void Refiner::Halve()
{
  struct Part
  {
    std::vector<Cube> Cubes;
    std::vector<std::uint32_t> Cells;
  };
  const auto count = static_cast<std::int64_t>(this->Active.size());
  const std::int64_t length = std::max<std::int64_t>(1, count / (8 * this->Pool.Width()));
  std::vector<Part> parts(static_cast<std::size_t>((count + length - 1) / length));
  this->Pool.ParallelFor(static_cast<std::int64_t>(parts.size()),
    [&](std::int64_t number)
    {
      Part& part = parts[static_cast<std::size_t>(number)];
      for (std::int64_t i = number * length; i < std::min(count, (number + 1) * length); ++i)
      {
        this->HalveOne(this->Active[static_cast<std::size_t>(i)], part.Cubes, part.Cells);
      }
    });
  this->Active.clear();
  this->Cells.clear();
  for (Part& part : parts)
  {
    const auto before = static_cast<std::uint32_t>(this->Cells.size());
    this->Cells.insert(this->Cells.end(), part.Cells.begin(), part.Cells.end());
    for (Cube& cube : part.Cubes)
    {
      cube.First += before;
    }
    this->Active.insert(this->Active.end(), part.Cubes.begin(), part.Cubes.end());
    part = {};
  }
  --this->Level;
  if (static_cast<std::int64_t>(this->Active.size()) > 8 * this->Sampling.MostCubes)
  {
    throw Error("The mesh has cells so thin that more than " +
                std::to_string(8 * this->Sampling.MostCubes) +
                " cubes would be needed to sample it: use 'Resample To Image'");
  }
}

SampledCubes Refiner::Refine()
{
  const glm::ivec3& extent = this->Shapes.Extent();
  while (1 << this->Level < std::max({ extent.x, extent.y, extent.z }))
  {
    ++this->Level;
  }
  Cube root;
  root.Level = this->Level;
  root.Count = static_cast<std::uint32_t>(this->Shapes.Count());
  this->Active.push_back(root);
  this->Cells.resize(root.Count);
  std::iota(this->Cells.begin(), this->Cells.end(), 0u);
  while (!this->Active.empty())
  {
    this->Judge();
    this->Settle();
    this->Halve();
  }
  return std::move(this->Result);
}

} // namespace

SampledCubes RefineCubes(const CellShapes& shapes, const MeshSampling& sampling, ThreadPool& pool)
{
  return Refiner(shapes, sampling, pool).Refine();
}

} // namespace banyan
