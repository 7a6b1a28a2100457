/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_COMPARISON_JSON_H
#define TACTUS_CLI_COMPARISON_JSON_H

#include "results_file.h"

/* The results of `tactus compare`, a comparison. */
extern const results_format comparison_format;

#endif
