/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_SNAPSHOT_H
#define TACTUS_CLI_SNAPSHOT_H

#include <stdbool.h>
#include <stdio.h>

#include "tactus/belief.h"

/* A belief as it is drawn: its summary, and some of the voxels' centres or of the target's possible positions. */
typedef struct {
  tactus_summary summary;
  double* points; /* count x 3, m */
  size_t count;
} belief_snapshot;

/* False if the library failed; then there is nothing to free. */
bool take_snapshot(const tactus_belief* belief, belief_snapshot* snapshot);
void print_snapshot(FILE* out, const belief_snapshot* snapshot);
void free_snapshot(belief_snapshot* snapshot);

const char* snapshot_phase(const belief_snapshot* snapshot); /* "voxels" or "poses" */

#endif
