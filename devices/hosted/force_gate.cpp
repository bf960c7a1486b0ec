// SPDX-License-Identifier: Apache-2.0
#include "devices/hosted/force_gate.hpp"

#include <glm/geometric.hpp>

namespace tactus::hosted {

void ForceGate::close(std::int64_t fade_from_ns) noexcept {
    if (passes_) {
        fade_from_ns_ = fade_from_ns;
        was_lost_ = true;
    }
    passes_ = false;
    small_ = 0;
}

Wrench ForceGate::give(const ForceRecord& newest, std::uint64_t number, std::int64_t now_ns) noexcept {
    const Wrench wanted = unpack(newest);
    const bool is_new = number != number_;
    number_ = number;
    if (!is_felt) {
        passes_ = true;
        return bounds.clamp(wanted);
    }
    if (!is_young(newest.committed_ns, now_ns, limit_ns)) {
        // The age counts, not when it was noticed: after a suspend nothing is left to fade.
        const bool is_past = newest.committed_ns > 0 && newest.committed_ns <= now_ns;
        close(is_past ? newest.committed_ns + limit_ns : now_ns);
    } else if (!is_finite(wanted)) {
        close(now_ns);
        last_ = {};
    } else if (!passes_ && is_new) {
        wants_large_ = !(glm::length(wanted.force) < small_force && glm::length(wanted.torque) < small_torque);
        small_ = wants_large_ ? 0 : small_ + 1;
        passes_ = small_ >= small_commits && now_ns - fade_from_ns_ >= fade_ns;
        if (passes_) was_lost_ = false;
    }
    if (passes_) {
        last_ = bounds.clamp(wanted);
        return last_;
    }
    return last_ * control::fade_left(static_cast<double>(now_ns - fade_from_ns_), static_cast<double>(fade_ns));
}

}  // namespace tactus::hosted
