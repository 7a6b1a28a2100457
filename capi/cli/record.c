/* SPDX-License-Identifier: BSD-3-Clause */
#include "record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "explanation.h"
#include "json.h"
#include "snapshot.h"

enum { frames_at_first_spacing = 1500 }; /* then the spacing doubles, so that a long trial stays a small file */

static const double first_spacing = 1.0 / 300.0; /* m: three frames a centimetre */
static const double lever = 0.1;                 /* m: a turn counts as the way of a point so far out */

typedef struct {
  step_facts facts;
  bool contact;
  belief_snapshot belief;
  explanation why;
} recorded_step;

struct recording {
  FILE* file;
  const tactus_scenario* scenario;
  double true_pose[7];
  size_t dof, bodies;
  double *poses, *last_poses; /* bodies x 7 */
  double spacing;
  int frames, frames_here; /* written; of them with this spacing */
  recorded_step* steps;
  int count, room;
};

/* --- the bodies */

static const char* kind_name(tactus_body_kind kind) {
  switch (kind) {
    case TACTUS_BODY_ROBOT:
      return "robot";
    case TACTUS_BODY_TOOL:
      return "tool";
    case TACTUS_BODY_WORLD:
      return "world";
    default:
      return "target";
  }
}

static void print_mesh(FILE* out, const double* vertices, size_t vertex_count, const int32_t* triangles,
                       size_t triangle_count) {
  json_numbers_field(out, "vertices", vertices, 3 * vertex_count, json_short);
  fputs(", \"triangles\": [", out);
  for (size_t i = 0; i < 3 * triangle_count; ++i) fprintf(out, i > 0 ? ",%d" : "%d", (int)triangles[i]);
  fputc(']', out);
}

static bool print_body(FILE* out, const tactus_scenario* scenario, size_t body) {
  const char* name = "";
  tactus_body_kind kind = 0;
  size_t vertex_count = 0, triangle_count = 0;
  if (tactus_scenario_body_name(scenario, body, &name) != TACTUS_OK ||
      tactus_scenario_body_kind(scenario, body, &kind) != TACTUS_OK ||
      tactus_scenario_body_vertices(scenario, body, NULL, 0, &vertex_count) != TACTUS_OK ||
      tactus_scenario_body_triangles(scenario, body, NULL, 0, &triangle_count) != TACTUS_OK)
    return false;
  double* vertices = malloc((3 * vertex_count + 1) * sizeof *vertices);
  int32_t* triangles = malloc((3 * triangle_count + 1) * sizeof *triangles);
  const bool good =
      vertices != NULL && triangles != NULL &&
      tactus_scenario_body_vertices(scenario, body, vertices, vertex_count, &vertex_count) == TACTUS_OK &&
      tactus_scenario_body_triangles(scenario, body, triangles, triangle_count, &triangle_count) == TACTUS_OK;
  if (good) {
    fputs(body > 0 ? ",\n{\"name\": " : "{\"name\": ", out);
    json_text(out, name);
    fprintf(out, ", \"kind\": \"%s\"", kind_name(kind));
    print_mesh(out, vertices, vertex_count, triangles, triangle_count);
    fputc('}', out);
  }
  free(vertices);
  free(triangles);
  return good;
}

/* --- the frames */

/* The farthest that a body moved since the last frame, metres. */
static double moved(const recording* record) {
  double farthest = 0.0;
  for (size_t b = 0; b < record->bodies; ++b) {
    const double *p = record->poses + 7 * b, *l = record->last_poses + 7 * b;
    const double way =
        sqrt((p[0] - l[0]) * (p[0] - l[0]) + (p[1] - l[1]) * (p[1] - l[1]) + (p[2] - l[2]) * (p[2] - l[2]));
    const double cosine = fabs(p[3] * l[3] + p[4] * l[4] + p[5] * l[5] + p[6] * l[6]);
    farthest = fmax(farthest, way + lever * 2.0 * acos(fmin(1.0, cosine)));
  }
  return farthest;
}

/* A frame at `q`; left out if little has moved and nothing makes it `needed`. */
static bool print_frame(recording* record, const double* q, bool contact, bool needed) {
  size_t count = 0;
  if (tactus_scenario_body_poses(record->scenario, q, record->true_pose, record->poses, record->bodies, &count) !=
      TACTUS_OK)
    return false;
  if (record->frames > 0 && !needed && moved(record) < record->spacing) return true;
  FILE* out = record->file;
  fputs(record->frames++ > 0 ? ",\n{\"poses\": [" : "{\"poses\": [", out);
  for (size_t b = 0; b < record->bodies; ++b) {
    if (b > 0) fputc(',', out);
    json_numbers(out, record->poses + 7 * b, 7, json_short);
  }
  fprintf(out, "], \"action\": %d", record->count);
  json_bool_field(out, "contact", contact);
  fputc('}', out);
  memcpy(record->last_poses, record->poses, 7 * record->bodies * sizeof *record->poses);
  if (++record->frames_here == frames_at_first_spacing) record->frames_here = 0, record->spacing *= 2.0;
  return true;
}

