# SPDX-License-Identifier: BSD-3-Clause
"""report.py DIR FILM : draws the chart of interaction-quality.csv in DIR, prints interaction.csv as a table, and makes
DIR/interaction.mp4 of what drive_window.py has left in the folders of FILM, one for each mode."""

import json
import math
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)
from matplotlib import font_manager  # noqa: E402
from matplotlib.ticker import LogLocator, NullLocator  # noqa: E402
from PIL import Image, ImageDraw, ImageFont  # noqa: E402

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402

WORDS = ("scene", "mode", "path")
KINDS = {"": ("Banyan Volume, Decoupled", "tab:blue"), "off": ("Banyan Volume, not Decoupled", "tab:red"),
         "volume": ("ParaView's own Volume", "tab:purple"),
         "remote": ("drawn by the server, Decoupled", "tab:green"),
         "remote-off": ("drawn by the server, not Decoupled", "tab:orange")}
PLACES = {"builtin": "without a server", "server": "with a server on this machine", "line": "with a server on a line"}
EQUAL_DB = 62  # where equal pictures are drawn
LATEST_MS = 1.3  # times the last picture's: where curves end
FRAMES_PER_SECOND = 25
PANEL = 600  # pixels of a film's panel
AFTER_S = 1.0  # how long a film goes on after the last picture


def kind_of(mode):
    return KINDS[mode.partition("-")[2]]


def table(rows):
    yield ("| scene | mode | path | move, ms: p50 | p95 | worst | first true, ms | exact, ms | synchronous, ms | kB up | kB down | "
           "dB moving |")
    yield "|---|---|---|---|---|---|---|---|---|---|---|---|"
    for row in rows:
        times = " | ".join(f"{row[name]:.0f}" for name in ("move_ms_p50", "move_ms_p95", "move_ms_worst", "first_true_ms",
                                                           "exact_ms", "synchronous_ms"))
        traffic = " | ".join("" if row[name] is None else f"{row[name] / 1e3:.0f}" for name in ("bytes_up", "bytes_down"))
        quality = "equal" if math.isinf(row["psnr_moving_p50"]) else f"{row['psnr_moving_p50']:.1f}"
        yield f"| {row['scene']} | {row['mode']} | {row['path']} | {times} | {traffic} | {quality} |"


def draw(rows, path):
    """Quality of what the window shows against the time after a move: a row of charts for each place of the server."""
    scenes = in_order(rows, "scene")
    places = [place for place in PLACES if any(row["mode"].partition("-")[0] == place for row in rows)]
    begin, end = min([20.0] + [row["ms"] for row in rows if row["ms"] > 0]), LATEST_MS * max(row["ms"] for row in rows)
    figure, grid = plot.subplots(len(places), len(scenes), figsize=(max(7.5, 4.4 * len(scenes)), 3.2 * len(places) + 0.9),
                                 squeeze=False, sharey=True)
    for down, place in enumerate(places):
        of_place = [row for row in rows if row["mode"].partition("-")[0] == place]
        for across, scene in enumerate(scenes):
            axes = grid[down][across]
            axes.set_visible(any(row["scene"] == scene for row in of_place))
            for mode in in_order([row for row in of_place if row["scene"] == scene], "mode"):
                of = [row for row in of_place if (row["scene"], row["mode"]) == (scene, mode)]
                label, color = kind_of(mode)
                # On a logarithmic axis the picture from before the move begins at the left edge.
                times = [begin] + [row["ms"] for row in of[1:]]
                heights = [min(row["psnr_db"], EQUAL_DB) for row in of]
                axes.step(times + [end], heights + heights[-1:], where="post", color=color, label=label, linewidth=1.8)
                axes.plot(times[1:], heights[1:], "o", color=color, markersize=4)
            axes.set_xscale("log")
            axes.xaxis.set_minor_locator(NullLocator())
            axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axes.xaxis.set_major_formatter("{x:g}")
            axes.xaxis.set_tick_params(labelbottom=True)
            axes.set_xlim(begin, end)
            axes.axhline(EQUAL_DB, color="tab:gray", linewidth=0.8, linestyle=":")
            axes.set_title(f"{scene}, {PLACES[place]}", fontsize=10)
            axes.grid(True, which="both", alpha=0.2)
        grid[down][0].set_ylabel("PSNR to the exact picture, dB")
    ticks = list(range(10, EQUAL_DB - 5, 10))
    grid[0][0].set_yticks(ticks + [EQUAL_DB], [str(tick) for tick in ticks] + ["equal"])
    for axes in grid[-1]:
        axes.set_xlabel("ms after a move of 5 degrees")
    labels = {}
    for axes in grid.flat:
        labels.update(zip(*reversed(axes.get_legend_handles_labels())))
    figure.legend(labels.values(), labels.keys(), loc="lower center", ncols=3, fontsize=9)
    figure.tight_layout(rect=(0, 0.45 / figure.get_figheight(), 1, 1))
    figure.savefig(path, dpi=110)


