/* SPDX-License-Identifier: BSD-3-Clause */
#include "instance_options.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options.h"

const char* const instance_usage =
    "\n"
    "options of export and evaluate:\n"
    "  --poses N                  drawn from the prior (15)\n"
    "  --configurations N         at most (60)\n"
    "  --motions N                sweeps and pokes, at most (6); beside an insertion at each pose, and small moves\n"
    "  --discount G               of the cost of each further motion (0.999)\n"
    "  --seed S                   of the draw (1)\n"
    "of export alone:\n"
    "  --pomdpx FILE              PomdpX, for SARSOP; - for stdout\n"
    "  --pomdp FILE               Cassandra's format, for pomdp-solve; - for stdout\n"
    "of evaluate alone:\n"
    "  --solver NAME              as for run\n"
    "  --budget-expansions E      for one planning call (100)\n"
    "  --most-beliefs N           to be solved for the optimum (200000)\n"
    "  --json FILE                the results; - for stdout\n";

enum { default_expansions = 100, default_beliefs = 200000 };

/* An option and where its value goes; one of the pointers is set. */
typedef struct {
  const char* name;
  const char* command; /* that has it; NULL: both */
  const char** text;
  uint32_t* small;
  uint64_t* whole;
  double* number;
} option;

static bool read_whole(const char* text, uint64_t most, uint64_t* value) {
  char* end = NULL;
  if (!isdigit((unsigned char)text[0])) return false;
  errno = 0;
  *value = strtoull(text, &end, 10);
  return errno == 0 && *end == '\0' && *value <= most;
}

/* What was expected if the value makes no sense, NULL if it does. Ranges are the library's to check. */
static const char* take(const option* to, const char* value) {
  uint64_t whole = 0;
  if (to->text != NULL) {
    *to->text = value;
  } else if (to->small != NULL) {
    if (!read_whole(value, UINT32_MAX, &whole)) return "a whole number";
    *to->small = (uint32_t)whole;
  } else if (to->whole != NULL) {
    if (!read_whole(value, UINT64_MAX, to->whole)) return "a whole number";
  } else {
    char* end = NULL;
    *to->number = strtod(value, &end);
    if (end == value || *end != '\0' || !isfinite(*to->number)) return "a number";
  }
  return NULL;
}

static bool complain(const char* command, const char* about, const char* what) {
  fprintf(stderr, "tactus %s: %s: %s\n", command, about, what);
  return false;
}

static const option* find(const option* options, size_t count, const char* command, const char* name) {
  for (size_t i = 0; i < count; ++i)
    if (strcmp(options[i].name, name) == 0 && (options[i].command == NULL || strcmp(options[i].command, command) == 0))
      return &options[i];
  return NULL;
}

static bool check(const char* command, const instance_options* options) {
  if (options->scenario == NULL) return complain(command, "SCENARIO", "expected a scenario file, see tactus --help");
  if (strcmp(command, "export") == 0 && options->pomdpx == NULL && options->pomdp == NULL)
    return complain(command, "--pomdpx or --pomdp", "expected a file to write to");
  if (options->budget_expansions == 0)
    return complain(command, "--budget-expansions", "found 0, expected a whole number greater than 0");
  return true;
}

bool parse_instance_options(const char* command, int argc, char** argv, instance_options* o) {
  memset(o, 0, sizeof *o);
  tactus_instance_options_init(&o->instance, sizeof o->instance);
  o->budget_expansions = default_expansions;
  o->most_beliefs = default_beliefs;
  const option all[] = {{"--poses", NULL, NULL, &o->instance.poses, NULL, NULL},
                        {"--configurations", NULL, NULL, &o->instance.configurations, NULL, NULL},
                        {"--motions", NULL, NULL, &o->instance.motions, NULL, NULL},
                        {"--discount", NULL, NULL, NULL, NULL, &o->instance.discount},
                        {"--seed", NULL, NULL, NULL, &o->instance.seed, NULL},
                        {"--pomdpx", "export", &o->pomdpx, NULL, NULL, NULL},
                        {"--pomdp", "export", &o->pomdp, NULL, NULL, NULL},
                        {"--solver", "evaluate", &o->solver, NULL, NULL, NULL},
                        {"--json", "evaluate", &o->json, NULL, NULL, NULL},
                        {"--budget-expansions", "evaluate", NULL, NULL, &o->budget_expansions, NULL},
                        {"--most-beliefs", "evaluate", NULL, NULL, &o->most_beliefs, NULL}};
  for (int i = 0; i < argc; ++i) {
    const char* name = argv[i];
    if (!is_option(name)) {
      if (o->scenario != NULL) return complain(command, name, "expected one scenario only");
      o->scenario = name;
      continue;
    }
    const option* found = find(all, sizeof all / sizeof all[0], command, name);
    if (found == NULL) return complain(command, name, "unknown option, see tactus --help");
    if (++i == argc) return complain(command, name, "expected a value");
    const char* expected = is_option(argv[i]) ? "a value" : take(found, argv[i]);
    if (expected != NULL) {
      fprintf(stderr, "tactus %s: %s: found '%s', expected %s\n", command, name, argv[i], expected);
      return false;
    }
  }
  return check(command, o);
}

bool load_instance(const char* command, const instance_options* options, tactus_scenario** scenario,
                   tactus_instance** instance) {
  fprintf(stderr, "loading %s\n", options->scenario);
  if (tactus_scenario_load(options->scenario, scenario) == TACTUS_OK &&
      tactus_instance_create(*scenario, &options->instance, instance) == TACTUS_OK)
    return true;
  fprintf(stderr, "tactus %s: %s\n", command, tactus_last_error());
  return false;
}
