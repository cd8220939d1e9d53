# SPDX-License-Identifier: BSD-3-Clause
"""The filters that test_filters.py compares: name -> function from a source to the filter."""
from paraview import simple

import session

# The grid of test_filters.py: 41 x 34 x 29 samples, unit spacing, from (0, 0, 0).
CENTRE = [20.0, 16.0, 14.0]
TOP = [40.0, 33.0, 28.0]


def isolated(kind, source, **properties):
    """A filter with those properties that ParaView does not make a default of the data for."""
    return getattr(simple, kind)(Input=source, **properties)


def slice_(s):
    f = isolated("Slice", s, SliceType="Plane")
    f.SliceType.Origin, f.SliceType.Normal = CENTRE, [0.3, 1.0, 0.2]
    return f


def clip(s):
    f = isolated("Clip", s, ClipType="Plane")
    f.ClipType.Origin, f.ClipType.Normal = CENTRE, [1.0, 0.5, 0.0]
    return f


def clip_by_scalar(s):
    return isolated("Clip", s, ClipType="Scalar", Scalars=["POINTS", "p"], Value=0.4)


def contour(s):
    return isolated("Contour", s, ContourBy=["POINTS", "p"], Isosurfaces=[0.3, 0.6],
                    ComputeScalars=1)


def threshold(s):
    return isolated("Threshold", s, Scalars=["POINTS", "p"], LowerThreshold=0.3,
                    UpperThreshold=0.7)


def threshold_of_vectors(s):
    return isolated("Threshold", s, Scalars=["POINTS", "v"], LowerThreshold=0.2,
                    UpperThreshold=0.9)


def calculator(s):
    return isolated("Calculator", s, Function="p*2 + mag(v)", ResultArrayName="r")


def python_calculator(s):
    return isolated("PythonCalculator", s, Expression="sqrt(abs(p)) + v[:,0]", ArrayName="r")


def programmable(s):
    return isolated(
        "ProgrammableFilter", s, CopyArrays=1,
        Script="output.PointData.append(inputs[0].PointData['p'] * 3, 'r')")


def gradient(s):
    return isolated("Gradient", s, ScalarArray=["POINTS", "p"])


def gradient_of_vectors(s):
    return isolated("Gradient", s, ScalarArray=["POINTS", "v"], ComputeVorticity=1,
                    ComputeDivergence=1, ComputeQCriterion=1)


def probe(s):
    f = simple.ProbeLocation(Input=s, ProbeType="Fixed Radius Point Source")
    # More points would be random ones.
    f.ProbeType.Center, f.ProbeType.NumberOfPoints, f.ProbeType.Radius = [19.3, 15.2, 14.9], 1, 0
    return f


def line(s):
    return isolated("PlotOverLine", s, Point1=[0.5, 1.0, 2.0], Point2=TOP, Resolution=200)


def resample_to_image(s):
    return isolated("ResampleToImage", s, SamplingDimensions=[17, 18, 19])


def resample_with_dataset(s):
    ball = simple.Sphere(Center=CENTRE, Radius=10.0, ThetaResolution=24, PhiResolution=24)
    return simple.ResampleWithDataset(SourceDataArrays=s, DestinationMesh=ball)


def stream_tracer(s):
    f = simple.StreamTracer(Input=s, SeedType="Line", Vectors=["POINTS", "v"],
                            MaximumStreamlineLength=60.0)
    f.SeedType.Point1, f.SeedType.Point2, f.SeedType.Resolution = [5, 5, 5], TOP, 15
    return f


def glyph(s):
    return isolated("Glyph", s, GlyphType="Arrow", OrientationArray=["POINTS", "v"],
                    ScaleArray=["POINTS", "p"], ScaleFactor=1.0, GlyphMode="Every Nth Point",
                    Stride=97)


def iso_volume(s):
    return isolated("IsoVolume", s, InputScalars=["POINTS", "p"], ThresholdRange=[0.3, 0.5])


def transform(s):
    f = isolated("Transform", s, Transform="Transform")
    f.Transform.Rotate, f.Transform.Translate = [10.0, 20.0, 30.0], [1.0, 2.0, 3.0]
    return f


def extract_subset(s):
    return isolated("ExtractSubset", s, VOI=[3, 30, 5, 33, 7, 8])


def to_cells(s):
    return isolated("PointDatatoCellData", s, PassPointData=1)


