// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Sampling/SampledMesh.h"

#include "Base/FirstFailure.h"
#include "Base/RadixSort.h"
#include "Base/ThreadPool.h"
#include "Mesh/Octree/TakenComponent.h"

#include <algorithm>
#include <limits>

namespace banyan
{
namespace
{

std::size_t Index(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

glm::ivec3 CornerOf(const SampledCubes::Cube& cube, int corner)
{
  return PositionOfKey(cube.Key) +
         (1 << cube.Level) * glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
}

} // namespace

std::shared_ptr<SampledMesh> SampledMesh::Of(
  const HexMesh& mesh, const MeshSampling& sampling, ThreadPool& pool)
{
  const CellShapes shapes(mesh, MeshSampling::FinestPart, pool);
  const SampledCubes cubes = RefineCubes(shapes, sampling, pool);
  if (cubes.Cubes.empty())
  {
    throw Error("The mesh has no place that a box fits into");
  }
  std::shared_ptr<SampledMesh> made(new SampledMesh);
  made->LargestDeviation = cubes.Deviation;
  made->BoxesAbove = cubes.Above;
  made->Coarse = cubes.Denied;
  made->Tangled = shapes.Tangled();
  made->FirstTangled = shapes.FirstTangled();
  made->NodesOfCells.resize(Index(shapes.Count()));
  for (std::int64_t cell = 0; cell < shapes.Count(); ++cell)
  {
    shapes.NodesOf(cell, made->NodesOfCells[Index(cell)]);
  }
  made->MakeBoxes(shapes, cubes, pool);
  if (sampling.Watch)
  {
    (void)sampling.Watch(1.0); // all is done: too late to be stopped
  }
  return made;
}

/// Points are the different corners of all cubes, in the order of their Morton keys.
void SampledMesh::MakeBoxes(const CellShapes& shapes, const SampledCubes& cubes, ThreadPool& pool)
{
  const std::size_t corners = 8 * cubes.Cubes.size();
  if (corners > std::numeric_limits<std::int32_t>::max())
  {
    throw Error("The mesh needs too many boxes: lower 'Mesh Sampling Boxes'");
  }
  std::vector<std::uint64_t> keys(corners);
  std::vector<std::uint32_t> slots(corners);
  for (std::size_t i = 0; i < corners; ++i)
  {
    keys[i] = KeyOf(CornerOf(cubes.Cubes[i / 8], static_cast<int>(i % 8)));
    slots[i] = static_cast<std::uint32_t>(i);
  }
  RadixSort(keys, slots, 3 * MortonBits, pool);
  const auto ids = std::make_shared<std::vector<std::int32_t>>(corners);
  this->Points = std::make_shared<std::vector<glm::dvec3>>();
  std::vector<std::uint32_t> cubeOfPoint;
  for (std::size_t i = 0; i < corners; ++i)
  {
    if (i == 0 || keys[i] != keys[i - 1])
    {
      this->Points->push_back(shapes.Origin() + glm::dvec3(PositionOfKey(keys[i])) * shapes.Edge());
      cubeOfPoint.push_back(slots[i] / 8);
    }
    (*ids)[slots[i]] = static_cast<std::int32_t>(this->Points->size() - 1);
  }
  this->BoxMesh.Points = this->Points->data();
  this->BoxMesh.PointOwner = this->Points;
  this->BoxMesh.PointType = ScalarType::Float64;
  this->BoxMesh.PointCount = static_cast<std::int64_t>(this->Points->size());
  this->BoxMesh.Connectivity = ids->data();
  this->BoxMesh.Owner = ids;
  this->BoxMesh.IdType = ScalarType::Int32;
  this->BoxMesh.CellCount = static_cast<std::int64_t>(cubes.Cubes.size());
  this->PlacePoints(shapes, cubes, cubeOfPoint, pool);
}

void SampledMesh::PlacePoints(const CellShapes& shapes, const SampledCubes& cubes,
  const std::vector<std::uint32_t>& cubeOfPoint, ThreadPool& pool)
{
  this->Places.resize(this->Points->size());
  FirstFailure failure;
  ForRuns(this->BoxMesh.PointCount, pool, failure,
    [&](std::int64_t begin, std::int64_t end, int)
    {
      for (std::int64_t point = begin; point < end; ++point)
      {
        const SampledCubes::Cube& cube = cubes.Cubes[cubeOfPoint[Index(point)]];
        const std::uint32_t* const cells = cubes.Cells.data() + cube.First;
        const PlaceInCell place = FindPlace(shapes, { cells, cells + cube.Count },
          ((*this->Points)[Index(point)] - shapes.Origin()) / shapes.Edge());
        this->Places[Index(point)] = { static_cast<std::uint32_t>(place.Cell),
          glm::vec3(place.Part) };
      }
    });
}

void SampledMesh::DropBoxes()
{
  this->Points.reset();
  this->BoxMesh.Points = nullptr;
  this->BoxMesh.PointOwner.reset();
  this->BoxMesh.Connectivity = nullptr;
  this->BoxMesh.Owner.reset();
}

NodeArray SampledMesh::Values::Array() const
{
  NodeArray array;
  array.Values = this->Floats.empty() ? static_cast<const void*>(this->Doubles.data())
                                      : static_cast<const void*>(this->Floats.data());
  array.Type = this->Floats.empty() ? ScalarType::Float64 : ScalarType::Float32;
  return array;
}

template <class In, class Out>
void SampledMesh::SampleInto(
  const In* values, const NodeArray& array, std::vector<Out>& out, ThreadPool& pool) const
{
  out.resize(this->Places.size());
  FirstFailure failure;
  ForRuns(this->BoxMesh.PointCount, pool, failure,
    [&](std::int64_t begin, std::int64_t end, int)
    {
      for (std::int64_t point = begin; point < end; ++point)
      {
        const Place& place = this->Places[Index(point)];
        const std::array<std::int64_t, 8>& nodes = this->NodesOfCells[place.Nodes];
        double corners[8];
        for (std::size_t i = 0; i < 8; ++i)
        {
          corners[i] = TakenComponent(values + nodes[i] * array.Components, array);
        }
        out[Index(point)] =
          static_cast<Out>(NodalField::Interpolate(corners, glm::dvec3(place.Part)));
      }
    });
}

SampledMesh::Values SampledMesh::Sample(const NodeArray& array, ThreadPool& pool) const
{
  RequireComponent(array);
  Values sampled;
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* const values = static_cast<const T*>(array.Values);
      if (FitsFloat(array.Type))
      {
        this->SampleInto(values, array, sampled.Floats, pool);
      }
      else
      {
        this->SampleInto(values, array, sampled.Doubles, pool);
      }
    });
  return sampled;
}

} // namespace banyan
