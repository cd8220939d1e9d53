// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_InputStamp_h
#define banyan_Parallel_Fields_InputStamp_h

#include <cstdint>
#include <string>
#include <type_traits>

namespace banyan
{

class Communicator;

/// Says what a rank's input is, cheaply: objects, when they were modified, and settings. Inputs
/// with equal stamps are the same. Contents are not looked at.
class InputStamp
{
public:
  /// Appends a number or an address, bit by bit: a NaN is equal to itself.
  template <class T>
  void Add(const T& value)
  {
    if constexpr (std::is_pointer_v<T>)
    {
      this->Add(reinterpret_cast<std::uintptr_t>(value));
    }
    else
    {
      static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
      this->Bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
  }
  void Add(const std::string& text)
  {
    this->Add(text.size());
    this->Bytes += text;
  }
  /// @param object of VTK, say; null where there is none
  template <class T>
  void AddObject(T* object)
  {
    this->Add(object);
    this->Add(object ? object->GetMTime() : 0);
  }

  bool operator==(const InputStamp& other) const { return this->Bytes == other.Bytes; }
  bool operator!=(const InputStamp& other) const { return !(*this == other); }

  /// Collective: becomes `now`. @return whether the stamp of some rank has changed by that; the
  /// same on all ranks. A stamp to which nothing was added differs from all others.
  bool Become(Communicator& communicator, InputStamp now);

private:
  std::string Bytes;
};

} // namespace banyan

#endif
