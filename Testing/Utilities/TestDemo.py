# SPDX-License-Identifier: BSD-3-Clause
"""TestDemo.py whole | earthquake | arguments | bad-input: runs Utilities/demo.sh from outside and looks at what it leaves behind."""

import glob
import json
import os
import subprocess
import sys
import tempfile

SKIPPED = 77
DEMO = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Utilities", "demo.sh")


def demo(folder, *arguments, seconds=280):
    """Runs the demonstration in a folder; returns its exit status and messages."""
    done = subprocess.run([DEMO, *arguments], cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=seconds, text=True, check=False)
    return done.returncode, done.stdout


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


def check_refused(folder, sentence, *arguments):
    """The demonstration must end with an error that says `sentence`, and leave nothing."""
    status, messages = demo(folder, *arguments)
    check(status != 0, f"{arguments} succeeded:\n{messages}")
    check(sentence in messages, f'{arguments} did not say "{sentence}":\n{messages}')
    check(os.listdir(folder) == [], f"{arguments} left {os.listdir(folder)}")


def test_arguments(folder):
    status, messages = demo(folder, "--help")
    check(status == 0, "--help failed")
    for option in ("--input", "--ranks", "--output", "--error-bound"):
        check(option in messages, f"--help does not explain {option}")
    check_refused(folder, "--ranks needs", "--ranks", "0")
    check_refused(folder, "--ranks needs a value", "--ranks")
    check_refused(folder, "--error-bound needs", "--error-bound", "1/0")
    check_refused(folder, "--error-bound needs", "--error-bound", "1.5")
    check_refused(folder, "--error-bound needs", "--error-bound", "-0.1")
    check_refused(folder, "--input needs", "--input", "--ranks", "2")
    check_refused(folder, "does not exist", "--input", "nowhere.vti")
    check_refused(folder, "--earthquake makes its own input", "--earthquake", "--input", "a.vti")
    check_refused(folder, "--cells needs", "--earthquake", "--cells", "many")
    check_refused(folder, "no option '--rank'", "--rank", "2")


def check_results(output, bound, ranks):
    with open(os.path.join(output, "report.json"), encoding="utf-8") as file:
        report = json.load(file)
    frames = sorted(glob.glob(os.path.join(output, "frame_*.png")))
    check(len(frames) == report["input"]["steps"] == len(report["drawing"]["frames"]) == 24,
          f"{len(frames)} frames")
    check(all(os.path.getsize(frame) > 10000 for frame in frames), "a frame looks empty")
    check(report["drawing"]["ranks"] == ranks, "ranks")
    check(report["series"]["ratio"] > 2, f"ratio {report['series']['ratio']}")
    component = report["series"]["arrays"][0]["components"][0]
    low, high = component["range"]
    check(component["within_bound"] and component["max_error"] <= bound * (high - low), "bound")
    check(component["max_error"] > 0, "an error of zero was not expected of lossy coding")
    check(component["psnr_db"] > 40, f"PSNR {component['psnr_db']}")
    check(any(frame["statistics"]["BricksDrawn"] > 0 for frame in report["drawing"]["frames"]),
          "no frame drew a brick")
    codec = subprocess.run(
        ["ffprobe", "-v", "error", "-show_entries", "stream=codec_name,pix_fmt,nb_frames", "-of",
         "default=nokey=1:noprint_wrappers=1", os.path.join(output, "animation.mp4")],
        stdout=subprocess.PIPE, text=True, check=True).stdout.split()
    check(codec == ["h264", "yuv420p", "24"], f"animation: {codec}")
    return report


def test_demo(folder):
    status, messages = demo(folder, "--size", "32", "--ranks", "2", "--error-bound", "1/256",
                            "--output", "out put")
    check(status == 0, messages)
    for number in range(1, 7):
        check(f"[{number}/6]" in messages, f"stage {number} was not announced:\n{messages}")
    output = os.path.join(folder, "out put")
    check_results(output, 1 / 256, 2)
    check(sorted(os.listdir(folder)) == ["out put"], f"left over: {os.listdir(folder)}")

    # The results are input as well, here on an odd number of ranks and into the same folder;
    # a series decoded and encoded again may be off by both bounds, but the second is kept.
    copy = os.path.join(folder, "copy")
    os.mkdir(copy)
    for name in ("series.banyan", "series.banyan.d"):
        os.rename(os.path.join(output, name), os.path.join(copy, name))
    status, messages = demo(folder, "--input", "copy/series.banyan", "--ranks", "3",
                            "--error-bound", "1/64", "--output", "out put")
    check(status == 0, messages)
    check_results(output, 1 / 64, 3)


def test_earthquake(folder):
    status, messages = demo(folder, "--earthquake", "--cells", "1000", "--output", "quake",
                            seconds=580)
    check(status == 0, messages)
    output = os.path.join(folder, "quake")
    with open(os.path.join(output, "report.json"), encoding="utf-8") as file:
        report = json.load(file)
    for kind in ("plain", "enhanced"):
        pictures = glob.glob(os.path.join(output, kind + "_*.png"))
        check(len(pictures) == report["input"]["steps"] == 81, f"{len(pictures)} {kind} pictures")
    for name in ("earthquake.png", "animation.mp4", "series.banyan"):
        check(os.path.getsize(os.path.join(output, name)) > 10000 or name == "series.banyan", name)
    for component in report["series"]["arrays"][0]["components"]:
        check(component["within_bound"] and component["max_error"] > 0, f"{component}")
    check(report["series"]["ratio"] > 4, f"ratio {report['series']['ratio']}")
    check(os.listdir(folder) == ["quake"], f"left over: {os.listdir(folder)}")


def test_bad_input(folder):
    data = os.path.join(os.environ.get("BANYAN_DATA_DIR", ""), "malformed_basic")
    if not os.path.isdir(data):
        print("BANYAN_DATA_DIR has no malformed_basic")
        sys.exit(SKIPPED)
    files = {"m01_short.mhd": "At step 0: The input cannot be read",
             "m03_missing.mhd": "At step 0: The input cannot be read",
             "v11_trunc.vti": "nothing could be read"}
    for name, sentence in files.items():
        check_refused(folder, sentence, "--input", os.path.join(data, name))
    dims = sorted(glob.glob(os.path.join(data, "series_trouble", "dims_*.vti")))
    changed = "At step 1 (time 1): The file does not fit the ones before: the extent was"
    check_refused(folder, changed, "--input", *dims)


def main():
    cases = {"arguments": test_arguments, "whole": test_demo, "earthquake": test_earthquake,
             "bad-input": test_bad_input}
    with tempfile.TemporaryDirectory() as folder:
        cases[sys.argv[1]](folder)


main()
