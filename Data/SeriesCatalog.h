// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_SeriesCatalog_h
#define banyan_Data_SeriesCatalog_h

#include "GenerateOptions.h"
#include "ImageSeriesWriter.h"
#include "MeshSeriesWriter.h"

#include <functional>
#include <string>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Takes the steps of a series in order of time: the time, and the arrays that the options name,
/// in that order, N^3 tuples each.
using SeriesSink = std::function<void(double time, const std::vector<ImageArray>& arrays)>;

/// Takes a series piece by piece: whole slices of the first array, in order of memory and time.
using SlabSink = std::function<void(const std::vector<float>& values)>;

/// A step of a series on a mesh, which is the same each time.
struct MeshStep
{
  const OctreeMesh& Mesh;
  double Time;
  std::vector<NodeArray> Arrays; ///< those that the options name, in that order
  std::string About;             ///< a line on what the mesh can carry
};

/// Takes the steps of a series on a mesh in order of time.
using MeshSeriesSink = std::function<void(const MeshStep& step)>;

/// One kind of series that banyan-generate can make.
struct SeriesKind
{
  std::string Name;        ///< as `--series` takes it
  std::string FileName;    ///< start of the names of the files
  std::string Description; ///< one line for the help text
  /// What `--arrays` may name; the first is the default, on a mesh all of them.
  std::vector<std::string> Arrays;
  int DefaultSize = 128;
  int DefaultSteps = 50;
  double DefaultDuration = 1.0; ///< time of the last step; the first is at time 0
  /// Length of the box; sample i lies at i * Edge / N. 0 for unit spacing: sample i lies at i.
  double Edge = 1.0;
  bool Steady = false; ///< all steps have the same values
  /// Makes the series and hands every step to the sink. Equal options give equal bytes on the same
  /// machine, for any width of the pool. Throws Error when the simulation fails.
  std::function<void(const GenerateOptions& options, ThreadPool& pool, const SeriesSink& sink)>
    Generate;
  /// May be empty. The same values without ever holding a whole step: for `--raw` alone, and sizes
  /// that fit no memory.
  std::function<void(const GenerateOptions& options, ThreadPool& pool, const SlabSink& sink)>
    GenerateSlabs;
  /// Not empty for a series on a mesh, which has `--cells` instead of a size; `Generate` is empty
  /// then, and this makes the series as that does.
  std::function<void(const GenerateOptions& options, ThreadPool& pool, const MeshSeriesSink& sink)>
    GenerateMesh;
  std::int64_t DefaultCells = 0; ///< on a mesh
};

/// All kinds; the first is the one made when `--series` is not given. To add one, write a function
/// that returns its `SeriesKind` in a file of its own, and name it in the table in the .cxx.
const std::vector<SeriesKind>& SeriesCatalog();

/// The kind of that name. Throws Error, with a sentence that lists the names, when there is none.
const SeriesKind& FindSeriesKind(const std::string& name);

/// Time of a step in [0, options.Steps): evenly spaced from 0 to options.Duration. A series of one
/// step shows the end.
double TimeOfStep(const GenerateOptions& options, int step);

} // namespace banyan

#endif
