// SPDX-License-Identifier: BSD-3-Clause
#include "MeshPlanTexts.h"

#include "Base/Varint.h"
#include "Series/Format/Zstd.h"

namespace banyan
{
namespace
{

std::shared_ptr<const std::vector<std::uint8_t>> Unpacked(
  const std::string& packed, std::uint64_t samples)
{
  auto mask = std::make_shared<std::vector<std::uint8_t>>(samples);
  Decompress(reinterpret_cast<const std::uint8_t*>(packed.data()), packed.size(), mask->data(),
    mask->size());
  return mask;
}

} // namespace

std::vector<std::string> TextsOf(const MeshPlan& plan)
{
  const MeshIndex& index = plan.Index;
  Bytes numbers, needed, ofCells;
  for (const std::uint64_t number : { index.Bytes, index.HashLow, index.HashHigh,
         static_cast<std::uint64_t>(index.Points), static_cast<std::uint64_t>(index.Cells),
         std::uint64_t{ index.OfCells ? 1U : 0U }, std::uint64_t{ plan.Needed->size() } })
  {
    PutVarint(numbers, number);
  }
  AppendCompressed(plan.Needed->data(), plan.Needed->size(), 1, needed);
  AppendCompressed(plan.NeededOfCells->data(), plan.NeededOfCells->size(), 1, ofCells);
  std::vector<std::string> texts = { index.File };
  for (const Bytes& bytes : { numbers, needed, ofCells })
  {
    texts.emplace_back(bytes.begin(), bytes.end());
  }
  for (const auto& array : plan.CellArrays)
  {
    texts.insert(texts.end(), { array.first, array.second });
  }
  return texts;
}

std::shared_ptr<const MeshPlan> PlanFrom(const std::vector<std::string>& texts)
{
  auto plan = std::make_shared<MeshPlan>();
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(texts[1].data());
  ByteReader reader(bytes, texts[1].size());
  plan->Index.File = texts[0];
  plan->Index.Bytes = reader.Varint();
  plan->Index.HashLow = reader.Varint();
  plan->Index.HashHigh = reader.Varint();
  plan->Index.Points = static_cast<std::int64_t>(reader.Varint());
  plan->Index.Cells = static_cast<std::int64_t>(reader.Varint());
  plan->Index.OfCells = reader.Varint() != 0;
  const std::uint64_t samples = reader.Varint();
  plan->Needed = Unpacked(texts[2], samples);
  plan->NeededOfCells = Unpacked(texts[3], samples);
  for (std::size_t i = 4; i + 1 < texts.size(); i += 2)
  {
    plan->CellArrays[texts[i]] = texts[i + 1];
  }
  return plan;
}

} // namespace banyan
