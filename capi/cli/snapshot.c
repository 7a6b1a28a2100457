/* SPDX-License-Identifier: BSD-3-Clause */
#include "snapshot.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "json.h"

enum { most_points = 3000 };

typedef tactus_status (*get_rows)(const tactus_belief*, double*, size_t, size_t*);

/* A well-mixed number [Steele et al., SplitMix64]: an even stride would draw stripes into a regular grid. */
static uint64_t mixed(uint64_t x) {
  x = (x + 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/* Some of the rows that `get` gives, picked without a pattern, the first three numbers of each. */
static bool take_points(const tactus_belief* belief, get_rows get, size_t width, belief_snapshot* snapshot) {
  size_t rows = 0;
  if (get(belief, NULL, 0, &rows) != TACTUS_OK) return false;
  double* all = malloc((rows * width + 1) * sizeof *all);
  if (all == NULL || get(belief, all, rows, &rows) != TACTUS_OK) {
    free(all);
    return false;
  }
  snapshot->points = all; /* the rows that stay move to its front */
  snapshot->count = 0;
  for (size_t r = 0; r < rows; ++r)
    if (mixed(r) % rows < most_points) memmove(all + 3 * snapshot->count++, all + r * width, 3 * sizeof *all);
  double* shrunk = realloc(all, (3 * snapshot->count + 1) * sizeof *all);
  if (shrunk != NULL) snapshot->points = shrunk;
  return true;
}

bool take_snapshot(const tactus_belief* belief, belief_snapshot* snapshot) {
  tactus_summary_init(&snapshot->summary, sizeof snapshot->summary);
  if (tactus_belief_summary(belief, &snapshot->summary) != TACTUS_OK) return false;
  return snapshot->summary.phase == TACTUS_PHASE_VOXELS ? take_points(belief, tactus_belief_voxels, 3, snapshot)
                                                        : take_points(belief, tactus_belief_poses, 7, snapshot);
}

void print_snapshot(FILE* out, const belief_snapshot* snapshot) {
  const tactus_summary* summary = &snapshot->summary;
  fprintf(out, "{\"possibly_occupied\": %.0f", (double)summary->possibly_occupied);
  json_number_field(out, "cells", (double)summary->cells, json_full);
  json_number_field(out, "bits", summary->bits, json_short);
  json_numbers_field(out, "mean", summary->mean, 6, json_full);
  json_numbers_field(out, "extent", summary->extent, 6, json_full);
  fputs(", \"points\": [", out);
  for (size_t i = 0; i < snapshot->count; ++i) {
    if (i > 0) fputc(',', out);
    json_numbers(out, snapshot->points + 3 * i, 3, json_short);
  }
  fputs("]}", out);
}

void free_snapshot(belief_snapshot* snapshot) {
  free(snapshot->points);
  snapshot->points = NULL;
}

const char* snapshot_phase(const belief_snapshot* snapshot) {
  return snapshot->summary.phase == TACTUS_PHASE_VOXELS ? "voxels" : "poses";
}
