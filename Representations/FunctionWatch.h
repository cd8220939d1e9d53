// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_FunctionWatch_h
#define banyan_Representations_FunctionWatch_h

#include "vtkWeakPointer.h"

#include <functional>

class vtkObject;

namespace banyan
{

/// Tells when a colour map or an opacity function changes, as when somebody drags a point of it.
class FunctionWatch
{
public:
  explicit FunctionWatch(std::function<void()> changed)
    : Changed(std::move(changed))
  {
  }
  ~FunctionWatch() { this->Watch(nullptr); }
  FunctionWatch(const FunctionWatch&) = delete;
  FunctionWatch& operator=(const FunctionWatch&) = delete;

  /// @param function in place of the last one; null for none
  void Watch(vtkObject* function);

private:
  void Tell() { this->Changed(); }

  std::function<void()> Changed;
  vtkWeakPointer<vtkObject> Function;
  unsigned long Observer = 0;
};

} // namespace banyan

#endif
