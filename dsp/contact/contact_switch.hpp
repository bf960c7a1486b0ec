// SPDX-License-Identifier: Apache-2.0
// Decides whether a tool is in contact.
#pragma once

namespace tactus::contact {

/// Contact by force, with hysteresis. A comparison with zero would count rounding errors as contact, and near a single
/// threshold a contact would begin and end in each tick. Summaries, scores, tasks and events all use this definition.
class ContactSwitch {
public:
    static constexpr double default_on = 0.05, default_off = 0.02;  // N

    /// `force`: sum of the magnitudes of the forces of all points, N. Contact begins above `on` and ends below `off`,
    /// N.
    bool update(double force, double on = default_on, double off = default_off) noexcept {
        touches_ = touches_ ? !(force < off) : force > on;
        return touches_;
    }

private:
    bool touches_ = false;
};

}  // namespace tactus::contact
