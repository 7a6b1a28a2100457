#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Every test, with the set-up it needs: C++ through CTest, Python through pytest. Fails when anything fails.

source "$(dirname "${BASH_SOURCE[0]}")/../examples/setup.sh" all

logs=build/tests
mkdir -p "$logs"
summary=()
failures=0

# suite NAME COMMAND...: runs it to the end whatever the others did, and keeps its output in a file.
suite() {
  local name=$1 started=$SECONDS result=passed
  shift
  step "$name tests"
  if ! "$@" 2>&1 | tee "$logs/$name.log"; then
    result=FAILED
    failures=$((failures + 1))
  fi
  summary+=("$(printf '%-8s %-7s %4d s   %s' "$name" "$result" $((SECONDS - started)) "$(closing_line "$logs/$name.log")")")
}

# The line in which CTest and pytest count.
closing_line() { grep -E 'tests passed|[0-9]+ (passed|failed|error)|No tests were found|no tests ran' "$1" | tail -n 1 | tr -d '=' || true; }

suite C++ ctest --preset release --parallel "$jobs" --no-tests=error
suite Python env PYTHONPATH=python_shim "$python" -m pytest -q --durations=5 tests/python

step "Summary, after $((SECONDS / 60)) min $((SECONDS % 60)) s"
printf '    %s\n' "${summary[@]}"
exit $((failures > 0))
