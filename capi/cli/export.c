/* SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "instance_options.h"

/* The instance in a format; NULL: stderr says why. The caller's to free. */
static char* exported(const tactus_instance* instance, int32_t format) {
  size_t count = 0;
  char* text = NULL;
  if (tactus_instance_export(instance, format, NULL, 0, &count) == TACTUS_OK && (text = malloc(count)) != NULL &&
      tactus_instance_export(instance, format, text, count, &count) == TACTUS_OK)
    return text;
  fprintf(stderr, "tactus export: %s\n", text == NULL ? "out of memory" : tactus_last_error());
  free(text);
  return NULL;
}

static bool write_text(const char* path, const char* text) {
  FILE* out = strcmp(path, "-") == 0 ? stdout : fopen(path, "w");
  bool good = out != NULL && fputs(text, out) >= 0;
  if (out != NULL) good = (out == stdout ? fflush(out) : fclose(out)) == 0 && good;
  if (!good) fprintf(stderr, "tactus export: %s: found a file that can't be written\n", path);
  return good;
}

/* `path`: NULL if this format was not asked for. */
static bool export_to(const char* path, const tactus_instance* instance, int32_t format) {
  if (path == NULL) return true;
  char* text = exported(instance, format);
  const bool written = text != NULL && write_text(path, text);
  free(text);
  return written;
}

int export_command(int argc, char** argv) {
  instance_options options;
  if (!parse_instance_options("export", argc, argv, &options)) return exit_usage;
  tactus_scenario* scenario = NULL;
  tactus_instance* instance = NULL;
  const bool written = load_instance("export", &options, &scenario, &instance) &&
                       export_to(options.pomdpx, instance, TACTUS_FORMAT_POMDPX) &&
                       export_to(options.pomdp, instance, TACTUS_FORMAT_POMDP);
  size_t poses = 0, configurations = 0, motions = 0;
  if (written && tactus_instance_size(instance, &poses, &configurations, &motions) == TACTUS_OK)
    fprintf(stderr, "written: %zu poses, %zu configurations, %zu motions\n", poses, configurations, motions);
  tactus_instance_destroy(instance);
  tactus_scenario_destroy(scenario);
  return written ? exit_good : exit_usage;
}
