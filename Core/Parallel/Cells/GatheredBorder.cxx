// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/GatheredBorder.h"

#include "Base/Varint.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Communicate/ExchangeBytes.h"

#include <cstring>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace banyan
{
namespace
{

/// Cells with their points and what is on them.
struct SomeCells
{
  std::vector<double> Points;
  std::vector<std::int64_t> Ids;
  std::vector<std::int64_t> Offsets{ 0 };
  std::vector<std::uint8_t> Types;
  std::vector<std::uint8_t> Bits; ///< of faces at the border, by cell
  std::vector<float> Values;      ///< of points, or of cells
  std::vector<float> Gradients;   ///< of points
};

/// A type of VTK whose corners stand as those of MeshCell.
std::uint8_t TypeOf(CellShape shape)
{
  switch (shape)
  {
    case CellShape::Tetrahedron:
      return 10;
    case CellShape::Hexahedron:
      return 11; // a voxel, x fastest
    case CellShape::Wedge:
      return 13;
    case CellShape::Pyramid:
      return 14;
    default:
      return 0;
  }
}

/// The cells of a piece that have faces at the border.
SomeCells BorderOf(const CellField& piece, bool withGradients)
{
  const DrawnCells& cells = *piece.Cells;
  SomeCells found;
  std::unordered_map<std::int64_t, std::int64_t> numbers;
  const auto numberOf = [&](std::int64_t point)
  {
    const auto [at, isNew] = numbers.emplace(point, static_cast<std::int64_t>(numbers.size()));
    if (isNew)
    {
      const glm::dvec3 place = cells.Mesh.Point(point);
      found.Points.insert(found.Points.end(), { place.x, place.y, place.z });
      if (!piece.OfCells)
      {
        found.Values.push_back(piece.Values[static_cast<std::size_t>(point)]);
      }
      if (withGradients)
      {
        const auto from = piece.Gradients.begin() + 3 * static_cast<std::ptrdiff_t>(point);
        found.Gradients.insert(found.Gradients.end(), from, from + 3);
      }
    }
    return at->second;
  };
  for (std::size_t place = 0; place < cells.BorderBits.size(); ++place)
  {
    if (cells.BorderBits[place] == 0)
    {
      continue;
    }
    const std::int64_t number = cells.Order[place];
    const MeshCell cell = cells.Mesh.Cell(number);
    for (int i = 0; i < CornersOf(cell.Shape); ++i)
    {
      found.Ids.push_back(numberOf(cell.Points[static_cast<std::size_t>(i)]));
    }
    found.Offsets.push_back(static_cast<std::int64_t>(found.Ids.size()));
    found.Types.push_back(TypeOf(cell.Shape));
    found.Bits.push_back(cells.BorderBits[place]);
    if (piece.OfCells)
    {
      found.Values.push_back(piece.Values[static_cast<std::size_t>(number)]);
    }
  }
  return found;
}

template <class T>
void Put(Bytes& message, const std::vector<T>& numbers)
{
  const std::uint64_t count = numbers.size();
  const std::size_t at = message.size();
  message.resize(at + sizeof(count) + numbers.size() * sizeof(T));
  StoreNumber(message.data() + at, count);
  if (!numbers.empty())
  {
    std::memcpy(message.data() + at + sizeof(count), numbers.data(), numbers.size() * sizeof(T));
  }
}

/// Adds what Put has put.
template <class T>
void Add(ByteReader& in, std::vector<T>& numbers)
{
  const std::size_t had = numbers.size();
  const auto count = static_cast<std::size_t>(in.Number<std::uint64_t>());
  numbers.resize(had + count);
  const std::uint8_t* const from = in.Skip(count * sizeof(T));
  if (count > 0)
  {
    std::memcpy(numbers.data() + had, from, count * sizeof(T));
  }
}

Bytes MessageOf(const SomeCells& cells)
{
  Bytes message;
  Put(message, cells.Points);
  Put(message, cells.Ids);
  Put(message, cells.Offsets);
  Put(message, cells.Types);
  Put(message, cells.Bits);
  Put(message, cells.Values);
  Put(message, cells.Gradients);
  return message;
}

/// Adds the cells of another rank.
void AddCells(const Bytes& message, SomeCells& all)
{
  ByteReader in(message.data(), message.size());
  const auto firstPoint = static_cast<std::int64_t>(all.Points.size() / 3);
  const std::size_t firstId = all.Ids.size();
  Add(in, all.Points);
  Add(in, all.Ids);
  for (std::size_t i = firstId; i < all.Ids.size(); ++i)
  {
    all.Ids[i] += firstPoint;
  }
  all.Offsets.pop_back(); // begins the cells that follow, from their own 0 on
  const std::size_t firstOffset = all.Offsets.size();
  Add(in, all.Offsets);
  for (std::size_t i = firstOffset; i < all.Offsets.size(); ++i)
  {
    all.Offsets[i] += static_cast<std::int64_t>(firstId);
  }
  Add(in, all.Types);
  Add(in, all.Bits);
  Add(in, all.Values);
  Add(in, all.Gradients);
}

/// A field that owns its cells.
/// @param piece has the same index space
std::shared_ptr<const CellField> FieldOf(SomeCells found, const CellField& piece)
{
  auto field = std::make_shared<CellField>();
  field->Base = piece.Base;
  field->OfCells = piece.OfCells;
  field->Values = std::move(found.Values);
  field->Gradients = std::move(found.Gradients);
  const auto owner = std::make_shared<const SomeCells>(std::move(found));
  auto cells = std::make_shared<DrawnCells>();
  const DrawnCells& like = *piece.Cells;
  cells->Lattice = like.Lattice;
  cells->OrderedBy = like.OrderedBy;
  cells->Low = like.Low;
  cells->High = like.High;
  cells->Count = like.Count;
  CellMesh& mesh = cells->Mesh;
  mesh.Points = owner->Points.data();
  mesh.PointType = ScalarType::Float64;
  mesh.PointCount = static_cast<std::int64_t>(owner->Points.size() / 3);
  mesh.Connectivity = owner->Ids.data();
  mesh.ConnectivityCount = static_cast<std::int64_t>(owner->Ids.size());
  mesh.Offsets = owner->Offsets.data();
  mesh.Types = owner->Types.data();
  mesh.CellCount = static_cast<std::int64_t>(owner->Types.size());
  mesh.Owner = owner;
  std::vector<BorderFace> border;
  for (std::size_t cell = 0; cell < owner->Bits.size(); ++cell)
  {
    cells->Order.push_back(static_cast<std::uint32_t>(cell));
    for (std::uint8_t face = 0; face < 6; ++face)
    {
      if ((owner->Bits[cell] >> face & 1U) != 0)
      {
        border.push_back({ static_cast<std::uint32_t>(cell), face });
      }
    }
  }
  cells->SetBorder(std::move(border));
  field->Cells = cells;
  return field;
}

} // namespace

std::shared_ptr<const CellField> GatherBorder(
  Communicator& communicator, const CellField& piece, bool withGradients)
{
  std::string failure;
  Bytes mine;
  Attempt(failure, [&] { mine = MessageOf(BorderOf(piece, withGradients)); });
  const std::vector<Bytes> messages = AllGatherBytes(communicator, std::move(mine), failure);
  std::shared_ptr<const CellField> border;
  Collective(communicator,
    [&]
    {
      SomeCells all;
      for (const Bytes& message : messages)
      {
        AddCells(message, all);
      }
      border = FieldOf(std::move(all), piece);
    });
  return border;
}

} // namespace banyan
