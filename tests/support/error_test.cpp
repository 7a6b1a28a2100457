// SPDX-License-Identifier: BSD-3-Clause
#include "support/error.hpp"

#include <gtest/gtest.h>

namespace tactus::support {
namespace {

const std::vector<Problem> two{{"a.yaml:1: x", "-1", "a width >= 0"}, {"a.yaml:2: y", "nothing", "a number"}};

TEST(Problems, AreALineEach) {
  EXPECT_EQ(to_text(two),
            "a.yaml:1: x: found -1, expected a width >= 0\na.yaml:2: y: found nothing, expected a number");
  EXPECT_EQ(to_text({}), "");
}

TEST(Problems, AreThrownTogether) {
  EXPECT_NO_THROW(throw_if_any({}, Status::bad_scenario, "a.yaml"));
  try {
    throw_if_any(two, Status::bad_scenario, "a.yaml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::bad_scenario);
    EXPECT_EQ(std::string(error.what()), "a.yaml: 2 problems\n" + to_text(two));
  }
}

TEST(Problems, OneAloneIsNotCalledProblems) {
  try {
    throw_if_any({two[0]}, Status::bad_mesh, "a.stl");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find("a.stl: 1 problem\n"), 0u);
  }
}

}  // namespace
}  // namespace tactus::support
