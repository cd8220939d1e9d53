// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Render_ColouredFields_h
#define banyan_Testing_Core_Render_ColouredFields_h

#include "Render/Bricks/ColourNumbers.h"
#include "Render/Scenes.h"

#include <algorithm>
#include <cmath>
#include <vector>

/// Fields of colours, and what they look like in double.
namespace coloured
{

using namespace banyan;

/// Components of samples, interleaved, 0 to 255: red, green and blue are waves of their own, and
/// alpha is the standard field, of which most is 0 with `sparse`.
template <class T = std::uint8_t>
std::vector<T> Sampled(const glm::ivec3& n, int components, bool sparse = false)
{
  const std::vector<double> alpha = scenes::Sampled<double>(scenes::Standard, n);
  std::vector<T> values;
  std::size_t at = 0;
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      for (int x = 0; x < n.x; ++x, ++at)
      {
        const double a = sparse ? std::max(0.0, 2.0 * alpha[at] - 1.0) : alpha[at];
        const double wave[4] = { 127.5 * (1.0 + std::sin(0.5 * x)),
          127.5 * (1.0 + std::sin(0.4 * y + 1.0)), 127.5 * (1.0 + std::cos(0.3 * z + 0.2 * x)),
          255.0 * std::min(std::max(a, 0.0), 1.0) };
        for (int c = 0; c < components; ++c)
        {
          const double scale = components == 3 && sparse ? wave[3] / 255.0 : 1.0;
          values.push_back(static_cast<T>(wave[c] * scale));
        }
      }
    }
  }
  return values;
}

template <class T>
SampleArray ArrayOf(const std::vector<T>& values, const glm::ivec3& n, int components)
{
  SampleArray array = scenes::ArrayOf(values, n);
  array.Components = components;
  array.Component = SampleArray::Colours;
  for (std::ptrdiff_t& stride : array.Stride)
  {
    stride *= components;
  }
  return array;
}

/// The same colours as one number per sample.
template <class T>
std::vector<double> NumbersOf(const std::vector<T>& values, int components)
{
  std::vector<double> numbers;
  for (std::size_t i = 0; i < values.size(); i += static_cast<std::size_t>(components))
  {
    const std::vector<double> of(values.begin() + static_cast<std::ptrdiff_t>(i),
      values.begin() + static_cast<std::ptrdiff_t>(i) + components);
    numbers.push_back(ColourNumber::Of(of.data(), components));
  }
  return numbers;
}

/// What is drawn of whole numbers from 0 to 255, written down again.
struct Looks
{
  std::vector<double> Shown; ///< NaN: nothing
  std::vector<glm::dvec3> Colours;

  template <class T>
  Looks(const std::vector<T>& values, int components)
  {
    for (std::size_t i = 0; i < values.size(); i += static_cast<std::size_t>(components))
    {
      const glm::dvec3 bytes(values[i], values[i + 1], values[i + 2]);
      const double luminance = 0.3 * bytes.r + 0.59 * bytes.g + 0.11 * bytes.b;
      this->Shown.push_back(
        components == 4 ? static_cast<double>(values[i + 3]) : std::floor(luminance + 0.5));
      this->Colours.push_back(bytes / 255.0);
    }
  }
};

/// White: samples alone have colours.
inline glm::dvec4 White(double value)
{
  return { 1.0, 1.0, 1.0, scenes::Smooth(value).a };
}

/// White, and nothing below a third.
inline glm::dvec4 SparseWhite(double value)
{
  return { 1.0, 1.0, 1.0, value < 1.0 / 3.0 ? 0.0 : 0.4 * value };
}

inline RayScene SceneOf(const glm::ivec3& n, const glm::ivec2& picture,
  const scenes::Function& function = White, double distance = 1.4)
{
  RayScene scene = scenes::Scene(n, picture, glm::dmat4(1.0), distance);
  scene.Transfer = scenes::Tabulate(function, 16384);
  scene.Transfer.High = 255.0;
  return scene;
}

inline FloatImage ReferenceOf(const RayScene& scene, const Looks& looks, const glm::ivec3& n,
  const std::function<bool(const glm::ivec3&)>& hidden = {})
{
  const auto colour = [&looks, n](const glm::ivec3& p)
  { return looks.Colours[p.x + std::size_t(n.x) * (p.y + std::size_t(n.y) * p.z)]; };
  return ReferenceImage(
    scene, scenes::ValueOf(looks.Shown, n), scenes::NearestEntry(scene.Transfer), hidden, colour);
}

/// The largest of `of(pixel)` in a picture: whether there is something to compare.
template <class Function>
float Most(const FloatImage& image, Function&& of)
{
  float most = 0.0f;
  for (const glm::vec4& pixel : image.Pixels)
  {
    most = std::max(most, of(pixel));
  }
  return most;
}

inline float ColourOf(const glm::vec4& pixel)
{
  return std::abs(pixel.r - pixel.b);
}

} // namespace coloured

#endif
