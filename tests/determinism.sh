#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Whether the same seed and budget in expansions give the same trials on one thread and on two, in a release and in a debug build:
# determinism.sh [--scenario NAME] [--trials N] [--seed S] [--expansions E] [--solver NAME] [--belief KIND]

source "$(dirname "${BASH_SOURCE[0]}")/../examples/setup.sh" bin/tactus

step "Debug build"
quietly build/setup-debug.log cmake --preset debug
quietly build/setup-debug.log cmake --build --preset debug --target bin/tactus --parallel "$jobs"

exec "$python" tests/determinism.py "$@"
