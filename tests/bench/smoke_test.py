# SPDX-License-Identifier: BSD-3-Clause
"""Runs a small part of the benchmark: the rows parse, and every answer agrees with FCL's."""

import json
import subprocess
import sys

KEYS = {"work", "pairs", "baseline_s", "ours_s", "ratio", "agreeing", "flips_within_1e-9", "threads", "memory_mib"}


def main(bench):
    command = [bench, "contact", "--works", "straight", "--pairs", "200", "--json", "-"]
    rows = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)["rows"]
    assert rows, "no rows"
    for row in rows:
        assert KEYS <= row.keys(), f"missing: {KEYS - row.keys()}"
        assert row["work"] == "straight" and row["pairs"] == 200, row
        assert row["agreeing"] == row["pairs"], row

    for suite in [["nonsense"], ["contact", "--works", "nonsense"], ["contact", "--pairs", "many"]]:
        refused = subprocess.run([bench, *suite], capture_output=True, text=True)
        assert refused.returncode == 2 and "expected" in refused.stderr, (suite, refused)


main(sys.argv[1])
