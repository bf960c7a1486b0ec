// SPDX-License-Identifier: Apache-2.0
// Z-width: which stiffness and damping of a wall a device bears, per rate and delay.
#pragma once

#include "dsp/control/sampled_wall.hpp"
#include "graph/node/device.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tactus::study {

struct ZWidthDevice {
    std::string name;
    control::SampledWall wall;  ///< its mass, friction, step, force and own delay
};

/// One point of a border, at one damping of the wall.
struct ZWidthPoint {
    double damping = 0.0;    ///< N·s/m
    double bound = 0.0;      ///< N/m, Colgate and Schenkel with the delay
    double passive = 0.0;    ///< N/m, the same by motion
    double friction = 0.0;  ///< N/m up to which Coulomb friction takes what encoder steps give; infinite without steps
    control::SimulatedLimit simulated;  ///< at which the simulated device begins to oscillate, at the worst press
};

struct ZWidthCurve {
    std::string device;
    double rate = 1000.0;  ///< Hz
    double delay = 0.0;  ///< s, that of the device included
    std::vector<ZWidthPoint> points;
};

struct ZWidthGrid {
    std::vector<double> rates{1000.0, 4000.0};  ///< Hz
    std::vector<double> periods_late{0.0, 1.0};  ///< of delay besides that of the device
    std::vector<double> dampings{0.0, 1.0, 2.0, 5.0, 10.0, 20.0};  ///< N·s/m
    double most = 500e3;  ///< N/m, where the search ends
};

/// A device of a patch as an ideal one of its damping.
ZWidthDevice ideal_device(const std::string& name, const DeviceInfo& info);
/// The simulated devices, each with the hand of `control::StatedHand`.
std::vector<ZWidthDevice> modelled_devices();

/// One curve per device, rate and delay, computed on all cores. `tell` hears how many points are done, of how many, from
/// one thread at a time.
std::vector<ZWidthCurve> z_width(const std::vector<ZWidthDevice>& devices, const ZWidthGrid& grid,
                                 const std::function<void(std::size_t done, std::size_t all)>& tell = {});

}  // namespace tactus::study
