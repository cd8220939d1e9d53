// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_SetNumber_h
#define banyan_Readers_SetNumber_h

#include "vtkObject.h"

#include "Base/PropertyNumber.h"

#include <algorithm>

/// Defines a setter of a double that is kept within limits. NaN, infinities and negative numbers
/// are refused with an error message; the property stays as it was.
#define banyanSetNumberMacro(Class, Property, least, most)                                         \
  void Class::Set##Property(double number)                                                         \
  {                                                                                                \
    const std::string problem = banyan::ProblemOfNumber(#Property, number);                        \
    if (!problem.empty())                                                                          \
    {                                                                                              \
      vtkErrorMacro(<< problem << ". It stays " << this->Property << ".");                         \
      return;                                                                                      \
    }                                                                                              \
    number = std::min(std::max<double>(number, least), static_cast<double>(most));                 \
    if (this->Property != number)                                                                  \
    {                                                                                              \
      this->Property = number;                                                                     \
      this->Modified();                                                                            \
    }                                                                                              \
  }

#endif
