// SPDX-License-Identifier: Apache-2.0
// Guides a person through the touches of a calibration.
#pragma once

#include "graph/node/device.hpp"
#include "tools/analysis/display/touch_lead.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace tactus::analysis {

/// Reads the tip of a device.
class TipReader {
public:
    /// `tip`: position in the frame of the handle, m; `is_real`: hardware, read in real time. `tracker` is read at the
    /// same instants; may be null. Prepares both. Throws Error.
    TipReader(std::unique_ptr<HapticDevice> device, bool is_real, const Vec3& tip,
              std::unique_ptr<HapticDevice> tracker);

    /// Waits for the button, or until `is_asked` returns true, then reads for 0.2 s. Calls `tend` regularly. Throws
    /// Error when a simulated hand does not press within a minute, or when the device fails.
    Touched touch(const std::function<bool()>& is_asked, const std::function<void()>& tend);

private:
    DeviceSample read();

    std::unique_ptr<HapticDevice> device_, tracker_;
    bool is_real_;
    Vec3 tip_;
    std::optional<Vec3> tracked_;  // from the last read
    bool was_pressed_ = true;  // a button held from the beginning does not count as pressed
    bool has_begun_ = false;
    std::int64_t last_counter_ = -1;
};

/// Runs all steps, see TouchLead: `show` displays the next touch, `say` reports why a touch is repeated.
struct TouchSession {
    std::function<void(const display::Touch& step, std::size_t number, std::size_t of)> show;
    std::function<void(const std::string& said)> say;
    std::function<bool()> is_asked;
    std::function<void()> tend;

    void run(TipReader& tip, TouchLead& lead) const;
};

}  // namespace tactus::analysis
