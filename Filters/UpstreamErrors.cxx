#include "UpstreamErrors.h"

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"
#include "vtkOutputWindow.h"

#include <algorithm>
#include <iostream>
#include <streambuf>

namespace banyan
{
namespace
{

/// Takes "ERROR: In file, line n" and the object's description off, and line breaks out.
std::string Plain(std::string text)
{
  if (text.rfind("ERROR: In ", 0) == 0)
  {
    const std::size_t end = text.find('\n');
    text.erase(0, end == std::string::npos ? text.size() : end + 1);
  }
  const std::size_t object = text.find("): ");
  if (text.rfind("vtk", 0) == 0 && object != std::string::npos)
  {
    text.erase(0, object + 3);
  }
  text.erase(std::min(text.find('\n'), text.size()));
  return text;
}

} // namespace

/// Passes std::cerr on to where it went before, and keeps what it was told.
class UpstreamErrors::Tee : public std::streambuf
{
public:
  Tee()
    : Before(std::cerr.rdbuf(this))
  {
  }
  ~Tee() override { std::cerr.rdbuf(this->Before); }
  Tee(const Tee&) = delete;
  Tee& operator=(const Tee&) = delete;

  /// The line on which MetaIO complains, or nothing.
  std::string Complaint() const
  {
    const std::size_t begin = this->Kept.find("MetaImage: ");
    return begin == std::string::npos
             ? std::string()
             : this->Kept.substr(begin, this->Kept.find('\n', begin) - begin);
  }

protected:
  int overflow(int c) override
  {
    if (c == traits_type::eof())
    {
      return traits_type::not_eof(c);
    }
    this->Kept += static_cast<char>(c);
    return this->Before->sputc(static_cast<char>(c));
  }
  std::streamsize xsputn(const char* text, std::streamsize length) override
  {
    this->Kept.append(text, static_cast<std::size_t>(length));
    return this->Before->sputn(text, length);
  }
  int sync() override { return this->Before->pubsync(); }

private:
  std::streambuf* Before;
  std::string Kept;
};

UpstreamErrors::UpstreamErrors(vtkAlgorithm* last)
  : StandardError(new Tee)
{
  if (vtkObject* window = vtkOutputWindow::GetInstance())
  {
    this->ListenTo(window);
  }
  this->ListenUpstream(last);
}

UpstreamErrors::~UpstreamErrors()
{
  for (const auto& [object, tag] : this->Observers)
  {
    object->RemoveObserver(tag);
    object->UnRegister(nullptr);
  }
}

std::string UpstreamErrors::First() const
{
  return this->Text.empty() ? this->StandardError->Complaint() : this->Text;
}

void UpstreamErrors::ListenTo(vtkObject* object)
{
  object->Register(nullptr);
  this->Observers.emplace_back(
    object, object->AddObserver(vtkCommand::ErrorEvent, this, &UpstreamErrors::Take));
}

void UpstreamErrors::ListenUpstream(vtkAlgorithm* algorithm)
{
  for (vtkObject* object :
    { static_cast<vtkObject*>(algorithm), static_cast<vtkObject*>(algorithm->GetExecutive()) })
  {
    const bool known = std::any_of(this->Observers.begin(), this->Observers.end(),
      [object](const auto& observer) { return observer.first == object; });
    // An object with a listener of its own does not tell the output window; one without would
    // stop telling it if we listened.
    if (!known && object->HasObserver(vtkCommand::ErrorEvent))
    {
      this->ListenTo(object);
    }
  }
  for (int port = 0; port < algorithm->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < algorithm->GetNumberOfInputConnections(port); ++i)
    {
      this->ListenUpstream(algorithm->GetInputAlgorithm(port, i));
    }
  }
}

void UpstreamErrors::Take(vtkObject*, unsigned long, void* text)
{
  if (this->Text.empty() && text)
  {
    this->Text = Plain(static_cast<const char*>(text));
  }
}

} // namespace banyan
