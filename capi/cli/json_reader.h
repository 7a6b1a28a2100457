/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_JSON_READER_H
#define TACTUS_CLI_JSON_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "json.h"

/* Reads back what the command itself has written: the members in their order and no others. A function that returns
 * false has said on stderr where, what it found and what it expected. */
typedef struct {
  const char* path; /* for messages */
  const char* text; /* all of the file, ends with 0 */
  const char* at;   /* what is to be read next */
} json_reader;

bool json_complain(const json_reader* reader, const char* expected);

/* Passes the token, if it is what comes next. */
bool json_next(json_reader* reader, const char* token);
bool json_expect(json_reader* reader, const char* token);
bool json_expect_key(json_reader* reader, const char* key);
/* Passes a value, whatever it is. */
bool json_skip(json_reader* reader);

bool json_expect_end(json_reader* reader);

bool json_read_text(json_reader* reader, char* text, size_t room);
bool json_read_whole(json_reader* reader, uint64_t* value, uint64_t most);
bool json_read_members(json_reader* reader, void* object, const json_member* members, size_t count);

#endif
