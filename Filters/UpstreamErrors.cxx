// SPDX-License-Identifier: BSD-3-Clause
#include "UpstreamErrors.h"

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"
#include "vtkOutputWindow.h"

#include <algorithm>
#include <iostream>
#include <sstream>
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

/// Recognizes the texts of vtkErrorMacro: they say where it was called, or a class and an address.
/// All that scripts write to Python's standard error comes to the window as well, piece by piece.
bool IsOfVtk(const std::string& text)
{
  const std::size_t address = text.find(" (");
  const std::size_t end = text.find("): ");
  return text.rfind("ERROR: In ", 0) == 0 ||
         (address != std::string::npos && end != std::string::npos &&
           text.find_first_of(" \n") == address && text.find('\n') > end);
}

/// The line of an exception in what scripts have written, or nothing: warnings are no errors.
std::string PythonError(const std::string& written)
{
  std::istringstream lines(written);
  bool inTraceback = false;
  for (std::string line; std::getline(lines, line);)
  {
    const bool ofSyntax = line.rfind("SyntaxError: ", 0) == 0 ||
                          line.rfind("IndentationError: ", 0) == 0 ||
                          line.rfind("TabError: ", 0) == 0;
    if (ofSyntax || (inTraceback && !line.empty() && line[0] != ' '))
    {
      return line;
    }
    inTraceback = inTraceback || line == "Traceback (most recent call last):";
  }
  return inTraceback ? "a script failed" : "";
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
  if (!this->Text.empty())
  {
    return this->Text;
  }
  const std::string ofScripts = PythonError(this->Scripts);
  return ofScripts.empty() ? this->StandardError->Complaint() : ofScripts;
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

void UpstreamErrors::Take(vtkObject* speaker, unsigned long, void* text)
{
  if (!this->Text.empty() || !text)
  {
    return;
  }
  const std::string said = static_cast<const char*>(text);
  if (vtkOutputWindow::SafeDownCast(speaker) && !IsOfVtk(said))
  {
    this->Scripts += said;
    return;
  }
  const std::string before = PythonError(this->Scripts);
  this->Text = before.empty() ? Plain(said) : before;
}

} // namespace banyan
