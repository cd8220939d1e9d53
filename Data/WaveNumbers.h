// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_WaveNumbers_h
#define banyan_Data_WaveNumbers_h

#include <cstddef>
#include <cstdlib>

namespace banyan
{

/// Wave numbers of a grid. A mode is carried when each of its wave numbers is below N/3, so that
/// products of two carried modes alias onto modes that are not (the two-thirds rule).
struct WaveNumbers
{
  int N;

  int Signed(int index) const { return index <= this->N / 2 ? index : index - this->N; }
  bool Carried(int k) const { return 3 * std::abs(k) < this->N; }
  int CarriedCount() const { return (this->N + 2) / 3; }

  /// Calls body(mode index, kx, ky, kz) for each stored coefficient with the given kz index that
  /// is carried.
  template <typename Body>
  void ForCarried(int zIndex, const Body& body) const
  {
    const int kz = this->Signed(zIndex);
    if (!this->Carried(kz))
    {
      return;
    }
    for (int y = 0; y < this->N; ++y)
    {
      const int ky = this->Signed(y);
      if (!this->Carried(ky))
      {
        continue;
      }
      const std::size_t row = (static_cast<std::size_t>(zIndex) * this->N + y) *
                              static_cast<std::size_t>(this->N / 2 + 1);
      for (int kx = 0; kx < this->CarriedCount(); ++kx)
      {
        body(row + kx, static_cast<float>(kx), static_cast<float>(ky), static_cast<float>(kz));
      }
    }
  }
};

} // namespace banyan

#endif
