// SPDX-License-Identifier: BSD-3-Clause
#include "Series/GoldenFiles.h"

#include "Base/Hash.h"
#include "Mesh/CellSeries/CellsFile.h"
#include "Mesh/Series/AtlasValues.h"
#include "Mesh/Series/MeshFile.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Format/IndexText.h"
#include "Series/GoldenCells.h"
#include "Series/GoldenMesh.h"
#include "Series/Points/PointsReader.h"
#include "Series/SeriesTesting.h"

#include <array>
#include <cstdio>
#include <sstream>

namespace banyan::testing
{
namespace
{

namespace fs = std::filesystem;

constexpr std::uint64_t GreatestFile = std::uint64_t{ 1 } << 24;

std::string Hex(const Bytes& bytes)
{
  char text[17];
  std::snprintf(text, sizeof(text), "%016llx",
    static_cast<unsigned long long>(ShortHashOf(bytes.data(), bytes.size())));
  return text;
}

/// Text with digits enough for the same bits.
std::ostringstream Stream()
{
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  return out;
}

std::string TextOf(const ValueRange& range)
{
  auto out = Stream();
  if (range.Empty())
  {
    return "[]";
  }
  out << "[" << range.Low << " " << range.High << "]";
  return out.str();
}

template <class T>
void Append(T value, Bytes& out)
{
  out.resize(out.size() + sizeof(T));
  StoreNumber(out.data() + out.size() - sizeof(T), value);
}

std::string GridText(const SeriesIndex& index)
{
  auto out = Stream();
  const Grid& grid = index.Domain;
  out << "from";
  for (int i = 0; i < 3; ++i)
  {
    out << " " << grid.Extent.Lo[i];
  }
  out << " to";
  for (int i = 0; i < 3; ++i)
  {
    out << " " << grid.Extent.Hi[i];
  }
  out << ", origin";
  for (int i = 0; i < 3; ++i)
  {
    out << " " << grid.Origin[i];
  }
  out << ", spacing";
  for (int i = 0; i < 3; ++i)
  {
    out << " " << grid.Spacing[i];
  }
  out << ", axes";
  for (int i = 0; i < 9; ++i)
  {
    out << " " << grid.Direction[i / 3][i % 3];
  }
  out << ", bricks of " << index.BrickCells << ", levels " << index.Levels;
  return out.str();
}

std::string StepsText(const SeriesIndex& index)
{
  auto out = Stream();
  out << "times";
  for (const double time : index.Times)
  {
    out << " " << time;
  }
  out << ", segments of at most " << index.KeyframeInterval << ":";
  for (const SegmentIndex& segment : index.Segments)
  {
    out << " " << segment.FirstStep << "+" << segment.Steps;
  }
  return out.str();
}

std::string EncodingText(const SeriesIndex& index)
{
  auto out = Stream();
  const EncodeStatistics& s = index.Statistics;
  out << "bound " << index.ErrorBound
      << (index.Mode == ErrorBoundMode::Absolute ? " absolute" : " relative") << ", active '"
      << index.ActiveScalars << "', bytes in " << index.PayloadBytesIn << ", bricks " << s.Bricks
      << ", macro voxels " << s.MacroVoxelBricks << ", unchanged " << s.UnchangedBricks
      << ", merged " << s.MergedBricks << ", raw " << s.RawBricks << ", payload bytes "
      << s.PayloadBytes << ", table bytes " << s.TableBytes << ", blocks " << s.Blocks << ", empty "
      << s.EmptyBlocks << ", exceptions " << s.ExceptionVoxels << ", chains " << s.ChainSum
      << " over " << s.ChainBricks << ", longest " << s.ChainMost;
  return out.str();
}

std::string ArrayText(const ArrayIndex& array)
{
  std::string text = "'" + array.Name + "' " + banyan::NameOf(array.Type) + " in " +
                     std::to_string(array.Components.size());
  for (const ValueRange& magnitude : array.Magnitudes)
  {
    text += " " + TextOf(magnitude);
  }
  if (array.Flags != ArrayFlags::None)
  {
    text += array.Flags == ArrayFlags::OfPoints ? ", flags of points" : ", flags of cells";
  }
  return text + (array.CellArray.empty() ? "" : ", of cells '" + array.CellArray + "'");
}

/// What the quantizer of a component was told, as far as it was told anything.
std::string QuantizerText(const ComponentIndex& c)
{
  auto out = Stream();
  if (c.RangeFrom != RangeRule::Source::Data)
  {
    out << ", range from " << static_cast<int>(c.RangeFrom);
  }
  if (c.ClampOutside)
  {
    out << ", clamped " << c.ClampedCount;
  }
  for (const double value : c.FillValues)
  {
    out << ", fill value " << value;
  }
  if (!c.FillValues.empty())
  {
    out << " in " << c.FillCount;
  }
  for (const OpacityKnot& knot : c.Opacity)
  {
    out << ", opacity " << knot.Value << ":" << knot.Opacity;
  }
  if (!c.Opacity.empty())
  {
    out << ", invisible " << c.InvisibleCount << ", weighted " << c.SumWeightedError;
  }
  return out.str();
}

std::string ComponentText(const ComponentIndex& c, const MaskRange& masks)
{
  auto out = Stream();
  out << "'" << c.Name << "' in " << TextOf(c.Range) << ", promised " << TextOf(c.PromisedRange)
      << ", masks over " << masks.Low << " " << masks.High << ", bound " << c.ErrorBoundAbsolute
      << ", error " << c.MeasuredMaxError << ", squares " << c.SumSquaredError << ", finite "
      << c.FiniteCount << ", not finite " << c.NonFiniteCount;
  if (!c.ValueTransform.IsIdentity())
  {
    out << ", transform " << static_cast<int>(c.ValueTransform.Kind()) << " "
        << c.ValueTransform.Scale();
    for (const TransformKnot& knot : c.ValueTransform.Knots())
    {
      out << " " << knot.X << ":" << knot.Y;
    }
    out << ", error transformed " << c.MeasuredMaxErrorTransformed;
  }
  return out.str() + QuantizerText(c);
}

std::string FieldText(const SeriesFile& file, const FieldKey& field)
{
  const ScalarType type = file.Index().Arrays[static_cast<std::size_t>(field.Array)].Type;
  const BrickLayout layout = file.Layout(field.Level);
  Bytes values;
  Bytes nodes;
  for (std::int64_t brick = 0; brick < layout.BrickCount(); ++brick)
  {
    const std::size_t bytes =
      static_cast<std::size_t>(layout.SamplesOf(brick).Count()) * SizeOf(type);
    values.resize(values.size() + bytes);
    file.DecodeBrick(field, brick, values.data() + values.size() - bytes);
  }
  for (const BrickNode& node : *file.Nodes(field))
  {
    Append(node.Range.Low, nodes);
    Append(node.Range.High, nodes);
    Append(node.Mask, nodes);
    Append(static_cast<std::uint8_t>(node.Uniform), nodes);
    Append(static_cast<std::uint8_t>(node.HasNonFinite), nodes);
  }
  return "values " + Hex(values) + " nodes " + Hex(nodes);
}

void ReadArray(const SeriesFile& file, int a, const std::string& series, GoldenParts& parts)
{
  const ArrayIndex& array = file.Index().Arrays[static_cast<std::size_t>(a)];
  const std::string name = series + " array " + std::to_string(a);
  parts[name] = ArrayText(array);
  for (int c = 0; c < static_cast<int>(array.Components.size()); ++c)
  {
    const std::string component =
      array.Components.size() > 1 ? name + " component " + std::to_string(c) : name;
    parts[component + " index"] =
      ComponentText(array.Components[static_cast<std::size_t>(c)], file.MaskRangeOf(a, c));
    for (int step = 0; step < file.Index().Steps(); ++step)
    {
      for (int level = 0; level < file.Index().Levels; ++level)
      {
        std::string& text =
          parts[component + " step " + std::to_string(step) + " level " + std::to_string(level)];
        try
        {
          text = FieldText(file, { step, a, c, level });
        }
        catch (const Error& failure)
        {
          text = failure.what();
        }
      }
    }
  }
}

std::string MeshText(const StoredMesh& mesh)
{
  Bytes numbers;
  for (const std::int64_t id : mesh.Connectivity)
  {
    Append(id, numbers);
  }
  for (const auto* samples : { &mesh.SampleOfPoint, &mesh.SampleOfCell })
  {
    for (const std::uint32_t sample : *samples)
    {
      Append(sample, numbers);
    }
  }
  return std::to_string(mesh.PointCount()) + " points " + Hex(mesh.Points) + ", " +
         std::to_string(mesh.CellCount()) + " cells " + Hex(mesh.CellTypes) +
         ", corners and samples " + Hex(numbers);
}

/// Hashes of the points of all steps.
std::string PointsText(const SeriesFile& file)
{
  const SeriesIndex& index = file.Index();
  const PointsForm& form = index.Points->Form;
  const bool curvilinear = form.Kind == GridKind::Curvilinear;
  const Box whole{ glm::ivec3(0), index.Domain.Samples() };
  std::string text = curvilinear ? "curvilinear" : "rectilinear";
  ThreadPool pool(1);
  for (int step = 0; step < index.Steps(); ++step)
  {
    std::array<Bytes, 3> values;
    std::array<void*, 3> to{};
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto a = static_cast<std::size_t>(axis);
      const std::int64_t count = curvilinear ? 3 * whole.Count() : whole.Size()[axis];
      values[a].resize(static_cast<std::size_t>(count) * SizeOf(form.Types[a]));
      to[a] = values[a].data();
    }
    ReadPoints(file.Folder(), index, step, 0, whole, to, pool);
    text += std::string(", ") + NameOf(form.Types[0]);
    for (int axis = 0; axis < (curvilinear ? 1 : 3); ++axis)
    {
      text += " " + Hex(values[static_cast<std::size_t>(axis)]);
    }
  }
  return text;
}

void ReadSeries(const std::string& path, const std::string& name, GoldenParts& parts)
{
  const auto file = SeriesFile::Open(path);
  parts[name + " grid"] = GridText(file->Index());
  parts[name + " steps"] = StepsText(file->Index());
  parts[name + " encoding"] = EncodingText(file->Index());
  for (const std::string& feature : FeaturesOf(file->Index()))
  {
    parts[name + " feature " + feature] = "named";
  }
  if (file->Index().Mesh)
  {
    parts[name + " mesh"] =
      file->Index().Mesh->OfCells ? CellsText(*file) : MeshText(*ReadMesh(*file));
  }
  if (file->Index().Points)
  {
    parts[name + " points"] = PointsText(*file);
  }
  for (int a = 0; a < static_cast<int>(file->Index().Arrays.size()); ++a)
  {
    ReadArray(*file, a, name, parts);
  }
}

} // namespace

