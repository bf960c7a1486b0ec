// SPDX-License-Identifier: Apache-2.0
// The test matrix of the gripper's test rig: motors, objects, rates, amplitudes, and ranges of the assumptions about
// motors.
#pragma once

#include "dsp/control/virtual_object.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

struct RigObject {
    std::string name;
    control::ObjectKind kind = control::ObjectKind::elastic;      ///< elastic or wall
    double stiffness = 0.0, damping = 0.0;      ///< N/m, N·s/m
};

/// An assumed option of a motor with its lower and upper limit, in the syntax of a patch.
struct RigAssumption {
    std::string motor, option, low, high;
};

struct RigMatrix {
    std::vector<std::string> motors{"wqsm", "twum"};  ///< names of devices in the patch
    std::vector<RigObject> objects{{"spring 0.2 N/mm", control::ObjectKind::elastic, 200.0, 0.0},
                                   {"spring 1 N/mm", control::ObjectKind::elastic, 1000.0, 0.0},
                                   {"spring 5 N/mm", control::ObjectKind::elastic, 5000.0, 0.0},
                                   {"spring 0.2 N/mm + damper 0.02 N s/mm", control::ObjectKind::elastic, 200.0, 20.0},
                                   {"damper 0.02 N s/mm", control::ObjectKind::elastic, 0.0, 20.0},
                                   {"wall", control::ObjectKind::wall, 0.0, 0.0}};
    std::vector<double> rates{0.1, 0.2, 0.5, 1.0, 2.0, 4.0};  ///< Hz
    std::vector<double> amplitudes{0.007, 0.025};             ///< m, amplitude of the cord (half of peak to peak)
    int cycles = 4;                                           ///< evaluated cycles per cell
    std::vector<double> crossover_stiffness{200.0, 500.0, 1000.0};  ///< N/m
    std::vector<double> crossover_rates{0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2,
                                        1.5,  1.8, 2.2, 2.7, 3.3, 4.0, 6.0};  ///< Hz
    double crossover_force = 2.2;  ///< N; limits the amplitude of the cord by the force at the finger
    std::vector<RigAssumption> assumptions{{"wqsm", "lag", "1 ms", "4 ms"},
                                           {"wqsm", "holding_force", "3.5 N", "5 N"},
                                           {"twum", "max_speed", "400 mm/s", "800 mm/s"},
                                           {"twum", "dead_zone", "5 mm/s", "15 mm/s"},
                                           {"twum", "least_speed", "15 mm/s", "30 mm/s"},
                                           {"twum", "lag", "3 ms", "10 ms"},
                                           {"twum", "holding_force", "2.5 N", "4 N"}};
};

/// Reads TOML; missing keys keep the defaults above. Throws Error with file:line:column.
///
///     motors     = ["wqsm", "twum"]
///     rates      = ["0.1 Hz", "1 Hz"]
///     amplitudes = ["7 mm", "25 mm"]        # of the cord: half of peak to peak
///     cycles     = 4
///     [[objects]]
///     name      = "spring 1 N/mm"
///     kind      = "elastic"                 # or "wall"
///     stiffness = "1 N/mm"
///     damping   = "0 N s/mm"
///     [crossover]                           # above which rate is the second motor better?
///     force     = "2.2 N"                   # limits the amplitude of the cord by the force at the finger
///     stiffness = ["0.2 N/mm", "1 N/mm"]
///     rates     = ["0.1 Hz", "1 Hz", "9 Hz"]
///     [assumed.wqsm]                        # options of a device with the limits of the assumption
///     lag = ["1 ms", "4 ms"]
RigMatrix load_rig_matrix(const std::filesystem::path& path);

}  // namespace tactus::analysis
