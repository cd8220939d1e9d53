// SPDX-License-Identifier: BSD-3-Clause
#include "Agreement.h"

#include "Base/Error.h"

#include <algorithm>
#include <cstdio>

namespace banyan
{
namespace
{

[[noreturn]] void Refuse(int step, const std::string& sentence)
{
  throw Error("At step " + std::to_string(step) + " " + sentence);
}

std::string Text(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

std::string Text(const glm::dvec3& v)
{
  return "(" + Text(v.x) + ", " + Text(v.y) + ", " + Text(v.z) + ")";
}

std::string Text(const glm::ivec3& v)
{
  return std::to_string(v.x) + " x " + std::to_string(v.y) + " x " + std::to_string(v.z);
}

/// Writes an extent as VTK does: both ends included.
std::string Text(const Box& extent)
{
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
  {
    text += (axis > 0 ? " " : "") + std::to_string(extent.Lo[axis]) + ".." +
            std::to_string(extent.Hi[axis] - 1);
  }
  return text;
}

template <class Value>
std::string Differ(const std::string& what, const Value& source, const Value& series)
{
  return "the " + what + " of the source is " + Text(source) + " and that of the series " +
         Text(series) + ".";
}

void CheckMeshes(const SeriesIndex& index, int step, const SourceStep& source)
{
  if (!source.Mesh || !index.Mesh)
  {
    Refuse(step, index.Mesh
                   ? "the source has no mesh, and the series is one of a mesh. It is compared "
                     "with files of the mesh that it was made from."
                   : "the source is a mesh, and the series is one of images.");
  }
  if (source.Samples.x != index.Mesh->Points || source.Mesh->Cells != index.Mesh->Cells)
  {
    Refuse(step, "the mesh of the source has " + std::to_string(source.Samples.x) + " points and " +
                   std::to_string(source.Mesh->Cells) + " cells, and that of the series " +
                   std::to_string(index.Mesh->Points) + " and " +
                   std::to_string(index.Mesh->Cells) + ".");
  }
}

std::string KindOf(bool points, GridKind kind)
{
  return !points                         ? "an image"
         : kind == GridKind::Curvilinear ? "a curvilinear grid"
                                         : "a rectilinear grid";
}

/// Raw files know of no grid.
void CheckKinds(const SeriesIndex& index, int step, const SourceStep& source)
{
  const std::string mine =
    KindOf(index.Points.has_value(), index.Points ? index.Points->Form.Kind : GridKind{});
  const std::string theirs =
    KindOf(source.Points.has_value(), source.Points ? source.Points->Kind : GridKind{});
  if (source.Domain && mine != theirs)
  {
    Refuse(step, "the source is " + theirs + ", and the series is one of " + mine + ".");
  }
}

void CheckGrids(const SeriesIndex& index, int step, const SourceStep& source)
{
  if (source.Mesh || index.Mesh)
  {
    CheckMeshes(index, step, source);
    return;
  }
  CheckKinds(index, step, source);
  const Grid& series = index.Domain;
  if (source.Domain && source.Domain->Extent != series.Extent)
  {
    Refuse(step, Differ("extent", source.Domain->Extent, series.Extent));
  }
  if (source.Samples != series.Samples())
  {
    Refuse(step, Differ("number of samples", source.Samples, series.Samples()));
  }
  if (!source.Domain)
  {
    return;
  }
  if (source.Domain->Origin != series.Origin)
  {
    Refuse(step, Differ("origin", source.Domain->Origin, series.Origin));
  }
  if (source.Domain->Spacing != series.Spacing)
  {
    Refuse(step, Differ("spacing", source.Domain->Spacing, series.Spacing));
  }
  if (source.Domain->Direction != series.Direction)
  {
    Refuse(step, "the direction matrices of source and series differ.");
  }
}

void CheckArray(int step, const ArrayIndex& series, const SourceArray& source)
{
  if (source.Type != series.Type)
  {
    Refuse(step, "the array \"" + series.Name + "\" is " + NameOf(source.Type) +
                   " in the source and " + NameOf(series.Type) + " in the series.");
  }
  if (static_cast<std::size_t>(source.Components) != series.Components.size())
  {
    Refuse(step, "the array \"" + series.Name + "\" has " + std::to_string(source.Components) +
                   " components in the source and " + std::to_string(series.Components.size()) +
                   " in the series.");
  }
}

void CheckArrays(const SeriesIndex& index, int step, const SourceStep& source,
  const std::vector<std::string>& names)
{
  for (const int number : ChosenArrays(index, names))
  {
    const ArrayIndex& array = index.Arrays[static_cast<std::size_t>(number)];
    const auto fits = [&](const SourceArray& other) { return other.IsSourceOf(array); };
    const auto count = std::count_if(source.Arrays.begin(), source.Arrays.end(), fits);
    if (count == 0 && array.Flags != ArrayFlags::None)
    {
      continue; // a source speaks of them where it hides something
    }
    if (count != 1)
    {
      Refuse(step, "the source has " + std::string(count == 0 ? "no array" : "several arrays") +
                     " \"" + array.Name + "\", which the series holds.");
    }
    CheckArray(step, array, *std::find_if(source.Arrays.begin(), source.Arrays.end(), fits));
  }
  for (std::size_t a = 0; a < source.Arrays.size(); ++a)
  {
    const SourceArray& array = source.Arrays[a];
    const bool held = std::any_of(index.Arrays.begin(), index.Arrays.end(),
      [&](const ArrayIndex& other) { return array.IsSourceOf(other); });
    if (!held && (array.Name == FlagsName || array.Name == CellFlagsName))
    {
      Refuse(step,
        std::string("the source has hidden ") + (array.Name == FlagsName ? "points" : "cells") +
          ", and the series does not say which: it was made of other data, or by an older "
          "version.");
    }
    if (names.empty() && source.IsValue(a) && !held)
    {
      Refuse(step, "the source has the array \"" + array.Name +
                     "\", which the series does not hold; --array NAME compares only those that "
                     "are named.");
    }
  }
}

} // namespace

std::string NameOfComponent(const ArrayIndex& array, std::size_t component)
{
  if (array.Components.size() == 1)
  {
    return array.Name;
  }
  const std::string& name = array.Components[component].Name;
  return array.Name + "[" + (name.empty() ? std::to_string(component) : name) + "]";
}

std::vector<int> ChosenArrays(const SeriesIndex& index, const std::vector<std::string>& names)
{
  std::vector<int> numbers;
  for (std::size_t a = 0; a < index.Arrays.size(); ++a)
  {
    // Values cannot be judged without the flags.
    if (names.empty() || index.Arrays[a].Flags != ArrayFlags::None ||
        std::count(names.begin(), names.end(), index.Arrays[a].Name) > 0)
    {
      numbers.push_back(static_cast<int>(a));
    }
  }
  for (const std::string& name : names)
  {
    if (index.FindArray(name) < 0)
    {
      throw Error("The series has no array \"" + name + "\".");
    }
  }
  return numbers;
}

void CheckAgreement(const SeriesIndex& index, int step, const SourceStep& source,
  const std::vector<std::string>& names)
{
  CheckGrids(index, step, source);
  const double time = index.Times[static_cast<std::size_t>(step)];
  if (source.Time && *source.Time != time)
  {
    Refuse(step, Differ("time", *source.Time, time));
  }
  CheckArrays(index, step, source, names);
}

} // namespace banyan
