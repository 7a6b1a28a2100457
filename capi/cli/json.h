/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_JSON_H
#define TACTUS_CLI_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* The pieces of JSON that the command writes. A number that is not finite becomes null. */
void json_text(FILE* out, const char* text);
void json_bool(FILE* out, bool value);
void json_number(FILE* out, double value, int digits);
void json_numbers(FILE* out, const double* values, size_t count, int digits);

/* `, "key": ` and the value. */
void json_bool_field(FILE* out, const char* key, bool value);
void json_number_field(FILE* out, const char* key, double value, int digits);
void json_numbers_field(FILE* out, const char* key, const double* values, size_t count, int digits);

enum { json_full = 9, json_short = 5 }; /* significant digits: of results; of what is drawn */

/* A member of a struct as JSON has it. A table of these serves to write the struct and to read it back. */
typedef struct {
  const char* key;
  enum { member_text, member_bool, member_int, member_whole, member_count, member_double, member_doubles } type;
  size_t offset; /* of char[count], bool, int, uint64_t, double (whole or NAN), double, double[count] (null if its first
                    is NAN) */
  size_t count;
} json_member;

void json_member_value(FILE* out, const void* object, const json_member* member);

/* `"key": value` for each, `between` them what is said. */
void json_members(FILE* out, const void* object, const json_member* members, size_t count, const char* between);

#endif
