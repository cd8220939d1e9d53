// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBanyanTemporalEnhancement
 * @brief   brings out what moves in a time series, at all scales
 *
 * Adds the array `name_enhanced` to the points or cells of image data, unstructured grids, any
 * other data set or blocks of them, AMR, and to the cells of hyper trees: each value is mixed with
 * how much it changes from step to step in proportion to itself (banyan::TemporalEnhancement has
 * the formula). So waves stay visible over the whole period although they become weaker by decades,
 * as in an earthquake. The array itself passes unchanged: colour by the one or the other to switch
 * enhancement on and off. Vectors keep their direction; their length is enhanced.
 *
 * At each step the previous and the next one are read too. Steps that were read are kept (by
 * reference), so that playing reads each step once.
 *
 * @par Exactness:
 * Computed in double precision and rounded to float32, or kept in float64 where the array is.
 *
 * @par Limits:
 * Points, cells, trees and blocks must be the same at the three steps; where they are not (or the
 * array is missing in one) that is an error. At the first and last step the neighbour that there is
 * counts alone; without any, as in data without time, values pass unchanged.
 *
 * @par Source: section 5 of "Visualizing Very Large-Scale Earthquake Simulations".
 */
#ifndef vtkBanyanTemporalEnhancement_h
#define vtkBanyanTemporalEnhancement_h

#include "BanyanFiltersModule.h" // For export macro
#include "vtkPassInputTypeAlgorithm.h"
#include "vtkSmartPointer.h" // For members

#include "StepWindow.h"

#include <map>

class vtkCompositeDataIterator;
class vtkDataArray;
class vtkDataObject;
class vtkDataSetAttributes;

namespace banyan
{
struct TemporalEnhancement;
}

class BANYANFILTERS_EXPORT vtkBanyanTemporalEnhancement : public vtkPassInputTypeAlgorithm
{
public:
  static vtkBanyanTemporalEnhancement* New();
  vtkTypeMacro(vtkBanyanTemporalEnhancement, vtkPassInputTypeAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Steps
  {
    PREVIOUS = 1,
    NEXT = 2,
    BOTH = 3
  };

  ///@{
  /** Which neighbours in time are compared with. Default BOTH. */
  vtkSetClampMacro(CompareWith, int, PREVIOUS, BOTH);
  vtkGetMacro(CompareWith, int);
  ///@}

  ///@{
  /**
   * How many steps away these are, at least 1 (the default): more, where steps are so close that
   * hardly anything moves between two of them.
   */
  vtkSetClampMacro(StepDistance, int, 1, VTK_INT_MAX);
  vtkGetMacro(StepDistance, int);
  ///@}

  ///@{
  /** 0 changes nothing, 1 leaves the relative change only. In [0, 1]; default 0.5. */
  virtual void SetStrength(double number);
  vtkGetMacro(Strength, double);
  ///@}

  ///@{
  /**
   * A change from step to step by 1 / Sensitivity of the value counts as full motion: more, where
   * steps are close. Positive; default 4, for waves of up to 8 steps per period.
   */
  virtual void SetSensitivity(double number);
  vtkGetMacro(Sensitivity, double);
  ///@}

  ///@{
  /**
   * A large magnitude, in units of the array, that stays about where it is. 0 (the default) takes
   * the largest of the whole series where the array knows it, as those of a Banyan series do, and 1
   * otherwise.
   */
  virtual void SetScale(double number);
  vtkGetMacro(Scale, double);
  ///@}

  ///@{
  /**
   * Motion of values well below it, in units of the array, is not brought out. 0 (the default)
   * takes the error bound of the array if it is a Banyan series', and nothing otherwise.
   */
  virtual void SetNoiseFloor(double number);
  vtkGetMacro(NoiseFloor, double);
  ///@}

protected:
  vtkBanyanTemporalEnhancement();
  ~vtkBanyanTemporalEnhancement() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  using PlainArrays = std::map<vtkSmartPointer<vtkDataArray>, vtkSmartPointer<vtkDataArray>>;

  void EnhanceAll(vtkDataObject* output);
  bool Enhance(vtkDataObject* data, vtkCompositeDataIterator* place, PlainArrays& plain);
  vtkDataArray* PlainOf(vtkDataArray* array, const PlainArrays& before);
  banyan::TemporalEnhancement HowFor(vtkDataArray* array) const;

  int CompareWith = BOTH;
  int StepDistance = 1;
  double Strength = 0.5;
  double Sensitivity = 4.0;
  double Scale = 0.0;
  double NoiseFloor = 0.0;
  banyan::StepWindow Window;
  PlainArrays Decoded; ///< of arrays that decode on first touch, as long as their step is kept

  vtkBanyanTemporalEnhancement(const vtkBanyanTemporalEnhancement&) = delete;
  void operator=(const vtkBanyanTemporalEnhancement&) = delete;
};

#endif