GoldenParts ReadGolden(const std::string& folder)
{
  GoldenParts parts;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
  {
    const std::string name = fs::relative(entry.path(), folder).generic_string();
    if (!entry.is_regular_file() || name == ChecksumFile)
    {
      continue;
    }
    const std::string content = ReadWholeFile(entry.path().string(), GreatestFile);
    parts["file " + name] = ToHex(HashOf(content.data(), content.size()));
    if (entry.path().extension() == ".banyan")
    {
      const std::string series = entry.path().stem().string();
      try
      {
        ReadSeries(entry.path().string(), series, parts);
      }
      catch (const Error& failure)
      {
        parts[series + " as a whole"] = failure.what();
      }
    }
  }
  return parts;
}

GoldenParts LoadChecksums(const std::string& folder)
{
  std::istringstream lines(ReadWholeFile(folder + "/" + ChecksumFile, GreatestFile));
  GoldenParts parts;
  for (std::string line; std::getline(lines, line);)
  {
    const std::size_t colon = line.find(": ");
    if (line.empty() || line[0] == '#')
    {
      continue;
    }
    if (colon == std::string::npos ||
        !parts.emplace(line.substr(0, colon), line.substr(colon + 2)).second)
    {
      throw Error("The line '" + line + "' of the checksums is no 'part: text', or there twice",
        { folder + "/" + ChecksumFile });
    }
  }
  return parts;
}

