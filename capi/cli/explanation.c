/* SPDX-License-Identifier: BSD-3-Clause */
#include "explanation.h"

#include <stdlib.h>

#include "json.h"

enum { outcome_width = 7 };

static double* outcomes_of(const tactus_planner* planner, size_t index, size_t count) {
  double* rows = malloc(count * outcome_width * sizeof *rows);
  if (rows != NULL && tactus_planner_alternative_outcomes(planner, index, rows, count, &count) == TACTUS_OK)
    return rows;
  free(rows);
  return NULL;
}

static bool take_alternative(const tactus_planner* planner, size_t index, explanation* why) {
  tactus_alternative alternative;
  tactus_alternative_init(&alternative, sizeof alternative);
  if (tactus_planner_alternative(planner, index, &alternative) != TACTUS_OK) return false;
  if (index >= most_alternatives && alternative.verdict != TACTUS_VERDICT_CHOSEN) return true;
  double* outcomes = outcomes_of(planner, index, alternative.outcomes);
  if (outcomes == NULL) return false;
  why->alternatives[why->count] = alternative;
  why->outcomes[why->count++] = outcomes;
  return true;
}

bool take_explanation(const tactus_planner* planner, explanation* why) {
  why->count = 0;
  if (tactus_planner_alternative_count(planner, &why->weighed) != TACTUS_OK) return false;
  for (size_t i = 0; i < why->weighed; ++i)
    if (!take_alternative(planner, i, why)) {
      free_explanation(why);
      return false;
    }
  return true;
}

static void print_alternative(FILE* out, const tactus_alternative* alternative, const double* outcomes) {
  fprintf(out, "{\"kind\": \"%s\", \"verdict\": \"%s\"", tactus_action_kind_name(alternative->kind),
          tactus_verdict_name(alternative->verdict));
  json_number_field(out, "lower_bound", alternative->lower_bound, json_full);
  json_number_field(out, "value", alternative->value, json_full);
  json_number_field(out, "motion_cost", alternative->motion_cost, json_full);
  json_number_field(out, "information_bits", alternative->information, json_full);
  json_number_field(out, "contact_probability", alternative->contact_probability, json_full);
  json_number_field(out, "goal_probability", alternative->goal_probability, json_full);
  json_numbers_field(out, "start", alternative->start, 3, json_short);
  json_numbers_field(out, "end", alternative->end, 3, json_short);
  fputs(", \"outcomes\": [", out);
  for (size_t z = 0; z < alternative->outcomes; ++z) {
    if (z > 0) fputc(',', out);
    json_numbers(out, outcomes + outcome_width * z, outcome_width, json_short);
  }
  fputs("]}", out);
}

void print_explanation(FILE* out, const explanation* why) {
  fprintf(out, "{\"weighed\": %zu, \"alternatives\": [", why->weighed);
  for (int i = 0; i < why->count; ++i) {
    if (i > 0) fputs(", ", out);
    print_alternative(out, &why->alternatives[i], why->outcomes[i]);
  }
  fputs("]}", out);
}

void free_explanation(explanation* why) {
  for (int i = 0; i < why->count; ++i) free(why->outcomes[i]);
  why->count = 0;
}
