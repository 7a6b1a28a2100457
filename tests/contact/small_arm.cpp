// SPDX-License-Identifier: BSD-3-Clause
#include "contact/small_arm.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace tactus::test {

namespace {

constexpr const char* small_arm_urdf = R"(<?xml version="1.0"?>
<robot name="small_arm">
  <link name="base"><collision><origin xyz="0 0 0.05"/><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link>
  <link name="turret"><collision><origin xyz="0 0 0.07"/><geometry><cylinder radius="0.06" length="0.13"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0 0 0.2"/><geometry><box size="0.08 0.08 0.42"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0 0 0.18"/><geometry><cylinder radius="0.04" length="0.33"/></geometry></collision></link>
  <link name="wrist_1"><collision><origin xyz="0 0 0.04"/><geometry><box size="0.07 0.07 0.07"/></geometry></collision></link>
  <link name="wrist_2"><collision><origin xyz="0 0 0.04"/><geometry><box size="0.06 0.08 0.06"/></geometry></collision></link>
  <link name="wrist_3"><collision><origin xyz="0 0 0.04"/><geometry><cylinder radius="0.03" length="0.06"/></geometry></collision></link>
  <link name="flange"/>
  <link name="plate"><collision><geometry><box size="0.12 0.02 0.04"/></geometry></collision></link>
  <joint name="j1" type="revolute"><parent link="base"/><child link="turret"/><origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>
    <limit lower="-3.1" upper="3.1" velocity="2" effort="1"/></joint>
  <joint name="j2" type="revolute"><parent link="turret"/><child link="upper"/><origin xyz="0 0 0.14"/><axis xyz="0 1 0"/>
    <limit lower="-2.2" upper="2.2" velocity="2" effort="1"/></joint>
  <joint name="j3" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0 0 0.42"/><axis xyz="0 1 0"/>
    <limit lower="-2.8" upper="2.8" velocity="3" effort="1"/></joint>
  <joint name="j4" type="revolute"><parent link="lower"/><child link="wrist_1"/><origin xyz="0 0 0.35"/><axis xyz="0 0 1"/>
    <limit lower="-3.1" upper="3.1" velocity="3" effort="1"/></joint>
  <joint name="j5" type="revolute"><parent link="wrist_1"/><child link="wrist_2"/><origin xyz="0 0 0.08"/><axis xyz="0 1 0"/>
    <limit lower="-2.5" upper="2.5" velocity="3" effort="1"/></joint>
  <joint name="j6" type="revolute"><parent link="wrist_2"/><child link="wrist_3"/><origin xyz="0 0 0.07"/><axis xyz="0 0 1"/>
    <limit lower="-3.1" upper="3.1" velocity="4" effort="1"/></joint>
  <joint name="to_flange" type="fixed"><parent link="wrist_3"/><child link="flange"/><origin xyz="0 0 0.07"/></joint>
  <joint name="to_plate" type="fixed"><parent link="flange"/><child link="plate"/><origin xyz="0 0 0.02"/></joint>
</robot>
)";

}  // namespace

Model small_arm() {
  const auto file =
      std::filesystem::temp_directory_path() / ("tactus_small_arm_" + std::to_string(::getpid()) + ".urdf");
  std::ofstream(file) << small_arm_urdf;
  auto model =
      std::make_shared<const robot::RobotModel>(robot::load_model({.urdf = file, .package_roots = {}, .srdf = {}}));
  std::filesystem::remove(file);
  return model;
}

Model makers_ur10e() {
  const char* folder = std::getenv("TACTUS_TEST_MODELS");
  const std::filesystem::path models = folder != nullptr ? folder : TACTUS_SOURCE_DIR "/../shared/models";
  const std::filesystem::path ur10e = models / "ur10e";
  if (!std::filesystem::exists(ur10e / "ur10e.urdf")) return nullptr;
  return std::make_shared<const robot::RobotModel>(robot::load_model(
      {.urdf = ur10e / "ur10e.urdf", .package_roots = {{"ur_description", ur10e / "ur_description"}}, .srdf = {}}));
}

robot::JointVector random_configuration(const robot::RobotModel& model, support::Rng& rng) {
  robot::JointVector q(model.dof());
  for (int j = 0; j < model.dof(); ++j) {
    const robot::Joint& joint = model.joints[static_cast<std::size_t>(j)];
    q[j] = rng.uniform(joint.lower, joint.upper);
  }
  return q;
}

robot::JointVector joints(std::initializer_list<double> values) {
  return Eigen::Map<const robot::JointVector>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace tactus::test
