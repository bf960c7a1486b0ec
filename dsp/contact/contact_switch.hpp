// SPDX-License-Identifier: Apache-2.0
// Whether a tool counts as being in contact.
#pragma once

namespace tactus::contact {

/// Contact by force, with hysteresis. A comparison with zero would count what rounding leaves of a force, and a force at
/// one threshold would begin and end a contact in each tick. One definition for summaries, scores, tasks and events.
class ContactSwitch {
public:
    static constexpr double default_on = 0.05, default_off = 0.02;  // N

    /// `force` N: sum of the sizes of the forces of all points. Contact begins above `on` and ends below `off`, N.
    bool update(double force, double on = default_on, double off = default_off) noexcept {
        touches_ = touches_ ? !(force < off) : force > on;
        return touches_;
    }

private:
    bool touches_ = false;
};

}  // namespace tactus::contact
