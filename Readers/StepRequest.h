// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_StepRequest_h
#define banyan_Readers_StepRequest_h

#include <functional>
#include <memory>

namespace banyan
{

class SeriesFile;
struct ArrayIndex;

/// A step of a series, or a time between two, as somebody asks for it.
struct StepRequest
{
  std::shared_ptr<const SeriesFile> Series;
  int Step = 0;
  double Fraction = 0.0; ///< see StepAndFraction
  double Time = 0.0;     ///< of the output
  int Level = 0;
  int Piece = 0;  ///< of meshes
  int Pieces = 1; ///< of meshes
  std::function<bool(const ArrayIndex&)> Wants;
  std::function<void(double)> Progress; ///< is told values in [0, 1]
};

} // namespace banyan

#endif
