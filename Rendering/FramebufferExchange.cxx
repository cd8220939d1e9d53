// SPDX-License-Identifier: BSD-3-Clause
#include "FramebufferExchange.h"

#include "vtkNew.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLQuadHelper.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkSmartPointer.h"
#include "vtkTextureObject.h"
#if __has_include("vtk_glad.h")
#include "vtk_glad.h"
#else
#include "vtk_glew.h" // until VTK 9.3
#endif

#include <algorithm>
#include <cstring>

namespace banyan
{
namespace
{

const char* const FragmentShader = R"(//VTK::System::Dec
in vec2 texCoord;
uniform sampler2D colorTexture;
uniform sampler2D depthTexture;
//VTK::Output::Dec
void main()
{
  ivec2 at = ivec2(texCoord * vec2(textureSize(colorTexture, 0)));
  gl_FragDepth = texelFetch(depthTexture, at, 0).r;
  gl_FragData[0] = texelFetch(colorTexture, at, 0);
}
)";

vtkOpenGLRenderWindow* WindowOf(vtkRenderer* renderer)
{
  return vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
}

/// Lower left corner of the renderer's viewport in the framebuffer.
glm::ivec2 OriginOf(vtkRenderer* renderer)
{
  int width = 0;
  int height = 0;
  glm::ivec2 origin(0);
  renderer->GetTiledSizeAndOrigin(&width, &height, &origin.x, &origin.y);
  return origin;
}

/// Binds a framebuffer for reading and puts everything back at the end. VTK's cache of the state is
/// not told: it never notices.
class ScopedRead
{
public:
  ScopedRead(GLint framebuffer, GLint buffer)
  {
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &this->FramebufferBefore);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(framebuffer));
    glGetIntegerv(GL_READ_BUFFER, &this->BufferBefore);
    glReadBuffer(static_cast<GLenum>(buffer));
  }
  ~ScopedRead()
  {
    glReadBuffer(static_cast<GLenum>(this->BufferBefore));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(this->FramebufferBefore));
  }
  ScopedRead(const ScopedRead&) = delete;
  ScopedRead& operator=(const ScopedRead&) = delete;

private:
  GLint FramebufferBefore = 0;
  GLint BufferBefore = 0;
};

vtkSmartPointer<vtkTextureObject> NewTexture(vtkOpenGLRenderWindow* window)
{
  auto texture = vtkSmartPointer<vtkTextureObject>::New();
  texture->SetContext(window);
  texture->SetMinificationFilter(vtkTextureObject::Nearest);
  texture->SetMagnificationFilter(vtkTextureObject::Nearest);
  return texture;
}

} // namespace

/// What pixels are put on the screen with.
struct FramebufferExchange::Resources
{
  explicit Resources(vtkOpenGLRenderWindow* window)
    : Quad(window, nullptr, FragmentShader, nullptr)
    , Color(NewTexture(window))
    , Depth(NewTexture(window))
  {
  }

  void Release(vtkWindow* window)
  {
    this->Quad.ReleaseGraphicsResources(window);
    this->Color->ReleaseGraphicsResources(window);
    this->Depth->ReleaseGraphicsResources(window);
  }

  vtkOpenGLQuadHelper Quad;
  vtkSmartPointer<vtkTextureObject> Color;
  vtkSmartPointer<vtkTextureObject> Depth;
};

FramebufferExchange::FramebufferExchange() = default;
FramebufferExchange::~FramebufferExchange() = default;

/// glReadPixels of the framebuffer that is bound for reading.
void FramebufferExchange::ReadBound(
  const glm::ivec2& corner, const glm::ivec2& size, OpaquePixels& pixels)
{
  const auto count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  this->Depths.resize(count);
  this->Colors.resize(4 * count);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(corner.x, corner.y, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, this->Colors.data());
  glReadPixels(
    corner.x, corner.y, size.x, size.y, GL_DEPTH_COMPONENT, GL_FLOAT, this->Depths.data());
  pixels.resize(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    pixels[i].Depth = this->Depths[i];
    std::memcpy(pixels[i].Color, &this->Colors[4 * i], 4);
  }
}

