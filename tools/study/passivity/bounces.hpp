// SPDX-License-Identifier: Apache-2.0
// Masses thrown at every contact on devices as they are: how much of their energy comes back.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tactus::study {

struct BounceMatrix {
    std::vector<std::string> nodes;                        ///< empty: all of `bounce_nodes()`
    std::vector<std::string> devices;                      ///< empty: all of `bounce_devices()`
    std::vector<double> stiffnesses{1e3, 5e3, 12.8e3};     ///< N/m
    std::vector<double> speeds{0.2, 0.4, 0.6};             ///< m/s
    std::vector<double> masses{0.1, 0.3, 1.0};             ///< kg, of the hand; the device's is added
};

struct BounceRow {
    std::string node, device;
    double stiffness = 0.0, speed = 0.0, mass = 0.0;  ///< N/m, m/s, kg
    double energy_ratio = 0.0;          ///< kinetic energy after the contact over that before
    double energy_ratio_without = 0.0;  ///< without the energy cap
    double bound = 0.0;                 ///< of the first
    bool ok() const { return energy_ratio <= bound; }
};

/// Types that make a contact force, and couplings with their contact.
const std::vector<std::string>& bounce_nodes();
/// "ideal" and the simulated devices.
const std::vector<std::string>& bounce_devices();

/// 1.05 of the energy on a device whose steps are at most 20 µm, otherwise 1.10.
double bounce_bound(const std::string& device);

/// Runs the matrix, offline; `tell` gets each row as it is done. Throws Error for a name that does not exist.
std::vector<BounceRow> throw_at_contacts(const BounceMatrix& matrix, const std::function<void(const BounceRow&)>& tell);

}  // namespace tactus::study
