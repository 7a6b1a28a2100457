#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Many simulated episodes of several settings, and a table of them: study.sh [--trials N] [--seed S] [--expansions E] [--only NAME].
# Stop it at any time; started again with the same arguments it goes on where it was.

source "$(dirname "${BASH_SOURCE[0]}")/setup.sh" bin/tactus

exec "$python" examples/python/study.py "$@"
