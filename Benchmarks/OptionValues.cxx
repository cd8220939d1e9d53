// SPDX-License-Identifier: BSD-3-Clause
#include "OptionValues.h"

#include "Base/Error.h"

#include <sstream>

namespace banyan::bench
{

const std::string& ValueBehind(const std::vector<std::string>& arguments, std::size_t& i)
{
  if (i + 1 == arguments.size())
  {
    throw Error(arguments[i] + " needs a value.");
  }
  return arguments[++i];
}

std::vector<std::string> SplitAtCommas(const std::string& text)
{
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');)
  {
    parts.push_back(part);
  }
  return parts;
}

double NumberIn(const std::string& option, const std::string& text, double low, double high)
{
  std::size_t end = 0;
  double number = 0.0;
  try
  {
    number = std::stod(text, &end);
  }
  catch (const std::exception&)
  {
    end = std::string::npos;
  }
  if (end != text.size() || !(number >= low && number <= high))
  {
    std::ostringstream sentence;
    sentence.precision(10);
    sentence << option << " needs a number from " << low << " to " << high << ", not '" << text
             << "'.";
    throw Error(sentence.str());
  }
  return number;
}

int CountIn(const std::string& option, const std::string& text, int low, int high)
{
  const double number = NumberIn(option, text, low, high);
  if (number != static_cast<int>(number))
  {
    throw Error(option + " needs a whole number, not '" + text + "'.");
  }
  return static_cast<int>(number);
}

} // namespace banyan::bench
