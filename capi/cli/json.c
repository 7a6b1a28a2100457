/* SPDX-License-Identifier: BSD-3-Clause */
#include "json.h"

#include <inttypes.h>
#include <math.h>

void json_text(FILE* out, const char* text) {
  fputc('"', out);
  for (; *text != '\0'; ++text) {
    const unsigned char c = (unsigned char)*text;
    if (c == '"' || c == '\\')
      fprintf(out, "\\%c", c);
    else if (c < 0x20)
      fprintf(out, "\\u%04x", c);
    else
      fputc(c, out);
  }
  fputc('"', out);
}

void json_bool(FILE* out, bool value) { fputs(value ? "true" : "false", out); }

void json_number(FILE* out, double value, int digits) {
  if (isfinite(value))
    fprintf(out, "%.*g", digits, value);
  else
    fputs("null", out);
}

void json_numbers(FILE* out, const double* values, size_t count, int digits) {
  fputc('[', out);
  for (size_t i = 0; i < count; ++i) {
    if (i > 0) fputc(',', out);
    json_number(out, values[i], digits);
  }
  fputc(']', out);
}

static void json_key(FILE* out, const char* key) { fprintf(out, ", \"%s\": ", key); }

void json_bool_field(FILE* out, const char* key, bool value) {
  json_key(out, key);
  json_bool(out, value);
}

void json_number_field(FILE* out, const char* key, double value, int digits) {
  json_key(out, key);
  json_number(out, value, digits);
}

void json_numbers_field(FILE* out, const char* key, const double* values, size_t count, int digits) {
  json_key(out, key);
  json_numbers(out, values, count, digits);
}

void json_member_value(FILE* out, const void* object, const json_member* member) {
  const void* value = (const char*)object + member->offset;
  const double* numbers = value;
  switch (member->type) {
    case member_text:
      json_text(out, value);
      break;
    case member_bool:
      json_bool(out, *(const bool*)value);
      break;
    case member_int:
      fprintf(out, "%d", *(const int*)value);
      break;
    case member_whole:
      fprintf(out, "%" PRIu64, *(const uint64_t*)value);
      break;
    case member_count:
    case member_double:
      json_number(out, *numbers, json_full);
      break;
    case member_doubles:
      if (isnan(numbers[0]))
        fputs("null", out);
      else
        json_numbers(out, numbers, member->count, json_full);
  }
}

void json_members(FILE* out, const void* object, const json_member* members, size_t count, const char* between) {
  for (size_t i = 0; i < count; ++i) {
    fprintf(out, "%s\"%s\": ", i > 0 ? between : "", members[i].key);
    json_member_value(out, object, &members[i]);
  }
}
