/* SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "instance_options.h"
#include "options.h"
#include "tactus/tactus.h"

static void print_log(int32_t level, const char* message, void* context) {
  (void)context;
  if (level >= TACTUS_LOG_WARNING)
    fprintf(stderr, "tactus: %s: %s\n", level == TACTUS_LOG_ERROR ? "error" : "warning", message);
}

int main(int argc, char** argv) {
  const char* command = argc > 1 ? argv[1] : "";
  tactus_set_log_callback(print_log, NULL);
  if (strcmp(command, "run") == 0) return run_command(argc - 2, argv + 2);
  if (strcmp(command, "compare") == 0) return compare_command(argc - 2, argv + 2);
  if (strcmp(command, "check") == 0) return check_command(argc - 2, argv + 2);
  if (strcmp(command, "export") == 0) return export_command(argc - 2, argv + 2);
  if (strcmp(command, "evaluate") == 0) return evaluate_command(argc - 2, argv + 2);
  if (strcmp(command, "--version") == 0) {
    printf("tactus %s\n", tactus_version_string());
    return exit_good;
  }
  const int asked = strcmp(command, "--help") == 0;
  fputs(usage, asked ? stdout : stderr);
  fputs(instance_usage, asked ? stdout : stderr);
  return asked ? exit_good : exit_usage;
}
