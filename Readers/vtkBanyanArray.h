// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBanyanArray
 * @brief   a point array of a Banyan series that decodes its piece when a value is first asked for
 *
 * Name, size and ranges are answered from the series' tree; the first access to a value decodes
 * the whole piece (through the brick cache, on all threads of the pool) into ordinary memory.
 * NewInstance() yields a plain array, so filters write plain arrays.
 *
 * @par Ranges:
 * - GetRange(): of this piece at this step. Contains the true range; exact when the piece consists
 *   of whole bricks, and always once the values have been decoded. Over the pieces of all ranks
 *   together it is exact. Infinities do not count before the values have been decoded. Between two
 *   steps it contains the true range until then.
 * - GetFiniteRange(range, component): of the whole *series*. ParaView asks it in
 *   vtkPVArrayInformation only (since 5.13 through the vtkFieldData), to choose colour ranges.
 *   They do not drift over time therefore. (In VTK 9.2, vtkVolumeTexture and
 *   vtkPVExtractHistogram2D ask it too; they need a range that contains the values and get one.)
 * - With a ghost array: decodes, and gives what a plain array gives. With the ghost array that the
 *   reader made: as without one, as the tree does not count hidden points.
 * - Without it, GetRange() of a series with hidden points decodes, as their values count then.
 * - Of magnitudes: the same; the index holds them per step.
 *
 * @par Limits:
 * VTK's array dispatch does not know this type. Filters then take their general path, if they have
 * one: it is slower (1 to 4 times), rounds integers where the other cuts them off, and in some
 * filters it is wrong. So only those get such arrays who are known to read them rightly: see
 * DeferredConsumers.h. A program may give the reader's output to other filters by itself: the first
 * value that is not read by a pointer then brings a warning, once for each series.
 * A value access cannot report an error: the reader checks the checksums of all that a piece needs.
 * When decoding fails nevertheless, an error message says so, and the values are NaN (0 for
 * integers).
 */
#ifndef vtkBanyanArray_h
#define vtkBanyanArray_h

#include "vtkBanyanDeferred.h"
#include "vtkGenericDataArray.h"
#include "vtkObjectFactory.h"

#include "Base/LargePages.h"
#include "Series/Decode/PieceRange.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <typeinfo>
#include <vector>

