#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The paper's tables and its figure beside what is measured here: paper_tables.sh [--trials N] [--solvers A,B,...] [--expansions E] ...
# Stop it at any time; started again with the same arguments, or more trials, it goes on where it was.

source "$(dirname "${BASH_SOURCE[0]}")/setup.sh" bin/tactus

exec "$python" examples/python/paper_tables.py "$@"
