#pragma once

#include <stdexcept>
#include <string>

namespace casepush {

/// A cart for tests: a box with one caster of trail 0.02 m at (0.2, 0.1) and one fixed wheel.
inline std::string smallCartUrdf() {
  return R"(<?xml version="1.0"?>
<robot name="cart">
  <link name="body">
    <inertial>
      <origin xyz="0.1 0 0.3"/>
      <mass value="10"/>
      <inertia ixx="0.5" ixy="0" ixz="0" iyy="0.6" iyz="0" izz="0.7"/>
    </inertial>
    <visual>
      <geometry><box size="0.6 0.4 0.2"/></geometry>
      <material name="red"><color rgba="0.9 0.1 0.2 1"/></material>
    </visual>
    <collision>
      <origin xyz="0 0 0.3"/>
      <geometry><box size="0.6 0.4 0.2"/></geometry>
    </collision>
  </link>
  <link name="fork">
    <inertial>
      <mass value="0.4"/>
      <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/>
    </inertial>
  </link>
  <link name="wheel">
    <inertial>
      <mass value="0.6"/>
      <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/>
    </inertial>
    <collision>
      <origin rpy="1.5707963267948966 0 0"/>
      <geometry><cylinder radius="0.05" length="0.04"/></geometry>
    </collision>
  </link>
  <link name="fixed_wheel">
    <inertial>
      <mass value="0.6"/>
      <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/>
    </inertial>
    <collision>
      <geometry><sphere radius="0.05"/></geometry>
    </collision>
  </link>
  <joint name="swivel" type="continuous">
    <parent link="body"/>
    <child link="fork"/>
    <origin xyz="0.2 0.1 0.12"/>
    <axis xyz="0 0 1"/>
    <dynamics friction="0.1"/>
  </joint>
  <joint name="axle" type="continuous">
    <parent link="fork"/>
    <child link="wheel"/>
    <origin xyz="-0.02 0 -0.07"/>
    <axis xyz="0 1 0"/>
  </joint>
  <joint name="fixed_axle" type="continuous">
    <parent link="body"/>
    <child link="fixed_wheel"/>
    <origin xyz="-0.2 0 0.05"/>
    <axis xyz="0 1 0"/>
  </joint>
</robot>
)";
}

inline std::string smallCartYaml() {
  return "class: cart\ntags:\n"
         "  - {id: 4, size_m: 0.1, xyz: [0.31, 0, 0.3], rpy_deg: [-90, 0, 90]}\n"
         "  - {id: 5, size_m: 0.1, xyz: [-0.31, 0, 0.3], rpy_deg: [-90, 0, -90]}\n";
}

inline std::string smallRobotUrdf() {
  return R"(<robot name="bot">
  <link name="base_link">
    <inertial>
      <origin xyz="0 0 0.2"/>
      <mass value="20"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    </inertial>
    <collision>
      <origin xyz="0 0 0.2"/>
      <geometry><cylinder radius="0.3" length="0.3"/></geometry>
    </collision>
  </link>
</robot>
)";
}

inline std::string smallRobotYaml() {
  return R"(limits:
  max_speed_mps: 0.5
  max_yaw_rate_rps: 1.0
  max_acceleration_mps2: 0.8
  max_yaw_acceleration_rps2: 2.0
  max_force_n: 150
  max_torque_nm: 40
cameras:
  - name: left
    xyz: [0, 0.3, 0.5]
    rpy_deg: [0, 30, 90]
    width_px: 640
    height_px: 480
    horizontal_fov_deg: 90
    rate_hz: 15
    latency_s: 0.05
    max_range_m: 5
    max_view_angle_deg: 70
    corner_noise_px: 0.3
    dropout: 0.02
)";
}

inline std::string smallWorldYaml() {
  return R"(bounds: {min: [-2, -3], max: [4, 5]}
floor: {friction: 0.7, rolling_lever_arm_m: 0.003}
robot: {model: bot, xy: [-1, 0], yaw_deg: 90}
objects:
  - {id: cart_1, model: cart, xy: [1, 2], yaw_deg: -45, tag_offset: 10}
  - {id: cart_2, model: cart, xy: [2, 0], yaw_deg: 0}
goal: {xy: [3, 3], yaw_deg: 180}
boxes:
  - {name: wall, size_m: [6, 0.1, 1], xyz: [1, 5, 0.5]}
  - {name: table, size_m: [1, 2, 0.1], xyz: [0, 0, 0.7], yaw_deg: 30}
)";
}

/// The text with the first `from` replaced, which must be there.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    throw std::logic_error("no '" + from + "' to replace");
  }
  return text.replace(at, from.size(), to);
}

}  // namespace casepush
