// SPDX-License-Identifier: Apache-2.0
// Leads a person through touching places with the tip of a device, one after another.
#pragma once

#include "dsp/view/rig_touches.hpp"
#include "graph/device.hpp"

#include <functional>
#include <memory>
#include <string>

namespace tactus {

/// Reads one device by its tip.
class TipReader {
public:
    /// `tip` in the frame of the handle, m; `is_real`: hardware, which is read on the clock of the wall. `tracker` is read
    /// at the same moments, or null. Prepares both. Throws Error.
    TipReader(std::unique_ptr<HapticDevice> device, bool is_real, const Vec3& tip,
              std::unique_ptr<HapticDevice> tracker);

    struct Touched {
        Vec3 tip{0.0}, tracked{0.0};  ///< means over the touch, m, each in its own frame
        double moved = 0.0;  ///< m, the farthest from the mean
    };
    /// Waits for the button, or for `is_asked` to say yes, then reads 0.2 s. `tend` is called now and then meanwhile.
    /// Throws Error when a simulated hand has not pressed within a minute, or when the device fails.
    Touched touch(const std::function<bool()>& is_asked, const std::function<void()>& tend);

private:
    DeviceSample read();

    std::unique_ptr<HapticDevice> device_, tracker_;
    bool is_real_;
    Vec3 tip_;
    Vec3 tracked_{0.0};
    bool was_pressed_ = true;  // a button that is held from the beginning says nothing
    bool has_begun_ = false;
    std::int64_t last_counter_ = -1;
};

/// Fills the readings of `steps` one by one: `show` tells what is to be touched now, and `say` what went wrong with a
/// touch, which is then asked for again; so is a touch that `check`, called after the last of a part, throws as BadTouch.
/// A place that does not come out right the third time is thrown.
struct TouchSession {
    std::function<void(const RigTouch& step, std::size_t number, std::size_t of)> show;
    std::function<void(const std::string& said)> say;
    std::function<bool()> is_asked;
    std::function<void()> tend;
    std::function<void(std::span<const RigTouch> done)> check;

    void run(TipReader& tip, std::vector<RigTouch>& steps, bool has_tracker) const;
};

}  // namespace tactus
