# SPDX-License-Identifier: BSD-3-Clause
"""goals.py RAYCAST.csv [TABLE.csv...] : prints how many times faster than VTK's GPU mapper the ray caster
is in the standard scenes, beside what the design asks for, and the verdicts of more tables (verdicts.py).
goals.py --needed RAYCAST.csv : prints for each scene which settings say so. Errors do not depend on the
number of threads, so no other one has to be measured with fewer of them."""

import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402
from verdicts import WORDS, lines_of, show, verdict  # noqa: E402

OURS = "banyan"
PEER = "vtk-gpu"
# Rounding to 8 bits may add a half to an error of 1.
LARGEST_ERROR = 1.5
CRITERIA = (("one sample per voxel", lambda row: row["sample_distance"] == 1.0),
            ("40 dB or better", lambda row: row["psnr_db"] >= 40.0),
            ("50 dB or better", lambda row: row["psnr_db"] >= 50.0),
            ("no pixel off by more than 1/255", lambda row: row["max_error"] <= LARGEST_ERROR))
# By function and whether it is shaded: at equal step, and at equal error.
AT_EQUAL_STEP = {("S1", False): 6, ("S1", True): 11, ("S2", False): 15, ("S2", True): 35}
AT_EQUAL_ERROR = {("S1", False): 10, ("S2", False): 25}


def is_standard(scene):
    return scene.split("-")[0] in ("S1", "S2")


def goal_of(scene, criterion):
    """The ratio that is asked for, or nothing."""
    kind = (scene.split("-")[0], scene.endswith("-shaded"))
    goals = AT_EQUAL_STEP if criterion == CRITERIA[0][0] else AT_EQUAL_ERROR
    return goals.get(kind)


def quickest(rows, renderer, good):
    """Milliseconds of the quickest setting that is good enough: infinite when none is, not a number
    when the renderer was not measured."""
    times = [(row["ms_per_frame"], good(row)) for row in rows if row["renderer"] == renderer]
    return min((time for time, is_good in times if is_good),
               default=math.inf if times else math.nan)


def ratio(ours, peer):
    return f"{peer / ours:.1f}" if math.isfinite(ours) and math.isfinite(peer) else "-"


def milliseconds(value):
    return "-" if math.isnan(value) else "never" if math.isinf(value) else f"{value:.0f}"


def judged(ours, peer, goal):
    """Whether a goal is kept; nothing where there is none, or nothing to compare with."""
    if not goal or math.isnan(ours) or math.isnan(peer):
        return ""
    return verdict(math.isfinite(ours) and peer / ours >= goal)


def lines(rows):
    """The table, line by line, in the way that the documents have it."""
    yield f"| scene | at | threads | {OURS} ms | {PEER} ms | times faster | goal | |"
    yield "|---|---|---|---|---|---|---|---|"
    for scene in filter(is_standard, in_order(rows, "scene")):
        for criterion, good in CRITERIA:
            for threads in in_order(rows, "threads"):
                here = [row for row in rows if row["scene"] == scene and row["threads"] == threads]
                ours, peer = (quickest(here, name, good) for name in (OURS, PEER))
                goal = goal_of(scene, criterion)
                yield (f"| {scene} | {criterion} | {threads:g} | {milliseconds(ours)} | "
                       f"{milliseconds(peer)} | {ratio(ours, peer)} | {goal or '-'} | {judged(ours, peer, goal)} |")


def speed_ups(rows):
    """How many times faster one sample per voxel is with all threads than with one."""
    most = max(row["threads"] for row in rows)
    if most == 1.0 or min(row["threads"] for row in rows) != 1.0:
        return
    yield f"| scene | {OURS}, 1 thread ms | {most:g} threads ms | times faster | of the ideal |"
    yield "|---|---|---|---|---|"
    for scene in in_order(rows, "scene"):
        one, all_ = (quickest([row for row in rows if row["scene"] == scene and
                               row["threads"] == threads], OURS, CRITERIA[0][1])
                     for threads in (1.0, most))
        if math.isfinite(one) and math.isfinite(all_):
            yield (f"| {scene} | {one:.0f} | {all_:.0f} | {one / all_:.2f} | "
                   f"{100.0 * one / all_ / most:.0f} % |")


