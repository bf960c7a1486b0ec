// SPDX-License-Identifier: Apache-2.0
// Messages from and to a board with motors and encoders, in the frames of grippers (devices/gripper/frame.hpp):
//
//     torque, kind 3, n = 10:  0  flags: bit 0 run (else no torque)   1  number of motors
//                              2  int32 torque of motor 0, µN·m      6  int32 of motor 1
//     joints, kind 4, n = 20:  0  flags: bit 0: no torque, because no torque frame came for 20 ms
//                              1  number of motors    2  uint16 sequence number of the last torque frame
//                              4  int32 angle of motor 0, µrad   8  int32 of motor 1
//                              12 uint16 buttons, bit n: button n   14 zero   16 uint32 serial number, 0: none
//
// A board answers each torque frame with a joints frame, and gives no torque if no valid frame came for 20 ms.
#pragma once

#include "devices/gripper/frame.hpp"

#include <array>
#include <cstdint>

namespace tactus::board {

struct TorqueFrame {
    bool run = false;
    int motors = 1;
    std::array<double, 2> torque{};  ///< N·m
};

struct JointsFrame {
    bool holds = false;
    int motors = 1;
    std::uint16_t answers = 0;
    std::array<double, 2> angle{};  ///< rad
    std::uint32_t buttons = 0, serial = 0;
};

gripper::Frame pack(const TorqueFrame& torque, std::uint16_t sequence) noexcept;
gripper::Frame pack(const JointsFrame& joints, std::uint16_t sequence) noexcept;
/// Returns false for another kind or length.
bool unpack(const gripper::Frame& frame, TorqueFrame& out) noexcept;
bool unpack(const gripper::Frame& frame, JointsFrame& out) noexcept;

}  // namespace tactus::board
