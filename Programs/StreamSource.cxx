// SPDX-License-Identifier: BSD-3-Clause
#include "StreamSource.h"

#include "Base/Error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace banyan
{
namespace
{

using Json = nlohmann::json;

// The header of a step is text of a few hundred bytes per array.
constexpr std::size_t GreatestHeader = std::size_t{ 1 } << 24;

std::string ReadLine(std::istream& stream)
{
  std::string line;
  for (int c = stream.get(); c != '\n'; c = stream.get())
  {
    if (c == std::istream::traits_type::eof() || line.size() >= GreatestHeader)
    {
      throw Error("The source was cut short: its last time step never came to an end");
    }
    line.push_back(static_cast<char>(c));
  }
  return line;
}

glm::dvec3 Vector(const Json& json)
{
  return { json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>() };
}

Grid GridFrom(const Json& json)
{
  Grid grid;
  const Json& extent = json.at("extent");
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::size_t i = static_cast<std::size_t>(axis);
    const std::int64_t low = extent.at(2 * i).get<std::int64_t>();
    const std::int64_t high = extent.at(2 * i + 1).get<std::int64_t>();
    constexpr std::int64_t Limit = std::int64_t{ 1 } << 30;
    if (low < -Limit || high >= Limit || high < low)
    {
      throw Error("The source has an empty or impossible extent");
    }
    grid.Extent.Lo[axis] = static_cast<int>(low);
    grid.Extent.Hi[axis] = static_cast<int>(high) + 1;
  }
  grid.Origin = Vector(json.at("origin"));
  grid.Spacing = Vector(json.at("spacing"));
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      grid.Direction[column][row] =
        json.at("direction").at(static_cast<std::size_t>(3 * row + column)).get<double>();
    }
  }
  return grid;
}

/// Takes the last array as points of a grid, if that is its role.
void TakePoints(const std::string& role, SourceStep& step)
{
  const int number = static_cast<int>(step.Arrays.size()) - 1;
  for (int axis = 0; !step.Mesh && axis < 3; ++axis)
  {
    if (role == std::string("along ") + "xyz"[axis])
    {
      step.Points = step.Points ? step.Points : SourcePoints{ GridKind::Rectilinear };
      step.Points->Arrays[static_cast<std::size_t>(axis)] = number;
      step.Arrays.back().Tuples = step.Samples[axis];
    }
  }
  if (!step.Mesh && role == "points")
  {
    step.Points = SourcePoints{ GridKind::Curvilinear, { number, -1, -1 } };
  }
}

/// Takes the last array as a part of the mesh, if that is its role.
void TakePartOfMesh(const Json& array, const std::string& role, SourceStep& step)
{
  if (!step.Mesh)
  {
    return;
  }
  SourceMesh& mesh = *step.Mesh;
  const std::pair<const char*, int*> parts[] = { { "coordinates", &mesh.Coordinates },
    { "corners", &mesh.Corners }, { "offsets", &mesh.Offsets }, { "types", &mesh.Types },
    { "faces", &mesh.Faces } };
  for (const auto& [name, number] : parts)
  {
    if (role == name)
    {
      *number = static_cast<int>(step.Arrays.size()) - 1;
      step.Arrays.back().Tuples = array.at("tuples").get<std::int64_t>();
      if (step.Arrays.back().Tuples < 1)
      {
        throw Error("The source has a mesh without " + role);
      }
    }
  }
}

SourceStep StepFrom(const Json& json)
{
  SourceStep step;
  if (!json.at("time").is_null())
  {
    step.Time = json.at("time").get<double>();
  }
  if (json.contains("mesh"))
  {
    const std::int64_t points = json["mesh"].at("points").get<std::int64_t>();
    step.Mesh = SourceMesh{ json["mesh"].at("cells").get<std::int64_t>(), -1, -1 };
    if (points < 1 || points > std::numeric_limits<int>::max() || step.Mesh->Cells < 1)
    {
      throw Error("The source has a mesh without points, or with too many");
    }
    step.Samples = { static_cast<int>(points), 1, 1 };
  }
  else
  {
    step.Domain = GridFrom(json);
    step.Samples = step.Domain->Samples();
  }
  for (const Json& array : json.at("arrays"))
  {
    const int components = array.at("components").get<int>();
    if (components < 1 || components > 65536)
    {
      throw Error("The source has an array with an impossible number of components");
    }
    step.Arrays.push_back({ array.at("name").get<std::string>(),
      ScalarTypeFromName(array.at("type").get<std::string>()), components });
    const std::string role = array.value("role", "");
    TakePoints(role, step);
    TakePartOfMesh(array, role, step);
    if (step.Mesh && role == "cells")
    {
      step.Arrays.back().OfCells = true;
      step.Arrays.back().Tuples = step.Mesh->Cells;
    }
  }
  return step;
}

} // namespace

StreamSource::StreamSource(std::istream& stream)
  : Stream(stream)
{
}

bool StreamSource::Next(SourceStep& step)
{
  this->SkipValues(this->Present.Arrays.size());
  try
  {
    const Json json = Json::parse(ReadLine(this->Stream));
    if (json.contains("error"))
    {
      throw Error(json["error"].get<std::string>());
    }
    if (json.contains("end"))
    {
      return false;
    }
    this->Present = StepFrom(json);
  }
  catch (const Json::exception& failure)
  {
    throw Error(std::string("The source sent what is not a time step: ") + failure.what());
  }
  this->Unread = 0;
  step = this->Present;
  return true;
}

void StreamSource::SkipValues(std::size_t until)
{
  for (; this->Unread < until; ++this->Unread)
  {
    std::uint64_t left = BytesOf(this->Present.Arrays[this->Unread], this->Present.Samples);
    std::vector<char> part(std::min<std::uint64_t>(left, 1 << 20));
    while (left > 0 && this->Stream)
    {
      const std::uint64_t some = std::min<std::uint64_t>(left, part.size());
      this->Stream.read(part.data(), static_cast<std::streamsize>(some));
      left -= some;
    }
  }
}

void StreamSource::ReadValues(std::size_t array, std::vector<std::uint8_t>& values)
{
  this->SkipValues(array);
  values.resize(BytesOf(this->Present.Arrays[array], this->Present.Samples));
  this->Stream.read(
    reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size()));
  if (!this->Stream)
  {
    throw Error("The source was cut short in the values of the array \"" +
                this->Present.Arrays[array].Name + "\"");
  }
  this->Unread = array + 1;
}

} // namespace banyan
