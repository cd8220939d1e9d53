// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/SeriesFile.h"

#include "Base/CacheBudget.h"
#include "Base/Error.h"
#include "Series/Decode/FieldReader.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Format/IndexText.h"
#include "Series/Format/SeriesFolder.h"

#include <atomic>

namespace banyan
{
namespace
{

std::atomic<std::uint64_t> NextId{ 1 };

} // namespace

struct SeriesFile::Internals
{
  OpenSeries Series;
  std::unique_ptr<FieldReader> Reader;
  Hash128 Fingerprint;

  /// @param text of the index
  void Read(const std::string& path, const std::string& text);
  void Check(const FieldKey& field) const;
  void CheckBrick(const FieldKey& field, std::int64_t brick) const;
};

MaskRange OpenSeries::MaskRangeOf(int array, int component) const
{
  const ComponentIndex& index = this->Index.Arrays[static_cast<std::size_t>(array)]
                                  .Components[static_cast<std::size_t>(component)];
  const ValueRange& range = index.PromisedRange.Empty() ? index.Range : index.PromisedRange;
  return range.Empty() ? MaskRange{ 0, 0 } : MaskRange{ range.Low, range.High };
}

void SeriesFile::Internals::Check(const FieldKey& field) const
{
  (void)this->Series.Index.SegmentOf(field.Step);
  if (field.Array < 0 || field.Array >= static_cast<int>(this->Series.Index.Arrays.size()))
  {
    throw Error(
      "The series has no array number " + std::to_string(field.Array), { this->Series.Path });
  }
  const auto& components =
    this->Series.Index.Arrays[static_cast<std::size_t>(field.Array)].Components;
  if (field.Component < 0 || field.Component >= static_cast<int>(components.size()))
  {
    throw Error(
      "The array has no component " + std::to_string(field.Component), { this->Series.Path });
  }
  if (field.Level < 0 || field.Level >= this->Series.Index.Levels)
  {
    throw Error("The series has no level " + std::to_string(field.Level), { this->Series.Path });
  }
}

void SeriesFile::Internals::CheckBrick(const FieldKey& field, std::int64_t brick) const
{
  if (brick < 0 ||
      brick >= this->Series.Layouts[static_cast<std::size_t>(field.Level)].BrickCount())
  {
    throw Error("The level has no brick number " + std::to_string(brick), { this->Series.Path });
  }
}

SeriesFile::SeriesFile()
  : Self(std::make_unique<Internals>())
{
}

SeriesFile::~SeriesFile() = default;

std::shared_ptr<SeriesFile> SeriesFile::Open(
  const std::string& path, std::shared_ptr<CacheContext> caches)
{
  (void)CacheBudgetAskedFor(); // who reads a series hears of a budget that is none
  RefuseFolder(path);
  std::string text = ReadWholeFile(path, GreatestIndexBytes);
  for (int attempt = 0;; ++attempt)
  {
    try
    {
      std::shared_ptr<SeriesFile> file(new SeriesFile);
      file->Self->Series.Caches = caches ? caches : CacheContext::Process();
      file->Self->Read(path, text);
      return file;
    }
    catch (const Error&)
    {
      // Segments go when a series is replaced, and there is then another index.
      const std::string now = ReadWholeFile(path, GreatestIndexBytes);
      if (now == text || attempt == 5)
      {
        throw;
      }
      text = now;
    }
  }
}

void SeriesFile::Internals::Read(const std::string& path, const std::string& text)
{
  OpenSeries& series = this->Series;
  series.Path = path;
  series.Id = NextId++;
  series.Index = IndexFromText(text, path);
  this->Fingerprint = HashOf(text.data(), text.size());
  for (int level = 0; level < series.Index.Levels; ++level)
  {
    series.Layouts.emplace_back(series.Index.Domain.Samples(), series.Index.BrickCells, level);
  }
  for (const ArrayIndex& array : series.Index.Arrays)
  {
    series.FirstComponents.push_back(series.Components);
    series.Components += static_cast<std::uint32_t>(array.Components.size());
  }
  const auto openIn = [this, &series](const std::string& folder)
  {
    series.Folder = folder;
    this->Reader = std::make_unique<FieldReader>(series);
  };
  // Looking at every file first would make opening a third slower, where there are thousands.
  const bool usual = BeginsInFolder(path + ".d", series.Index);
  try
  {
    openIn(usual ? path + ".d" : FindSeriesFolder(path, series.Index));
  }
  catch (const Error&)
  {
    const std::string other = usual ? FindSeriesFolder(path, series.Index) : series.Folder;
    if (other == series.Folder)
    {
      throw;
    }
    openIn(other);
  }
}

const std::string& SeriesFile::Path() const
{
  return this->Self->Series.Path;
}

const std::string& SeriesFile::Folder() const
{
  return this->Self->Series.Folder;
}

const SeriesIndex& SeriesFile::Index() const
{
  return this->Self->Series.Index;
}

const std::shared_ptr<CacheContext>& SeriesFile::Caches() const
{
  return this->Self->Series.Caches;
}

std::uint64_t SeriesFile::Id() const
{
  return this->Self->Series.Id;
}

Hash128 SeriesFile::Fingerprint() const
{
  return this->Self->Fingerprint;
}

BrickLayout SeriesFile::Layout(int level) const
{
  if (level < 0 || level >= this->Self->Series.Index.Levels)
  {
    throw Error("The series has no level " + std::to_string(level), { this->Self->Series.Path });
  }
  return this->Self->Series.Layouts[static_cast<std::size_t>(level)];
}

MaskRange SeriesFile::MaskRangeOf(int array, int component) const
{
  this->Self->Check({ 0, array, component, 0 });
  return this->Self->Series.MaskRangeOf(array, component);
}

double SeriesFile::StepOfValues(const FieldKey& field) const
{
  this->Self->Check(field);
  return this->Self->Reader->StepOfValues(field);
}

std::shared_ptr<const std::vector<BrickNode>> SeriesFile::Nodes(const FieldKey& field) const
{
  this->Self->Check(field);
  return this->Self->Reader->Nodes(field);
}

void SeriesFile::DecodeBrick(const FieldKey& field, std::int64_t brick, void* values) const
{
  this->Self->Check(field);
  this->Self->CheckBrick(field, brick);
  this->Self->Reader->DecodeBrick(field, brick, values);
}

void SeriesFile::DecodePart(const FieldKey& field, std::int64_t brick, const Box& part,
  const glm::i64vec3& stride, void* first) const
{
  const Internals& self = *this->Self;
  self.Check(field);
  self.CheckBrick(field, brick);
  const Box samples = self.Series.Layouts[static_cast<std::size_t>(field.Level)].SamplesOf(brick);
  if (part.Empty() || !samples.Contains(part))
  {
    throw Error("The part to decode is not inside its brick", { self.Series.Path });
  }
  if (self.Reader->DecodePart(field, brick, part, stride, first))
  {
    return;
  }
  Dispatch(self.Series.Index.Arrays[static_cast<std::size_t>(field.Array)].Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const glm::ivec3 size = samples.Size();
      std::vector<T> values(static_cast<std::size_t>(samples.Count()));
      self.Reader->DecodeBrick(field, brick, values.data());
      for (int z = part.Lo.z; z < part.Hi.z; ++z)
      {
        for (int y = part.Lo.y; y < part.Hi.y; ++y)
        {
          const glm::ivec3 p = glm::ivec3(part.Lo.x, y, z) - samples.Lo;
          const T* from = values.data() + (std::ptrdiff_t{ p.z } * size.y + p.y) * size.x + p.x;
          T* to = static_cast<T*>(first) + (z - part.Lo.z) * stride.z + (y - part.Lo.y) * stride.y;
          for (int x = 0; x < part.Size().x; ++x)
          {
            to[x * stride.x] = from[x];
          }
        }
      }
    });
}

