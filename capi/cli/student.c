/* SPDX-License-Identifier: BSD-3-Clause */
#include "student.h"

#include <math.h>

static const double two_by_pi = 0.63661977236758134;

/* The share between -t and t [Abramowitz and Stegun, 26.7.3 and 26.7.4]. */
static double share_within(double t, int degrees) {
  const double angle = atan2(t, sqrt((double)degrees)), c = cos(angle);
  const int odd = degrees % 2;
  double term = odd ? c : 1.0, sum = 0.0;
  for (int power = odd; power <= degrees - 2; power += 2) {
    sum += term;
    term *= c * c * (power + 1.0) / (power + 2.0);
  }
  return odd ? two_by_pi * (angle + sin(angle) * sum) : sin(angle) * sum;
}

double student_95(int degrees) {
  if (degrees < 1) return NAN;
  double low = 0.0, high = 16.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    if (share_within(middle, degrees) < 0.95)
      low = middle;
    else
      high = middle;
  }
  return high;
}
