// SPDX-License-Identifier: BSD-3-Clause
#include "SourceInspector.h"

#include "vtkDemandDrivenPipeline.h"
#include "vtkFileSeriesReader.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkXMLReader.h"

namespace
{

/// ParaView's reader of file series gives every file the extent of the first one, and fills what a
/// smaller file does not have with whatever is in memory.
class FileSeriesInspector : public banyan::SourceInspector
{
public:
  void Forget(vtkAlgorithm* source) const override
  {
    if (vtkFileSeriesReader::SafeDownCast(source))
    {
      source->Modified();
    }
  }

  vtkSmartPointer<vtkInformation> InformationOfFile(vtkAlgorithm* source) const override
  {
    auto* series = vtkFileSeriesReader::SafeDownCast(source);
    vtkAlgorithm* reader = series ? series->GetReader() : nullptr;
    if (!reader)
    {
      return nullptr;
    }
    // The file name of the reader within is that of the step that was read last.
    if (auto* xml = vtkXMLReader::SafeDownCast(reader))
    {
      // It tells the extent only to whoever makes it parse the file, which has happened: so
      // another one parses it again.
      const auto probe = vtkSmartPointer<vtkXMLReader>::Take(xml->NewInstance());
      probe->SetFileName(xml->GetFileName());
      probe->UpdateInformation();
      return probe->GetOutputInformation(0);
    }
    vtkNew<vtkInformation> request;
    request->Set(vtkDemandDrivenPipeline::REQUEST_INFORMATION());
    vtkNew<vtkInformationVector> outputs;
    outputs->SetNumberOfInformationObjects(reader->GetNumberOfOutputPorts());
    return reader->ProcessRequest(request, static_cast<vtkInformationVector**>(nullptr), outputs)
             ? outputs->GetInformationObject(0)
             : nullptr;
  }
};

/// Loading the plugin on the process that writes is all it takes.
const bool installed = []
{
  banyan::SourceInspector::Set(std::make_unique<FileSeriesInspector>());
  return true;
}();

} // namespace
