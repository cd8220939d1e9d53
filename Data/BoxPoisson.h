// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_BoxPoisson_h
#define banyan_Data_BoxPoisson_h

#include <memory>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Solves the discrete Poisson equation on N^3 cells of a closed box (no flow through the walls):
///
///   sum over the six neighbours inside the box of (p_neighbour - p) = right-hand side
///
/// that is, the cell width is taken as 1. Cosine transforms (FFTW) in x and y leave a tridiagonal
/// system along z for each pair of wave numbers; it is solved by elimination without pivoting,
/// which is stable because the systems are diagonally dominant. Single precision: the residual is
/// some rounding errors of p. Each transform and each elimination runs on one thread with an
/// estimated plan, so that the bits do not depend on the number of threads.
class BoxPoisson
{
public:
  /// @param size N, at least 2
  explicit BoxPoisson(int size);
  ~BoxPoisson();
  BoxPoisson(const BoxPoisson&) = delete;
  BoxPoisson& operator=(const BoxPoisson&) = delete;

  /// @param values `[z][y][x]`, x fastest, N^3: the right-hand side, replaced by the solution.
  ///   The mean of the right-hand side, which has no solution, is ignored; the solution is fixed
  ///   up to a constant, which is arbitrary.
  void Solve(std::vector<float>& values, ThreadPool& pool) const;

private:
  struct Plans;
  void SolveColumns(float* values, int y) const;

  std::unique_ptr<Plans> Self;
  int N;
  std::vector<float> Pivots; ///< `[z][y][x]`: reciprocal pivots of the eliminations
};

} // namespace banyan

#endif
