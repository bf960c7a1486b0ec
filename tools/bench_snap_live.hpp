// SPDX-License-Identifier: Apache-2.0
// What one tick of snap-to-fit costs while a fragment is led about the place where it fits.
#pragma once

#include <nlohmann/json.hpp>

namespace tactus {

/// One row per mode: pull, contact and coupling together, about 5,000 painted points, processor time of one thread.
/// `success` is the share of ticks under 0.5 ms.
nlohmann::ordered_json bench_snap_live();

}  // namespace tactus
