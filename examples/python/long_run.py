# SPDX-License-Identifier: BSD-3-Clause
"""One long run of the tactus command: what it says goes to a log, and the ends of trials, with the time that the rest will take, to the
screen."""

import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def span(seconds):
    return f"{seconds / 3600:.1f} h" if seconds > 5400 else f"{seconds / 60:.0f} min" if seconds > 90 else f"{seconds:.0f} s"


def report(lines, log):
    """Keeps every line in the log; shows the ends of trials, with the time that the rest will take."""
    began, ended = time.monotonic(), 0
    for line in lines:
        log.write(line)
        done = re.search(r"ended: .*; (\d+) of (\d+) trials", line)
        if done:
            ended += 1
            left = (int(done[2]) - int(done[1])) * (time.monotonic() - began) / ended
            print(f"    {line.strip()}, {span(left)} to go", flush=True)
        elif not line.startswith("seed "):
            print(f"    {line.strip()}", flush=True)


def run(title, words, path):
    """Runs `words` in the project's folder and keeps what it says in the log at `path`, behind what is there. Ends the program if the
    command fails; kills the command if the program is stopped."""
    print(f"\n==> {title}\n    {' '.join(words)}", flush=True)
    with open(path, "a", buffering=1) as log:
        with subprocess.Popen(words, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
            try:
                report(process.stderr, log)
            except BaseException:
                process.kill()
                raise
    if process.returncode not in (0, 1):  # 1: some were not inserted
        sys.exit(f"error: {words[0]} {words[1]} ended with status {process.returncode}; what it said is above and in {path}")
