#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What the voxels' likelihoods forecast against what happens: reliability.sh [--scenario NAME] [--trials N] [--seed S] [--expansions E] [--likelihood L].
# Stop it at any time; started again with the same arguments, or more trials, it goes on where it was.

source "$(dirname "${BASH_SOURCE[0]}")/setup.sh" lib/libtactus.so >&2

exec "$python" examples/python/reliability.py "$@"
