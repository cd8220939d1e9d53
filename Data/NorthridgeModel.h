// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_NorthridgeModel_h
#define banyan_Data_NorthridgeModel_h

#include "HexWaveSimulation.h"

#include <array>
#include <cstdint>
#include <vector>

namespace banyan
{

/// A block of ground, 80 km x 80 km and 30 km deep, with the proportions of the region of Los
/// Angeles, and below it an earthquake like that of Northridge, 1994: two basins of sediments, a
/// valley above the fault and a larger and deeper basin to its south-east, in rock whose speeds
/// grow with depth. In metres: x to the east, y to the north, z up, the surface at z = 0.
///
/// Not a map: the basins are bowls with wavy floors, which the seed decides, and so it does the
/// distribution of slip on the fault.
class NorthridgeModel
{
public:
  static constexpr double RootMetres = 10000.0;
  static constexpr std::array<int, 3> Roots = { 8, 8, 3 };
  static constexpr double DepthMetres = 30000.0;

  /// @param slowest speed of S waves in the sediments at the surface, m/s, 100 to 1500
  /// Throws Error when it is not.
  NorthridgeModel(std::uint64_t seed, double slowest);

  ElasticMaterial At(const std::array<double, 3>& point) const;

  /// About the slowest speed of S waves in a box: they grow with depth, so that a few places on its
  /// top are looked at.
  double SlowestIn(const std::array<double, 3>& low, double edge) const;

  /// Rate at which amplitudes decay in a material at a frequency, 1/s: quality factors are 50 times
  /// the speed of S waves in km/s, as is usual for such basins.
  static double DecayRate(const ElasticMaterial& material, double hertz);

  /// A fault 18 km long and 21 km wide, 5 km below the surface, with strike 122, dip 40 and rake
  /// 101 degrees; magnitude 6.7. It breaks from its deep south-eastern part on at 2.8 km/s.
  /// @param halfDuration of the slip at each place, s
  std::vector<MomentPoint> Fault(double halfDuration) const;

private:
  struct Wave
  {
    double KX, KY, Phase;
  };
  /// Metres from the surface to the floor of the sediments; at most 0 outside the basins.
  double Floor(double x, double y) const;

  double Slowest;
  std::array<Wave, 8> Waves;     ///< of the floor
  std::array<Wave, 4> SlipWaves; ///< along strike and dip
};

} // namespace banyan

#endif
