# SPDX-License-Identifier: BSD-3-Clause
"""What happens to a job when something happens to one of its ranks.

    lost_rank.py MISHAP LIMIT LAUNCHER...

Starts the launcher (mpiexec and the program), which loses rank 1 in the middle of frames. Checks
that the job ends in time, with the sentence that it should, or that it goes on where it should."""
import os
import signal
import subprocess
import sys
import time

# What must be said, or None where the job must go on.
SENTENCES = {
    "killed": None,  # by the launcher, in its own words, or by us
    "stopped": "Rank 1 (process {process}) has given no sign of life for",
    "stopped-elsewhere": "Rank 1 (process {process}) has given no sign of life for",
    "loops": "Rank 1 (process {process}) runs, but has not got on for",
    "throws": "Rank 1 failed alone, and the others wait for it. There is a worm in it.",
    "waits": "All ranks have waited for each other for",
}
GOES_ON = ("slow", "disk", "pipeline", "all-throw")


def fail(sentence, output):
    print(output)
    sys.exit("lost_rank.py: " + sentence)


def main():
    mishap, limit = sys.argv[1], float(sys.argv[2])
    environment = dict(os.environ, BANYAN_RANK_LIMIT_SECONDS=sys.argv[2])
    begin = time.monotonic()
    job = subprocess.Popen(sys.argv[3:] + [mishap], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                           text=True, env=environment, start_new_session=True)
    process, lines, lost_at = None, [], None
    # Ends the launcher, and the ranks with it, when the test has to.
    signal.signal(signal.SIGALRM, lambda *_: job.terminate())
    signal.alarm(int(limit) + 60)
    for line in job.stdout:
        lines.append(line)
        if line.startswith("process "):
            process, lost_at = line.split()[1], time.monotonic()
    status = job.wait()
    end = time.monotonic()
    output = "".join(lines)
    if process is None:
        fail("no rank came to where something happens to it.", output)
    print(f"{mishap}: the job ended with status {status} {end - lost_at:.1f} s after it happened, "
          f"{end - begin:.1f} s after it began")
    if mishap in GOES_ON:
        if status != 0 or "all frames are drawn" not in output:
            fail("the job had to go on, and did not.", output)
        return
    print(output)
    if status == 0:
        fail("the job had to fail, and did not.", output)
    if end - lost_at > limit + 10:
        fail(f"the job took {end - lost_at:.0f} s to end.", output)
    sentence = SENTENCES[mishap]
    if sentence is None:
        if "signal 9" not in output and "no sign of life" not in output:
            fail("nobody said that a rank was killed.", output)
        return
    if "banyan: " + sentence.format(process=process) not in output:
        fail(f"the sentence '{sentence.format(process=process)}' is missing.", output)
    if "told before" not in output and mishap != "stopped-elsewhere":
        fail("nobody was told before the job ended.", output)


main()
