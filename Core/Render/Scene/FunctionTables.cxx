// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/FunctionTables.h"

#include <algorithm>
#include <cstring>

namespace banyan
{
namespace
{

/// Bit for bit, so that what is not a number is the same as itself.
bool AreSame(const TransferFunction& a, const TransferFunction& b)
{
  const double first[3] = { a.Low, a.High, a.UnitDistance };
  const double second[3] = { b.Low, b.High, b.UnitDistance };
  return std::memcmp(first, second, sizeof(first)) == 0 && a.Entries.size() == b.Entries.size() &&
         a.Edges == b.Edges &&
         (a.Entries.empty() || std::memcmp(a.Entries.data(), b.Entries.data(),
                                 a.Entries.size() * sizeof(a.Entries[0])) == 0);
}

} // namespace

FunctionTables& FunctionTables::Process()
{
  static FunctionTables tables;
  return tables;
}

std::shared_ptr<const StepTable> FunctionTables::StepsOf(
  const TransferFunction& function, double sampleDistance)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  std::list<Tables>& known = this->ItemOf(function).Steps;
  const auto found = std::find_if(known.begin(), known.end(),
    [&](const Tables& tables) { return tables.Distance == sampleDistance; });
  if (found != known.end())
  {
    known.splice(known.begin(), known, found);
  }
  else
  {
    known.push_front(
      { sampleDistance, std::make_shared<const StepTable>(function, sampleDistance) });
  }
  std::shared_ptr<const StepTable> steps = known.front().Steps;
  this->LetGo();
  return steps;
}

std::shared_ptr<const VisibleValues> FunctionTables::VisibleOf(const TransferFunction& function)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return this->ItemOf(function).Visible;
}

/// Brings a function to the front, with what can be seen of it.
FunctionTables::Item& FunctionTables::ItemOf(const TransferFunction& function)
{
  const auto found = std::find_if(this->Items.begin(), this->Items.end(),
    [&](const Item& item) { return AreSame(item.Function, function); });
  if (found != this->Items.end())
  {
    this->Items.splice(this->Items.begin(), this->Items, found);
  }
  else
  {
    this->Items.push_front({ function, std::make_shared<const VisibleValues>(function), {} });
  }
  if (this->Items.size() > MostFunctions)
  {
    this->Items.pop_back();
  }
  return this->Items.front();
}

void FunctionTables::LetGo()
{
  std::size_t count = 0;
  for (Item& item : this->Items)
  {
    const std::size_t left = MostTables - std::min(MostTables, count);
    while (item.Steps.size() > left)
    {
      item.Steps.pop_back();
    }
    count += item.Steps.size();
  }
}

} // namespace banyan
