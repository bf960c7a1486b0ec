// SPDX-License-Identifier: Apache-2.0
#include "devices/hosted/placement.hpp"

#include "devices/haptic/catalogue.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::hosted {

double Placement::round_s(double period_s) const {
    if (rate > 0.0) return 1.0 / rate;
    return std::clamp(period_s / 4.0, 125e-6, 10e-3);
}

Placement read_placement(Options& options, std::string_view driver) {
    Placement placement;
    placement.own_process = options.flag("process", haptic::is_real_driver(driver));
    if (placement.own_process && haptic::needs_window(driver))
        throw Error(
            options.where("process"),
            fmt::format("the driver '{}' works in the process of the window; leave out process = true", driver));
    const double rate = options.quantity("process_rate", "4 kHz", "100 Hz", "20 kHz");
    if (options.has("process_rate")) placement.rate = rate;
    placement.open_timeout = options.quantity("open_timeout", "10 s", "0.1 s", "600 s");
    return placement;
}

}  // namespace tactus::hosted
