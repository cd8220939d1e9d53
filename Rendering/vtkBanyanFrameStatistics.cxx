// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanFrameStatistics.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkBanyanFrameStatistics);

void vtkBanyanFrameStatistics::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
#define BANYAN_NUMBER(Type, Name, Initial, Where, Sentence)                                        \
  os << indent << #Name ": " << this->Name << "\n";
#define BANYAN_TEXT(Name, Where, Sentence) os << indent << #Name ": " << this->Name << "\n";
  BANYAN_FRAME_STATISTICS(BANYAN_NUMBER, BANYAN_TEXT)
#undef BANYAN_NUMBER
#undef BANYAN_TEXT
}
