// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/FieldGroupEncoder.h"

#include "Base/ThreadPool.h"
#include "Codec/BlockEncoder.h"
#include "Codec/BlockScratch.h"
#include "Codec/GroupOrder.h"
#include "Codec/SymbolWriter.h"
#include "Codec/TokenHistogram.h"
#include "Series/Encode/ChainLengths.h"
#include "Series/Encode/FieldQuantizer.h"
#include "Series/Encode/GroupNodes.h"
#include "Series/Encode/ProfileModes.h"
#include "Series/Format/Exceptions.h"
#include "Series/Format/FieldLattice.h"

#include <algorithm>
#include <cmath>
#include <mutex>

namespace banyan
{
namespace
{

using StepTokens = std::vector<std::vector<BlockTokens>>; ///< of a step, by plane

template <class T>
class Encoder
{
public:
  Encoder(const FieldGroup& field, ThreadPool& pool)
    : Field(field)
    , Pool(pool)
  {
  }

  EncodedField Run(
    std::vector<std::vector<double>>* sumSquares, const std::function<void(double)>& tell);
  KeyFrame RunKeyFrame();

private:
  void Prepare();
  const std::vector<PlaneNumbers>* DecodedAt(int step) const;
  std::vector<PlaneNumbers> TakePlanes() const;
  using BlockBody = std::function<void(std::size_t plane, std::int64_t block)>;
  void EncodePlanes(int step, const BlockBody& done, const std::function<void(double)>& tell);
  void NoteOrigins(int step, int before, std::size_t plane);
  void EncodeStep(int step, std::vector<double>* squares, const std::function<void(double)>& tell);
  void WriteSymbols();
  void WriteSymbols(const SymbolTables& tables, std::vector<BlockTokens>& tokens,
    std::vector<EncodedBlock>& blocks) const;

