#include "SourceInspector.h"

#include "vtkDemandDrivenPipeline.h"
#include "vtkFileSeriesReader.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
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

  bool ExtentInFile(vtkAlgorithm* source, banyan::Box& extent) const override
  {
    auto* series = vtkFileSeriesReader::SafeDownCast(source);
    vtkAlgorithm* reader = series ? series->GetReader() : nullptr;
    if (!reader)
    {
      return false;
    }
    // The file name of the reader within is that of the step that was read last.
    if (auto* xml = vtkXMLReader::SafeDownCast(reader))
    {
      // It tells the extent only to whoever makes it parse the file, which has happened: so
      // another one parses it again.
      const auto probe = vtkSmartPointer<vtkXMLReader>::Take(xml->NewInstance());
      probe->SetFileName(xml->GetFileName());
      probe->UpdateInformation();
      return ExtentOf(probe->GetOutputInformation(0), extent);
    }
    vtkNew<vtkInformation> request;
    request->Set(vtkDemandDrivenPipeline::REQUEST_INFORMATION());
    vtkNew<vtkInformationVector> outputs;
    outputs->SetNumberOfInformationObjects(reader->GetNumberOfOutputPorts());
    return reader->ProcessRequest(request, static_cast<vtkInformationVector**>(nullptr), outputs) &&
           ExtentOf(outputs->GetInformationObject(0), extent);
  }

private:
  static bool ExtentOf(vtkInformation* info, banyan::Box& extent)
  {
    if (!info->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
    {
      return false;
    }
    const int* e = info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT());
    extent = { { e[0], e[2], e[4] }, { e[1] + 1, e[3] + 1, e[5] + 1 } };
    return true;
  }
};

/// Loading the plugin on the process that writes is all it takes.
const bool installed = []
{
  banyan::SourceInspector::Set(std::make_unique<FileSeriesInspector>());
  return true;
}();

} // namespace
