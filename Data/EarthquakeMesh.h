// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_EarthquakeMesh_h
#define banyan_Data_EarthquakeMesh_h

#include "NorthridgeModel.h"
#include "OctreeMesh.h"

#include <cstddef>

namespace banyan
{

/// Meshes of the ground of a `NorthridgeModel` whose cells are as wide as the waves allow.
struct EarthquakeMesh
{
  /// Cells per wavelength of S waves at the frequency that the mesh is made for; at that of the
  /// strongest motion there are twice as many, or more.
  static constexpr double CellsPerWave = 4.0;

  /// Cells are at most 1 / CellsPerWave of the local wavelength wide.
  static OctreeMesh ForFrequency(const NorthridgeModel& ground, double hertz, ThreadPool& pool);

  /// The frequency whose mesh has about so many cells. Widths are powers of two, so that numbers of
  /// cells grow with frequency in steps: what is found is within 30 % of what is wanted.
  /// @param cells 1000 to 2e8
  static double FrequencyForCells(const NorthridgeModel& ground, double cells, ThreadPool& pool);

  /// Half duration of a Gaussian rate of moment whose spectrum has fallen to a tenth at a
  /// frequency.
  static double HalfDuration(double hertz);
  /// The frequency at which far from such a source the ground moves fastest.
  static double StrongestHertz(double halfDuration);
};

} // namespace banyan

#endif