  const FieldGroup& Field;
  ThreadPool& Pool;
  std::unique_ptr<FieldQuantizer<T>> Target;
  std::vector<glm::ivec3> Planes;   ///< samples
  std::vector<PlaneNumbers> Wanted; ///< of the step under way
  std::vector<DecodedStep> Decoded; ///< all steps, as all else is kept until the group is written
  std::vector<StepTokens> Tokens;
  TokenHistogram Counters[2]; ///< of the finest planes, and of all others
  EncodedField Out;
};

/// Lattice, axes and planes, and whether the group refers to the one before.
template <class T>
void Encoder<T>::Prepare()
{
  group::FieldHead& head = this->Out.Head;
  ChooseLattice(this->Field.Type, this->Field.Map, this->Field.Bound, this->Field.Expected,
    this->Field.Beyond, head);
  this->Target = std::make_unique<FieldQuantizer<T>>(this->Field, head, this->Pool);
  head.Axes = this->Target->Axes();
  head.Open = this->Field.Before != nullptr && !head.Exact && this->Field.Steps.size() > 1 &&
              group::SameLattice(this->Field.Before->Head, head);
  this->Planes = this->Target->Planes();
  this->Wanted = this->TakePlanes();
  this->Out.Steps.resize(this->Field.Steps.size());
  this->Out.StepRmse.resize(this->Field.Steps.size());
  this->Decoded.resize(this->Field.Steps.size());
  this->Tokens.resize(this->Field.Steps.size());
}

/// The planes of a step that was encoded before, or of the key frame before the group.
template <class T>
const std::vector<PlaneNumbers>* Encoder<T>::DecodedAt(int step) const
{
  return step == StepBefore ? &this->Field.Before->Planes
                            : &this->Decoded[static_cast<std::size_t>(step)].Planes;
}

/// Spare planes where there are such ones that fit, else new ones.
template <class T>
std::vector<PlaneNumbers> Encoder<T>::TakePlanes() const
{
  SparePlanes* const spare = this->Field.Spare;
  while (spare != nullptr && !spare->empty())
  {
    std::vector<PlaneNumbers> planes = std::move(spare->back());
    spare->pop_back();
    bool fits = planes.size() == this->Planes.size();
    for (std::size_t p = 0; fits && p < planes.size(); ++p)
    {
      fits = planes[p].Samples == this->Planes[p] && planes[p].Edge == this->Field.BrickCells &&
             planes[p].Narrow == block::Narrow(this->Out.Head.Least, this->Out.Head.Greatest);
    }
    if (fits)
    {
      return planes;
    }
  }
  return this->Target->NewPlanes();
}

/// See DecodedStep::Origins.
/// @param before reference A
template <class T>
void Encoder<T>::NoteOrigins(int step, int before, std::size_t plane)
{
  const std::vector<BlockTokens>& blocks = this->Tokens[static_cast<std::size_t>(step)][plane];
  std::vector<std::vector<int>>& origins = this->Decoded[static_cast<std::size_t>(step)].Origins;
  origins.resize(std::max(origins.size(), plane + 1));
  origins[plane].assign(blocks.size(), step);
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    if (blocks[i].Same)
    {
      origins[plane][i] = before == StepBefore
                            ? StepBefore
                            : this->Decoded[static_cast<std::size_t>(before)].Origins[plane][i];
    }
  }
}

/// @param done called for each block, by any thread, when it is decoded
template <class T>
void Encoder<T>::EncodePlanes(
  int step, const BlockBody& done, const std::function<void(double)>& tell)
{
  std::vector<PlaneNumbers>& targets = this->Wanted;
  const std::size_t number = static_cast<std::size_t>(step);
  const bool blockwise = this->Target->MakeCoarser(number, targets);
  const auto make = [&](std::int64_t block) { this->Target->MakeBlock(number, block, targets[0]); };
  std::vector<PlaneNumbers>& decoded = this->Decoded[static_cast<std::size_t>(step)].Planes;
  StepTokens& tokens = this->Tokens[static_cast<std::size_t>(step)];
  EncodedStep& out = this->Out.Steps[static_cast<std::size_t>(step)];
  const StepReferences references =
    ReferencesOfStep(step, static_cast<int>(this->Field.Steps.size()), this->Out.Head.Open);
  decoded = this->TakePlanes();
  tokens.resize(targets.size() - 1);
  decoded.back() = targets.back();
  const PlaneNumbers& top = targets.back();
  for (int z = 0; z < top.Samples.z; ++z)
  {
    for (int y = 0; y < top.Samples.y; ++y)
    {
      for (int x = 0; x < top.Samples.x; ++x)
      {
        out.Top.push_back(top.At({ x, y, z }));
      }
    }
  }
  for (std::size_t p = targets.size() - 1; p-- > 0;)
  {
    PlaneToEncode plane;
    plane.Target = &targets[p];
    plane.Coarser = &decoded[p + 1];
    if (references.Any())
    {
      plane.A = &(*this->DecodedAt(references.A))[p];
      plane.B = &(*this->DecodedAt(references.B))[p];
    }
    plane.CoarseBin = BinOfOctave(this->Out.Head.Bin, static_cast<int>(2 * p + 1));
    plane.FineBin = BinOfOctave(this->Out.Head.Bin, static_cast<int>(2 * p));
    plane.Least = this->Out.Head.Least;
    plane.Greatest = this->Out.Head.Greatest;
    ApplyProfile(this->Field.Profile, this->Field.Ablation, plane);
    EncodePlane(
      plane, decoded[p], tokens[p], this->Pool, [&](std::int64_t block) { done(p, block); },
      p == 0 && blockwise ? std::function<void(std::int64_t)>(make) : nullptr);
    for (const BlockTokens& block : tokens[p])
    {
      this->Counters[p > 0 ? 1 : 0].Add(block.Tokens);
    }
    this->NoteOrigins(step, references.A, p);
    tell(static_cast<double>(targets.size() - 1 - p) / static_cast<double>(targets.size()));
  }
}

/// Encodes a step and compares what the samples of each block decode to with the originals; what is
/// out of bounds becomes an exception.
template <class T>
void Encoder<T>::EncodeStep(
  int step, std::vector<double>* squares, const std::function<void(double)>& tell)
{
  DecodedStep& decoded = this->Decoded[static_cast<std::size_t>(step)];
  EncodedStep& out = this->Out.Steps[static_cast<std::size_t>(step)];
  for (std::size_t p = 0; p + 1 < this->Planes.size(); ++p)
  {
    const std::size_t blocks = static_cast<std::size_t>(this->Wanted[p].BlockCount());
    out.Planes.emplace_back(blocks);
    decoded.Extremes.emplace_back(blocks);
  }
  std::vector<FieldErrors> parts(out.Planes.empty() ? 0 : out.Planes[0].size());
  this->EncodePlanes(
    step,
    [&](std::size_t plane, std::int64_t i)
    {
      ExceptionList<T> list;
      FieldErrors coarse; // counted on the finest plane only
      const PlaneNumbers& numbers = decoded.Planes[plane];
      decoded.Extremes[plane][static_cast<std::size_t>(i)] =
        ExtremesOfBlock(numbers, static_cast<int>(plane), i, this->Field.Levels);
      this->Target->Verify(static_cast<std::size_t>(step), numbers, static_cast<int>(plane), i,
        list, plane == 0 ? parts[static_cast<std::size_t>(i)] : coarse,
        plane == 0 ? squares : nullptr);
      if (!list.Positions.empty())
      {
        const std::uint32_t edge = static_cast<std::uint32_t>(numbers.Edge);
        out.Planes[plane][static_cast<std::size_t>(i)].Exceptions =
          PackExceptions(list, edge * edge * edge, this->Field.CompressionLevel);
      }
    },
    tell);
  FieldErrors& errors = this->Out.Errors;
  FieldErrors own;
  for (const FieldErrors& part : parts)
  {
    own.SumSquared += part.SumSquared;
    own.Finite += part.Finite;
    errors.Range.Include(part.Range);
    errors.Maximum = std::max(errors.Maximum, part.Maximum);
    errors.MaximumTransformed = std::max(errors.MaximumTransformed, part.MaximumTransformed);
    errors.SumSquared += part.SumSquared;
    errors.Finite += part.Finite;
    errors.NonFinite += part.NonFinite;
    errors.Exceptions += part.Exceptions;
    errors.Fill += part.Fill;
    errors.Invisible += part.Invisible;
    errors.SumWeighted += part.SumWeighted;
  }
  this->Out.StepRmse[static_cast<std::size_t>(step)] =
    own.Finite > 0 ? std::sqrt(own.SumSquared / static_cast<double>(own.Finite)) : 0.0;
}

/// Codes the tokens of all steps with tables made for all of them.
template <class T>
void Encoder<T>::WriteSymbols()
{
  for (int set = 0; set < 2; ++set)
  {
    ContextCounts counts = this->Counters[set].Counts();
    if (!this->Field.Ablation.TablesByActivity)
    {
      counts.ForgetClasses();
    }
    const SymbolTables tables(counts, this->Field.Ablation.SharedTables);
    this->Out.Head.Frequencies[set] = tables.Frequencies();
    for (std::size_t t = 0; t < this->Tokens.size(); ++t)
    {
      for (std::size_t p = 0; p < this->Tokens[t].size(); ++p)
      {
        if ((p > 0 ? 1 : 0) == set)
        {
          this->WriteSymbols(tables, this->Tokens[t][p], this->Out.Steps[t].Planes[p]);
        }
      }
    }
  }
}

/// Codes the tokens of the blocks of a plane, and lets go of them.
template <class T>
void Encoder<T>::WriteSymbols(const SymbolTables& tables, std::vector<BlockTokens>& tokens,
  std::vector<EncodedBlock>& blocks) const
{
  this->Pool.ParallelFor(static_cast<std::int64_t>(tokens.size()),
    [&](std::int64_t i)
    {
      BlockTokens& from = tokens[static_cast<std::size_t>(i)];
      EncodedBlock& to = blocks[static_cast<std::size_t>(i)];
      to.Mode = from.Uniform || from.Same ? 0 : from.Mode;
      to.Uniform = from.Uniform;
      to.Same = from.Same;
      to.Value = from.Value;
      if (!from.Tokens.empty())
      {
        to.Payload = tables.Encode(from.Tokens, from.Extra, from.Runs);
      }
      from = {};
    });
}

template <class T>
EncodedField Encoder<T>::Run(
  std::vector<std::vector<double>>* sumSquares, const std::function<void(double)>& tell)
{
  this->Prepare();
  const int steps = static_cast<int>(this->Field.Steps.size());
  int done = 0;
  for (const int step : DyadicOrder(steps))
  {
    this->EncodeStep(step,
      sumSquares != nullptr ? &(*sumSquares)[static_cast<std::size_t>(step)] : nullptr,
      [&](double share) { tell(done + share); });
    tell(++done);
  }
  this->WriteSymbols();
  MakeNodes<T>(this->Field, this->Out.Head, this->Decoded, this->Out.Steps, this->Pool);
  CountChains(this->Out, this->Field.Samples, this->Field.BrickCells);
  this->Out.Last = { this->Out.Head, std::move(this->Decoded.back().Planes) };
  this->Decoded.pop_back();
  if (this->Field.Spare != nullptr)
  {
    this->Field.Spare->push_back(std::move(this->Wanted));
    for (DecodedStep& step : this->Decoded)
    {
      this->Field.Spare->push_back(std::move(step.Planes));
    }
  }
  for (auto& set : this->Out.Last.Head.Frequencies)
  {
    set.clear();
  }
  return std::move(this->Out);
}

template <class T>
KeyFrame Encoder<T>::RunKeyFrame()
{
  this->Prepare();
  const int last = static_cast<int>(this->Field.Steps.size()) - 1;
  this->EncodePlanes(
    last, [](std::size_t, std::int64_t) {}, [](double) {});
  return { this->Out.Head, std::move(this->Decoded.back().Planes) };
}

} // namespace

