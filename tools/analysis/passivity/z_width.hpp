// SPDX-License-Identifier: Apache-2.0
// Z-width: the stiffness and damping of a wall that a device supports, per rate and delay.
#pragma once

#include "dsp/control/sampled_wall.hpp"
#include "graph/node/device.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct ZWidthDevice {
    std::string name;
    control::SampledWall wall;  ///< its mass, friction, step, force and own delay
};

/// One point of a boundary, at one damping of the wall.
struct ZWidthPoint {
    double damping = 0.0;    ///< N·s/m
    double bound = 0.0;      ///< N/m, Colgate and Schenkel with the delay
    double passive = 0.0;    ///< N/m, the same from motion
    double friction = 0.0;  ///< N/m: limit of Coulomb friction for encoder steps; infinite without steps
    control::SimulatedLimit simulated;  ///< at which the simulated device begins to oscillate, at the worst hand force
};

struct ZWidthCurve {
    std::string device;
    double rate = 1000.0;  ///< Hz
    double delay = 0.0;  ///< s, including that of the device
    std::vector<ZWidthPoint> points;
};

struct ZWidthGrid {
    std::vector<double> rates{1000.0, 4000.0};  ///< Hz
    std::vector<double> periods_late{0.0, 1.0};  ///< delay in addition to that of the device
    std::vector<double> dampings{0.0, 1.0, 2.0, 5.0, 10.0, 20.0};  ///< N·s/m
    double most = 500e3;  ///< N/m, upper end of the search
};

/// Returns a device of a patch as an ideal one with its damping.
ZWidthDevice ideal_device(const std::string& name, const DeviceInfo& info);
/// The simulated devices, each with the hand of `control::StatedHand`.
std::vector<ZWidthDevice> modelled_devices();

/// Returns one curve per device, rate and delay, computed on all cores. `tell` receives the number of finished points
/// and the total, from one thread at a time.
std::vector<ZWidthCurve> z_width(const std::vector<ZWidthDevice>& devices, const ZWidthGrid& grid,
                                 const std::function<void(std::size_t done, std::size_t all)>& tell = {});

}  // namespace tactus::analysis
