// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesHistograms.h"

#include "PieceValues.h"
#include "RankMessages.h"
#include "StepGathering.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"

#include "Parallel/Communicate/Collective.h"
#include "Series/Quantize/FillValues.h"

namespace banyan
{
namespace
{

void Save(const ValueHistogram& histogram, vtkMultiProcessStream& stream)
{
  const HistogramMessage message = histogram.Message();
  stream << static_cast<vtkTypeUInt64>(message.NonFinite) << message.Range.Low << message.Range.High
         << static_cast<int>(message.Entries.size());
  for (const HistogramEntry& entry : message.Entries)
  {
    stream << entry.Bin << static_cast<vtkTypeUInt64>(entry.Count);
  }
}

HistogramMessage Load(vtkMultiProcessStream& stream)
{
  HistogramMessage message;
  vtkTypeUInt64 count = 0;
  int entries = 0;
  stream >> count >> message.Range.Low >> message.Range.High >> entries;
  message.NonFinite = count;
  message.Entries.resize(entries);
  for (HistogramEntry& entry : message.Entries)
  {
    unsigned int bin = 0;
    stream >> bin >> count;
    entry = { bin, count };
  }
  return message;
}

} // namespace

void SeriesHistograms::Count(vtkImageData* image, const StepAgreement& step, int rank)
{
  std::vector<unsigned char> values;
  std::vector<std::uint8_t> hidden;
  for (const WrittenArray& array : step.Arrays)
  {
    if (!this->Options.NeedsHistogram(array.Name))
    {
      continue;
    }
    std::vector<ValueHistogram>& counts = this->Counts[array.Name];
    counts.resize(array.Components.size());
    const std::vector<double>& fills = this->Options.QuantizerFor(array.Name).FillValues;
    const int components = static_cast<int>(array.Components.size());
    for (const GatherPlan::Part& part : step.Plan.Parts)
    {
      // Slice by slice: a copy of a whole piece would double the memory.
      for (int z = part.Samples.Lo.z; part.Rank == rank && z < part.Samples.Hi.z; ++z)
      {
        Box slice = part.Samples;
        slice.Lo.z = z;
        slice.Hi.z = z + 1;
        values.resize(
          static_cast<std::size_t>(slice.Count()) * array.Components.size() * SizeOf(array.Type));
        CopyPart(image, ArrayOf(image, array.Name), slice, values.data());
        hidden.resize(step.HidesPoints ? static_cast<std::size_t>(slice.Count()) : 0);
        if (step.HidesPoints)
        {
          CopyFlags(image, ArrayFlags::OfPoints, slice, hidden.data());
        }
        for (int c = 0; c < components; ++c)
        {
          CountComponent(array.Type, values.data(), slice.Count(), components, c, fills,
            counts[static_cast<std::size_t>(c)], step.HidesPoints ? hidden.data() : nullptr);
        }
      }
    }
  }
}

void SeriesHistograms::Merge(Communicator& ranks, const std::vector<WrittenArray>& arrays)
{
  vtkMultiProcessStream mine;
  const auto forCounted = [&](const auto& action)
  {
    for (const WrittenArray& array : arrays)
    {
      if (this->Options.NeedsHistogram(array.Name))
      {
        action(this->Counts[array.Name], array.Components.size());
      }
    }
  };
  Collective(ranks,
    [&]
    {
      forCounted(
        [&](std::vector<ValueHistogram>& counts, std::size_t components)
        {
          counts.resize(components);
          for (const ValueHistogram& histogram : counts)
          {
            Save(histogram, mine);
          }
          counts.assign(components, ValueHistogram());
        });
    });
  std::vector<vtkMultiProcessStream> all = AllGatherStreams(ranks, mine);
  Collective(ranks,
    [&]
    {
      for (vtkMultiProcessStream& theirs : all)
      {
        forCounted(
          [&theirs](std::vector<ValueHistogram>& counts, std::size_t)
          {
            for (ValueHistogram& histogram : counts)
            {
              histogram.Merge(Load(theirs));
            }
          });
      }
    });
}

std::vector<ValueHistogram> SeriesHistograms::Of(const std::string& array) const
{
  const auto found = this->Counts.find(array);
  return found == this->Counts.end() ? std::vector<ValueHistogram>{} : found->second;
}

} // namespace banyan
