// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "solver/voxel_problem.hpp"

/// The paper's likelihood of a contact on voxels against its equations, written out.
namespace tactus::solver {
namespace {

using support::Rng;

constexpr double target_voxels = 100.0, diameter = 0.2;

std::vector<ContactEvidence> random_contacts(Rng& rng) {
  std::vector<ContactEvidence> contacts;
  for (std::uint64_t i = rng.below(4); i > 0; --i) {
    const double size = 1.0 + static_cast<double>(rng.below(100));
    contacts.push_back({rng.uniform(0.0, size), size, rng.uniform(-0.01, 0.25)});
  }
  return contacts;
}

TEST(ContactLikelihood, IsThePapersProduct) {
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    const double entered = static_cast<double>(1 + rng.below(60));
    const double possible = entered + static_cast<double>(rng.below(400));
    const std::vector<ContactEvidence> contacts = random_contacts(rng);
    const double others = possible - target_voxels;
    double expected = others > 0.0 ? std::min(1.0, entered / others) : 1.0;
    for (const auto& [overlap, size, distance] : contacts)
      expected *= (overlap + 1.0) / (size + 1.0) * (1.0 - std::clamp(distance / diameter, 0.0, 1.0));
    EXPECT_NEAR(contact_likelihood(entered, possible, target_voxels, diameter, contacts), expected, 1e-12);
  }
}

TEST(ContactLikelihood, IsNoneWhereNothingIsEntered) {
  Rng rng(2);
  for (const double possible : {0.0, 50.0, 100.0, 400.0})
    EXPECT_EQ(contact_likelihood(0.0, possible, target_voxels, diameter, random_contacts(rng)), 0.0);
}

TEST(FirstContactProbabilities, AreThoseOfAContactAfterNone) {
  Rng rng(3);
  for (int i = 0; i < 300; ++i) {
    std::vector<double> likelihood;
    for (std::uint64_t k = rng.below(40); k > 0; --k)
      likelihood.push_back(rng.below(3) == 0 ? static_cast<double>(rng.below(2)) : rng.uniform());
    const std::vector<double> first = first_contact_probabilities(likelihood);
    ASSERT_EQ(first.size(), likelihood.size() + 1);
    double still_free = 1.0, total = first.back();
    for (std::size_t k = 0; k < likelihood.size(); ++k) {
      EXPECT_NEAR(first[k], still_free * likelihood[k], 1e-12);
      still_free *= 1.0 - likelihood[k];
      total += first[k];
    }
    EXPECT_NEAR(first.back(), still_free, 1e-12);
    EXPECT_NEAR(total, 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace tactus::solver
