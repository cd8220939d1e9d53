// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/GroupMessage.h"

#include "Base/Error.h"

#include <type_traits>

namespace banyan
{
namespace
{

// Numbers without pointers: copied as they lie, so that a new one cannot be forgotten here.
static_assert(std::is_trivially_copyable_v<EncodeStatistics>);
static_assert(std::is_trivially_copyable_v<ValueRange>);

class Packer
{
public:
  template <class T>
  void Number(const T& value)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t at = this->Packed.size();
    this->Packed.resize(at + sizeof(T));
    StoreNumber(this->Packed.data() + at, value);
  }
  void Text(const std::string& text)
  {
    this->Number<std::uint64_t>(text.size());
    this->Packed.insert(this->Packed.end(), text.begin(), text.end());
  }
  /// Calls `each(packer, item)` for the items, after their number.
  template <class List, class Each>
  void Items(const List& items, const Each& each)
  {
    this->Number<std::uint64_t>(items.size());
    for (const auto& item : items)
    {
      each(item);
    }
  }
  Bytes Packed;
};

class Unpacker
{
public:
  explicit Unpacker(const Bytes& message)
    : Message(message)
  {
  }
  template <class T>
  void Number(T& value)
  {
    this->Need(sizeof(T));
    value = LoadNumber<T>(this->Message.data() + this->At);
    this->At += sizeof(T);
  }
  void Text(std::string& text)
  {
    const std::uint64_t size = this->Count();
    text.assign(reinterpret_cast<const char*>(this->Message.data()) + this->At, size);
    this->At += size;
  }
  template <class List, class Each>
  void Items(List& items, const Each& each)
  {
    items.resize(this->Count());
    for (auto& item : items)
    {
      each(item);
    }
  }
  void End() const
  {
    if (this->At != this->Message.size())
    {
      throw Error("The message about an encoded group is longer than it says");
    }
  }

private:
  /// A number of items, each of which takes at least one byte.
  std::uint64_t Count()
  {
    std::uint64_t count = 0;
    this->Number(count);
    this->Need(count);
    return count;
  }
  void Need(std::uint64_t bytes) const
  {
    if (bytes > this->Message.size() - this->At)
    {
      throw Error("The message about an encoded group is cut short");
    }
  }
  const Bytes& Message;
  std::size_t At = 0;
};

/// One walk for both directions, so that they cannot differ.
template <class Visitor, class Group>
void Visit(Visitor& visitor, Group& group)
{
  visitor.Text(group.Segment.File);
  visitor.Number(group.Segment.FirstStep);
  visitor.Number(group.Segment.Steps);
  visitor.Number(group.Segment.Bytes);
  visitor.Number(group.Segment.HashLow);
  visitor.Number(group.Segment.HashHigh);
  visitor.Items(group.Times, [&](auto& time) { visitor.Number(time); });
  visitor.Items(group.Measured,
    [&](auto& components)
    {
      visitor.Items(components,
        [&](auto& component)
        {
          visitor.Number(component.Range);
          visitor.Number(component.MeasuredMaxError);
          visitor.Number(component.MeasuredMaxErrorTransformed);
          visitor.Number(component.SumSquaredError);
          visitor.Items(component.StepRmse, [&](auto& rmse) { visitor.Number(rmse); });
          visitor.Number(component.FiniteCount);
          visitor.Number(component.NonFiniteCount);
          visitor.Number(component.ClampedCount);
          visitor.Number(component.FillCount);
          visitor.Number(component.InvisibleCount);
          visitor.Number(component.SumWeightedError);
        });
    });
  visitor.Items(group.Magnitudes,
    [&](auto& steps) { visitor.Items(steps, [&](auto& range) { visitor.Number(range); }); });
  visitor.Number(group.Statistics);
  visitor.Number(group.BytesIn);
}

} // namespace

Bytes PackGroup(const EncodedGroup& group)
{
  Packer packer;
  Visit(packer, group);
  return std::move(packer.Packed);
}

EncodedGroup UnpackGroup(const Bytes& message)
{
  EncodedGroup group;
  Unpacker unpacker(message);
  Visit(unpacker, group);
  unpacker.End();
  return group;
}

} // namespace banyan
