// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/BackgroundEncoder.h"

#include "Base/Error.h"

#include <system_error>

namespace banyan
{

BackgroundEncoder::BackgroundEncoder(
  SeriesIndex plan, const EncodeOptions& options, SegmentFolder& folder, int threads)
  : Plan(std::move(plan))
  , Options(options)
  , Folder(folder)
  , Pool(threads)
{
}

BackgroundEncoder::~BackgroundEncoder()
{
  this->Interrupt();
  if (this->Worker.joinable())
  {
    this->Worker.join();
  }
}

void BackgroundEncoder::Start(int number, std::vector<double> times,
  std::vector<std::vector<ArrayValues>> steps, std::vector<ArrayValues> before)
{
  if (this->Worker.joinable())
  {
    this->Worker.join();
  }
  this->Done = 0.0;
  this->Working = true;
  try
  {
    this->Worker = std::thread(
      [this, number, times = std::move(times), steps = std::move(steps), before = std::move(before)]
      { this->Encode(number, times, steps, before); });
  }
  catch (const std::system_error& error)
  {
    this->Working = false;
    throw Error(std::string("No thread can be started to encode: ") + error.what());
  }
}

void BackgroundEncoder::Encode(int number, const std::vector<double>& times,
  const std::vector<std::vector<ArrayValues>>& steps,
  const std::vector<ArrayValues>& before) noexcept
{
  std::optional<std::pair<int, EncodedGroup>> result;
  std::exception_ptr failure;
  try
  {
    const auto tell = [this](double share)
    {
      this->Done = share;
      return !this->Interrupted;
    };
    // Who brings the step before now will do so again: nothing needs to be kept.
    LastStep* last = before.empty() ? &this->Last : nullptr;
    if (last == nullptr)
    {
      this->Last = {};
    }
    result.emplace(number, EncodeGroup(this->Plan, this->Options, this->Folder,
                             { number, times, steps, before }, last, this->Pool, tell));
  }
  catch (...)
  {
    failure = std::current_exception();
  }
  const std::lock_guard<std::mutex> lock(this->Mutex);
  this->Result = std::move(result);
  this->Failure = failure;
  this->Working = false;
  this->Ended.notify_all();
}

bool BackgroundEncoder::Busy() const
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return this->Working;
}

void BackgroundEncoder::Wait(const std::function<void()>& tick)
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  while (
    !this->Ended.wait_for(lock, std::chrono::milliseconds(100), [this] { return !this->Working; }))
  {
    lock.unlock();
    tick();
    lock.lock();
  }
}

std::optional<std::pair<int, EncodedGroup>> BackgroundEncoder::Take()
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  if (this->Working)
  {
    return std::nullopt;
  }
  if (this->Failure)
  {
    std::rethrow_exception(std::exchange(this->Failure, nullptr));
  }
  return std::exchange(this->Result, std::nullopt);
}

} // namespace banyan