/* Along the waypoints to the last free one, on to where the robot stopped, and back if it was a contact. */
static bool print_frames(recording* record, const double* waypoints, size_t last_free,
                         const tactus_observation* observation) {
  for (size_t i = 0; i <= last_free; ++i)
    if (!print_frame(record, waypoints + i * record->dof, false, false)) return false;
  const bool contact = observation->contact != 0;
  if (!print_frame(record, observation->joints, contact, true)) return false;
  return !contact || print_frame(record, waypoints + last_free * record->dof, false, true);
}

static bool print_action(recording* record, const tactus_action* action, const tactus_observation* observation) {
  size_t count = 0, last_free = 0;
  if (tactus_action_waypoints(action, NULL, 0, &count) != TACTUS_OK ||
      tactus_action_retreat(action, observation, &last_free) != TACTUS_OK)
    return false;
  double* waypoints = malloc(count * record->dof * sizeof *waypoints);
  const bool good = waypoints != NULL && tactus_action_waypoints(action, waypoints, count, &count) == TACTUS_OK &&
                    print_frames(record, waypoints, last_free, observation);
  free(waypoints);
  return good;
}

/* --- the document */

static bool print_head(recording* record, const tactus_belief* belief) {
  const char* name = "";
  if (tactus_scenario_name(record->scenario, &name) != TACTUS_OK) return false;
  FILE* out = record->file;
  fputs("{\"scenario\": ", out);
  json_text(out, name);
  fputs(",\n\"bodies\": [\n", out);
  for (size_t b = 0; b < record->bodies; ++b)
    if (!print_body(out, record->scenario, b)) return false;
  fputs("],\n\"true_pose\": ", out);
  json_numbers(out, record->true_pose, 7, json_full);
  belief_snapshot prior;
  if (!take_snapshot(belief, &prior)) return false;
  fputs(",\n\"prior\": ", out);
  print_snapshot(out, &prior);
  free_snapshot(&prior);
  fputs(",\n\"frames\": [\n", out);
  return true;
}

static void free_recording(recording* record) {
  for (int i = 0; i < record->count; ++i) {
    free_snapshot(&record->steps[i].belief);
    free_explanation(&record->steps[i].why);
  }
  free(record->steps);
  free(record->poses);
  free(record->last_poses);
  free(record);
}

recording* record_begin(FILE* file, const tactus_scenario* scenario, const tactus_belief* belief,
                        const double true_pose[7]) {
  recording* record = calloc(1, sizeof *record);
  if (record == NULL) return NULL;
  record->file = file;
  record->scenario = scenario;
  record->spacing = first_spacing;
  memcpy(record->true_pose, true_pose, sizeof record->true_pose);
  if (tactus_scenario_dof(scenario, &record->dof) == TACTUS_OK &&
      tactus_scenario_body_count(scenario, &record->bodies) == TACTUS_OK) {
    record->poses = calloc(record->bodies, 7 * sizeof *record->poses);
    record->last_poses = calloc(record->bodies, 7 * sizeof *record->last_poses);
    if (record->poses != NULL && record->last_poses != NULL && print_head(record, belief)) return record;
  }
  free_recording(record);
  return NULL;
}

bool record_step(recording* record, const tactus_action* action, const tactus_observation* observation,
                 const tactus_belief* belief, const step_facts* facts) {
  if (record->count == record->room) {
    const int room = 2 * record->room + 16;
    recorded_step* steps = realloc(record->steps, (size_t)room * sizeof *steps);
    if (steps == NULL) return false;
    record->steps = steps;
    record->room = room;
  }
  recorded_step* step = &record->steps[record->count];
  step->facts = *facts;
  step->contact = observation->contact != 0;
  if (!print_action(record, action, observation) || !take_snapshot(belief, &step->belief)) return false;
  if (!take_explanation(facts->planner, &step->why)) {
    free_snapshot(&step->belief);
    return false;
  }
  ++record->count;
  return true;
}

static void print_step(FILE* out, const recorded_step* step) {
  fprintf(out, "{\"kind\": \"%s\", \"phase\": \"%s\"", step->facts.kind, snapshot_phase(&step->belief));
  json_bool_field(out, "contact", step->contact);
  json_number_field(out, "cost_m", step->facts.cost_m, json_full);
  json_number_field(out, "planning_s", step->facts.planning_s, json_full);
  json_number_field(out, "lower_bound", step->facts.lower_bound, json_full);
  json_number_field(out, "value", step->facts.value, json_full);
  fputs(", \"belief\": ", out);
  print_snapshot(out, &step->belief);
  fputs(", \"why\": ", out);
  print_explanation(out, &step->why);
  fputc('}', out);
}

void record_end(recording* record, bool inserted) {
  if (record == NULL) return;
  fputs("],\n\"steps\": [\n", record->file);
  for (int i = 0; i < record->count; ++i) {
    if (i > 0) fputs(",\n", record->file);
    print_step(record->file, &record->steps[i]);
  }
  fputs("]", record->file);
  json_bool_field(record->file, "inserted", inserted);
  fputs("}\n", record->file);
  free_recording(record);
}
