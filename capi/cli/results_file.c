/* SPDX-License-Identifier: BSD-3-Clause */
#include "results_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "result_json.h"

bool is_replaceable(const char* path) {
  struct stat facts;
  return strcmp(path, "-") != 0 && (stat(path, &facts) != 0 || S_ISREG(facts.st_mode));
}

/* --- saving */

static bool failed(const char* path, const char* what) {
  fprintf(stderr, "tactus run: %s: %s: %s\n", path, what, strerror(errno));
  return false;
}

static bool write_results(const char* path, const run_result* run) {
  FILE* out = fopen(path, "w");
  if (out == NULL) return failed(path, "could not be created");
  print_json(out, run);
  const bool written = fflush(out) == 0 && !ferror(out) && fsync(fileno(out)) == 0;
  const bool closed = fclose(out) == 0;
  return (written && closed) || failed(path, "could not be written");
}

bool save_results(const char* path, const run_result* run) {
  static const char ending[] = ".new";
  char* beside = malloc(strlen(path) + sizeof ending);
  if (beside == NULL) return failed(path, "could not be saved");
  strcat(strcpy(beside, path), ending);
  const bool saved = write_results(beside, run) && (rename(beside, path) == 0 || failed(path, "could not be replaced"));
  free(beside);
  return saved;
}

/* --- reading */

/* All of a file and a 0 after it; NULL if it can't be read. */
static char* read_all(FILE* in) {
  struct stat facts;
  if (fstat(fileno(in), &facts) != 0) return NULL;
  const size_t size = (size_t)facts.st_size;
  char* text = malloc(size + 1);
  if (text == NULL || fread(text, 1, size, in) != size) {
    free(text);
    return NULL;
  }
  text[size] = '\0';
  return text;
}

static bool read_results(const char* path, const char* text, run_result* run) {
  json_reader reader = {path, text, text};
  if (read_json(&reader, run)) return true;
  fprintf(stderr, "tactus run: %s: not whole, left as it is; mend it, or write to another file\n", path);
  return false;
}

bool load_results(const char* path, run_result* run) {
  FILE* in = fopen(path, "r");
  if (in == NULL) return errno == ENOENT || failed(path, "could not be opened");
  char* text = read_all(in);
  const bool loaded = text != NULL ? read_results(path, text, run) : failed(path, "could not be read");
  free(text);
  fclose(in);
  return loaded;
}

/* --- taking over */

static bool seeds_belong(const char* path, const run_result* run, uint64_t first, int count) {
  for (int i = 0; i < run->count; ++i) {
    const uint64_t seed = run->trials[i].seed;
    if (seed - first < (uint64_t)count) continue;
    fprintf(stderr,
            "tactus run: %s: found a trial of seed %" PRIu64 ", expected %d seeds from %" PRIu64
            " on; ask for it too, or write to another file\n",
            path, seed, count, first);
    return false;
  }
  return true;
}

bool trials_belong(const char* path, const run_result* run, const run_setting* setting, uint64_t first, int count) {
  setting_difference difference;
  if (run->count == 0) return true;
  if (same_setting(&run->setting, setting, &difference)) return seeds_belong(path, run, first, count);
  fprintf(stderr,
          "tactus run: %s: found trials with %s %s, expected %s as asked for now; ask for the same to go on with them, "
          "or write to another file\n",
          path, difference.name, difference.found, difference.expected);
  return false;
}
