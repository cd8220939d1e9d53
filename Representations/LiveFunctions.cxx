// SPDX-License-Identifier: BSD-3-Clause
#include "LiveFunctions.h"

#include "vtkClientServerStream.h"
#include "vtkColorTransferFunction.h"
#include "vtkPiecewiseFunction.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

namespace banyan
{
namespace
{

const char* const ColorsProperty = "LookupTable";
const char* const OpacityProperty = "ScalarOpacityFunction";

vtkSMProxy* FunctionOf(vtkSMProxy* display, const char* property)
{
  vtkSMProperty* const found = display->GetProperty(property);
  return found ? vtkSMPropertyHelper(found).GetAsProxy() : nullptr;
}

vtkObject* OfClient(vtkSMProxy* function)
{
  return function ? vtkObject::SafeDownCast(function->GetClientSideObject()) : nullptr;
}

} // namespace

void LiveFunctions::Watch(vtkSMProxy* display)
{
  this->Colors.Watch(OfClient(FunctionOf(display, ColorsProperty)));
  this->Opacity.Watch(OfClient(FunctionOf(display, OpacityProperty)));
}

void LiveFunctions::AppendPoints(vtkSMProxy* display, vtkClientServerStream& stream)
{
  vtkSMProxy* const opacityProxy = FunctionOf(display, OpacityProperty);
  auto* const opacity = vtkPiecewiseFunction::SafeDownCast(OfClient(opacityProxy));
  if (opacity)
  {
    stream << vtkClientServerStream::Invoke << VTKOBJECT(opacityProxy) << "RemoveAllPoints"
           << vtkClientServerStream::End;
    double node[4];
    for (int i = 0; i < opacity->GetSize(); ++i)
    {
      opacity->GetNodeValue(i, node);
      stream << vtkClientServerStream::Invoke << VTKOBJECT(opacityProxy) << "AddPoint" << node[0]
             << node[1] << node[2] << node[3] << vtkClientServerStream::End;
    }
  }
  vtkSMProxy* const colorsProxy = FunctionOf(display, ColorsProperty);
  auto* const colors = vtkColorTransferFunction::SafeDownCast(OfClient(colorsProxy));
  if (colors)
  {
    stream << vtkClientServerStream::Invoke << VTKOBJECT(colorsProxy) << "RemoveAllPoints"
           << vtkClientServerStream::End;
    double node[6];
    for (int i = 0; i < colors->GetSize(); ++i)
    {
      colors->GetNodeValue(i, node);
      stream << vtkClientServerStream::Invoke << VTKOBJECT(colorsProxy) << "AddRGBPoint" << node[0]
             << node[1] << node[2] << node[3] << node[4] << node[5] << vtkClientServerStream::End;
    }
  }
}

} // namespace banyan
