/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_EXPLANATION_H
#define TACTUS_CLI_EXPLANATION_H

#include <stdbool.h>
#include <stdio.h>

#include "tactus/planner.h"

enum { most_alternatives = 5 };

/* Why an action was chosen: the best motions that the planner weighed, and the chosen one if it is not among them. */
typedef struct {
  size_t weighed; /* motions in all */
  int count;      /* of those here */
  tactus_alternative alternatives[most_alternatives + 1];
  double* outcomes[most_alternatives + 1]; /* of each: alternatives[i].outcomes x 7 */
} explanation;

/* Of the last query. False if the library failed; then there is nothing to free. */
bool take_explanation(const tactus_planner* planner, explanation* why);
void print_explanation(FILE* out, const explanation* why);
void free_explanation(explanation* why);

#endif
