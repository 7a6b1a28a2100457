// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "robot/model.hpp"
#include "support/error.hpp"
#include "support/log.hpp"
#include "support/rng.hpp"

namespace tactus::robot::testing {

/// A folder of one test's own, removed at its end.
class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "tactus_robot_XXXXXX").string();
    path_ = std::filesystem::canonical(mkdtemp(name.data()));
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::filesystem::path& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// The log lines of its lifetime.
class CaptureLog {
 public:
  CaptureLog() {
    support::set_log_sink([](support::LogLevel, const char* text,
                             void* me) { static_cast<CaptureLog*>(me)->text_ += text + std::string("\n"); },
                          this);
  }
  ~CaptureLog() { support::set_log_sink(nullptr, nullptr); }
  CaptureLog(const CaptureLog&) = delete;
  CaptureLog& operator=(const CaptureLog&) = delete;
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

inline RobotModel load_text(const std::string& urdf) {
  const TempFolder folder;
  return load_model({folder.write("robot.urdf", urdf), {}, {}});
}

/// Every kind of joint, two of them mimic, a branch, and fixed links between.
inline const char* const tree_urdf = R"(<?xml version="1.0"?>
<robot name="tree">
  <link name="base"><collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link>
  <link name="post"/>
  <link name="upper"><collision><origin xyz="0 0 0.2"/><geometry><cylinder radius="0.05" length="0.4"/></geometry></collision></link>
  <link name="slide"/>
  <link name="wrist"><collision><geometry><sphere radius="0.07"/></geometry></collision></link>
  <link name="follower"/>
  <link name="finger"/>
  <link name="tip"/>
  <joint name="stand" type="fixed"><parent link="base"/><child link="post"/><origin xyz="0.1 -0.2 0.3" rpy="0.1 0.2 0.3"/></joint>
  <joint name="shoulder" type="revolute"><parent link="post"/><child link="upper"/><origin xyz="0 0 0.1" rpy="0 1.2 0"/>
    <axis xyz="0 3 4"/><limit lower="-2" upper="2.5" velocity="2" effort="1"/></joint>
  <joint name="rail" type="prismatic"><parent link="upper"/><child link="slide"/><origin xyz="0 0.05 0.4" rpy="-0.4 0 0.7"/>
    <axis xyz="1 0 1"/><limit lower="-0.1" upper="0.3" velocity="0.5" effort="1"/></joint>
  <joint name="spin" type="continuous"><parent link="slide"/><child link="wrist"/><origin xyz="0.1 0 0" rpy="0 0 1"/>
    <axis xyz="0 0 -1"/><limit velocity="3" effort="1"/></joint>
  <joint name="echo" type="revolute"><parent link="wrist"/><child link="follower"/><origin xyz="0 0.2 0"/>
    <axis xyz="1 0 0"/><limit lower="-9" upper="9" velocity="9" effort="1"/><mimic joint="shoulder" multiplier="-0.5" offset="0.3"/></joint>
  <joint name="grip" type="prismatic"><parent link="upper"/><child link="finger"/><origin xyz="0 0 0.1" rpy="1 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-9" upper="9" velocity="9" effort="1"/><mimic joint="rail" multiplier="2"/></joint>
  <joint name="flange" type="fixed"><parent link="follower"/><child link="tip"/><origin xyz="0.05 0.06 0.07" rpy="0.3 -0.2 0.9"/></joint>
</robot>)";

/// Six revolute joints of a common industrial arm: a shoulder, an elbow and a wrist whose axes do not meet. DH
/// parameters of a UR10e.
inline const char* const arm_urdf = R"(<robot name="arm">
  <link name="base"/><link name="l1"/><link name="l2"/><link name="l3"/><link name="l4"/><link name="l5"/><link name="l6"/>
  <joint name="pan" type="revolute"><parent link="base"/><child link="l1"/><origin xyz="0 0 0.1807"/>
    <axis xyz="0 0 1"/><limit lower="-6.2832" upper="6.2832" velocity="2" effort="1"/></joint>
  <joint name="lift" type="revolute"><parent link="l1"/><child link="l2"/><origin rpy="1.5707963267948966 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-6.2832" upper="6.2832" velocity="2" effort="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="l2"/><child link="l3"/><origin xyz="-0.6127 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-3.1416" upper="3.1416" velocity="3" effort="1"/></joint>
  <joint name="wrist1" type="revolute"><parent link="l3"/><child link="l4"/><origin xyz="-0.57155 0 0.17415"/>
    <axis xyz="0 0 1"/><limit lower="-6.2832" upper="6.2832" velocity="3" effort="1"/></joint>
  <joint name="wrist2" type="revolute"><parent link="l4"/><child link="l5"/><origin xyz="0 -0.11985 0" rpy="1.5707963267948966 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-6.2832" upper="6.2832" velocity="3" effort="1"/></joint>
  <joint name="wrist3" type="revolute"><parent link="l5"/><child link="l6"/><origin xyz="0 0.11655 0" rpy="-1.5707963267948966 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-6.2832" upper="6.2832" velocity="3" effort="1"/></joint>
</robot>)";

inline JointVector random_inside(const RobotModel& model, support::Rng& rng) {
  JointVector q(model.dof());
  for (int j = 0; j < model.dof(); ++j) {
    const Joint& joint = model.joints[static_cast<std::size_t>(j)];
    q[j] = joint.kind == JointKind::continuous ? rng.uniform(-4.0, 4.0) : rng.uniform(joint.lower, joint.upper);
  }
  return q;
}

/// Folder of robots made by others; tests that need it skip where it is not.
inline std::filesystem::path models_folder() {
  const char* named = std::getenv("TACTUS_TEST_MODELS");
  return named != nullptr ? std::filesystem::path(named)
                          : std::filesystem::path(TACTUS_SOURCE_DIR) / "../shared/models";
}

}  // namespace tactus::robot::testing
