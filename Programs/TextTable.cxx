// SPDX-License-Identifier: BSD-3-Clause
#include "TextTable.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace banyan
{
namespace
{

std::string Formatted(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

/// Characters, not bytes: names may hold any letters (UTF-8).
std::size_t WidthOf(const std::string& text)
{
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(),
    [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

} // namespace

TextTable::TextTable(std::vector<std::string> headings)
{
  this->Rows.push_back(std::move(headings));
}

void TextTable::AddRow(std::vector<std::string> cells)
{
  this->Rows.push_back(std::move(cells));
}

std::string TextTable::Text() const
{
  std::vector<std::size_t> widths(this->Rows[0].size(), 0);
  for (const std::vector<std::string>& row : this->Rows)
  {
    for (std::size_t c = 0; c < widths.size(); ++c)
    {
      widths[c] = std::max(widths[c], WidthOf(row[c]));
    }
  }
  std::string text;
  for (const std::vector<std::string>& row : this->Rows)
  {
    std::string line = "  ";
    for (std::size_t c = 0; c < widths.size(); ++c)
    {
      const std::string blanks(widths[c] - WidthOf(row[c]), ' ');
      line += c == 0 ? row[c] + blanks : "  " + blanks + row[c];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string Digits(const std::optional<double>& value)
{
  return value ? Formatted("%.4g", *value) : "-";
}

std::string Percent(double share)
{
  return Formatted("%.1f %%", 100.0 * share);
}

std::string Megabytes(std::uint64_t bytes)
{
  const double number = static_cast<double>(bytes);
  return bytes < 1000      ? std::to_string(bytes) + " bytes"
         : bytes < 1000000 ? Formatted("%.2f kB", number / 1e3)
                           : Formatted("%.2f MB", number / 1e6);
}

} // namespace banyan