EncodedField EncodeFieldGroup(const FieldGroup& field, ThreadPool& pool,
  std::vector<std::vector<double>>* sumSquares, const std::function<void(double)>& tell)
{
  EncodedField result;
  Dispatch(field.Type, [&](auto tag)
    { result = Encoder<typename decltype(tag)::Type>(field, pool).Run(sumSquares, tell); });
  return result;
}

KeyFrame EncodeKeyFrame(const FieldGroup& field, ThreadPool& pool)
{
  KeyFrame result;
  Dispatch(field.Type,
    [&](auto tag) { result = Encoder<typename decltype(tag)::Type>(field, pool).RunKeyFrame(); });
  return result;
}

void MarkStatic(EncodedField& field, std::int64_t steps)
{
  field.Head.Static = true;
  field.Head.Open = false;
  field.Head.Exact = false;
  for (std::vector<tans::Frequencies>& set : field.Head.Frequencies)
  {
    std::fill(set.begin(), set.end(), tans::Frequencies{});
  }
  FieldErrors& errors = field.Errors;
  for (std::int64_t* count :
    { &errors.Finite, &errors.NonFinite, &errors.Exceptions, &errors.Fill, &errors.Invisible })
  {
    *count *= steps;
  }
  errors.SumSquared *= static_cast<double>(steps);
  errors.SumWeighted *= static_cast<double>(steps);
  field.StepRmse.assign(static_cast<std::size_t>(steps), field.StepRmse.at(0));
  field.ChainSum *= steps;
  field.ChainBricks *= steps;
}

} // namespace banyan
