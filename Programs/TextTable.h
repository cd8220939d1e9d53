// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_TextTable_h
#define banyan_Programs_TextTable_h

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace banyan
{

/// Lines of text in columns: the first to the left, the others to the right.
class TextTable
{
public:
  explicit TextTable(std::vector<std::string> headings);

  /// Adds a row of as many cells as there are headings.
  void AddRow(std::vector<std::string> cells);
  /// Each line indented by two blanks and ended by a newline.
  std::string Text() const;

private:
  std::vector<std::vector<std::string>> Rows;
};

/// Four significant digits; "-" for nothing.
std::string Digits(const std::optional<double>& value);
std::string Percent(double share);          ///< "12.3 %"
std::string Megabytes(std::uint64_t bytes); ///< "1.23 MB" (a million), or bytes or kB where small

} // namespace banyan

#endif
