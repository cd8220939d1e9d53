// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_ImageSeriesWriter_h
#define banyan_Data_ImageSeriesWriter_h

#include <string>
#include <vector>

namespace banyan
{

/// An array of single-precision point data.
struct ImageArray
{
  std::string Name;
  int Components = 1;
  std::vector<float> Values; ///< `[z][y][x][component]`, component fastest
};

/// Writes a time series of cubic images as VTK XML files (`NAME_0000.vti`, ...), and in the end
/// `NAME.vti.series`, which ParaView opens as one series with its time values.
///
/// Values are written as inline base64, never appended: some XML parsers that VTK is built with
/// lose appended data. A file gets its name only when it is whole.
class ImageSeriesWriter
{
public:
  /// @param folder is made when it does not exist
  /// @param size samples per axis
  /// @param edge length of the (periodic) box; sample i lies at i * edge / size
  ImageSeriesWriter(const std::string& folder, const std::string& name, int size, double edge);

  /// The first array becomes the active scalars. Throws Error when the file cannot be written.
  void AddStep(double time, const std::vector<ImageArray>& arrays);
  void Finish() const;

  int Steps() const { return static_cast<int>(this->Times.size()); }

private:
  std::string FileName(int step) const;

  std::string Folder, Name;
  int Size;
  double Edge;
  std::vector<double> Times;
};

/// Base64 (RFC 4648) with padding.
std::string EncodeBase64(const unsigned char* bytes, std::size_t count);

} // namespace banyan

#endif
