// SPDX-License-Identifier: Apache-2.0
// What `tactus check` says of stiffness: what a hand feels on each way, by which law bodies touch, and what other devices
// would make of it.
#pragma once

#include "engine/run/engine.hpp"
#include "graph/analyse/stiffness.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace tactus::command {

/// Adds to the row of a path what the loop says: "ok" is null when the device states no damping.
void add_stiffness(nlohmann::ordered_json& row, const analyse::ForceLoop& loop);

/// The part of a path's line after its latency.
std::string stiffness_text(const nlohmann::ordered_json& row);

/// One row per node that computes contact of bodies: its law, and the stiffness of it.
nlohmann::ordered_json contact_laws_json(const std::vector<std::shared_ptr<build::LiveNode>>& nodes);
void print_contact_laws(const nlohmann::ordered_json& laws);

/// What devices of known classes could feel of each loop.
nlohmann::ordered_json device_classes_json(const std::vector<analyse::ForceLoop>& loops);
void print_device_classes(const nlohmann::ordered_json& classes);

}  // namespace tactus::command
