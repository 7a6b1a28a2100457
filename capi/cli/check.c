/* SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>
#include <stdlib.h>

#include "commands.h"
#include "tactus/tactus.h"

enum { enough = 1 << 20 }; /* bytes: checking takes seconds, so it is done once, with room for much */

int check_command(int argc, char** argv) {
  if (argc != 1) {
    fprintf(stderr, "usage: tactus check SCENARIO\n");
    return exit_usage;
  }
  char* text = malloc(enough);
  size_t count = 0;
  int result = exit_usage;
  if (text == NULL || tactus_scenario_check(argv[0], text, enough, &count) != TACTUS_OK) {
    fprintf(stderr, "tactus check: %s\n", text == NULL ? "out of memory" : tactus_last_error());
  } else if (text[0] != '\0') {
    printf("%s\n", text);
  } else {
    printf("%s: nothing wrong\n", argv[0]);
    result = exit_good;
  }
  free(text);
  return result;
}
