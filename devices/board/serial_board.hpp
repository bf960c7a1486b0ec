// SPDX-License-Identifier: Apache-2.0
// Drivers "serial_board" (a board that uses Tactus' frames) and "haply_2diy".
#pragma once

#include "devices/driver/backend.hpp"
#include "graph/node/options.hpp"

#include <memory>

namespace tactus::board {

/// Options: port, baud, mechanism, radius, proximal, distal, spacing, motors, max_torque, max_force, serial. Throws
/// Error.
std::unique_ptr<driver::Backend> make_serial_board(Options& options);

/// Options: those of serial_board except mechanism and radius; offset_1, offset_2, counts. Throws Error.
std::unique_ptr<driver::Backend> make_haply_2diy(Options& options);

}  // namespace tactus::board
