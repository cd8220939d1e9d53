// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/PieceLattice.h"

#include "Base/Varint.h"
#include "Cells/CellOrder.h"
#include "Parallel/Cells/GatheredBorder.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Communicate/ExchangeBytes.h"
#include "Render/Cells/MeshLattice.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace banyan
{
namespace
{

bool HasBit(const Bytes& bits, std::size_t place)
{
  return (bits[place / 8] >> place % 8 & 1U) != 0;
}

void SetBit(Bytes& bits, std::size_t place)
{
  bits[place / 8] = static_cast<std::uint8_t>(bits[place / 8] | 1U << place % 8);
}

/// Puts together what ranks have at the places of a lattice.
class PlacesOfRanks
{
public:
  PlacesOfRanks(Communicator& communicator, const CellField& field, const PlacesInRows& places)
    : Ranks(communicator)
    , Field(field)
    , Places(places)
    , Size(static_cast<std::size_t>(communicator.Size()))
    , Each((places.Size() + this->Size - 1) / this->Size)
  {
  }

  /// Collective.
  std::vector<float> All(ThreadPool& pool)
  {
    std::string failure;
    std::vector<Bytes> bits;
    Attempt(failure,
      [&]
      {
        SampleField(this->Field, this->Places, this->Mine, pool, &this->Owners);
        bits = this->BitsOfMine();
      });
    const std::vector<Bytes> theirs = ExchangeBytes(this->Ranks, bits, failure);
    std::vector<Bytes> several;
    Attempt(failure,
      [&]
      {
        this->Several = SeveralOf(theirs);
        several = this->AnswersTo(theirs);
      });
    const std::vector<Bytes> contested = ExchangeBytes(this->Ranks, std::move(several), failure);
    std::vector<Bytes> values;
    Attempt(failure, [&] { values = this->ValuesOfMine(bits, contested); });
    const std::vector<Bytes> all = ExchangeBytes(this->Ranks, std::move(values), failure);
    Bytes part;
    Attempt(failure, [&] { part = this->Decide(theirs, all); });
    return this->Join(AllGatherBytes(this->Ranks, std::move(part), failure));
  }

private:
  struct Part
  {
    std::size_t Begin;
    std::size_t End;
  };
  /// The places that a rank decides.
  Part PartOf(std::size_t rank) const
  {
    const std::size_t all = this->Places.Size();
    return { std::min(rank * this->Each, all), std::min((rank + 1) * this->Each, all) };
  }

  /// By the rank that decides: a bit for each place with a value; nothing where there is none.
  std::vector<Bytes> BitsOfMine() const
  {
    std::vector<Bytes> bits(this->Size);
    for (std::size_t rank = 0; rank < this->Size; ++rank)
    {
      const Part part = this->PartOf(rank);
      for (std::size_t place = part.Begin; place < part.End; ++place)
      {
        if (std::isfinite(this->Mine[place]))
        {
          bits[rank].resize((this->Each + 7) / 8);
          SetBit(bits[rank], place - part.Begin);
        }
      }
    }
    return bits;
  }

  /// A bit for each place where several ranks have a value.
  static Bytes SeveralOf(const std::vector<Bytes>& bits)
  {
    Bytes once;
    Bytes twice;
    for (const Bytes& of : bits)
    {
      once.resize(std::max(once.size(), of.size()), 0);
      twice.resize(once.size(), 0);
      for (std::size_t i = 0; i < of.size(); ++i)
      {
        twice[i] = static_cast<std::uint8_t>(twice[i] | (once[i] & of[i]));
        once[i] = static_cast<std::uint8_t>(once[i] | of[i]);
      }
    }
    return twice;
  }

  /// Several, to each rank that has values here.
  std::vector<Bytes> AnswersTo(const std::vector<Bytes>& bits) const
  {
    std::vector<Bytes> answers(bits.size());
    for (std::size_t rank = 0; rank < bits.size(); ++rank)
    {
      answers[rank] = bits[rank].empty() ? Bytes() : this->Several;
    }
    return answers;
  }

  /// By the rank that decides: the values, each with the key of its cell where several ranks have
  /// one.
  std::vector<Bytes> ValuesOfMine(
    const std::vector<Bytes>& bits, const std::vector<Bytes>& contested) const
  {
    const DrawnCells& cells = *this->Field.Cells;
    const CellKeys keys(cells.Mesh, cells.OrderedBy);
    std::vector<Bytes> messages(this->Size);
    for (std::size_t rank = 0; rank < this->Size; ++rank)
    {
      const Part part = this->PartOf(rank);
      Bytes& message = messages[rank];
      const auto put = [&message](const auto& number)
      {
        message.resize(message.size() + sizeof(number));
        StoreNumber(message.data() + message.size() - sizeof(number), number);
      };
      for (std::size_t i = 0; i < part.End - part.Begin && !bits[rank].empty(); ++i)
      {
        if (HasBit(bits[rank], i))
        {
          const std::size_t place = part.Begin + i;
          put(this->Mine[place]);
          if (HasBit(contested[rank], i))
          {
            put(keys.Of(cells.Order[this->Owners[place]]));
          }
        }
      }
    }
    return messages;
  }

  /// The values of the places that this rank decides.
  /// @param bits of each rank
  /// @param values of each rank
  Bytes Decide(const std::vector<Bytes>& bits, const std::vector<Bytes>& values) const
  {
    std::vector<ByteReader> readers;
    readers.reserve(values.size());
    for (const Bytes& message : values)
    {
      readers.emplace_back(message.data(), message.size());
    }
    const Part part = this->PartOf(static_cast<std::size_t>(this->Ranks.Rank()));
    Bytes decided((part.End - part.Begin) * sizeof(float));
    for (std::size_t i = 0; i < part.End - part.Begin; ++i)
    {
      float value = std::numeric_limits<float>::quiet_NaN();
      CellKey last;
      for (std::size_t rank = 0; rank < bits.size(); ++rank)
      {
        if (!bits[rank].empty() && HasBit(bits[rank], i))
        {
          const auto theirs = readers[rank].Number<float>();
          const CellKey key = HasBit(this->Several, i) ? readers[rank].Number<CellKey>() : last;
          value = key < last ? value : theirs;
          last = std::max(last, key);
        }
      }
      StoreNumber(decided.data() + i * sizeof(float), value);
    }
    return decided;
  }

  /// Collective: all places.
  /// @param parts by rank
  std::vector<float> Join(const std::vector<Bytes>& parts) const
  {
    std::vector<float> all;
    Collective(this->Ranks,
      [&]
      {
        all.resize(this->Places.Size());
        for (std::size_t rank = 0; rank < this->Size; ++rank)
        {
          if (!parts[rank].empty())
          {
            std::memcpy(
              all.data() + this->PartOf(rank).Begin, parts[rank].data(), parts[rank].size());
          }
        }
      });
    return all;
  }

  Communicator& Ranks;
  const CellField& Field;
  const PlacesInRows& Places;
  const std::size_t Size;
  const std::size_t Each; ///< places that a rank decides
  std::vector<float> Mine;
  std::vector<std::uint32_t> Owners; ///< cells of the order, where Mine has a value
  Bytes Several;                     ///< of the places that this rank decides
};

} // namespace

void GivePieceLattice(Communicator& communicator, CellSource& source, bool shaded, ThreadPool& pool)
{
  if (AllMax(communicator, source.HasLattice(shaded) ? 0.0 : 1.0) == 0.0)
  {
    return;
  }
  const CellField& field = source.Cells();
  const double edge = source.EdgeOf(1);
  const PlacesInRows places = MeshLattice::PlacesFor(*field.Cells, edge);
  const auto valuesOf = [&](const CellField& of)
  { return PlacesOfRanks(communicator, of, places).All(pool); };
  const std::shared_ptr<const CellField> border = GatherBorder(communicator, field, shaded);
  std::vector<float> values = valuesOf(field);
  std::shared_ptr<MeshLattice> lattice;
  Collective(communicator, [&]
    { lattice = std::make_shared<MeshLattice>(*border->Cells, edge, std::move(values), pool); });
  for (std::size_t axis = 0; axis < 3 && shaded; ++axis)
  {
    CellField slope;
    Collective(communicator, [&] { slope = MeshLattice::SlopeOf(field, axis); });
    std::vector<float> slopes = valuesOf(slope);
    Collective(communicator, [&] { lattice->AddSlopes(axis, std::move(slopes), pool); });
  }
  source.GiveLattice(border, lattice);
}

} // namespace banyan