def to_cells_and_back(s):
    return simple.CellDatatoPointData(Input=isolated("PointDatatoCellData", s))


def connectivity(s):
    return simple.Connectivity(Input=threshold(s))


def smooth(s):
    return simple.Smooth(Input=contour(s), NumberofIterations=5)


def histogram(s):
    return isolated("Histogram", s, SelectInputArray=["POINTS", "p"], BinCount=13)


def statistics(s):
    return isolated("DescriptiveStatistics", s, VariablesofInterest=["p"], TrainingFraction=1.0)


def statistics_over_time(s):
    return isolated("TemporalStatistics", s)


def averages_over_time(s):
    """VTK 9.2 ends the process here when arrays are deferred."""
    return isolated("TemporalStatistics", s, ComputeStandardDeviation=0)


def contingency(s):
    return isolated("ContingencyStatistics", s, VariablesofInterest=["n", "p"],
                    TrainingFraction=1.0)


def deflect_normals(s):
    """VTK 9.2 gives nothing but an error when vectors are deferred."""
    return isolated("DeflectNormals", s, UseUserNormal=1, Vectors=["POINTS", "v"])


def histogram_of_two(s):
    """ParaView looks at arrays before the update, and goes through them after it."""
    s.UpdatePipeline(1.0)
    return isolated("Histogram2D", s, InputArrayforXAxis=["POINTS", "p"],
                    InputArrayforYAxis=["POINTS", "v"], UseCustomBinRangesforXAxis=1,
                    CustomBinRangesforXAxis=[0, 1], UseCustomBinRangesforYAxis=1,
                    CustomBinRangesforYAxis=[-1, 1], NumberofBins=[17, 19])


FILTERS = {
    "slice": slice_,
    "clip": clip,
    "clip by scalar": clip_by_scalar,
    "contour": contour,
    "threshold": threshold,
    "threshold of vectors": threshold_of_vectors,
    "calculator": calculator,
    "python calculator": python_calculator,
    "programmable filter": programmable,
    "gradient": gradient,
    "gradient of vectors": gradient_of_vectors,
    "probe": probe,
    "plot over line": line,
    "resample to image": resample_to_image,
    "resample with dataset": resample_with_dataset,
    "stream tracer": stream_tracer,
    "glyph": glyph,
    "iso volume": iso_volume,
    "transform": transform,
    "extract subset": extract_subset,
    "point data to cell data": to_cells,
    "cell data to point data": to_cells_and_back,
    "connectivity": connectivity,
    "smooth": smooth,
    "histogram": histogram,
    "descriptive statistics": statistics,
    "warp by vector": lambda s: isolated("WarpByVector", s, Vectors=["POINTS", "v"]),
    "warp by scalar": lambda s: isolated("WarpByScalar", s, Scalars=["POINTS", "p"],
                                         ScaleFactor=3.0),
    "integrate variables": lambda s: isolated("IntegrateVariables", s),
    "extract surface": lambda s: isolated("ExtractSurface", s),
    "extract component": lambda s: isolated("ExtractComponent", s,
                                            InputArray=["POINTS", "v"]),
    "cell centers": lambda s: isolated("CellCenters", to_cells(s)),
    "clean to grid": lambda s: isolated("CleantoGrid", s),
    "tetrahedralize": lambda s: isolated("Tetrahedralize", s),
    "shrink": lambda s: isolated("Shrink", s),
    "append attributes": lambda s: simple.AppendAttributes(Input=[s, calculator(s)]),
    "pass arrays": lambda s: isolated("PassArrays", s, PointDataArrays=["p"]),
    "group datasets": lambda s: simple.GroupDatasets(Input=[s, slice_(s)]),
    "temporal statistics": statistics_over_time,
    "averages over time": averages_over_time,
    "contingency statistics": contingency,
    "deflect normals": deflect_normals,
    "2D histogram": histogram_of_two,
    "temporal interpolator": lambda s: isolated("TemporalInterpolator", s),
    "outline": lambda s: isolated("Outline", s),
    "image to points": lambda s: isolated("ImageDatatoPointSet", s),
    "ghost cells": lambda s: session.ghost_cells(Input=s, BuildIfRequired=0),
    "redistribute": lambda s: simple.RedistributeDataSet(Input=s, NumberOfPartitions=3),
    "decode": lambda s: isolated("BanyanDecode", s),
}