class Panel:
    """One mode's part of a film."""

    def __init__(self, folder):
        self.name = kind_of(folder.name)[0]
        told = json.loads((folder / "film.json").read_text(encoding="utf-8"))
        self.pictures, self.mouse, self.released = told["pictures"], told["mouse"], told["released"]
        self.rate = told["moves_per_second"]
        self.images = [Image.open(folder / f"{number}.png").convert("RGB").resize((PANEL, PANEL), Image.LANCZOS)
                       for number in range(len(self.pictures))]
        self.end = self.pictures[-1][0]

    def at(self, seconds, font):
        """What the window shows then, the mouse, and how old the picture is."""
        number = max(i for i, picture in enumerate(self.pictures) if picture[0] <= seconds)
        _, shown, exact = self.pictures[number]
        move = min(len(self.mouse) - 1, int(seconds * self.rate))
        behind = 0.0 if shown >= move else seconds - (shown + 1) / self.rate
        image = Image.new("RGB", (PANEL, PANEL + 64), "black")
        image.paste(self.images[number], (0, 64))
        drawn = ImageDraw.Draw(image)
        x, y = PANEL * self.mouse[move][0], 64 + PANEL * (1 - self.mouse[move][1])
        drawn.ellipse((x - 7, y - 7, x + 7, y + 7), outline="white", fill="orange" if seconds < self.released else "gray", width=2)
        drawn.text((8, 6), self.name, font=font, fill="white")
        state = {True: ", exact", False: ", not yet exact", None: ""}[exact]
        drawn.text((8, 34), f"{1e3 * seconds:.0f} ms: {1e3 * behind:.0f} ms behind the mouse{state}", font=font,
                   fill="lightgreen" if exact is not False and not behind else "orange")
        return image


def make_film(folder, path):
    """All modes side by side, in real time."""
    panels = [Panel(folder / mode) for mode in ("builtin", "builtin-off", "builtin-volume") if (folder / mode).is_dir()]
    if not panels:
        return
    font = ImageFont.truetype(font_manager.findfont("DejaVu Sans"), 20)
    width, height = PANEL * len(panels), PANEL + 64
    encoder = subprocess.Popen(
        ["ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-framerate",
         str(FRAMES_PER_SECOND), "-i", "-", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart", str(path)],
        stdin=subprocess.PIPE)
    frames = math.ceil((max(panel.end for panel in panels) + AFTER_S) * FRAMES_PER_SECOND)
    for frame in range(frames):
        image = Image.new("RGB", (width, height))
        for across, panel in enumerate(panels):
            image.paste(panel.at(frame / FRAMES_PER_SECOND, font), (across * PANEL, 0))
        encoder.stdin.write(image.tobytes())
    encoder.stdin.close()
    if encoder.wait() != 0:
        sys.exit("report.py: ffmpeg could not make the film.")


def main():
    folder, film = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    draw(read(folder / "interaction-quality.csv", WORDS), folder / "interaction.png")
    print("\n".join(table(read(folder / "interaction.csv", WORDS))))
    make_film(film, folder / "interaction.mp4")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main()
