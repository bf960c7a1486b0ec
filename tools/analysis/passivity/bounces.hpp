// SPDX-License-Identifier: Apache-2.0
// Throws masses at every contact, on simulated devices, and measures the returned energy.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tactus::analysis {

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
    double bound = 0.0;                 ///< of `energy_ratio`
    bool ok() const { return energy_ratio <= bound; }
};

/// Node types with a contact force, and couplings with their contact.
const std::vector<std::string>& bounce_nodes();
/// Returns "ideal" and the simulated devices.
const std::vector<std::string>& bounce_devices();

/// Returns 1.05 for a device with a resolution of at most 20 µm, otherwise 1.10.
double bounce_bound(const std::string& device);

/// Runs the matrix, offline; `tell` receives each row when it is complete. Throws Error for a name that does not exist.
std::vector<BounceRow> throw_at_contacts(const BounceMatrix& matrix, const std::function<void(const BounceRow&)>& tell);

}  // namespace tactus::analysis
