// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_Box_h
#define banyan_Base_Box_h

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include <cstdint>

namespace banyan
{

/// A half-open box of integer positions: Lo <= p < Hi per axis. Of cells or of samples, as said
/// where it is used.
struct Box
{
  glm::ivec3 Lo{ 0 };
  glm::ivec3 Hi{ 0 };

  glm::ivec3 Size() const { return glm::max(this->Hi - this->Lo, glm::ivec3(0)); }
  bool Empty() const { return glm::any(glm::lessThanEqual(this->Hi, this->Lo)); }

  /// Number of positions inside; 64 bits, because 2048^3 does not fit into 32.
  std::int64_t Count() const
  {
    const glm::ivec3 size = this->Size();
    return std::int64_t{ size.x } * size.y * size.z;
  }

  bool Contains(const glm::ivec3& p) const
  {
    return glm::all(glm::greaterThanEqual(p, this->Lo)) && glm::all(glm::lessThan(p, this->Hi));
  }

  bool Contains(const Box& other) const
  {
    return other.Empty() || (glm::all(glm::greaterThanEqual(other.Lo, this->Lo)) &&
                              glm::all(glm::lessThanEqual(other.Hi, this->Hi)));
  }

  friend bool operator==(const Box& a, const Box& b) { return a.Lo == b.Lo && a.Hi == b.Hi; }
  friend bool operator!=(const Box& a, const Box& b) { return !(a == b); }
};

inline Box Intersection(const Box& a, const Box& b)
{
  return { glm::max(a.Lo, b.Lo), glm::min(a.Hi, b.Hi) };
}

/// Calls function(position) for all positions in a box, x fastest.
template <class Function>
void ForPositions(const Box& box, Function&& function)
{
  for (int z = box.Lo.z; z < box.Hi.z; ++z)
  {
    for (int y = box.Lo.y; y < box.Hi.y; ++y)
    {
      for (int x = box.Lo.x; x < box.Hi.x; ++x)
      {
        function(glm::ivec3(x, y, z));
      }
    }
  }
}

/// Smallest box around both; an empty box counts as nothing.
inline Box Union(const Box& a, const Box& b)
{
  if (a.Empty())
  {
    return b;
  }
  return b.Empty() ? a : Box{ glm::min(a.Lo, b.Lo), glm::max(a.Hi, b.Hi) };
}

} // namespace banyan

#endif
