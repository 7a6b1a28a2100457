/* SPDX-License-Identifier: BSD-3-Clause */
#include "options.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "results_file.h"

const char* const usage =
    "usage: tactus run SCENARIO [options]       find the target by touch, in simulation\n"
    "       tactus compare SCENARIO [options]   the same trials by several solvers, and what each takes beside the "
    "first\n"
    "       tactus check SCENARIO               name everything that is wrong with a scenario\n"
    "       tactus export SCENARIO [options]    write a small instance of it for public POMDP solvers\n"
    "       tactus evaluate SCENARIO [options]  what a policy costs on such an instance, and the least possible\n"
    "       tactus --version | --help\n"
    "\n"
    "options of run and compare:\n"
    "  --trials N                 how many (1); trial i draws the true pose from the prior with seed S + i\n"
    "  --seed S                   (1)\n"
    "  --belief KIND              hierarchical or particles (the scenario's)\n"
    "  --budget-seconds B         for one planning call (the scenario's)\n"
    "  --budget-expansions E      the same, counted: same seed, same actions, on every machine\n"
    "  --stopping-distance M      that the simulated robot may travel on after a contact (the scenario's)\n"
    "  --encoder-error M          by which what it reports may be off (the scenario's)\n"
    "  --missed-contacts P        share of motions in which it feels no contact (the scenario's)\n"
    "  --false-contacts P         share of motions that a false contact stops (the scenario's)\n"
    "  --jobs J                   trials at a time (1); they share the machine, and a budget in seconds buys less:\n"
    "                             with --budget-expansions the results are the same for every J, limits of time apart\n"
    "  --json FILE                results, saved whole after every trial; - for stdout, at the end\n"
    "  --tables FILE              tables of contact: taken in if FILE is there, and saved at the end for the next "
    "start\n"
    "  --resume                   run only the trials that FILE does not have; its others must be of the same options\n"
    "                             and scenario (to compare, with more solvers too, unless with --phase poses)\n"
    "\n"
    "of run alone:\n"
    "  --solver NAME              rtdp-bel, rtdp-inad, rtdp-ad, brtdp-bel, tbl, frontier or rate (the scenario's)\n"
    "  --true-pose x,y,z,r,p,y    of the target in the robot's base frame, m and rad, instead of drawing it\n"
    "  --record FILE              the first trial, for a replay page\n"
    "\n"
    "of compare alone:\n"
    "  --solvers A,B,...          two or more, the one that the others are measured by first\n"
    "  --phase PHASE              whole (the default); voxels: trials end when poses take over from voxels; poses: "
    "they\n"
    "                             begin there, every solver with the belief to which the first solver has come\n"
    "\n"
    "Progress goes to stderr, results to stdout. Exit status: 0 all inserted (with --phase voxels: all came to "
    "poses),\n"
    "1 some were not, or failed, 2 usage or scenario error.\n";

static bool read_count(const char* text, uint64_t low, uint64_t high, uint64_t* value) {
  char* end = NULL;
  if (!isdigit((unsigned char)text[0])) return false;
  errno = 0;
  *value = strtoull(text, &end, 10);
  return errno == 0 && *end == '\0' && *value >= low && *value <= high;
}

static bool read_seconds(const char* text, double* value) {
  char* end = NULL;
  *value = strtod(text, &end);
  return end != text && *end == '\0' && isfinite(*value) && *value > 0.0;
}

static bool read_up_to(const char* text, double high, double* value) {
  char* end = NULL;
  *value = strtod(text, &end);
  return end != text && *end == '\0' && isfinite(*value) && *value >= 0.0 && *value <= high;
}

static bool read_six(const char* text, double* values) {
  for (int i = 0; i < 6; ++i) {
    char* end = NULL;
    values[i] = strtod(text, &end);
    if (end == text || !isfinite(values[i]) || *end != (i < 5 ? ',' : '\0')) return false;
    text = end + 1;
  }
  return true;
}

static bool read_phase(const char* text, trial_phase* phase) {
  for (*phase = phase_whole; *phase < phase_count; ++*phase)
    if (strcmp(text, trial_phase_name(*phase)) == 0) return true;
  return false;
}

/* The same as `take`, for an option that says what the simulated robot does; `*known` is false for another option. */
static const char* take_sensing(const char* name, const char* value, trial_options* options, bool* known) {
  const struct {
    const char* name;
    double* field;
    bool share;
  } all[] = {{"--stopping-distance", &options->stopping_distance, false},
             {"--encoder-error", &options->encoder_error, false},
             {"--missed-contacts", &options->missed_contacts, true},
             {"--false-contacts", &options->false_contacts, true}};
  *known = false;
  for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i)
    if (strcmp(name, all[i].name) == 0) {
      *known = true;
      if (!read_up_to(value, all[i].share ? 0.5 : DBL_MAX, all[i].field))
        return all[i].share ? "a number from 0 to 0.5" : "a number of at least 0";
    }
  return NULL;
}

