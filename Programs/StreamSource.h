// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_StreamSource_h
#define banyan_Programs_StreamSource_h

#include "SourceSteps.h"

#include <istream>

namespace banyan
{

/// Steps that another program sends through a pipe, so that whatever it can read can be compared.
///
/// Each step is one line of JSON, followed by the values of its arrays in their order, without
/// anything in between:
///
///     {"time": 0.5, "extent": [0, 9, 0, 9, 0, 9], "origin": [0, 0, 0], "spacing": [1, 1, 1],
///      "direction": [1, 0, 0, 0, 1, 0, 0, 0, 1],
///      "arrays": [{"name": "pressure", "type": "float32", "components": 1}]}
///
/// Points of a grid that is not regular are arrays, too, with a "role": "points", or "along x",
/// "along y" and "along z". They come before all other arrays. So do the parts of a mesh:
/// "coordinates", "corners", "offsets", "types" and "faces", as SourceMesh has them, with their
/// number of "tuples".
///
/// (in one line; extent and direction as in VTK; "time" may be null). Values are little-endian,
/// `[z][y][x][component]`. The last line is {"end": true}; or {"error": "A sentence."} when the
/// program cannot go on. A stream that ends without either is cut short.
class StreamSource : public SourceSteps
{
public:
  /// @param stream must live as long as this
  explicit StreamSource(std::istream& stream);

  bool Next(SourceStep& step) override;
  void ReadValues(std::size_t array, std::vector<std::uint8_t>& values) override;

private:
  void SkipValues(std::size_t until);

  std::istream& Stream;
  SourceStep Present;
  std::size_t Unread = 0; ///< the first array whose values are still to come
};

} // namespace banyan

#endif
