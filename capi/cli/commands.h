/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_COMMANDS_H
#define TACTUS_CLI_COMMANDS_H

/* Exit statuses of the command. */
enum { exit_good = 0, exit_not_inserted = 1, exit_usage = 2 };

/* Each takes what follows the command's name and returns an exit status. */
int run_command(int argc, char** argv);
int compare_command(int argc, char** argv);
int check_command(int argc, char** argv);
int export_command(int argc, char** argv);
int evaluate_command(int argc, char** argv);

#endif
