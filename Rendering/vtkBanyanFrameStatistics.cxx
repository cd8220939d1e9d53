// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanFrameStatistics.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkBanyanFrameStatistics);

void vtkBanyanFrameStatistics::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TotalSeconds: " << this->TotalSeconds << "\n"
     << indent << "RenderSeconds: " << this->RenderSeconds << "\n"
     << indent << "CompositeSeconds: " << this->CompositeSeconds << "\n"
     << indent << "PilotSeconds: " << this->PilotSeconds << "\n"
     << indent << "StrideSeconds: " << this->StrideSeconds << "\n"
     << indent << "Pilots: " << this->Pilots << "\n"
     << indent << "Imbalance: " << this->Imbalance << "\n"
     << indent << "SamplesTaken: " << this->SamplesTaken << "\n"
     << indent << "BricksDrawn: " << this->BricksDrawn << "\n"
     << indent << "BricksUniform: " << this->BricksUniform << "\n"
     << indent << "BricksSkipped: " << this->BricksSkipped << "\n"
     << indent << "BytesComposited: " << this->BytesComposited << "\n"
     << indent << "MessagesComposited: " << this->MessagesComposited << "\n"
     << indent << "BytesRead: " << this->BytesRead << "\n"
     << indent << "CacheBytes: " << this->CacheBytes << "\n"
     << indent << "PixelsReadBehind: " << this->PixelsReadBehind << "\n"
     << indent << "MeshBytes: " << this->MeshBytes << "\n"
     << indent << "MeshBytesShared: " << this->MeshBytesShared << "\n"
     << indent << "BytesMoved: " << this->BytesMoved << "\n"
     << indent << "CacheHitsAhead: " << this->CacheHitsAhead << "\n"
     << indent << "CacheHits: " << this->CacheHits << "\n"
     << indent << "CacheMisses: " << this->CacheMisses << "\n"
     << indent << "EstimatedImageError: " << this->EstimatedImageError << "\n"
     << indent << "ImageErrorLimit: " << this->ImageErrorLimit << "\n"
     << indent << "EncodingErrorOfValues: " << this->EncodingErrorOfValues << "\n"
     << indent << "MeshDeviation: " << this->MeshDeviation << "\n"
     << indent << "Frames: " << this->Frames << "\n";
}
