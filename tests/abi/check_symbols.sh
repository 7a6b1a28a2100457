#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# check_symbols.sh NM LIBRARY LIST: the library exports exactly the names of the list.
# A name that goes or comes is a change of the ABI: edit the list only when that is meant.
set -eu
exported=$(mktemp)
trap 'rm -f "$exported"' EXIT
"$1" --dynamic --defined-only "$2" | awk '$2 != "A" { sub(/@.*/, "", $3); print $3 }' | LC_ALL=C sort > "$exported"
diff -u "$3" "$exported"
