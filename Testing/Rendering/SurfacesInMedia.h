// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_SurfacesInMedia_h
#define banyan_Testing_SurfacesInMedia_h

#include "SeveralVolumes.h"

#include "vtkCellArray.h"
#include "vtkPlaneSource.h"
#include "vtkPolyData.h"
#include "vtkPolyDataAlgorithm.h"

#include <array>

/// Translucent surfaces among volumes of one density, and a formula for each pixel.
namespace surfaces_in_media
{

using namespace several_volumes;

struct Surface
{
  std::vector<std::array<glm::dvec3, 3>> Triangles;
  glm::dvec4 Color{ 0.0 };
  vtkActor* Actor = nullptr;
};

/// Where a ray meets a triangle; infinite if it does not.
inline double Meets(const banyan::Ray& ray, const std::array<glm::dvec3, 3>& triangle)
{
  const glm::dvec3 one = triangle[1] - triangle[0];
  const glm::dvec3 two = triangle[2] - triangle[0];
  const glm::dvec3 across = glm::cross(ray.Direction, two);
  const double volume = glm::dot(one, across);
  const glm::dvec3 from = ray.Origin - triangle[0];
  const glm::dvec3 other = glm::cross(from, one);
  const double u = glm::dot(from, across) / volume;
  const double v = glm::dot(ray.Direction, other) / volume;
  const double t = glm::dot(two, other) / volume;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > ray.Near && t < ray.Far
           ? t
           : std::numeric_limits<double>::infinity();
}

/// A volume of one density and colour.
struct Medium
{
  Shown* Its = nullptr;
  glm::dvec3 Color{ 0.0 };
  double Density = 0.0; ///< per length in its own space
};

class Place
{
public:
  Place()
  {
    // Beside volumes VTK draws surfaces, in their order only so.
    this->Shot.Renderer->UseDepthPeelingOn();
    this->Shot.Renderer->SetMaximumNumberOfPeels(64);
  }
  Medium& AddMedium(const glm::ivec3& samples, const glm::dvec3& color, double opacity)
  {
    Shown& shown = this->Shot.Add(samples, color, opacity);
    shown.Mapper->SetInputDataObject(
      PlainImage([](double, double, double, int) { return 0.5f; }, samples));
    vtkNew<vtkColorTransferFunction> colors;
    colors->AddRGBPoint(0.5, color.r, color.g, color.b);
    vtkNew<vtkPiecewiseFunction> opacities;
    opacities->AddPoint(0.0, opacity);
    opacities->AddPoint(1.0, opacity);
    shown.Volume->GetProperty()->SetColor(colors);
    shown.Volume->GetProperty()->SetScalarOpacity(opacities);
    this->Media.push_back({ &shown, color, -std::log1p(-opacity) });
    return this->Media.back();
  }

  Surface& AddSurface(vtkPolyDataAlgorithm* source, const glm::dvec4& color)
  {
    source->Update();
    vtkPolyData* const data = source->GetOutput();
    Surface surface;
    surface.Color = color;
    surface.Actor = this->Shot.AddActor(source->GetOutputPort(), color.a);
    surface.Actor->GetProperty()->SetColor(color.r, color.g, color.b);
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    const auto at = [&](vtkIdType i)
    {
      const double* const point = data->GetPoint(ids[i]);
      return glm::dvec3(point[0], point[1], point[2]);
    };
    for (data->GetPolys()->InitTraversal(); data->GetPolys()->GetNextCell(count, ids) != 0;)
    {
      for (vtkIdType i = 2; i < count; ++i)
      {
        surface.Triangles.push_back({ at(0), at(i - 1), at(i) });
      }
    }
    this->Surfaces.push_back(std::move(surface));
    return this->Surfaces.back();
  }

  void AddPlane(
    const glm::dvec3& middle, const glm::dvec3& one, const glm::dvec3& two, const glm::dvec4& color)
  {
    const glm::dvec3 corner = middle - 0.5 * (one + two);
    const glm::dvec3 first = corner + one;
    const glm::dvec3 second = corner + two;
    vtkNew<vtkPlaneSource> plane;
    plane->SetOrigin(corner.x, corner.y, corner.z);
    plane->SetPoint1(first.x, first.y, first.z);
    plane->SetPoint2(second.x, second.y, second.z);
    this->AddSurface(plane, color);
  }

