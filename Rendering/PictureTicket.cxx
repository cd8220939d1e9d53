// SPDX-License-Identifier: BSD-3-Clause
#include "PictureTicket.h"

#include <algorithm>

namespace banyan
{

namespace
{

constexpr std::size_t OfMatrix = PictureTicket::Numbers - 16; ///< its first number

} // namespace

std::array<double, PictureTicket::Numbers> PictureTicket::ToNumbers() const
{
  std::array<double, Numbers> numbers{ { double(this->Number), double(this->Display),
    double(this->Scene), this->Moves ? 1.0 : 0.0, double(this->CoarseEvery), double(this->Credit),
    double(this->Shown), double(this->Volumes), double(this->View.Size.x),
    double(this->View.Size.y), this->View.Far, double(this->Others),
    double(this->Depths.size()) } };
  for (std::size_t i = 0; i < 16; ++i)
  {
    numbers[OfMatrix + i] = this->View.WorldToClip[int(i / 4)][int(i % 4)];
  }
  return numbers;
}

std::vector<unsigned int> PictureTicket::DepthWords() const
{
  std::vector<unsigned int> words(1 + this->Depths.size() / sizeof(unsigned int));
  std::copy(
    this->Depths.begin(), this->Depths.end(), reinterpret_cast<std::uint8_t*>(words.data()));
  return words;
}

PictureTicket PictureTicket::Of(
  const double numbers[Numbers], unsigned int words, const unsigned int* depths)
{
  const auto whole = [numbers](int i) { return static_cast<int>(numbers[i]); };
  PictureTicket ticket{ whole(0), whole(1), whole(2), numbers[3] != 0.0, whole(4), whole(5),
    whole(6), whole(7), {}, static_cast<Geometries>(whole(11)), {} };
  ticket.View.Size = { whole(8), whole(9) };
  ticket.View.Far = numbers[10];
  for (std::size_t i = 0; i < 16; ++i)
  {
    ticket.View.WorldToClip[int(i / 4)][int(i % 4)] = numbers[OfMatrix + i];
  }
  const auto bytes = std::min(static_cast<std::size_t>(numbers[12]), words * sizeof(*depths));
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(depths);
  ticket.Depths.assign(begin, begin + bytes);
  return ticket;
}

} // namespace banyan
