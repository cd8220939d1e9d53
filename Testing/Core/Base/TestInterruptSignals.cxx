// SPDX-License-Identifier: BSD-3-Clause
#include "Base/InterruptSignals.h"

#include <gtest/gtest.h>

#include <csignal>
#include <functional>

#include <sys/wait.h>
#include <unistd.h>

namespace
{

using banyan::InterruptSignals;

/// How a process of its own ended, as waitpid says; 0 when `body` returned true.
int InChild(const std::function<bool()>& body)
{
  const pid_t child = fork();
  if (child == 0)
  {
    _exit(body() ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(InterruptSignals, AreNotedAndThenPutBack)
{
  for (const int number : { SIGINT, SIGTERM })
  {
    const int status = InChild(
      [number]
      {
        {
          const InterruptSignals signals;
          const InterruptSignals inner;
          if (InterruptSignals::Came())
          {
            _exit(2);
          }
          (void)raise(number);
          if (!InterruptSignals::Came())
          {
            _exit(3);
          }
        }
        if (InterruptSignals::Last() != number)
        {
          _exit(4);
        }
        (void)raise(number);
        return false;
      });
    EXPECT_TRUE(WIFSIGNALED(status)) << WEXITSTATUS(status);
    EXPECT_EQ(WTERMSIG(status), number);
  }
}

TEST(InterruptSignals, TheSecondEndsTheProcess)
{
  const int status = InChild(
    []
    {
      const InterruptSignals signals;
      (void)raise(SIGINT);
      (void)raise(SIGINT);
      return true;
    });
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGINT);
}

TEST(InterruptSignals, WhatIsIgnoredStaysIgnoredAndHandlersComeBack)
{
  static volatile std::sig_atomic_t calls = 0;
  EXPECT_EQ(InChild(
              []
              {
                (void)std::signal(SIGINT, SIG_IGN);
                (void)std::signal(SIGTERM, [](int) { calls = calls + 1; });
                {
                  const InterruptSignals signals;
                  (void)raise(SIGINT);
                  if (InterruptSignals::Came())
                  {
                    return false;
                  }
                  (void)raise(SIGTERM);
                  if (!InterruptSignals::Came() || calls != 0)
                  {
                    return false;
                  }
                }
                (void)raise(SIGINT);
                (void)raise(SIGTERM);
                return calls == 1;
              }),
    0);
}

TEST(InterruptSignals, AreForgottenByTheNext)
{
  EXPECT_EQ(InChild(
              []
              {
                {
                  const InterruptSignals signals;
                  (void)raise(SIGTERM);
                }
                const InterruptSignals next;
                return !InterruptSignals::Came();
              }),
    0);
}

} // namespace
