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
    "usage: tactus run SCENARIO [options]   find the target by touch, in simulation\n"
    "       tactus check SCENARIO           name everything that is wrong with a scenario\n"
    "       tactus export SCENARIO [options]    write a small instance of it for public POMDP solvers\n"
    "       tactus evaluate SCENARIO [options]  what a policy costs on such an instance, and the least possible\n"
    "       tactus --version | --help\n"
    "\n"
    "options of run:\n"
    "  --trials N                 how many (1); trial i draws the true pose from the prior with seed S + i\n"
    "  --seed S                   (1)\n"
    "  --solver NAME              rtdp-bel, rtdp-inad, rtdp-ad, brtdp-bel, tbl, frontier or rate (the scenario's)\n"
    "  --belief KIND              hierarchical or particles (the scenario's)\n"
    "  --budget-seconds B         for one planning call (the scenario's)\n"
    "  --budget-expansions E      the same, counted: same seed, same actions, on every machine\n"
    "  --true-pose x,y,z,r,p,y    of the target in the robot's base frame, m and rad, instead of drawing it\n"
    "  --stopping-distance M      that the simulated robot may travel on after a contact (the scenario's)\n"
    "  --encoder-error M          by which what it reports may be off (the scenario's)\n"
    "  --missed-contacts P        share of motions in which it feels no contact (the scenario's)\n"
    "  --false-contacts P         share of motions that a false contact stops (the scenario's)\n"
    "  --jobs J                   trials at a time (1); they share the machine, and a budget in seconds buys less:\n"
    "                             with --budget-expansions the results are the same for every J, limits of time apart\n"
    "  --json FILE                results, saved whole after every trial; - for stdout, at the end\n"
    "  --resume                   run only the trials that FILE does not have; its others must be of the same options\n"
    "  --record FILE              the first trial, for a replay page\n"
    "\n"
    "options of export and evaluate:\n"
    "  --poses N                  drawn from the prior (15)\n"
    "  --configurations N         at most (60)\n"
    "  --motions N                sweeps and pokes, at most (6); beside an insertion at each pose, and small moves\n"
    "  --discount G               of the cost of each further motion (0.999)\n"
    "  --seed S                   of the draw (1)\n"
    "  --pomdpx FILE              export: PomdpX, for SARSOP; - for stdout\n"
    "  --pomdp FILE               export: Cassandra's format, for pomdp-solve\n"
    "  --solver NAME              evaluate: as for run\n"
    "  --budget-expansions E      evaluate: for one planning call (100)\n"
    "  --most-beliefs N           evaluate: to be solved for the optimum (200000)\n"
    "  --json FILE                evaluate: the results; - for stdout\n"
    "\n"
    "Progress goes to stderr, results to stdout. Exit status: 0 all inserted, 1 some were not, 2 usage or scenario "
    "error.\n";

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

/* The same as `take`, for an option that says what the simulated robot does; `*known` is false for another option. */
static const char* take_sensing(const char* name, const char* value, run_options* options, bool* known) {
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
static const char* take(const char* name, const char* value, run_options* options) {
  uint64_t count = 0;
  bool known = false;
  const char* expected = take_sensing(name, value, options, &known);
  if (known) return expected;
  if (strcmp(name, "--solver") == 0) {
    options->solver = value;
  } else if (strcmp(name, "--belief") == 0) {
    options->belief = value;
    if (strcmp(value, "hierarchical") != 0 && strcmp(value, "particles") != 0) return "hierarchical or particles";
  } else if (strcmp(name, "--json") == 0) {
    options->json = value;
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

static bool is_option(const char* name) {
  static const char* const names[] = {"--trials",
                                      "--seed",
                                      "--jobs",
                                      "--solver",
                                      "--belief",
                                      "--budget-seconds",
                                      "--budget-expansions",
                                      "--json",
                                      "--record",
                                      "--true-pose",
                                      "--stopping-distance",
                                      "--encoder-error",
                                      "--missed-contacts",
                                      "--false-contacts"};
  for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i)
    if (strcmp(name, names[i]) == 0) return true;
  return false;
}

static bool complain(const char* about, const char* what) {
  fprintf(stderr, "tactus run: %s: %s\n", about, what);
  return false;
}

bool parse_run_options(int argc, char** argv, run_options* options) {
  memset(options, 0, sizeof *options);
  options->trials = options->jobs = 1;
  options->seed = 1;
  options->stopping_distance = options->encoder_error = options->missed_contacts = options->false_contacts = -1.0;
  for (int i = 0; i < argc; ++i) {
    if (strncmp(argv[i], "--", 2) != 0) {
      if (options->scenario != NULL) return complain(argv[i], "expected one scenario only");
      options->scenario = argv[i];
      continue;
    }
    const char* name = argv[i];
    if (strcmp(name, "--resume") == 0) {
      options->resume = true;
      continue;
    }
    if (!is_option(name)) return complain(name, "unknown option, see tactus --help");
    if (++i == argc) return complain(name, "expected a value");
    const char* expected = take(name, argv[i], options);
    if (expected != NULL) {
      fprintf(stderr, "tactus run: %s: found '%s', expected %s\n", name, argv[i], expected);
      return false;
    }
  }
  if (options->scenario == NULL) return complain("SCENARIO", "expected a scenario file, see tactus --help");
  if (options->resume && (options->json == NULL || !is_replaceable(options->json)))
    return complain("--resume", "expected --json and a file that keeps the trials");
  if (options->resume && options->record != NULL)
    return complain("--record", "expected no --resume, with which the first trial may not be run");
  return true;
}
