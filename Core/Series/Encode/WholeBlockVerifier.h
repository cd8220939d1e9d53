// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_WholeBlockVerifier_h
#define banyan_Series_Encode_WholeBlockVerifier_h

#include "Codec/BlockEncoder.h"
#include "Series/Decode/LatticeDecoder.h"
#include "Series/Encode/FieldGroup.h"

namespace banyan
{

/// Compares whole blocks of the finest plane with the original values at once, where these are
/// ordinary numbers that are not transformed: the fast path of BoundVerifier.
template <class T>
class WholeBlockVerifier
{
public:
  /// @param stride of values along the codec's axes
  /// @param values of the step
  WholeBlockVerifier(const group::FieldHead& head, const LatticeDecoder<T>& decoder, double bound,
    const glm::i64vec3& stride, const T* values)
    : Head(head)
    , Decoder(decoder)
    , Bound(bound)
    , Stride(stride)
    , Values(values)
  {
  }

  /// @param low first sample of the block
  /// @param n its samples
  /// @return whether all of the block is within the bound; `errors` have it then, and are as they
  /// were otherwise. Always false for integer types.
  bool Verify(const PlaneNumbers& decoded, const glm::ivec3& low, const glm::ivec3& n,
    FieldErrors& errors) const;

private:
  template <class Number>
  bool VerifyAs(const PlaneNumbers& decoded, const glm::ivec3& low, const glm::ivec3& n,
    FieldErrors& errors) const;

  const group::FieldHead& Head;
  const LatticeDecoder<T>& Decoder;
  double Bound;
  glm::i64vec3 Stride;
  const T* Values;
};

} // namespace banyan

#endif
