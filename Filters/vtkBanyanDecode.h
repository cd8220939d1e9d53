// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBanyanDecode
 * @brief   replaces point arrays that decode on first touch by plain, decoded ones
 *
 * The reader gives plain arrays to filters that are connected to it. This filter makes them where
 * the data come another way, or where the series behind them is to be forgotten. Everything else
 * passes unchanged; arrays that are plain and know of no series are passed by reference.
 *
 * @par Exactness:
 * The values are bit-exact those of the deferred array. Ranges become those of the values: the
 * finite range of a plain array is that of its step, not of the series.
 */
#ifndef vtkBanyanDecode_h
#define vtkBanyanDecode_h

#include "BanyanFiltersModule.h" // For export macro
#include "vtkPassInputTypeAlgorithm.h"

class BANYANFILTERS_EXPORT vtkBanyanDecode : public vtkPassInputTypeAlgorithm
{
public:
  static vtkBanyanDecode* New();
  vtkTypeMacro(vtkBanyanDecode, vtkPassInputTypeAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkBanyanDecode() = default;
  ~vtkBanyanDecode() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkBanyanDecode(const vtkBanyanDecode&) = delete;
  void operator=(const vtkBanyanDecode&) = delete;
};

#endif
