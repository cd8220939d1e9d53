// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_StaggeredBox_h
#define banyan_Data_StaggeredBox_h

#include "BoxPoisson.h"

#include <array>
#include <cstddef>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Velocity and a scalar in a closed cube of N^3 cells with no-slip walls, as Harlow and Welch
/// place them: the scalar at the centres of cells, velocity component c at the centres of the faces
/// on the low side along axis c. Component c of cell 0 lies in the wall and is zero; the high wall
/// is component c of cell N, among the ghosts.
///
/// Arrays are `[z][y][x]`, x fastest, with two layers of ghost cells on each side.
class StaggeredBox
{
public:
  /// @param size N, at least 4
  explicit StaggeredBox(int size);

  int Size() const { return this->N; }
  /// Place of a cell in the arrays; each coordinate in [-2, N + 2).
  std::size_t Index(int x, int y, int z) const
  {
    return (static_cast<std::size_t>(z + 2) * this->Row + (y + 2)) * this->Row + (x + 2);
  }
  /// Distance between neighbours along each axis.
  const std::array<std::ptrdiff_t, 3>& Strides() const { return this->Stride; }
  /// Values in a plane of constant z, ghosts included; plane z starts at Index(-2, -2, z).
  std::size_t PlaneCount() const { return this->Row * this->Row; }

  /// Components 0 to 2, and 3 for the scalar.
  std::vector<float>& operator[](int array) { return this->Arrays[array]; }
  const std::vector<float>& operator[](int array) const { return this->Arrays[array]; }
  /// The N^3 values of cells without ghosts, `[z][y][x]`.
  std::vector<float> Inner(int array) const;

  /// Sets the ghosts next to the cells: velocity that vanishes on the walls; a scalar that is `low`
  /// on the wall x = 0, `high` on the wall opposite, and has no gradient on the other four.
  void FillGhosts(float low, float high, ThreadPool& pool);

  /// Takes the gradient part away from the velocity: what is left has no divergence, up to some
  /// roundings of the largest velocity, and the walls' faces are as they were.
  void Project(ThreadPool& pool);

  /// The largest |outflow - inflow| of a cell: divergence times the cell's width.
  double LargestDivergence() const;

private:
  void FillVelocityGhosts(int component);
  void FillScalarGhosts(float low, float high);

  int N;
  std::size_t Row;
  std::array<std::ptrdiff_t, 3> Stride;
  std::array<std::vector<float>, 4> Arrays;
  BoxPoisson Poisson;
  std::vector<float> Pressure; ///< N^3: divergence, then the potential of the gradient part
};

} // namespace banyan

#endif
