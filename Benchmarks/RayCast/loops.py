# SPDX-License-Identifier: BSD-3-Clause
"""loops.py perf LIBRARY PERF.data : prints which part of the time of PacketMarcher's functions goes into each
of their loops, from `perf record`.
loops.py callgrind FILE.out : prints how often the instructions of MarchPackets were executed, those that were as often
as each other together, and how many of their reads missed the first cache and the last, from `valgrind --tool=callgrind --dump-instr=yes --cache-sim=yes`.
Documentation/measurements/raycasting.md has the commands that make both files."""

import collections
import re
import subprocess
import sys

MARCHER = "PacketMarcher<banyan::"
PACKETS = "MarchPackets<"
SMALLEST_LOOP = 100  # instructions


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def function_of(symbol):
    """Without its arguments, which are not always there."""
    return symbol.split("::March")[0]


def marchers(library):
    """Name, address and bytes of the functions for the newest processors."""
    for line in output_of("nm", "-C", "--defined-only", "-S", library):
        match = re.match(r"([0-9a-f]+) ([0-9a-f]+) [tW] (.*N_AVX3::" + MARCHER + ".*)", line)
        if match:
            yield function_of(match[3]), int(match[1], 16), int(match[2], 16)


def loops_of(library, start, size):
    """Addresses and the number of instructions of loops, by their jumps back."""
    places = []
    for line in output_of("objdump", "-d", "--no-show-raw-insn", f"--start-address={start}",
                          f"--stop-address={start + size}", library):
        match = re.match(r"\s*([0-9a-f]+):\s+(\S+)\s*([0-9a-f]*)", line)
        if match:
            places.append((int(match[1], 16), match[2], match[3]))
    for place, word, target in places:
        if word.startswith("j") and target and start <= int(target, 16) < place:
            first = int(target, 16)
            yield first, place, sum(first <= other[0] <= place for other in places)


def of_time(library, data):
    """Samples by the clock, per function and loop."""
    hits = collections.defaultdict(collections.Counter)
    total = 0
    for line in output_of("perf", "script", "-i", data, "-F", "ip,sym,symoff"):
        total += 1
        match = re.match(r"\s*[0-9a-f]+ (.*)\+0x([0-9a-f]+)$", line)
        if match and MARCHER in match[1]:
            hits[function_of(match[1])][int(match[2], 16)] += 1
    print(f"{total} samples in all")
    for name, start, size in marchers(library):
        here = hits.get(name, {})
        count = sum(here.values())
        if count < 0.01 * total:
            continue
        print(f"{count} in {name}")
        for first, last, instructions in loops_of(library, start, size):
            inside = sum(number for offset, number in here.items() if first <= start + offset <= last)
            if instructions >= SMALLEST_LOOP:
                print(f"  {first - start:#x} to {last - start:#x}: {instructions} instructions, "
                      f"{100.0 * inside / count:.1f} %")


def executed(path):
    """Per function of PACKETS and address: instructions, and reads that miss the first cache and the last."""
    names = {}
    costs = collections.defaultdict(lambda: collections.defaultdict(lambda: [0, 0, 0]))
    columns = []
    function, address, is_call = "", 0, False
    for line in open(path, encoding="utf-8"):
        match = re.match(r"(c?)fn=\((\d+)\)(?: (.*))?", line)
        if line.startswith("events:"):
            events = line.split()[1:]
            columns = [events.index(name) for name in ("Ir", "D1mr", "DLmr")]
        elif match:
            names.setdefault(match[2], match[3] or "")
            function = function if match[1] else names[match[2]]
        elif line.startswith("calls="):
            is_call = True
        elif re.match(r"[0-9*+-]", line):
            fields = line.split()
            if fields[0][0] in "+-":
                address += int(fields[0], 0)
            elif fields[0] != "*":
                address = int(fields[0], 0)
            if not is_call and PACKETS in function:
                numbers = [int(field) for field in fields[2:]]
                numbers += [0] * (max(columns) + 1 - len(numbers))
                for i, column in enumerate(columns):
                    costs[function][address][i] += numbers[column]
            is_call = False
    return costs


def of_instructions(path):
    for function, here in executed(path).items():
        groups = collections.defaultdict(lambda: [0, 0, 0])
        for times, first, last in here.values():
            for i, number in enumerate((1, first, last)):
                groups[times][i] += number
        print(f"{sum(cost[0] for cost in here.values())} instructions in {function.split('(')[0]}")
        ordered = sorted(groups.items(), key=lambda item: -item[0] * item[1][0])
        for times, (instructions, first, last) in ordered[:8]:
            print(f"  {instructions} instructions {times} times each: {first} misses, {last} of the last cache")


if len(sys.argv) == 4 and sys.argv[1] == "perf":
    of_time(sys.argv[2], sys.argv[3])
elif len(sys.argv) == 3 and sys.argv[1] == "callgrind":
    of_instructions(sys.argv[2])
else:
    sys.exit(__doc__)
