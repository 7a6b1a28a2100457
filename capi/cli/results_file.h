/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_RESULTS_FILE_H
#define TACTUS_CLI_RESULTS_FILE_H

#include "json_reader.h"

/* Results in a file that is whole at every moment. False: stderr says why. */

/* How a command writes its results, and reads them back into empty ones. */
typedef struct {
  void (*print)(FILE* out, const void* results);
  bool (*read)(json_reader* reader, void* results);
} results_format;

typedef struct {
  const char* path; /* NULL: nowhere */
  const results_format* format;
  void* results;
} results_file;

/* Whether there is a file at `path` that can be replaced, or none: not a pipe, a device or "-" for stdout. */
bool is_replaceable(const char* path);

/* Puts the results in the place of what the file holds, at once: they are first written beside it. What can't be
 * replaced is left for the end. */
bool save_results(const results_file* file);

/* Into what can't be replaced, such as stdout. */
bool write_at_end(const results_file* file);

/* Reads a file that may be there. */
bool load_results(const results_file* file);

/* All bytes of a file that may be there and a 0 after them, to be freed; NULL if there is none. */
bool read_file(const char* path, uint8_t** bytes, size_t* size);

bool is_stdout(const char* path);

/* NULL if it can't be. */
FILE* open_for_writing(const char* path);
bool close_written(FILE* file); /* NULL is legal */

#endif
