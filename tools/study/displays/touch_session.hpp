// SPDX-License-Identifier: Apache-2.0
// Leads a person through touching places with the tip of a device, one after another.
#pragma once

#include "graph/node/device.hpp"
#include "tools/study/displays/touch_lead.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace tactus::study {

/// Reads one device by its tip.
class TipReader {
public:
    /// `tip` in the frame of the handle, m; `is_real`: hardware, which is read on the clock of the wall. `tracker` is read
    /// at the same moments, or null. Prepares both. Throws Error.
    TipReader(std::unique_ptr<HapticDevice> device, bool is_real, const Vec3& tip,
              std::unique_ptr<HapticDevice> tracker);

    /// Waits for the button, or for `is_asked` to say yes, then reads 0.2 s. `tend` is called now and then meanwhile.
    /// Throws Error when a simulated hand has not pressed within a minute, or when the device fails.
    Touched touch(const std::function<bool()>& is_asked, const std::function<void()>& tend);

private:
    DeviceSample read();

    std::unique_ptr<HapticDevice> device_, tracker_;
    bool is_real_;
    Vec3 tip_;
    std::optional<Vec3> tracked_;  // of the last read
    bool was_pressed_ = true;  // a button that is held from the beginning says nothing
    bool has_begun_ = false;
    std::int64_t last_counter_ = -1;
};

/// Leads through all steps, see TouchLead: `show` tells what is to be touched now, and `say` what was wrong with a touch.
struct TouchSession {
    std::function<void(const display::RigTouch& step, std::size_t number, std::size_t of)> show;
    std::function<void(const std::string& said)> say;
    std::function<bool()> is_asked;
    std::function<void()> tend;

    void run(TipReader& tip, TouchLead& lead) const;
};

}  // namespace tactus::study
