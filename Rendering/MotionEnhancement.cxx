#include "MotionEnhancement.h"

#include "DistributedField.h"

#include "Cache/BrickCache.h"
#include "EnhancedArray.h"
#include "Render/EnhancedBrickSource.h"
#include "Render/SeriesBrickSource.h"
#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace banyan
{
namespace
{

std::uint64_t Bits(double value)
{
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

std::uint64_t Address(const void* pointer)
{
  return reinterpret_cast<std::uintptr_t>(pointer);
}

/// Null unless it can be compared with `array`.
vtkDataArray* Neighbour(vtkDataObject* data, const char* name, const FieldPiece& piece)
{
  vtkDataArray* const array = piece.Array;
  vtkDataArray* const found =
    data
      ->GetAttributes(piece.Where == ValuesOn::Points ? vtkDataObject::POINT : vtkDataObject::CELL)
      ->GetArray(name);
  return found && found->GetNumberOfTuples() == array->GetNumberOfTuples() &&
             found->GetNumberOfComponents() == array->GetNumberOfComponents()
           ? found
           : nullptr;
}

} // namespace

void MotionEnhancement::Apply(
  double strength, vtkVolumeProperty* property, vtkDataObject* data, FieldPiece& piece)
{
  if (strength == 0.0 || !data || !piece.Array || !piece.Problem.empty())
  {
    this->Enhanced = nullptr;
    return;
  }
  if (piece.Leaves)
  {
    piece.Problem = std::string("Motion is not brought out in data of the type ") +
                    data->GetClassName() + ": set 'Temporal Enhancement' to 0.";
    return;
  }
  const double* const range = property->GetScalarOpacity(0)->GetRange();
  const double scale = std::max(std::abs(range[0]), std::abs(range[1]));
  piece.Enhancement = {};
  piece.Enhancement.Strength = strength;
  piece.Enhancement.Scale = scale > 0.0 ? scale : 1.0;
  const vtkBanyanDeferred::Handle* const handle = vtkBanyanDeferred::From(piece.Array);
  if (handle && piece.Image && vtkBanyanDeferred::LiesOnSeries(piece.Image, *handle))
  {
    return;
  }
  vtkDataArray* const arrays[3] = { piece.Array, Neighbour(data, PreviousName(), piece),
    Neighbour(data, NextName(), piece) };
  const std::array<std::uint64_t, 9> stamp{ { Address(arrays[0]), arrays[0]->GetMTime(),
    Address(arrays[1]), arrays[1] ? arrays[1]->GetMTime() : 0, Address(arrays[2]),
    arrays[2] ? arrays[2]->GetMTime() : 0, static_cast<std::uint64_t>(piece.Component + 1),
    Bits(strength), Bits(piece.Enhancement.Scale) } };
  if (!this->Enhanced || stamp != this->Stamp)
  {
    vtkSmartPointer<vtkDataArray> plain[3];
    for (int i = 0; i < 3; ++i)
    {
      plain[i] = arrays[i] ? vtkBanyanDeferred::Plain(arrays[i]) : nullptr;
    }
    if (!plain[0])
    {
      piece.Problem = "The values to be enhanced cannot be decoded.";
      return;
    }
    this->Enhanced = EnhancedArray(
      piece.Enhancement, plain[0], plain[1], plain[2], static_cast<EnhancedPart>(piece.Component));
    this->Stamp = stamp;
  }
  piece.Array = this->Enhanced;
  piece.Component = 0;
}

std::unique_ptr<BrickSource> MakeSeriesSource(const std::shared_ptr<const SeriesFile>& series,
  const FieldKey& field, int component, const TemporalEnhancement& how)
{
  const auto at = [&](int step) -> std::unique_ptr<BrickSource>
  {
    FieldKey key = field;
    key.Step = step;
    return step < 0 || step >= series->Index().Steps()
             ? nullptr
             : std::make_unique<SeriesBrickSource>(series, key, component, BrickCache::Process());
  };
  if (how.Strength == 0.0)
  {
    return at(field.Step);
  }
  TemporalEnhancement complete = how;
  const ArrayIndex& array = series->Index().Arrays.at(static_cast<std::size_t>(field.Array));
  complete.NoiseFloor = EnhancementFor(array, how.Strength, component).NoiseFloor;
  return std::make_unique<EnhancedBrickSource>(
    complete, at(field.Step - 1), at(field.Step), at(field.Step + 1));
}

} // namespace banyan
