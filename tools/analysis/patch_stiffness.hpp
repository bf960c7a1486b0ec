// SPDX-License-Identifier: Apache-2.0
// Contact laws of the bodies of a patch, and its stable stiffness on other devices.
#pragma once

#include "engine/run/engine.hpp"
#include "graph/analyse/stiffness.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

/// The contact law of a node that computes contact of bodies.
struct NodeContactLaw {
    std::string node;
    bool by_point = false;
    double stiffness = 0.0;  ///< N/m per point, or N/m per m² of surface
    bool is_felt = true;  ///< it lies between a hand and a force on a hand
    std::optional<double> felt;  ///< N/m, largest rendered stiffness: that of the node's spring; none: all of it
};

std::vector<NodeContactLaw> contact_laws(const run::Engine& engine);

/// A loop through a hand with a device of a known class instead of the patch's own.
struct ClassVerdict {
    std::string from, to;
    analyse::DeviceClass device;
    double may_feel = 0.0;  ///< N/m: the lower of the limit of its damping and the maximum stated by its maker
    bool ok = false;
};

/// Evaluates loops that declare a stiffness.
std::vector<ClassVerdict> class_verdicts(const std::vector<analyse::ForceLoop>& loops);

}  // namespace tactus::analysis