void SaveChecksums(const std::string& folder, const GoldenParts& parts)
{
  std::string text = "# What the series of this folder have to be read as; see ../README.md.\n";
  for (const auto& part : parts)
  {
    text += part.first + ": " + part.second + "\n";
  }
  WriteFileAtomically(folder + "/" + ChecksumFile, text);
}

std::vector<std::string> Differences(const GoldenParts& expected, const GoldenParts& found)
{
  std::vector<std::string> sentences;
  for (const auto& part : expected)
  {
    const auto other = found.find(part.first);
    if (other == found.end())
    {
      sentences.push_back("'" + part.first + "' is listed and was not found.");
    }
    else if (other->second != part.second)
    {
      sentences.push_back("'" + part.first + "' was read as '" + other->second +
                          "' and has to be '" + part.second + "'.");
    }
  }
  for (const auto& part : found)
  {
    if (expected.count(part.first) == 0)
    {
      sentences.push_back("'" + part.first + "' was found and is not listed.");
    }
  }
  return sentences;
}

namespace
{

/// Values at points or cells as the image that is encoded.
Bytes ImageOf(
  const GoldenCase& series, const GoldenArray& array, const Bytes& values, ThreadPool& pool)
{
  if (!series.OnMesh && !series.OnCells)
  {
    return values;
  }
  const MeshValues where = array.CellArray.empty() ? MeshValues::OfPoints : MeshValues::OfCells;
  const auto components = static_cast<int>(array.Components.size());
  Bytes image(
    static_cast<std::size_t>(series.Domain.Extent.Count() * components) * SizeOf(array.Type));
  (series.OnMesh ? AtlasValues(GoldenMesh().Mesh, where) : AtlasValues(GoldenCells().Mesh, where))
    .ToImage(array.Type, values.data(), components, {}, image.data(), pool);
  return image;
}

/// Writes the mesh of a series that has one.
std::shared_ptr<MeshPlan> PlanOf(const GoldenCase& series, const std::string& path)
{
  if (!series.OnMesh && !series.OnCells)
  {
    return nullptr;
  }
  SegmentFolder folder(path);
  std::shared_ptr<MeshPlan> plan =
    series.OnMesh ? WriteMesh(*GoldenMesh().Mesh, folder) : WriteCells(*GoldenCells().Mesh, folder);
  for (const GoldenArray& array : series.Arrays)
  {
    if (!array.CellArray.empty())
    {
      plan->CellArrays[array.Name] = array.CellArray;
    }
  }
  return plan;
}

/// The points of a golden series at a step, small whole numbers: those of step 0 until step 2, then
/// others.
std::vector<std::vector<double>> GoldenPoints(const GoldenCase& series, int step)
{
  const glm::ivec3 samples = series.Domain.Samples();
  const int moved = step < 2 ? 0 : 1;
  std::vector<std::vector<double>> points(3);
  const bool curvilinear = series.Options.Points->Kind == GridKind::Curvilinear;
  for (int axis = 0; axis < 3 && !curvilinear; ++axis)
  {
    for (int i = 0; i < samples[axis]; ++i)
    {
      points[static_cast<std::size_t>(axis)].push_back(i * i + 10 * axis + moved);
    }
  }
  const auto bend = [&](const glm::ivec3& s)
  {
    for (const int number : { 16 * s.x + s.y * s.y, 16 * s.y - s.z * s.x, 16 * s.z + moved * s.x })
    {
      points[0].push_back(number);
    }
  };
  if (curvilinear)
  {
    ForPositions({ glm::ivec3(0), samples }, bend);
  }
  return points;
}

PointsView ViewOf(const GoldenCase& series, const std::vector<std::vector<double>>& points)
{
  PointsView view;
  view.Form = *series.Options.Points;
  view.Samples = series.Domain.Samples();
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    view.Values[axis] = points[axis].data();
  }
  return view;
}

} // namespace

