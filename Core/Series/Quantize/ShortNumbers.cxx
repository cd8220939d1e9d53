// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/ShortNumbers.h"

#include "Base/Error.h"

#include <charconv>

namespace banyan
{

std::string ShortNumbers(const std::vector<double>& numbers)
{
  std::string text;
  for (const double number : numbers)
  {
    char digits[32]; // -1.23e-308 is the longest
    const auto end =
      std::to_chars(digits, digits + sizeof(digits), number, std::chars_format::general, 3).ptr;
    text += (text.empty() ? "" : " ") + std::string(digits, end);
  }
  return text;
}

std::vector<double> FromShortNumbers(const std::string& text)
{
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end)
  {
    double number = 0;
    const auto read = std::from_chars(at, end, number);
    const bool last = read.ptr == end;
    if (read.ec != std::errc() || !(last || (*read.ptr == ' ' && read.ptr + 1 < end)))
    {
      throw Error("A list of numbers of the index is damaged");
    }
    numbers.push_back(number);
    at = last ? end : read.ptr + 1;
  }
  return numbers;
}

} // namespace banyan