void SeriesFile::DecodeRow(const FieldKey& field, std::int64_t brick, int count, const Box& part,
  const glm::i64vec3& stride, void* first) const
{
  const Internals& self = *this->Self;
  self.Check(field);
  self.CheckBrick(field, brick);
  self.CheckBrick(field, brick + count - 1);
  const BrickLayout& layout = self.Series.Layouts[static_cast<std::size_t>(field.Level)];
  const Box begin = layout.SamplesOf(brick);
  const Box end = layout.SamplesOf(brick + count - 1);
  if (count < 1 || part.Empty() || begin.Lo.y != end.Lo.y || begin.Lo.z != end.Lo.z ||
      !begin.Contains(
        { part.Lo, glm::ivec3(part.Lo.x + (count > 1 ? 2 : 1), part.Hi.y, part.Hi.z) }) ||
      !end.Contains({ glm::ivec3(part.Hi.x - 1, part.Lo.y, part.Lo.z), part.Hi }))
  {
    throw Error("The part to decode is not inside its row of bricks", { self.Series.Path });
  }
  if (count > 1 && self.Reader->DecodeRow(field, brick, count, part, stride, first))
  {
    return;
  }
  // The last one first: a brick then finds the layers that it shares with others decoded.
  const std::size_t bytes =
    SizeOf(self.Series.Index.Arrays[static_cast<std::size_t>(field.Array)].Type);
  for (int k = count - 1; k >= 0; --k)
  {
    const Box own = RowPart(layout, brick, count, k, part);
    this->DecodePart(field, brick + k, own, stride,
      static_cast<char*>(first) +
        static_cast<std::ptrdiff_t>(bytes) * (own.Lo.x - part.Lo.x) * stride.x);
  }
}

void SeriesFile::VerifyBricks(const FieldKey& field, const std::vector<std::int64_t>& bricks) const
{
  this->Self->Check(field);
  for (const std::int64_t brick : bricks)
  {
    this->Self->CheckBrick(field, brick);
  }
  this->Self->Reader->VerifyBricks(field, bricks);
}

std::uint64_t SeriesFile::BytesRead() const
{
  return this->Self->Reader->BytesRead();
}

std::uint64_t SeriesFile::BricksDecoded() const
{
  return this->Self->Reader->BricksDecoded();
}

} // namespace banyan
