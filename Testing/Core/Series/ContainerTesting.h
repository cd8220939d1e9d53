// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_ContainerTesting_h
#define banyan_Testing_ContainerTesting_h

#include "Series/SeriesTesting.h"

#include "Base/Error.h"

/// A small series, and errors that must name something.
namespace banyan::testing
{

inline const Grid Small = GridOf(33, 20, 18);

inline Steps<float> SmallSteps(int count, double shift = 0)
{
  return Sample<float>(
    Small, count, [shift](int x, int y, int z, int s) { return shift + Wavy<float>(x, y, z, s); });
}

inline EncodeOptions TwoPerSegment()
{
  EncodeOptions options;
  options.KeyframeInterval = 2;
  return options;
}

template <class Body>
void ExpectError(Body&& body, const std::string& word)
{
  try
  {
    body();
    ADD_FAILURE() << "no error about: " << word;
  }
  catch (const Error& failure)
  {
    EXPECT_NE(std::string(failure.what()).find(word), std::string::npos) << failure.what();
  }
}

} // namespace banyan::testing

#endif
