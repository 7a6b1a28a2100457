/* SPDX-License-Identifier: BSD-3-Clause */
#include "json_reader.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void skip_spaces(json_reader* reader) { reader->at += strspn(reader->at, " \n"); }

bool json_complain(const json_reader* reader, const char* expected) {
  int line = 1;
  for (const char* c = reader->text; c < reader->at; ++c) line += *c == '\n';
  const int shown = (int)strcspn(reader->at, "\n");
  fprintf(stderr, "tactus: %s:%d: found ", reader->path, line);
  if (*reader->at == '\0')
    fputs("the end of the file", stderr);
  else
    fprintf(stderr, "'%.*s'", shown < 24 ? shown : 24, reader->at);
  fprintf(stderr, ", expected %s\n", expected);
  return false;
}

bool json_next(json_reader* reader, const char* token) {
  skip_spaces(reader);
  const size_t length = strlen(token);
  if (strncmp(reader->at, token, length) != 0) return false;
  reader->at += length;
  return true;
}

bool json_expect(json_reader* reader, const char* token) {
  return json_next(reader, token) || json_complain(reader, token);
}

bool json_expect_key(json_reader* reader, const char* key) {
  char token[64];
  snprintf(token, sizeof token, "\"%s\":", key);
  return json_expect(reader, token);
}

/* To behind a text that begins here. */
static void skip_text(json_reader* reader) {
  for (++reader->at; *reader->at != '\0' && *reader->at != '"'; ++reader->at)
    if (reader->at[0] == '\\' && reader->at[1] != '\0') ++reader->at;
}

bool json_skip(json_reader* reader) {
  int depth = 0;
  for (; *reader->at != '\0'; ++reader->at) {
    if (depth == 0 && strchr(",]}", *reader->at) != NULL) return true;
    if (strchr("[{", *reader->at) != NULL) ++depth;
    if (strchr("]}", *reader->at) != NULL) --depth;
    if (*reader->at == '"') skip_text(reader);
    if (*reader->at == '\0') break;
  }
  return json_complain(reader, "a value before this");
}

bool json_expect_end(json_reader* reader) {
  skip_spaces(reader);
  return *reader->at == '\0' || json_complain(reader, "the end of the file");
}

/* One character of a text, which may be escaped as `json_text` does; 0 at the text's end or where none can be. */
static char read_character(json_reader* reader) {
  unsigned code = 0;
  int length = 0;
  const char* c = reader->at;
  if ((unsigned char)c[0] < 0x20 || c[0] == '"') return '\0';
  if (c[0] != '\\')
    code = (unsigned char)c[0], length = 1;
  else if (c[1] == '"' || c[1] == '\\')
    code = (unsigned char)c[1], length = 2;
  else if (sscanf(c, "\\u00%2x%n", &code, &length) != 1 || length != 6)
    return '\0';
  reader->at += length;
  return (char)code;
}

bool json_read_text(json_reader* reader, char* text, size_t room) {
  if (!json_next(reader, "\"")) return json_complain(reader, "a text");
  size_t length = 0;
  char c;
  while (length + 1 < room && (c = read_character(reader)) != '\0') text[length++] = c;
  text[length] = '\0';
  return json_expect(reader, "\"");
}

bool json_read_whole(json_reader* reader, uint64_t* value, uint64_t most) {
  skip_spaces(reader);
  char* end = NULL;
  errno = 0;
  *value = isdigit((unsigned char)*reader->at) ? strtoull(reader->at, &end, 10) : 0;
  if (end == NULL || errno != 0 || *value > most) return json_complain(reader, "a whole number");
  reader->at = end;
  return true;
}

static bool read_int(json_reader* reader, int* value) {
  uint64_t whole = 0;
  if (!json_read_whole(reader, &whole, INT_MAX)) return false;
  *value = (int)whole;
  return true;
}

static bool read_bool(json_reader* reader, bool* value) {
  *value = json_next(reader, "true");
  return *value || json_next(reader, "false") || json_complain(reader, "true or false");
}

static bool read_count(json_reader* reader, double* value) {
  uint64_t whole = 0;
  *value = NAN;
  if (json_next(reader, "null")) return true;
  if (!json_read_whole(reader, &whole, UINT64_MAX)) return false;
  *value = (double)whole;
  return true;
}

static bool read_number(json_reader* reader, double* value) {
  *value = NAN;
  if (json_next(reader, "null")) return true;
  char* end = NULL;
  if (isdigit((unsigned char)*reader->at) || *reader->at == '-') *value = strtod(reader->at, &end);
  if (!isfinite(*value)) return json_complain(reader, "a number or null");
  reader->at = end;
  return true;
}

static bool read_numbers(json_reader* reader, double* values, size_t count) {
  values[0] = NAN;
  if (json_next(reader, "null")) return true;
  for (size_t i = 0; i < count; ++i)
    if (!json_expect(reader, i == 0 ? "[" : ",") || !read_number(reader, &values[i])) return false;
  return json_expect(reader, "]");
}

static bool read_value(json_reader* reader, void* value, const json_member* member) {
  switch (member->type) {
    case member_text:
      return json_read_text(reader, value, member->count);
    case member_bool:
      return read_bool(reader, value);
    case member_int:
      return read_int(reader, value);
    case member_whole:
      return json_read_whole(reader, value, UINT64_MAX);
    case member_count:
      return read_count(reader, value);
    case member_double:
      return read_number(reader, value);
    case member_doubles:
      return read_numbers(reader, value, member->count);
  }
  return false;
}

bool json_read_members(json_reader* reader, void* object, const json_member* members, size_t count) {
  for (size_t i = 0; i < count; ++i)
    if ((i > 0 && !json_expect(reader, ",")) || !json_expect_key(reader, members[i].key) ||
        !read_value(reader, (char*)object + members[i].offset, &members[i]))
      return false;
  return true;
}
