// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_BasinModel_h
#define banyan_Data_BasinModel_h

#include "ElasticWaveSimulation.h"

#include <array>
#include <cstdint>

namespace banyan
{

/// A block of ground, 12.8 km wide and deep: rock in two layers, and in it a bowl of soft sediments
/// in two layers, with slightly wavy borders. Below the bowl lies a point source, a shear crack
/// (double couple). The seed decides the place and shape of the bowl, the waves on its borders, and
/// the place and direction of the source.
class BasinModel
{
public:
  static constexpr double EdgeMetres = 12800.0;

  explicit BasinModel(std::uint64_t seed);

  /// @param x,y,depth position in metres in the block, depth below the surface
  ElasticMaterial At(double x, double y, double depth) const;

  /// The source for a grid of the given size. Its duration is as short as the grid can carry: waves
  /// of the highest frequency that matters are about four cells long in the softest sediments.
  MomentSource Source(int size) const;

private:
  double Ripple(int border, double x, double y) const;

  struct Wave
  {
    double KX, KY, Phase;
  };
  std::array<std::array<Wave, 6>, 3> Waves; ///< of the three borders
  std::array<double, 2> Centre, Radius;
  double Depth;
  std::array<double, 3> SourcePlace; ///< x, y, depth in metres
  std::array<double, 6> Moment;
};

} // namespace banyan

#endif
