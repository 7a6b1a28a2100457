/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_STUDENT_H
#define TACTUS_CLI_STUDENT_H

/* The t beyond which, on both sides, 5 % of Student's distribution lie; NAN without a degree of freedom. */
double student_95(int degrees);

#endif
