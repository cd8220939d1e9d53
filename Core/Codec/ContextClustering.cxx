// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/ContextClustering.h"

#include <algorithm>
#include <numeric>

namespace banyan
{
namespace
{

using Counts = std::array<std::uint32_t, tans::SymbolCount>;

/// In 65536ths of a bit, as all costs here.
constexpr int BitShift = 16;

/// Cost of a table in the head, about: six bits for each frequency, compressed.
constexpr std::int64_t FrequencyCost = std::int64_t{ 6 } << BitShift;
/// Saying that a table is another context's.
constexpr std::int64_t ShareCost = std::int64_t{ 5 } << BitShift;

/// @param value > 0
std::int64_t LogarithmOf(std::uint64_t value)
{
  const int whole = 63 - __builtin_clzll(value);
  std::int64_t result = whole;
  std::uint64_t part =
    whole > 31 ? value >> (whole - 31) : value << (31 - whole); // 1 to 2, as 2^31
  for (int bit = 0; bit < BitShift; ++bit)
  {
    part = (part * part) >> 31;
    const std::uint64_t two = part >> 32;
    part >>= two;
    result = 2 * result + static_cast<std::int64_t>(two);
  }
  return result;
}

/// Cost of the symbols of a context and of its table.
std::int64_t CostOf(const Counts& counts)
{
  std::uint64_t total = 0;
  std::int64_t cost = 0;
  std::int64_t last = 0;
  for (std::size_t s = 0; s < counts.size(); ++s)
  {
    if (counts[s] > 0)
    {
      total += counts[s];
      cost -= counts[s] * LogarithmOf(counts[s]);
      last = static_cast<std::int64_t>(s);
    }
  }
  return total == 0 ? 0
                    : cost + static_cast<std::int64_t>(total) * LogarithmOf(total) +
                        (last + 2) * FrequencyCost;
}

Counts SumOf(const Counts& a, const Counts& b)
{
  Counts sum;
  std::transform(a.begin(), a.end(), b.begin(), sum.begin(), std::plus<>());
  return sum;
}

/// Contexts that are likely to be alike, as numbers of them.
struct Pair
{
  int A, B;
  bool Known = false;
  std::int64_t Gain = 0; ///< of having one table
};

class Clustering
{
public:
  explicit Clustering(ContextCounts& counts)
    : All(counts.Of)
  {
    std::iota(std::begin(this->Parent), std::end(this->Parent), 0);
    for (std::size_t c = 0; c < this->All.size(); ++c)
    {
      this->Cost[c] = CostOf(this->All[c]);
    }
    for (int band = 0; band < residual::Bands; ++band)
    {
      for (int c = 0; c < residual::Classes; ++c)
      {
        const int context = band * residual::Classes + c;
        this->PairUp(context, 1, c % residual::Signed);
        this->PairUp(context, residual::Signed, c / residual::Signed);
        this->PairUp(context, residual::Classes, band);
      }
      for (int c = 0; c < residual::RowClasses; ++c)
      {
        const int context = residual::FlagContext + band * residual::RowClasses + c;
        this->PairUp(context, 1, c);
        this->PairUp(context, residual::RowClasses, band);
      }
    }
  }

  void Run()
  {
    for (;;)
    {
      Pair* best = nullptr;
      for (Pair& pair : this->Pairs)
      {
        this->Weigh(pair);
        best = pair.Gain > 0 && (best == nullptr || pair.Gain > best->Gain) ? &pair : best;
      }
      if (best == nullptr)
      {
        break;
      }
      this->Join(this->RootOf(best->A), this->RootOf(best->B));
    }
    for (int c = 0; c < residual::ContextCount; ++c)
    {
      if (this->Cost[static_cast<std::size_t>(c)] > 0)
      {
        this->All[static_cast<std::size_t>(c)] =
          this->All[static_cast<std::size_t>(this->RootOf(c))];
      }
    }
  }

private:
  /// With the nearest context that comes at all, up to `most` times `step` before.
  void PairUp(int context, int step, int most)
  {
    int other = context - step;
    while (most > 0 && this->Cost[static_cast<std::size_t>(other)] == 0)
    {
      other -= step;
      --most;
    }
    if (most > 0 && this->Cost[static_cast<std::size_t>(context)] > 0)
    {
      this->Pairs.push_back({ other, context });
    }
  }

  int RootOf(int context) const
  {
    while (this->Parent[context] != context)
    {
      context = this->Parent[context];
    }
    return context;
  }

  void Weigh(Pair& pair)
  {
    if (!pair.Known)
    {
      const std::size_t a = static_cast<std::size_t>(this->RootOf(pair.A));
      const std::size_t b = static_cast<std::size_t>(this->RootOf(pair.B));
      pair.Known = true;
      pair.Gain = a == b ? 0
                         : this->Cost[a] + this->Cost[b] - ShareCost -
                             CostOf(SumOf(this->All[a], this->All[b]));
    }
  }

  void Join(int a, int b)
  {
    const int root = std::min(a, b);
    const int other = std::max(a, b);
    Counts& counts = this->All[static_cast<std::size_t>(root)];
    counts = SumOf(counts, this->All[static_cast<std::size_t>(other)]);
    this->Cost[static_cast<std::size_t>(root)] = CostOf(counts);
    this->Parent[other] = root;
    for (Pair& pair : this->Pairs)
    {
      const int first = this->RootOf(pair.A);
      pair.Known = pair.Known && first != root && this->RootOf(pair.B) != root;
    }
  }

  std::array<Counts, residual::ContextCount>& All; ///< of roots: of all that share them
  std::int64_t Cost[residual::ContextCount];
  int Parent[residual::ContextCount];
  std::vector<Pair> Pairs;
};

} // namespace

void ClusterContexts(ContextCounts& counts)
{
  Clustering(counts).Run();
}

} // namespace banyan