  void AddSphere(const glm::dvec3& center, double radius, const glm::dvec4& color)
  {
    vtkNew<vtkSphereSource> sphere;
    sphere->SetCenter(center.x, center.y, center.z);
    sphere->SetRadius(radius);
    sphere->SetThetaResolution(24);
    sphere->SetPhiResolution(17);
    this->AddSurface(sphere, color);
  }

  /// What the formula says.
  Picture Expected()
  {
    this->Shot.Show(-2);
    this->ShowTranslucent(false);
    const Picture behind = this->Shot.Draw();
    this->Shot.Show(-1);
    this->ShowTranslucent(true);
    const banyan::RayCamera camera = this->Shot.Camera();
    Picture result = behind;
    for (int pixel = 0; pixel < Width * Height; ++pixel)
    {
      const glm::dvec4 before = this->Along(camera.RayOf(pixel % Width, pixel / Width));
      for (int c = 0; c < 3; ++c)
      {
        const auto at = static_cast<std::size_t>(3 * pixel + c);
        const double value = 255.0 * before[c] + (1.0 - before.a) * behind[at];
        result[at] = static_cast<unsigned char>(std::lround(std::clamp(value, 0.0, 255.0)));
      }
    }
    return result;
  }

  void ShowTranslucent(bool shows)
  {
    for (const Surface& surface : this->Surfaces)
    {
      surface.Actor->SetVisibility(shows || surface.Color.a >= 1.0);
    }
  }

  int Warnings() const
  {
    int count = 0;
    for (const auto& shown : this->Shot.Volumes)
    {
      count += shown->Warnings + (shown->Messages->GetError() ? 1 : 0);
    }
    return count;
  }

  Scene Shot;
  std::vector<Medium> Media;
  std::vector<Surface> Surfaces;

private:
  struct Part
  {
    double Begin;
    double End;
    glm::dvec4 Color; ///< of a surface; of a medium with density in place of opacity
  };

  glm::dvec4 Along(const banyan::Ray& ray) const
  {
    double end = ray.Far;
    std::vector<Part> parts;
    for (const Surface& surface : this->Surfaces)
    {
      for (const auto& triangle : surface.Triangles)
      {
        const double at = Meets(ray, triangle);
        end = surface.Color.a >= 1.0 ? std::min(end, at) : end;
        if (surface.Color.a < 1.0 && std::isfinite(at))
        {
          parts.push_back({ at, at, surface.Color });
        }
      }
    }
    std::vector<double> cuts{ ray.Near, end };
    for (const Medium& medium : this->Media)
    {
      const double enters = medium.Its->Enters(ray);
      if (std::isfinite(enters))
      {
        const glm::dvec3 step(glm::inverse(medium.Its->ToWorld) * glm::dvec4(ray.Direction, 0.0));
        const double leaves = -medium.Its->Enters({ ray.Origin, -ray.Direction, 0.0, 0.0 });
        parts.push_back(
          { enters, leaves, glm::dvec4(medium.Color, medium.Density * glm::length(step)) });
      }
    }
    for (const Part& part : parts)
    {
      cuts.push_back(part.Begin);
      cuts.push_back(part.End);
    }
    std::sort(cuts.begin(), cuts.end());
    glm::dvec4 color(0.0);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    {
      if (cuts[i] < ray.Near || cuts[i + 1] > end)
      {
        continue;
      }
      double density = 0.0;
      glm::dvec3 mixed(0.0);
      for (const Part& part : parts)
      {
        if (part.Begin == part.End && part.Begin == cuts[i] && cuts[i + 1] > cuts[i])
        {
          color += (1.0 - color.a) * part.Color.a * glm::dvec4(glm::dvec3(part.Color), 1.0);
        }
        if (part.Begin <= cuts[i] && part.End >= cuts[i + 1])
        {
          density += part.Color.a;
          mixed += part.Color.a * glm::dvec3(part.Color);
        }
      }
      if (density > 0.0 && cuts[i + 1] > cuts[i])
      {
        const double opacity = -std::expm1(-density * (cuts[i + 1] - cuts[i]));
        color += (1.0 - color.a) * opacity * glm::dvec4(mixed / density, 1.0);
      }
    }
    return color;
  }
};

} // namespace surfaces_in_media

#endif
