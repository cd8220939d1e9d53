// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMBanyanSourceProxy
 * @brief   the proxy of a reader whose failure raises an exception in Python
 *
 * OpenDataFile(), UpdatePipeline() and Show() raise RuntimeError with the reader's own sentence,
 * which it says in its information property ErrorMessage.
 *
 * @par Limits:
 * Updates that come from a filter or a view print the error and raise nothing.
 */
#ifndef vtkSMBanyanSourceProxy_h
#define vtkSMBanyanSourceProxy_h

#include "BanyanRepresentationsModule.h" // For export macro
#include "vtkSMSourceProxy.h"

class BANYANREPRESENTATIONS_EXPORT vtkSMBanyanSourceProxy : public vtkSMSourceProxy
{
public:
  static vtkSMBanyanSourceProxy* New();
  vtkTypeMacro(vtkSMBanyanSourceProxy, vtkSMSourceProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void UpdatePipelineInformation() override;
  void UpdatePipeline() override;
  void UpdatePipeline(double time) override;

protected:
  vtkSMBanyanSourceProxy() = default;
  ~vtkSMBanyanSourceProxy() override = default;

private:
  vtkSMBanyanSourceProxy(const vtkSMBanyanSourceProxy&) = delete;
  void operator=(const vtkSMBanyanSourceProxy&) = delete;
};

#endif
