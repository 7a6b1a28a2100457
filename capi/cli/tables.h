/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_TABLES_H
#define TACTUS_CLI_TABLES_H

#include <stdbool.h>

#include "tactus/tactus.h"

/* A scenario's tables of contact in a file, for the next start. `path`: NULL is legal and means nowhere. False: stderr
 * says why. */

/* Takes in a file that may be there. */
bool load_tables(const char* path, const tactus_scenario* scenario);

bool save_tables(const char* path, const tactus_scenario* scenario);

#endif