/// Copies a rectangle of a multisampled framebuffer into a plain one and reads that.
void FramebufferExchange::ReadResolved(vtkOpenGLRenderWindow* window, int framebuffer, int buffer,
  const glm::ivec2& corner, const glm::ivec2& size, OpaquePixels& pixels)
{
  vtkOpenGLState* state = window->GetState();
  vtkNew<vtkOpenGLFramebufferObject> resolved;
  resolved->SetContext(window);
  // Depths are only copied between equal formats.
  GLint depthBits = 0;
  GLint stencilBits = 0;
  glGetFramebufferAttachmentParameteriv(
    GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE, &depthBits);
  glGetFramebufferAttachmentParameteriv(
    GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE, &stencilBits);
  state->PushFramebufferBindings();
  resolved->PopulateFramebuffer(
    size.x, size.y, true, 1, VTK_UNSIGNED_CHAR, true, depthBits, 0, stencilBits > 0);
  {
    vtkOpenGLState::ScopedglScissor scissor(state);
    state->vtkglScissor(0, 0, size.x, size.y);
    const ScopedRead source(framebuffer, buffer);
    glBlitFramebuffer(corner.x, corner.y, corner.x + size.x, corner.y + size.y, 0, 0, size.x,
      size.y, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  }
  {
    const ScopedRead copy(static_cast<GLint>(resolved->GetFBOIndex()), GL_COLOR_ATTACHMENT0);
    this->ReadBound(glm::ivec2(0), size, pixels);
  }
  state->PopFramebufferBindings();
}

void FramebufferExchange::Read(vtkRenderer* renderer, const PixelRect& rect, OpaquePixels& pixels)
{
  vtkOpenGLRenderWindow* window = WindowOf(renderer);
  const glm::ivec2 corner = OriginOf(renderer) + rect.Lo;
  const glm::ivec2 size = rect.Size();

  GLint framebuffer = 0;
  GLint buffer = 0;
  GLint samples = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
  glGetIntegerv(GL_DRAW_BUFFER0, &buffer);
  glGetIntegerv(GL_SAMPLES, &samples);
  if (samples > 1)
  {
    this->ReadResolved(window, framebuffer, buffer, corner, size, pixels);
    return;
  }
  const ScopedRead bound(framebuffer, buffer);
  this->ReadBound(corner, size, pixels);
}

void FramebufferExchange::Write(vtkRenderer* renderer, const PixelRect& rect,
  const OpaquePixels& pixels, const std::vector<PixelRect>& parts, bool blend)
{
  vtkOpenGLRenderWindow* window = WindowOf(renderer);
  vtkOpenGLState* state = window->GetState();
  const glm::ivec2 corner = OriginOf(renderer) + rect.Lo;
  const glm::ivec2 size = rect.Size();

  this->Colors.resize(4 * pixels.size());
  this->Depths.resize(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i)
  {
    std::memcpy(&this->Colors[4 * i], pixels[i].Color, 4);
    this->Depths[i] = pixels[i].Depth;
  }

  vtkOpenGLState::ScopedglViewport viewport(state);
  vtkOpenGLState::ScopedglScissor scissor(state);
  vtkOpenGLState::ScopedglEnableDisable scissorTest(state, GL_SCISSOR_TEST);
  vtkOpenGLState::ScopedglEnableDisable blending(state, GL_BLEND);
  vtkOpenGLState::ScopedglBlendFuncSeparate blendFunction(state);
  vtkOpenGLState::ScopedglEnableDisable depthTest(state, GL_DEPTH_TEST);
  vtkOpenGLState::ScopedglDepthMask depthMask(state);
  vtkOpenGLState::ScopedglDepthFunc depthFunction(state);
  state->vtkglViewport(corner.x, corner.y, size.x, size.y);
  state->SetEnumState(GL_BLEND, blend);
  state->vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  // Some props leave it off (Surface LIC): each part would be blended over the whole rectangle.
  state->vtkglEnable(GL_SCISSOR_TEST);
  // Depths are written only while the test is on.
  state->vtkglEnable(GL_DEPTH_TEST);
  state->vtkglDepthFunc(GL_ALWAYS);
  state->vtkglDepthMask(GL_TRUE);

  std::unique_ptr<Resources>& own = this->OfWindow[window];
  if (!own)
  {
    own = std::make_unique<Resources>(window);
  }
  vtkShaderProgram* const program = own->Quad.Program;
  window->GetShaderCache()->ReadyShaderProgram(program);
  const auto width = static_cast<unsigned int>(size.x);
  const auto height = static_cast<unsigned int>(size.y);
  own->Color->Create2DFromRaw(width, height, 4, VTK_UNSIGNED_CHAR, this->Colors.data());
  own->Depth->Create2DFromRaw(width, height, 1, VTK_FLOAT, this->Depths.data());
  own->Color->Activate();
  own->Depth->Activate();
  program->SetUniformi("colorTexture", own->Color->GetTextureUnit());
  program->SetUniformi("depthTexture", own->Depth->GetTextureUnit());
  for (const PixelRect& part : parts)
  {
    const glm::ivec2 low = corner + part.Lo - rect.Lo;
    state->vtkglScissor(low.x, low.y, part.Size().x, part.Size().y);
    own->Quad.Render();
  }
  own->Depth->Deactivate();
  own->Color->Deactivate();
}

void FramebufferExchange::ReleaseGraphicsResources(vtkWindow* window)
{
  for (auto own = this->OfWindow.begin(); own != this->OfWindow.end();)
  {
    if (window && own->first != window)
    {
      ++own;
      continue;
    }
    own->second->Release(window);
    own = this->OfWindow.erase(own);
  }
}

} // namespace banyan