SeriesIndex WriteGoldenSeries(const std::string& folder, const GoldenCase& series)
{
  const std::string path = folder + "/" + series.Name + ".banyan";
  ThreadPool pool(2);
  EncodeOptions options = series.Options;
  options.Mesh = PlanOf(series, path);
  std::vector<ArrayDescription> descriptions;
  for (const GoldenArray& array : series.Arrays)
  {
    descriptions.push_back(GoldenDescription(series, array));
  }
  SeriesEncoder encoder(path, series.Domain, descriptions, options, pool);
  encoder.SetActiveScalars(series.Arrays.back().Name);
  for (int step = 0; step < series.Steps; ++step)
  {
    std::vector<Bytes> values;
    std::vector<ArrayValues> borrowed;
    for (const GoldenArray& array : series.Arrays)
    {
      values.push_back(ImageOf(series, array, GoldenValues(series, array, step), pool));
      borrowed.push_back({ values.back().data() });
    }
    if (options.Points)
    {
      encoder.SetPoints(ViewOf(series, GoldenPoints(series, step)));
    }
    if (series.OnCells && step == 2)
    {
      const GoldenCells cells;
      SegmentFolder folder(path);
      encoder.SetMovedPoints(
        WriteMovedPoints(*cells.Mesh, cells.PointsAt(step).data(), step, folder));
    }
    encoder.AddStep(GoldenTime(step), borrowed);
  }
  return encoder.Finish();
}

int VersionOf(const std::string& indexPath)
{
  std::istringstream text(ReadWholeFile(indexPath, GreatestFile));
  std::string word;
  int version = 0;
  text >> word >> version;
  return version;
}

} // namespace banyan::testing
