// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_WeightedPoints_h
#define banyan_Inputs_WeightedPoints_h

#include "Base/Hash.h"

#include "vtkType.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

class vtkPoints;

namespace banyan
{

/// Points that are made of others: each the sum of some, times their weights.
struct WeightedPoints
{
  std::vector<std::size_t> Ends;  ///< of each point's sources below
  std::vector<vtkIdType> Sources; ///< numbers of points
  std::vector<double> Weights;    ///< of these

  std::size_t Count() const { return this->Ends.size(); }

  /// The sums, each made in double in the order of the sources.
  /// @param from one tuple for each old point
  /// @param to one for each new point
  template <class In, class Out>
  void Sum(const In* from, int components, Out* to) const
  {
    std::size_t begin = 0;
    for (const std::size_t end : this->Ends)
    {
      for (int c = 0; c < components; ++c)
      {
        double sum = 0.0;
        for (std::size_t i = begin; i < end; ++i)
        {
          sum += this->Weights[i] * static_cast<double>(from[this->Sources[i] * components + c]);
        }
        *to++ = static_cast<Out>(sum);
      }
      begin = end;
    }
  }
};

/// Makes points of the points of a grid: the same one of the same sources.
class WeightedPointMaker
{
public:
  /// A point and its weight.
  using Source = std::pair<std::int64_t, double>;

  /// @param points must stay as long as this
  explicit WeightedPointMaker(vtkPoints* points);

  /// Makes room for so many new points, and their sources.
  void Reserve(std::size_t points, std::size_t sources);

  /// The number of the point that is made of these: an old one, one that was made before, or a new
  /// one. New ones have the numbers behind the old ones. Their sources stand in the order of their
  /// places, which no numbers change.
  /// @param sources at least one, of points that exist; is changed
  vtkIdType Add(std::vector<Source>& sources);

  /// The same of points that count alike.
  vtkIdType AddMean(const std::vector<vtkIdType>& points);

  WeightedPoints Finish() { return std::move(this->Made); }

private:
  struct HashOfHash
  {
    std::size_t operator()(const Hash128& hash) const { return static_cast<std::size_t>(hash.Low); }
  };

  void Keep(const std::vector<Source>& sources);

  vtkPoints* Points;
  vtkIdType Count;
  WeightedPoints Made;
  std::unordered_map<Hash128, vtkIdType, HashOfHash> Known;
  std::vector<Source> Sources; ///< of a mean
  std::vector<std::pair<std::array<double, 3>, Source>> Sorted;
};

} // namespace banyan

#endif
