/* SPDX-License-Identifier: BSD-3-Clause */
#include "tables.h"

#include <stdlib.h>

#include "results_file.h"

typedef struct {
  uint8_t* bytes;
  size_t size;
} saved_tables;

static bool failed(const char* path) {
  fprintf(stderr, "tactus: --tables %s: %s\n", path, tactus_last_error());
  return false;
}

static void print_bytes(FILE* out, const void* results) {
  const saved_tables* tables = results;
  fwrite(tables->bytes, 1, tables->size, out);
}

static const results_format format = {print_bytes, NULL};

bool load_tables(const char* path, const tactus_scenario* scenario) {
  saved_tables tables = {NULL, 0};
  if (path == NULL) return true;
  if (!read_file(path, &tables.bytes, &tables.size)) return false;
  const bool good =
      tables.bytes == NULL || tactus_scenario_restore_tables(scenario, tables.bytes, tables.size) == TACTUS_OK;
  free(tables.bytes);
  return good || failed(path);
}

bool save_tables(const char* path, const tactus_scenario* scenario) {
  saved_tables tables = {NULL, 0};
  if (path == NULL) return true;
  if (tactus_scenario_save_tables(scenario, NULL, 0, &tables.size) != TACTUS_OK) return failed(path);
  tables.bytes = malloc(tables.size);
  const results_file file = {path, &format, &tables};
  const bool good = tables.bytes != NULL &&
                            tactus_scenario_save_tables(scenario, tables.bytes, tables.size, &tables.size) == TACTUS_OK
                        ? save_results(&file)
                        : failed(path);
  free(tables.bytes);
  return good;
}
