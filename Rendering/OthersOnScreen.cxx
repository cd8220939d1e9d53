// SPDX-License-Identifier: BSD-3-Clause
#include "OthersOnScreen.h"

#include "RendererCamera.h"

#include "vtkActor.h"
#include "vtkActor2D.h"
#include "vtkCollection.h"
#include "vtkMapper.h"
#include "vtkMapper2D.h"
#include "vtkMath.h"
#include "vtkProp.h"
#include "vtkPropCollection.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace banyan
{
namespace
{

/// Around what bounds cover: edges of polygons, volumes that others draw a pixel too large.
constexpr int Margin = 4;

template <std::size_t Count>
bool IsOneOf(vtkObject* object, const std::array<const char*, Count>& names)
{
  const std::string name = object->GetClassName();
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether a prop draws nothing before volumes, but over them: texts, scalar bars and such ones are
/// drawn last. Of classes that are not known here nobody knows.
bool IsDrawnLast(vtkProp* prop)
{
  constexpr std::array<const char*, 7> overlays{ "vtkActor2D", "vtkTextActor", "vtkOpenGLTextActor",
    "vtkScalarBarActor", "vtkCornerAnnotation", "vtkAxisActor2D", "vtkLegendBoxActor" };
  constexpr std::array<const char*, 2> mappers{ "vtkPolyDataMapper2D",
    "vtkOpenGLPolyDataMapper2D" };
  auto* const actor = vtkActor2D::SafeDownCast(prop);
  return actor != nullptr && IsOneOf(actor, overlays) &&
         (actor->GetMapper() == nullptr || IsOneOf(actor->GetMapper(), mappers));
}

/// Whether all that a prop draws is within its bounds, but for so many pixels.
bool StaysInBounds(vtkProp* prop, int& pixels)
{
  if (auto* const placed = vtkProp3D::SafeDownCast(prop))
  {
    if (placed->GetCoordinateSystem() != vtkProp3D::WORLD)
    {
      return false;
    }
  }
  if (vtkVolume::SafeDownCast(prop))
  {
    return true;
  }
  constexpr std::array<const char*, 5> actors{ "vtkActor", "vtkOpenGLActor", "vtkLODActor",
    "vtkPVLODActor", "vtkPVCenterAxesActor" };
  // Not those of splats and glyphs, which draw more than the points that they are given.
  constexpr std::array<const char*, 5> mappers{ "vtkPolyDataMapper", "vtkOpenGLPolyDataMapper",
    "vtkCompositePolyDataMapper2", "vtkDataSetMapper", "vtkOpenGLPolyDataMapper2" };
  if (!IsOneOf(prop, actors))
  {
    return false;
  }
  auto* const actor = static_cast<vtkActor*>(prop);
  vtkMapper* const mapper = actor->GetMapper();
  const double widest =
    std::max(actor->GetProperty()->GetLineWidth(), actor->GetProperty()->GetPointSize());
  pixels = static_cast<int>(std::min(widest, 1e6)) + 1;
  return mapper != nullptr && IsOneOf(mapper, mappers);
}

} // namespace

PixelRect OthersOnScreen(
  vtkRenderer* renderer, const std::vector<vtkVolume*>& own, const PixelRect& rect)
{
  PixelRect around;
  vtkPropCollection* const props = renderer->GetViewProps();
  vtkCollectionSimpleIterator at;
  props->InitTraversal(at);
  while (vtkProp* const prop = props->GetNextProp(at))
  {
    if (std::find(own.begin(), own.end(), prop) != own.end() || !prop->GetVisibility() ||
        IsDrawnLast(prop))
    {
      continue;
    }
    int pixels = 0;
    if (!StaysInBounds(prop, pixels))
    {
      return rect;
    }
    const double* const bounds = prop->GetBounds();
    if (bounds == nullptr || !vtkMath::AreBoundsInitialized(bounds))
    {
      continue; // there is nothing in it
    }
    const glm::dvec3 low(bounds[0], bounds[2], bounds[4]);
    const glm::dvec3 high(bounds[1], bounds[3], bounds[5]);
    PixelRect seen = CameraOf(renderer, low).Footprint(low, high);
    if (!seen.Empty())
    {
      seen.Lo -= Margin + pixels;
      seen.Hi += Margin + pixels;
      around = Union(around, Intersection(seen, rect));
    }
  }
  return around;
}

} // namespace banyan
