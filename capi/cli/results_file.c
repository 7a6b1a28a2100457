/* SPDX-License-Identifier: BSD-3-Clause */
#include "results_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool is_stdout(const char* path) { return path != NULL && strcmp(path, "-") == 0; }

bool is_replaceable(const char* path) {
  struct stat facts;
  return !is_stdout(path) && (stat(path, &facts) != 0 || S_ISREG(facts.st_mode));
}

static bool failed(const char* path, const char* what) {
  fprintf(stderr, "tactus: %s: %s: %s\n", path, what, strerror(errno));
  return false;
}

/* --- saving */

static bool write_beside(const char* path, const results_file* file) {
  FILE* out = fopen(path, "w");
  if (out == NULL) return failed(path, "could not be created");
  file->format->print(out, file->results);
  const bool written = fflush(out) == 0 && !ferror(out) && fsync(fileno(out)) == 0;
  const bool closed = fclose(out) == 0;
  return (written && closed) || failed(path, "could not be written");
}

static bool replace(const results_file* file) {
  static const char ending[] = ".new";
  char* beside = malloc(strlen(file->path) + sizeof ending);
  if (beside == NULL) return failed(file->path, "could not be saved");
  strcat(strcpy(beside, file->path), ending);
  const bool saved =
      write_beside(beside, file) && (rename(beside, file->path) == 0 || failed(file->path, "could not be replaced"));
  free(beside);
  return saved;
}

bool save_results(const results_file* file) {
  return file->path == NULL || !is_replaceable(file->path) || replace(file);
}

FILE* open_for_writing(const char* path) {
  FILE* file = is_stdout(path) ? stdout : fopen(path, "w");
  if (file == NULL) fprintf(stderr, "tactus: %s: found a file that can't be written\n", path);
  return file;
}

bool close_written(FILE* file) {
  if (file == NULL || (file == stdout ? fflush(file) : fclose(file)) == 0) return true;
  fputs("tactus: could not write all of the results\n", stderr);
  return false;
}

bool write_at_end(const results_file* file) {
  if (file->path == NULL || is_replaceable(file->path)) return true;
  FILE* out = open_for_writing(file->path);
  if (out == NULL) return false;
  file->format->print(out, file->results);
  return close_written(out);
}

/* --- reading */

static bool read_all(FILE* in, uint8_t** bytes, size_t* size) {
  struct stat facts;
  if (fstat(fileno(in), &facts) != 0) return false;
  *size = (size_t)facts.st_size;
  *bytes = malloc(*size + 1);
  if (*bytes == NULL || fread(*bytes, 1, *size, in) != *size) return false;
  (*bytes)[*size] = '\0';
  return true;
}

bool read_file(const char* path, uint8_t** bytes, size_t* size) {
  *bytes = NULL;
  FILE* in = fopen(path, "r");
  if (in == NULL) return errno == ENOENT || failed(path, "could not be opened");
  const bool whole = read_all(in, bytes, size) || failed(path, "could not be read");
  fclose(in);
  if (!whole) free(*bytes), *bytes = NULL;
  return whole;
}

static bool read_results(const results_file* file, const char* text) {
  json_reader reader = {file->path, text, text};
  if (file->format->read(&reader, file->results) && json_expect_end(&reader)) return true;
  fprintf(stderr, "tactus: %s: not whole, left as it is; mend it, or write to another file\n", file->path);
  return false;
}

bool load_results(const results_file* file) {
  uint8_t* text = NULL;
  size_t size = 0;
  if (!read_file(file->path, &text, &size)) return false;
  const bool loaded = text == NULL || read_results(file, (const char*)text);
  free(text);
  return loaded;
}
