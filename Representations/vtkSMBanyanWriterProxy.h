// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMBanyanWriterProxy
 * @brief   the proxy of a writer whose failure raises an exception in Python
 *
 * SaveData() raises RuntimeError with the writer's own sentence, so that a script that does not
 * catch it ends with an exit code other than 0. The writer says it in its information property
 * ErrorMessage.
 */
#ifndef vtkSMBanyanWriterProxy_h
#define vtkSMBanyanWriterProxy_h

#include "BanyanRepresentationsModule.h" // For export macro
#include "vtkSMPWriterProxy.h"

class BANYANREPRESENTATIONS_EXPORT vtkSMBanyanWriterProxy : public vtkSMPWriterProxy
{
public:
  static vtkSMBanyanWriterProxy* New();
  vtkTypeMacro(vtkSMBanyanWriterProxy, vtkSMPWriterProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void UpdatePipeline() override;
  void UpdatePipeline(double time) override;

protected:
  vtkSMBanyanWriterProxy() = default;
  ~vtkSMBanyanWriterProxy() override = default;

private:
  vtkSMBanyanWriterProxy(const vtkSMBanyanWriterProxy&) = delete;
  void operator=(const vtkSMBanyanWriterProxy&) = delete;
};

#endif