/* Takes in one option; what was expected if its value makes no sense, NULL if it does. */
static const char* take(const char* name, const char* value, trial_options* options) {
  uint64_t count = 0;
  bool known = false;
  const char* expected = take_sensing(name, value, options, &known);
  if (known) return expected;
  if (strcmp(name, "--solver") == 0) {
    options->solver = value;
  } else if (strcmp(name, "--solvers") == 0) {
    options->solvers = value;
  } else if (strcmp(name, "--phase") == 0) {
    if (!read_phase(value, &options->phase)) return "whole, voxels or poses";
  } else if (strcmp(name, "--belief") == 0) {
    options->belief = value;
    if (strcmp(value, "hierarchical") != 0 && strcmp(value, "particles") != 0) return "hierarchical or particles";
  } else if (strcmp(name, "--json") == 0) {
    options->json = value;
  } else if (strcmp(name, "--tables") == 0) {
    options->tables = value;
    if (!is_replaceable(value)) return "a file that can be replaced";
  } else if (strcmp(name, "--record") == 0) {
    options->record = value;
  } else if (strcmp(name, "--trials") == 0) {
    if (!read_count(value, 1, 1000000, &count)) return "a number from 1 to 1000000";
    options->trials = (int)count;
  } else if (strcmp(name, "--jobs") == 0) {
    if (!read_count(value, 1, most_jobs, &count)) return "a number from 1 to 256";
    options->jobs = (int)count;
  } else if (strcmp(name, "--seed") == 0) {
    if (!read_count(value, 0, UINT64_MAX, &options->seed)) return "a whole number";
  } else if (strcmp(name, "--budget-seconds") == 0) {
    if (!read_seconds(value, &options->budget_seconds)) return "a number greater than 0";
  } else if (strcmp(name, "--budget-expansions") == 0) {
    if (!read_count(value, 1, UINT64_MAX, &options->budget_expansions)) return "a whole number greater than 0";
  } else {
    options->has_true_pose = true;
    if (!read_six(value, options->true_pose)) return "six numbers x,y,z,roll,pitch,yaw";
  }
  return NULL;
}

bool is_option(const char* word) { return strncmp(word, "--", 2) == 0; }

/* Whether the command has this option. */
static bool has_option(const char* command, const char* name) {
  static const struct {
    const char *name, *only; /* the one command that has it; NULL: both have */
  } all[] = {{"--trials", NULL},
             {"--seed", NULL},
             {"--jobs", NULL},
             {"--belief", NULL},
             {"--budget-seconds", NULL},
             {"--budget-expansions", NULL},
             {"--json", NULL},
             {"--tables", NULL},
             {"--stopping-distance", NULL},
             {"--encoder-error", NULL},
             {"--missed-contacts", NULL},
             {"--false-contacts", NULL},
             {"--solver", "run"},
             {"--true-pose", "run"},
             {"--record", "run"},
             {"--solvers", "compare"},
             {"--phase", "compare"}};
  for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i)
    if (strcmp(name, all[i].name) == 0) return all[i].only == NULL || strcmp(command, all[i].only) == 0;
  return false;
}

static bool complain(const char* command, const char* about, const char* what) {
  fprintf(stderr, "tactus %s: %s: %s\n", command, about, what);
  return false;
}

static bool take_next(const char* command, const char* name, const char* value, trial_options* options) {
  if (!has_option(command, name)) return complain(command, name, "unknown option, see tactus --help");
  if (value == NULL) return complain(command, name, "expected a value");
  const char* expected = is_option(value) ? "a value" : take(name, value, options);
  if (expected == NULL) return true;
  fprintf(stderr, "tactus %s: %s: found '%s', expected %s\n", command, name, value, expected);
  return false;
}

/* What one option alone can't tell. */
static bool make_sense(const char* command, const trial_options* options) {
  if (options->scenario == NULL) return complain(command, "SCENARIO", "expected a scenario file, see tactus --help");
  if (options->resume && (options->json == NULL || !is_replaceable(options->json)))
    return complain(command, "--resume", "expected --json and a file that keeps the trials");
  if (options->resume && options->record != NULL)
    return complain(command, "--record", "expected no --resume, with which the first trial may not be run");
  if (options->json != NULL && options->record != NULL && strcmp(options->json, options->record) == 0)
    return complain(command, "--record", "found what --json writes to, expected another file: each is one document");
  return true;
}

bool parse_options(const char* command, int argc, char** argv, trial_options* options) {
  memset(options, 0, sizeof *options);
  options->trials = options->jobs = 1;
  options->seed = 1;
  options->stopping_distance = options->encoder_error = options->missed_contacts = options->false_contacts = -1.0;
  for (int i = 0; i < argc; ++i) {
    const bool is_scenario = !is_option(argv[i]);
    if (is_scenario && options->scenario != NULL) return complain(command, argv[i], "expected one scenario only");
    if (is_scenario)
      options->scenario = argv[i];
    else if (strcmp(argv[i], "--resume") == 0)
      options->resume = true;
    else if (take_next(command, argv[i], i + 1 < argc ? argv[i + 1] : NULL, options))
      ++i;
    else
      return false;
  }
  return make_sense(command, options);
}
