// SPDX-License-Identifier: BSD-3-Clause
#include "PythonErrors.h"

#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <cstddef>

#include <dlfcn.h>

namespace banyan
{
namespace
{

/// A function of Python's C interface, if this process has a Python. Looked up instead of linked,
/// so that the plugin loads into servers without Python as well.
template <class Function>
Function* Find(const char* name)
{
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

/// Whether this thread is inside of Python, and may call it.
bool IsInPython()
{
  const auto isInitialized = Find<int()>("Py_IsInitialized");
  const auto holdsLock = Find<int()>("PyGILState_Check");
  const auto frame = Find<void*()>("PyEval_GetFrame");
  return isInitialized && holdsLock && frame && isInitialized() && holdsLock() && frame();
}

} // namespace

void ForgetGarbageOfPython()
{
  const auto setInSystem = Find<int(const char*, void*)>("PySys_SetObject");
  const auto collect = Find<std::ptrdiff_t()>("PyGC_Collect");
  if (setInSystem && collect && IsInPython())
  {
    for (const char* name : { "last_traceback", "last_value", "last_type", "last_exc" })
    {
      (void)setInSystem(name, nullptr);
    }
    (void)collect();
  }
}

void RaiseInPython(const std::string& sentence)
{
  const auto setError = Find<void(void*, const char*)>("PyErr_SetString");
  void** runtimeError = reinterpret_cast<void**>(dlsym(RTLD_DEFAULT, "PyExc_RuntimeError"));
  if (setError && runtimeError && IsInPython())
  {
    // VTK's wrappers look for an error when the C++ method returns.
    setError(*runtimeError, sentence.c_str());
  }
}

void RaiseErrorOf(vtkSMProxy* proxy)
{
  vtkSMProperty* property = proxy->GetProperty("ErrorMessage");
  if (!property)
  {
    return;
  }
  proxy->UpdatePropertyInformation(property);
  const char* message = vtkSMPropertyHelper(property).GetAsString();
  if (message && *message)
  {
    RaiseInPython(message);
  }
}

} // namespace banyan
