// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBanyanDeferred
 * @brief   what a point array of a Banyan series says about where its values come from
 *
 * vtkBanyanSeriesReader gives its point arrays this second base class, so that a renderer can read
 * bricks from the series instead of values from the array, without knowing the array's template.
 * Deferred ones (vtkBanyanArray) decode on first touch. Plain ones (vtkBanyanDecodedArray) are for
 * filters; DeferredConsumers.h says who gets which.
 *
 * @par Limits:
 * A handle says where the values come from, never where the points lie: filters such as Transform
 * keep the array on moved points. Ask LiesOnSeries() before drawing from the series.
 */
#ifndef vtkBanyanDeferred_h
#define vtkBanyanDeferred_h

#include "BanyanReadersModule.h" // For export macro
#include "vtkSmartPointer.h"     // For return type

#include "Base/Box.h"

#include <atomic>
#include <cstdint>
#include <memory>

class vtkAbstractArray;
class vtkDataArray;
class vtkImageData;
class vtkUnsignedCharArray;

namespace banyan
{
class CacheContext;
class SeriesFile;
struct ArrayIndex;
}

class BANYANREADERS_EXPORT vtkBanyanDeferred
{
public:
  /// Where the values of an array come from.
  struct Handle
  {
    std::shared_ptr<const banyan::SeriesFile> Series;
    int Step = 0;
    /// Towards the next step: see banyan::StepAndFraction. 0 for values that are not interpolated.
    double Fraction = 0.0;
    int Array = 0; ///< index in the series' list of arrays
    int Level = 0; ///< 0 is the finest
    /// The samples of that level, starting at 0 in each axis (see banyan::BrickLayout), that the
    /// array's tuples stand for, x fastest.
    banyan::Box Samples;
    /// Where the series has hidden points: the ghost array that the reader gave the image, and its
    /// time then.
    vtkSmartPointer<vtkUnsignedCharArray> Flags;
    vtkMTimeType FlagsTime = 0;
    /// The same of cells, if each hidden one has a hidden corner; null otherwise.
    vtkSmartPointer<vtkUnsignedCharArray> CellFlags;
    vtkMTimeType CellFlagsTime = 0;
    /// Whether these flags of points are the ones that the series has.
    bool HasFlags(vtkUnsignedCharArray* flags) const;
    /// Whether what an image hides is hidden by bricks whose hidden points are left out.
    bool HidesAs(vtkImageData* image) const;
  };

  /**
   * The handle of an array whose values are still those of the series, decoded or not; nullptr for
   * plain arrays and for arrays that were written to. The pointer lives as long as the array.
   */
  static const Handle* From(vtkAbstractArray* array);

  /**
   * Whether the array is of the deferred kind, whatever became of its values: GetVoidPointer()
   * then gives one block of tuples, although HasStandardMemoryLayout() is false.
   */
  static bool IsDeferred(vtkAbstractArray* array);

  /**
   * Whether the array is deferred and none of its values has been asked for (or they were let go
   * again): it holds no decoded values now.
   */
  static bool IsUntouched(vtkAbstractArray* array);

  /**
   * Says that the reader is about to give plain values in the place of an array: filters may look
   * at the old one until then, and no warning is due.
   */
  static void Supersede(vtkAbstractArray* array);

  /**
   * Whether the image's extent, origin, spacing and direction say that its points are the samples
   * of the handle, and it hides the points that the series does: only then may the series be drawn
   * in the place of the image.
   */
  static bool LiesOnSeries(vtkImageData* image, const Handle& handle);

  /**
   * The array with its values in ordinary memory, and no handle: `array` itself when it has none,
   * else a new array of the same name, type, components and information. It shares the memory of
   * one that NewDecoded() made. Decodes straight into the new array when the values are not there
   * yet. nullptr when they cannot be decoded (after an error message) or there is no memory for
   * them.
   */
  static vtkSmartPointer<vtkDataArray> Plain(vtkDataArray* array);

  /**
   * A deferred array with the name and component names of the series.
   * 64-bit integers that a double cannot hold exactly come as a plain array, already decoded:
   * VTK handles arrays that it does not know in double precision.
   * Throws banyan::Error when the values have to be decoded and cannot be.
   */
  static vtkSmartPointer<vtkDataArray> New(const Handle& handle);

  /**
   * As New(), but plain and decoded. Throws banyan::Error, or std::bad_alloc.
   */
  static vtkSmartPointer<vtkDataArray> NewPlain(const Handle& handle);

  /**
   * As NewPlain(), but the array knows its handle (From() gives it), and its finite range is that
   * of the series: see vtkBanyanDecodedArray.
   */
  static vtkSmartPointer<vtkDataArray> NewDecoded(const Handle& handle);

  /**
   * A plain array of the type, name, components and component names that an array of a series has,
   * without tuples.
   */
  static vtkSmartPointer<vtkDataArray> NewEmpty(const Handle& handle);

  /**
   * Decodes the values of a handle, through the caches of its series and on the threads of the
   * process.
   * @param values receives Samples.Count() tuples of the array's own type, components fastest,
   * then x.
   * Throws banyan::Error.
   */
  static void ReadInto(const Handle& handle, void* values);

  /**
   * Lets decoded values go, oldest first, until all deferred arrays of the series of one
   * CacheContext together hold no more than its budget. Values to which somebody has a pointer
   * stay, and so do values that were changed. To be called when no filter is at work, as at the
   * start of a reader's execution.
   */
  static void ReleaseBeyondBudgets();

  /**
   * Bytes of decoded values that all deferred arrays of this process hold now.
   */
  static std::uint64_t HeldBytes();

  virtual ~vtkBanyanDeferred();

protected:
  vtkBanyanDeferred();
  vtkBanyanDeferred(const vtkBanyanDeferred&) = delete;
  void operator=(const vtkBanyanDeferred&) = delete;

  /// Whether the values are still the series'.
  virtual bool IsPristine() const = 0;
  /// Whether the array is one of VTK's plain ones, decoded from the start.
  virtual bool IsPlain() const { return false; }
  /// Bytes of decoded values that are held; 0 when untouched.
  virtual std::uint64_t DecodedBytes() const = 0;
  /// Frees decoded values unless a pointer to them was given away; returns whether it did.
  virtual bool Release() = 0;

  /// Says, once for each series, that filters which the reader does not know may be wrong.
  void WarnOfFilters(const char* name) const;
  std::atomic<bool> Superseded{ false };

  /// To be called when values have been decoded, and before they are destroyed.
  void Remember() const;
  void Forget();
  /// Gives an array the name, number of components and their names.
  static void Label(vtkDataArray& array, const banyan::ArrayIndex& index);

  Handle Source;

private:
  /// The caches of its series.
  banyan::CacheContext* Caches() const;
};

#endif
