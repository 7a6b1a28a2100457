/* SPDX-License-Identifier: BSD-3-Clause */
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "result_json.h"
#include "resume.h"
#include "setup.h"
#include "tables.h"
#include "trials.h"

typedef struct {
  trial_options options;
  loaded_setup setup;
  run_result result;
  FILE* record;
} run;

static bool open_record(run* r) {
  if (r->options.record == NULL) return true;
  r->record = open_for_writing(r->options.record);
  return r->record != NULL;
}

static int report(const run* r, const results_file* file) {
  print_table(is_stdout(file->path) || is_stdout(r->options.record) ? stderr : stdout, &r->result);
  if (!write_at_end(file)) return exit_usage;
  return summarise(&r->result).inserted == r->result.count ? exit_good : exit_not_inserted;
}

/* The trials that the file has, if they are of this run. */
static bool take_over(run* r, const run_setting* setting) {
  const trial_options* o = &r->options;
  if (r->result.count > 0 &&
      !(settings_agree(o, &r->result.setting, setting) && trials_belong(o, r->setup.scenario, &r->result)))
    return false;
  if (o->resume) fprintf(stderr, "%s: %d of %d trials are there\n", o->json, r->result.count, o->trials);
  return true;
}

static int run_all(run* r) {
  const trial_options* o = &r->options;
  const results_file file = {o->json, &run_format, &r->result};
  if ((o->resume && !load_results(&file)) || !load_setup(o, &r->setup)) return exit_usage;
  const run_setting setting = setting_of(o, &r->setup);
  if (!take_over(r, &setting)) return exit_usage;
  r->result.setting = setting;
  if (!open_record(r)) return exit_usage;
  const campaign all = {o, &r->setup.trial, &r->result, 1, r->record, &file};
  if (!save_results(&file)) return exit_usage;
  const bool ran = run_trials(&all), kept = save_tables(o->tables, r->setup.scenario);
  const int reported = report(r, &file);
  return ran && kept ? reported : exit_usage;
}

int run_command(int argc, char** argv) {
  run r;
  memset(&r, 0, sizeof r);
  if (!parse_options("run", argc, argv, &r.options)) return exit_usage;
  int result = run_all(&r);
  if (!close_written(r.record)) result = exit_usage;
  free(r.result.trials);
  free_setup(&r.setup);
  return result;
}