def estimates(rows):
    """Whether the worst pixel of each scene is off by no more than was estimated, whatever the tolerance."""
    yield "| scene | renderer | tolerances | worst pixel over what was estimated | |"
    yield "|---|---|---|---|---|"
    for scene, renderer in dict.fromkeys((row["scene"], row["renderer"]) for row in rows):
        found = [(row["max_error_unrounded"] / row["estimated_error"], row["tolerance"]) for row in rows
                 if row["scene"] == scene and row["renderer"] == renderer and row.get("estimated_error")]
        if found:
            missed = ", ".join(f"{tolerance:g}" for ratio_, tolerance in sorted(found, key=lambda f: f[1])
                               if ratio_ > 1.0)
            verdict = f"not held at {missed}" if missed else "held"
            yield f"| {scene} | {renderer} | {len(found)} | {max(found)[0]:.2f} | {verdict} |"


def trees(rows):
    """Which part of a first frame the tree of its values takes, where it is made on the fly."""
    yield "| scene | renderer | threads | at | tree ms | first frame ms | part |"
    yield "|---|---|---|---|---|---|---|"
    for row in rows:
        if row.get("tree_ms"):
            sampling = (f"tolerance {row['tolerance']:g}" if row["tolerance"]
                        else f"step {row['sample_distance']:g}")
            yield (f"| {row['scene']} | {row['renderer']} | {row['threads']:g} | {sampling} | {row['tree_ms']:.1f} | "
                   f"{row['first_frame_ms']:.1f} | {100.0 * row['tree_ms'] / row['first_frame_ms']:.0f} % |")


def plans(rows):
    """Which part of a frame finding its samplings takes."""
    yield "| scene | renderer | threads | tolerance | frame ms | distances and levels | pixels without rays |"
    yield "|---|---|---|---|---|---|---|"
    for row in rows:
        if row.get("probe_ms") is not None:
            parts = (100.0 * row[column] / row["ms_per_frame"] for column in ("probe_ms", "stride_ms"))
            yield (f"| {row['scene']} | {row['renderer']} | {row['threads']:g} | {row['tolerance']:g} | "
                   f"{row['ms_per_frame']:.1f} | " + " | ".join(f"{part:.0f} %" for part in parts) + " |")


def needed(rows):
    """A scene and its settings per line, separated by commas."""
    for scene in in_order(rows, "scene"):
        settings = {1.0}
        for renderer in (OURS, PEER) if is_standard(scene) else ():
            here = [row for row in rows if row["scene"] == scene and row["renderer"] == renderer]
            for _, good in CRITERIA:
                best = min(filter(good, here), key=lambda row: row["ms_per_frame"], default=None)
                if best:
                    settings.add(best["tolerance"] or best["sample_distance"])
        yield f"{scene} " + ",".join(f"{number:g}" for number in sorted(settings))


def main(path, others):
    rows = read(path, ("scene", "renderer"))
    print("Goals: how many times faster than VTK's GPU mapper, quickest settings that are good enough")
    print("\n".join(lines(rows)))
    print("\nEstimates: what is said to be the largest error, and what it is")
    print("\n".join(estimates(rows)))
    print("\nTrees: made on the fly in the first frame of a scene")
    print("\n".join(trees(rows)))
    print("\nPlans: what is part of a frame, to keep its tolerance")
    print("\n".join(plans(rows)))
    print("\nThreads: one sample per voxel")
    print("\n".join(speed_ups(rows)))
    verdicts = [line for other in others for line in lines_of(read(other, WORDS))]
    if verdicts:
        print("\nSizes and meshes")
        show(verdicts)


if len(sys.argv) == 3 and sys.argv[1] == "--needed":
    print("\n".join(needed(read(sys.argv[2], ("scene", "renderer")))))
elif len(sys.argv) > 1:
    main(sys.argv[1], sys.argv[2:])
else:
    sys.exit(__doc__)
