#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The set-up that quickstart.sh and tests/run.sh share: from a bare Debian 12 to a built tree, and nothing twice.
#
#     bash examples/setup.sh [TARGET...]      builds everything, or only the targets named
#     source examples/setup.sh [TARGET...]    the same, and leaves the caller in the root folder with `step`, `python` and `jobs`

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mkdir -p build

packages=(
  g++ cmake ninja-build ccache pkg-config git
  libeigen3-dev libfcl-dev liburdfdom-dev libassimp-dev libompl-dev libyaml-cpp-dev libgtest-dev libbenchmark-dev
  python3 python3-numpy python3-matplotlib python3-pytest
)
python=/usr/bin/python3   # Debian's own: the packages above belong to it, whatever comes first on the PATH

step() { printf '\n==> %s\n' "$*" >&2; }

fail() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# quietly LOG COMMAND...: the output goes to a file, and comes to light only if the command fails.
quietly() {
  local log=$1
  shift
  "$@" >"$log" 2>&1 && return
  tail -n 40 "$log" >&2
  printf 'error: "%s" failed; all it said is in %s\n' "$*" "$log" >&2
  return 1
}

missing_packages() {
  local package
  for package in "${packages[@]}"; do
    [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || echo "$package"
  done
}

install_packages() {
  command -v dpkg-query >/dev/null || fail "this set-up is for Debian 12; elsewhere install the counterparts of: ${packages[*]}"
  local missing as_root=()
  mapfile -t missing < <(missing_packages)
  if ((${#missing[@]} == 0)); then
    step "Debian packages: all ${#packages[@]} are there"
    return
  fi
  if ((EUID != 0)); then
    command -v sudo >/dev/null || fail "neither root nor sudo; ask for these packages to be installed: ${missing[*]}"
    as_root=(sudo)
  fi
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -o Dpkg::Use-Pty=0)
  local install=("${apt[@]}" install --no-install-recommends "${missing[@]}")
  if ! "${install[@]}" --simulate >/dev/null 2>&1; then
    step "Debian packages: reading the lists"
    quietly build/setup-apt.log "${apt[@]}" update
  fi
  step "Debian packages: installing ${missing[*]}"
  if ! quietly build/setup-apt.log "${install[@]}"; then
    step "Debian packages: once more, with fresh lists"
    quietly build/setup-apt.log "${apt[@]}" update
    quietly build/setup-apt.log "${install[@]}"
  fi
}

# How many compilers fit: one a core, and 1.5 GB for each.
parallel_jobs() {
  local cores kilobytes limit fits
  cores=$(nproc)
  kilobytes=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo)
  limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || echo max)
  if [[ $limit != max ]] && ((limit / 1024 < kilobytes)); then
    kilobytes=$((limit / 1024))
  fi
  fits=$((kilobytes / 1500000))
  ((fits >= 1)) || fits=1
  echo $((fits < cores ? fits : cores))
}

build_targets() {
  step "Configuring build/release"
  quietly build/setup-cmake.log cmake --preset release
  step "Building ${*:-everything}, $jobs at a time"
  cmake --build --preset release --parallel "$jobs" ${1:+--target "$@"}
}

install_packages
jobs=${CMAKE_BUILD_PARALLEL_LEVEL:-$(parallel_jobs)}
build_targets "$@"
