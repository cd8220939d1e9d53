# SPDX-License-Identifier: BSD-3-Clause
"""python3 demo_report.py FOLDER RANKS STAGE=SECONDS...

Puts the reports of the stages together as FOLDER/report.json and prints its main figures.
"""

import json
import os
import statistics
import sys


def read(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return json.load(file)


def medians_by_kind(frames):
    """Seconds in the volume by the first word of the files' names: plain, enhanced."""
    kinds = {}
    for frame in frames:
        kinds.setdefault(frame["file"].split("_")[0], []).append(frame["statistics"]["TotalSeconds"])
    return {kind: statistics.median(seconds) for kind, seconds in kinds.items()}


def summary(frames):
    """Figures over all frames but the first, which also loads and compiles."""
    steady = frames[1:] or frames
    return {"median_seconds_per_frame": statistics.median(f["seconds"] for f in steady),
            "median_seconds_in_the_volume": statistics.median(
                f["statistics"]["TotalSeconds"] for f in steady)}


def main():
    folder, ranks, stages = sys.argv[1], int(sys.argv[2]), sys.argv[3:]
    encode, measure, draw = (read(folder, name) for name in
                             ("encode.json", "measure.json", "draw.json"))
    size, raw = encode["bytes_encoded"], measure["bytes_raw"]
    points = encode["steps"] * encode["points"]
    report = {
        "input": {"files": encode["files"], "steps": encode["steps"],
                  **{name: encode[name] for name in ("dimensions", "points", "cells")
                     if name in encode}, "bytes": raw},
        "series": {"file": "series.banyan", "bytes": size, "ratio": raw / size,
                   "bits_per_point": 8.0 * size / points, "arrays": measure["arrays"],
                   "encode_megabytes_per_second": raw / 1e6 / encode["seconds"]},
        "drawing": {"representation": draw["representation"], "ranks": ranks,
                    "image_size": draw["image_size"], "paraview": draw["paraview"],
                    **summary(draw["frames"]), "frames": draw["frames"]},
        "animation": "animation.mp4",
        "seconds": {name: float(value) for name, value in
                    (stage.split("=", 1) for stage in stages)}}
    with open(os.path.join(folder, "report.json"), "w", encoding="utf-8") as file:
        json.dump(report, file, indent=2, allow_nan=False)
        file.write("\n")

    print(f"      {raw / 1e6:.1f} MB became {size / 1e6:.2f} MB: ratio {raw / size:.1f}",
          file=sys.stderr)
    for array in measure["arrays"]:
        for component in array["components"]:
            quality = "bit-exact" if component["psnr_db"] is None else \
                f"PSNR {component['psnr_db']:.1f} dB"
            print(f"      {array['name']}: largest error {component['max_error']:.3g}, "
                  f"{component['error_bound_absolute']:.3g} allowed, {quality}", file=sys.stderr)
    print(f"      {report['drawing']['median_seconds_per_frame']:.2f} s per frame, of which "
          f"{report['drawing']['median_seconds_in_the_volume']:.2f} s in the volume",
          file=sys.stderr)
    kinds = medians_by_kind(draw["frames"])
    if len(kinds) > 1:
        print("      in the volume: " + ", ".join(
            f"{kind} {1e3 * seconds:.0f} ms" for kind, seconds in kinds.items()), file=sys.stderr)


main()
