// SPDX-License-Identifier: BSD-3-Clause
#include "Base/BackgroundTask.h"

#include "Base/ThreadPool.h"

#include <atomic>
#include <string>
#include <utility>

namespace banyan
{

struct BackgroundTask::Shared
{
  StopFlag Flag;
  std::exception_ptr Failure;
  std::atomic<bool> Ended{ false };
};

void BackgroundTask::Start(Task task)
{
  this->Stop();
  const auto now = std::make_shared<Shared>();
  const auto run = [now, work = std::move(task)]
  {
    ThreadPool::LowerPriority();
    try
    {
      work(now->Flag);
    }
    catch (...)
    {
      now->Failure = std::current_exception();
    }
    now->Ended = true;
  };
  try
  {
    this->Thread = std::thread(run);
  }
  catch (const std::exception& error)
  {
    throw Error(std::string("No thread could be started (") + error.what() + ").");
  }
  this->Now = now;
}

bool BackgroundTask::HasEnded() const
{
  return this->Now && this->Now->Ended;
}

void BackgroundTask::Stop()
{
  if (this->Now)
  {
    this->Now->Flag.Ask();
  }
  this->Finish();
  this->Now.reset();
}

void BackgroundTask::Finish()
{
  if (this->Thread.joinable())
  {
    this->Thread.join();
  }
}

void BackgroundTask::Wait()
{
  this->Finish();
  const std::shared_ptr<Shared> now = std::exchange(this->Now, nullptr);
  if (now && now->Failure)
  {
    std::rethrow_exception(now->Failure);
  }
}

} // namespace banyan