template <class ValueTypeT>
class vtkBanyanArray
  : public vtkGenericDataArray<vtkBanyanArray<ValueTypeT>, ValueTypeT>
  , public vtkBanyanDeferred
{
  using GenericType = vtkGenericDataArray<vtkBanyanArray<ValueTypeT>, ValueTypeT>;

public:
  using SelfType = vtkBanyanArray<ValueTypeT>;
  vtkAbstractTypeMacroWithNewInstanceType(
    SelfType, GenericType, vtkDataArray, typeid(SelfType).name());
  using ValueType = ValueTypeT;

  static vtkBanyanArray* New() { VTK_STANDARD_NEW_BODY(SelfType); }

  /// To be called once, before anything else. Throws banyan::Error when the tree cannot be read.
  void SetSource(const Handle& source);

  ///@{
  /// The concept methods of vtkGenericDataArray.
  ValueType GetValue(vtkIdType index) const { return this->ValuesOneByOne()[index]; }
  void SetValue(vtkIdType index, ValueType value) { this->Writable()[index] = value; }
  void GetTypedTuple(vtkIdType tuple, ValueType* values) const
  {
    const ValueType* from = this->ValuesOneByOne() + tuple * this->NumberOfComponents;
    std::copy_n(from, this->NumberOfComponents, values);
  }
  void SetTypedTuple(vtkIdType tuple, const ValueType* values)
  {
    ValueType* to = this->Writable() + tuple * this->NumberOfComponents;
    std::copy_n(values, this->NumberOfComponents, to);
  }
  ValueType GetTypedComponent(vtkIdType tuple, int component) const
  {
    return this->ValuesOneByOne()[tuple * this->NumberOfComponents + component];
  }
  void SetTypedComponent(vtkIdType tuple, int component, ValueType value)
  {
    this->Writable()[tuple * this->NumberOfComponents + component] = value;
  }
  ///@}

  void* GetVoidPointer(vtkIdType index) override;
  void* WriteVoidPointer(vtkIdType index, vtkIdType count) override;
  void ExportToVoidPointer(void* to) override;
  // HasStandardMemoryLayout() stays false although there is one block of tuples: VTK takes true for
  // a promise that the array can be cast to the plain type.
  vtkArrayIterator* NewIterator() override;
  unsigned long GetActualMemorySize() const override;
  void Squeeze() override;

protected:
  vtkBanyanArray();
  ~vtkBanyanArray() override;

  // A filter's output is to be written, and that is what plain arrays are for.
  vtkObjectBase* NewInstanceInternal() const override;

  bool AllocateTuples(vtkIdType tuples);
  bool ReallocateTuples(vtkIdType tuples);
  friend GenericType;

  void ComputeRange(double range[2], int component) override;
  void ComputeRange(
    double range[2], int component, const unsigned char* ghosts, unsigned char skip) override;
  void ComputeFiniteRange(double range[2], int component) override;
  void ComputeFiniteRange(
    double range[2], int component, const unsigned char* ghosts, unsigned char skip) override;
  bool ComputeScalarRange(double* ranges) override;
  bool ComputeScalarRange(double* ranges, const unsigned char* ghosts, unsigned char skip) override;
  bool ComputeVectorRange(double range[2]) override;
  bool ComputeVectorRange(
    double range[2], const unsigned char* ghosts, unsigned char skip) override;
  bool ComputeFiniteScalarRange(double* ranges) override;
  bool ComputeFiniteScalarRange(
    double* ranges, const unsigned char* ghosts, unsigned char skip) override;
  bool ComputeFiniteVectorRange(double range[2]) override;
  bool ComputeFiniteVectorRange(
    double range[2], const unsigned char* ghosts, unsigned char skip) override;

  bool IsPristine() const override;
  std::uint64_t DecodedBytes() const override;
  bool Release() override;

private:
  vtkBanyanArray(const vtkBanyanArray&) = delete;
  void operator=(const vtkBanyanArray&) = delete;

  enum class Infinities
  {
    Count,
    Skip
  };

  const ValueType* Values() const
  {
    const ValueType* values = this->Data.load(std::memory_order_acquire);
    return values ? values : this->Decode();
  }
  /// The same for the general path of filters: the first of them is told of its limits.
  const ValueType* ValuesOneByOne() const
  {
    const ValueType* values = this->OneByOne.load(std::memory_order_acquire);
    return values ? values : this->FirstOneByOne();
  }
  const ValueType* FirstOneByOne() const;
  ValueType* Decode() const;
  ValueType* Writable();
  bool Own(vtkIdType tuples, bool keep);
  /// Ranges of a part of the values: NumberOfComponents of them, and the magnitude last.
  std::vector<banyan::ValueRange> Scan(
    const unsigned char* ghosts, unsigned char skip, Infinities infinities) const;
  /// Whether these are flags that the tree knows of.
  bool AreOwn(const unsigned char* ghosts, unsigned char skip) const;
  /// The same without hidden points, from the tree, or from the values once they are there.
  std::vector<banyan::ValueRange> Told(Infinities infinities);
  std::vector<banyan::ValueRange> Answer(
    const unsigned char* ghosts, unsigned char skip, Infinities infinities);
  /// What GetFiniteRange() tells: of the series, or of the values with ghosts of others.
  std::vector<banyan::ValueRange> FiniteAnswer(const unsigned char* ghosts, unsigned char skip);

  banyan::PieceRange OfPiece;
  banyan::PieceRange OfSeries;
  mutable std::mutex Decoding;
  mutable banyan::ArrayInLargePages<ValueType> Storage;
  mutable std::atomic<ValueType*> Data{ nullptr };
  mutable std::atomic<const ValueType*> OneByOne{ nullptr }; ///< Data, once that was told
  mutable std::atomic<bool> GivenAway{ false };
  bool Written = false;
  vtkMTimeType UnchangedSince = 0;
  std::vector<banyan::ValueRange> Scanned[2]; ///< by Infinities; empty: not scanned yet
};

#endif
