// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/FrameStatistics.h"

#include "Parallel/Balance/Rebalance.h"
#include "Parallel/Communicate/Communicator.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace banyan
{

void FrameStatistics::Add(const FrameStatistics& other)
{
  this->TotalSeconds += other.TotalSeconds;
  this->RenderSeconds += other.RenderSeconds;
  this->CompositeSeconds += other.CompositeSeconds;
  this->ProbeSeconds += other.ProbeSeconds;
  this->StrideSeconds += other.StrideSeconds;
  this->Probes += other.Probes;
  this->Imbalance = std::max(this->Imbalance, other.Imbalance);
  this->SamplesTaken += other.SamplesTaken;
  this->BricksDrawn += other.BricksDrawn;
  this->BricksUniform += other.BricksUniform;
  this->BricksSkipped += other.BricksSkipped;
  this->ReusedFraction = std::min(this->ReusedFraction, other.ReusedFraction);
  this->BytesComposited += other.BytesComposited;
  this->MessagesComposited += other.MessagesComposited;
}

void Publish(
  Communicator& communicator, const FrameReport& mine, int root, FrameStatistics& statistics)
{
  std::vector<FrameReport> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());
  const auto values = [&all](double FrameReport::*of)
  {
    std::vector<double> list;
    list.reserve(all.size());
    for (const FrameReport& report : all)
    {
      list.push_back(report.*of);
    }
    return list;
  };
  const auto largest = [&values](double FrameReport::*of)
  {
    const std::vector<double> list = values(of);
    return *std::max_element(list.begin(), list.end());
  };
  const auto sum = [&values](double FrameReport::*of)
  {
    const std::vector<double> list = values(of);
    return std::llround(std::accumulate(list.begin(), list.end(), 0.0));
  };
  statistics.RenderSeconds = largest(&FrameReport::RenderSeconds);
  statistics.Imbalance = ImbalanceOf(values(&FrameReport::RenderSeconds));
  statistics.CompositeSeconds = largest(&FrameReport::CompositeSeconds);
  statistics.TotalSeconds = largest(&FrameReport::TotalSeconds);
  statistics.SamplesTaken = sum(&FrameReport::SamplesTaken);
  statistics.BricksDrawn = sum(&FrameReport::BricksDrawn);
  statistics.BricksUniform = sum(&FrameReport::BricksUniform);
  statistics.BricksSkipped = sum(&FrameReport::BricksSkipped);
  statistics.ReusedFraction = all[static_cast<std::size_t>(root)].ReusedFraction;
  statistics.BytesComposited = static_cast<std::uint64_t>(sum(&FrameReport::BytesComposited));
  statistics.MessagesComposited = static_cast<std::uint64_t>(sum(&FrameReport::MessagesComposited));
}

} // namespace banyan
