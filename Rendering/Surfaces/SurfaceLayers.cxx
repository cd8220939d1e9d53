// SPDX-License-Identifier: BSD-3-Clause
#include "Surfaces/SurfaceLayers.h"

#include "Backdrop.h"
#include "RendererCamera.h"
#include "vtkBanyanVolumeMapper.h"

#include "Render/Raycast/RayTile.h"

#include "vtkActor.h"
#include "vtkCollection.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLActor.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLRenderPass.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkPropCollection.h"
#include "vtkProperty.h"
#include "vtkRenderState.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkTextureObject.h"
#include "vtkVolume.h"
#if __has_include("vtk_glad.h")
#include "vtk_glad.h"
#else
#include "vtk_glew.h" // until VTK 9.3
#endif

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace banyan
{
namespace
{

/// More of one surface are left out.
constexpr int MostLayers = 64;
/// Surfaces on opaque geometry are seen, whatever depths are rounded to.
constexpr float DepthRounding = 2e-7f;

/// Has shaders of an actor leave out what is not behind the layer before.
class BehindLayer : public vtkOpenGLRenderPass
{
public:
  static BehindLayer* New();
  vtkTypeMacro(BehindLayer, vtkOpenGLRenderPass);
  void PrintSelf(ostream& os, vtkIndent indent) override
  {
    this->Superclass::PrintSelf(os, indent);
    os << indent << "Unit: " << this->Unit << "\n";
  }

  void Render(const vtkRenderState*) override {}

  /// @param unit of the texture that has depths of the layer before
  void RenderActor(vtkRenderer* renderer, vtkProp* actor, int unit)
  {
    this->Unit = unit;
    vtkRenderState state(renderer);
    state.SetPropArrayAndCount(&actor, 1);
    this->PreRender(&state); // which sees to it that there are keys
    vtkInformation* const keys = actor->GetPropertyKeys();
    keys->Set(vtkOpenGLActor::GLDepthMaskOverride(), 1);
    actor->RenderTranslucentPolygonalGeometry(renderer);
    keys->Remove(vtkOpenGLActor::GLDepthMaskOverride());
    this->PostRender(&state);
  }

  bool PostReplaceShaderValues(
    std::string&, std::string&, std::string& fragmentShader, vtkAbstractMapper*, vtkProp*) override
  {
    vtkShaderProgram::Substitute(
      fragmentShader, "//VTK::DepthPeeling::Dec", "uniform sampler2D layerBefore;\n");
    // Unless the mapper has set it.
    vtkShaderProgram::Substitute(
      fragmentShader, "//VTK::Depth::Impl", "gl_FragDepth = gl_FragCoord.z;\n");
    vtkShaderProgram::Substitute(fragmentShader, "//VTK::DepthPeeling::Impl",
      "if (gl_FragDepth <= texelFetch(layerBefore, ivec2(gl_FragCoord.xy), 0).r) { discard; }\n");
    return true;
  }

  bool SetShaderParameters(
    vtkShaderProgram* program, vtkAbstractMapper*, vtkProp*, vtkOpenGLVertexArrayObject*) override
  {
    if (program->IsUniformUsed("layerBefore"))
    {
      program->SetUniformi("layerBefore", this->Unit);
    }
    return true;
  }

protected:
  BehindLayer() = default;

private:
  int Unit = 0;
};

vtkStandardNewMacro(BehindLayer);

vtkOpenGLRenderWindow* WindowOf(vtkRenderer* renderer)
{
  return vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
}

template <class Function>
void ForEachVisible(vtkRenderer* renderer, Function&& function)
{
  vtkPropCollection* const props = renderer->GetViewProps();
  vtkCollectionSimpleIterator at;
  props->InitTraversal(at);
  while (vtkProp* const prop = props->GetNextProp(at))
  {
    if (prop->GetVisibility())
    {
      function(prop);
    }
  }
}

/// VTK's cache of OpenGL's state, put back at the end.
class ScopedState
{
public:
  explicit ScopedState(vtkOpenGLState* state)
    : State(state)
  {
    state->Push();
    state->PushFramebufferBindings();
  }
  ~ScopedState()
  {
    this->State->PopFramebufferBindings();
    this->State->Pop();
  }
  ScopedState(const ScopedState&) = delete;
  ScopedState& operator=(const ScopedState&) = delete;

private:
  vtkOpenGLState* State;
};

/// Takes apart what one actor draws in a rectangle.
class Peeler
{
public:
  Peeler(vtkRenderer* renderer, const PixelRect& rect)
    : Renderer(renderer)
    , Rect(rect)
    , Window(WindowOf(renderer))
    , Depths(static_cast<std::size_t>(rect.Count()), 0.0f)
  {
    const glm::uvec2 size(rect.Size());
    this->Color->SetContext(this->Window);
    this->Color->Allocate2D(size.x, size.y, 4, VTK_FLOAT);
    for (const auto& depth : this->Depth)
    {
      depth->SetContext(this->Window);
      depth->SetMinificationFilter(vtkTextureObject::Nearest);
      depth->SetMagnificationFilter(vtkTextureObject::Nearest);
      depth->AllocateDepth(size.x, size.y, vtkTextureObject::Float32);
    }
    this->Framebuffer->SetContext(this->Window);
  }

  /// @param fragments is added to
  /// @return whether that is all
  bool Peel(vtkProp* actor, std::vector<SurfaceFragment>& fragments)
  {
    vtkOpenGLState* const state = this->Window->GetState();
    const ScopedState before(state);
    this->Framebuffer->Bind();
    this->Framebuffer->AddColorAttachment(0, this->Color);
    this->Framebuffer->ActivateDrawBuffer(0);
    this->Framebuffer->ActivateReadBuffer(0);
    int size[2];
    int origin[2];
    this->Renderer->GetTiledSizeAndOrigin(&size[0], &size[1], &origin[0], &origin[1]);
    state->vtkglViewport(-this->Rect.Lo.x, -this->Rect.Lo.y, size[0], size[1]);
    state->vtkglDisable(GL_SCISSOR_TEST);
    state->vtkglDisable(GL_BLEND);
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglDepthFunc(GL_LESS);
    state->vtkglDepthMask(GL_TRUE);
    state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    state->vtkglClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    this->Begin(0, 0.0);
    for (int layer = 1; layer <= MostLayers; ++layer)
    {
      this->Begin(layer % 2, 1.0);
      vtkTextureObject* const behind = this->Depth[(layer - 1) % 2];
      behind->Activate();
      this->Pass->RenderActor(this->Renderer, actor, behind->GetTextureUnit());
      behind->Deactivate();
      if (!this->Read(fragments))
      {
        return true;
      }
    }
    return false;
  }

private:
  /// Empties a layer's textures, and has things drawn into them.
  void Begin(int number, double depth)
  {
    vtkOpenGLState* const state = this->Window->GetState();
    this->Framebuffer->AddDepthAttachment(this->Depth[number]);
    state->vtkglDepthMask(GL_TRUE);
    state->vtkglClearDepth(depth);
    state->vtkglClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  }

  /// @return whether there was something behind the layers before
  bool Read(std::vector<SurfaceFragment>& fragments)
  {
    const glm::ivec2 size = this->Rect.Size();
    std::vector<float> depths(this->Depths.size());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size.x, size.y, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
    const auto isNew = [&](std::size_t i) { return depths[i] < 1.0f && depths[i] > Depths[i]; };
    std::size_t count = 0;
    for (std::size_t i = 0; i < depths.size(); ++i)
    {
      count += isNew(i) ? 1 : 0;
    }
    if (count == 0)
    {
      return false;
    }
    this->Colors.resize(depths.size());
    glReadPixels(0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, this->Colors.data());
    fragments.reserve(fragments.size() + count);
    for (std::size_t i = 0; i < depths.size(); ++i)
    {
      if (isNew(i))
      {
        const glm::ivec2 at(static_cast<int>(i) % size.x, static_cast<int>(i) / size.x);
        fragments.push_back(
          { this->Rect.Lo + at, depths[i], glm::clamp(this->Colors[i], 0.0f, 1.0f) });
      }
    }
    this->Depths = std::move(depths);
    return true;
  }

  vtkRenderer* Renderer;
  PixelRect Rect;
  vtkOpenGLRenderWindow* Window;
  vtkNew<vtkTextureObject> Color;
  vtkNew<vtkTextureObject> Depth[2];
  vtkNew<vtkOpenGLFramebufferObject> Framebuffer;
  vtkNew<BehindLayer> Pass;  // mappers may keep it for longer
  std::vector<float> Depths; ///< of the layer before
  std::vector<glm::vec4> Colors;
};

/// Where an actor may show something, with the edges of its lines and points.
PixelRect PixelsOf(vtkRenderer* renderer, vtkProp* prop)
{
  const double* const bounds = prop->GetBounds();
  if (bounds == nullptr || bounds[0] > bounds[1])
  {
    return {};
  }
  const glm::dvec3 low(bounds[0], bounds[2], bounds[4]);
  const glm::dvec3 high(bounds[1], bounds[3], bounds[5]);
  PixelRect seen = CameraOf(renderer, low).Footprint(low, high);
  if (!seen.Empty())
  {
    vtkProperty* const property = static_cast<vtkActor*>(prop)->GetProperty();
    const int margin =
      2 + static_cast<int>(std::max(property->GetLineWidth(), property->GetPointSize()));
    seen.Lo -= margin;
    seen.Hi += margin;
  }
  return seen;
}

/// ParaView's volumes draw after all other data, in the pass of what lies over these.
bool DrawsInOverlay(vtkVolume* volume)
{
  return volume->IsA("vtkBanyanVolume") != 0;
}

/// Also what is hidden by opaque geometry.
/// @param rect relative to the renderer's viewport
/// @param complete set to false if a surface has more layers than are taken
std::vector<SurfaceFragment> FragmentsOf(
  vtkRenderer* renderer, const PixelRect& rect, bool& complete)
{
  std::vector<SurfaceFragment> fragments;
  ForEachVisible(renderer,
    [&](vtkProp* prop)
    {
      if (IsTranslucentSurface(prop))
      {
        const PixelRect seen = Intersection(PixelsOf(renderer, prop), rect);
        const bool all = seen.Empty() || Peeler(renderer, seen).Peel(prop, fragments);
        complete = complete && all;
      }
    });
  return fragments;
}

/// @param volume that is drawn next
void DrawWithoutSurfaces(vtkRenderer* renderer, const PixelRect& rect, vtkVolume* volume)
{
  vtkOpenGLState* const state = WindowOf(renderer)->GetState();
  const ScopedState before(state);
  int size[2];
  int origin[2];
  renderer->GetTiledSizeAndOrigin(&size[0], &size[1], &origin[0], &origin[1]);
  state->vtkglEnable(GL_SCISSOR_TEST);
  state->vtkglScissor(origin[0] + rect.Lo.x, origin[1] + rect.Lo.y, rect.Size().x, rect.Size().y);
  renderer->Clear();
  renderer->DeviceRenderOpaqueGeometry();
  state->vtkglEnable(GL_BLEND);
  state->vtkglBlendFuncSeparate(
    GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  ForEachVisible(renderer,
    [&](vtkProp* prop)
    {
      if (!vtkVolume::SafeDownCast(prop) && !IsTranslucentSurface(prop) &&
          prop->HasTranslucentPolygonalGeometry())
      {
        prop->RenderTranslucentPolygonalGeometry(renderer);
      }
    });
  bool isBefore = DrawsInOverlay(volume);
  ForEachVisible(renderer,
    [&](vtkProp* prop)
    {
      isBefore = isBefore && prop != volume;
      if (isBefore && !vtkVolume::SafeDownCast(prop))
      {
        prop->RenderOverlay(renderer);
      }
    });
}

} // namespace

bool IsTranslucentSurface(vtkProp* prop)
{
  vtkActor* const actor = vtkActor::SafeDownCast(prop);
  return actor && actor->GetVisibility() && actor->GetProperty()->GetOpacity() > 0.0 &&
         actor->HasTranslucentPolygonalGeometry();
}

bool CanHideSurfaces(vtkRenderer* renderer, const std::vector<vtkVolume*>& own)
{
  bool can = WindowOf(renderer) && !renderer->Transparent() && renderer->GetErase() &&
             !renderer->GetPreserveDepthBuffer();
  ForEachVisible(renderer,
    [&](vtkProp* prop)
    {
      auto* const volume = vtkVolume::SafeDownCast(prop);
      can = can && (!volume || vtkBanyanVolumeMapper::SafeDownCast(volume->GetMapper()) ||
                     std::find(own.begin(), own.end(), volume) != own.end());
    });
  return can;
}

bool SurfaceLayers::Take(
  vtkRenderer* renderer, const PictureView& view, const PixelRect& rect, vtkVolume* volume)
{
  const PixelRect own = Moved(rect, -view.Shown.Lo);
  bool complete = true;
  this->Fragments = FragmentsOf(renderer, own, complete);
  DrawWithoutSurfaces(renderer, own, volume);
  return complete;
}

void SurfaceLayers::Place(const PictureView& view, const PixelRect& rect, const Backdrop& backdrop)
{
  const RayCamera camera(view.View.WorldToClip, view.View.Size, glm::dvec3(0.0));
  const std::vector<float> depths = backdrop.Depths(rect);
  for (const SurfaceFragment& fragment : this->Fragments)
  {
    const glm::ivec2 at = view.Shown.Lo + fragment.Pixel;
    const glm::ivec2 inRect = at - rect.Lo;
    const auto number = static_cast<std::size_t>(inRect.y) * rect.Size().x + inRect.x;
    if (!depths.empty() && fragment.Depth > depths[number] + DepthRounding)
    {
      continue;
    }
    const glm::ivec2 position = at / RayTile::Edge;
    const glm::ivec2 inTile = at - position * RayTile::Edge;
    RaySegment surface;
    surface.Begin = camera.DistanceAtDepth(camera.RayOf(at.x, at.y), at.x, at.y, fragment.Depth);
    surface.Transmittance = 1.0f - fragment.Color.a;
    for (int i = 0; i < 3; ++i)
    {
      surface.Color[i] = fragment.Color.a * fragment.Color[i];
    }
    surface.Pixel = static_cast<std::uint32_t>(inTile.y * RayTile::Edge + inTile.x);
    if (std::isfinite(surface.Begin))
    {
      TileSegments& tile = this->Tiles[{ position.y, position.x }];
      tile.Position = position;
      tile.Segments.push_back(surface);
    }
  }
  this->Fragments = {};
}

void SurfaceLayers::AddTo(SegmentPicture& segments, const PixelRect& block) const
{
  const int end = (block.Hi.y + RayTile::Edge - 1) / RayTile::Edge;
  const auto last = this->Tiles.lower_bound({ end, 0 });
  for (auto at = this->Tiles.lower_bound({ block.Lo.y / RayTile::Edge, 0 }); at != last; ++at)
  {
    const int low = at->second.Position.x * RayTile::Edge;
    if (low < block.Hi.x && low + RayTile::Edge > block.Lo.x)
    {
      segments.Add(at->second);
    }
  }
}

} // namespace banyan
