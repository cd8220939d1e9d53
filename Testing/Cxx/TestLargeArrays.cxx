// SPDX-License-Identifier: BSD-3-Clause
// Arrays of the reader that are large.
#include "VtkIoTesting.h"

#include "vtkBanyanDecode.h"
#include "vtkBanyanSeriesReader.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include "Base/LargePages.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace
{

/// And are arrays as any other: they grow, and keep their values.
TEST(LargeArrays, LieInLargePages)
{
  double scale = 0.0;
  double offset = 0.0;
  GoodRange(banyan::ScalarType::Float32, scale, offset);
  const TemporaryFolder folder;
  const auto source = WaveSource(SimpleGrid({ 90, 85, 80 }), { 1.0 });
  WriteSeries(source, folder / "a.banyan");
  const auto expected = ImageAt(source, 1.0);
  for (const bool deferred : { true, false })
  {
    SCOPED_TRACE(deferred ? "deferred" : "at once");
    const auto reader = Reader(folder / "a.banyan");
    vtkNew<vtkBanyanDecode> readsDeferred;
    if (deferred)
    {
      readsDeferred->SetInputConnection(reader->GetOutputPort());
    }
    reader->UpdateTimeStep(1.0);
    vtkDataArray* const array = reader->GetOutput()->GetPointData()->GetScalars();
    const vtkIdType count = array->GetNumberOfValues();
    ASSERT_GE(static_cast<std::size_t>(count) * sizeof(float), banyan::LargePages::PageBytes);
    const auto address = reinterpret_cast<std::uintptr_t>(array->GetVoidPointer(0));
    EXPECT_EQ(address % banyan::LargePages::PageBytes, 0u);
    vtkDataArray* const original = expected->GetPointData()->GetScalars();
    EXPECT_LE(LargestDifference(original, array), 2.0 * scale / 512.0);
    const double last = array->GetTuple1(count - 1);
    array->InsertNextTuple1(4711.0);
    array->Squeeze();
    ASSERT_EQ(array->GetNumberOfValues(), count + 1);
    EXPECT_EQ(array->GetTuple1(count), 4711.0);
    EXPECT_EQ(array->GetTuple1(count - 1), last);
  }
}

} // namespace
