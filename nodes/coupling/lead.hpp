// SPDX-License-Identifier: Apache-2.0
// Guiding a held body to a pose: the pull fades in and out, the springs to the hand yield while the body settles, and
// its speed is limited.
#pragma once

#include "dsp/core/types.hpp"
#include "graph/node/node.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace tactus::nodes {

struct LeadParameters {
    Param fade{"100 ms", "1 ms", "10 s", "time in which the pull and the springs fade in and out"};
    Param lead_speed{"50 mm/s", "0.1 mm/s", "10 m/s",
                     "speed limit of a body that is guided or settles, beyond the motion of the hand: when it slips "
                     "over an edge, the force changes no faster than the spring's stiffness times this"};
    Param loose{"8 mm", "0.1 mm", "100 mm",
                "a hand that moves farther than this while the body settles holds it again"};
    TACTUS_GROUP(fade, lead_speed, loose)
};

class Lead {
public:
    /// The hand grasps a body: full springs, no pull.
    void take() noexcept { *this = {}; }

    /// `leads`: a pull is requested. `gives_way`: the springs to the hand fade to zero while something leads.
    /// `balanced`: the last tick ended in equilibrium. `elapsed` in s. After the hand has pulled the body away, the
    /// hand keeps it until `gives_way` ends, regardless of the pull.
    void update(const LeadParameters& parameters, const Pose& hand, bool leads, bool gives_way, bool balanced,
                double elapsed) noexcept {
        if (is_valid(hand)) hand_ = hand.position;
        const bool settles = leads && gives_way;
        if (!gives_way || held_ == 1.0) settles_ = false;
        if (settles && !settles_) settled_at_ = hand_;
        settles_ = settles_ || settles;
        pulled_away_ = gives_way && (pulled_away_ || (settles && glm::length(hand_ - settled_at_) > parameters.loose));
        const double change = elapsed / parameters.fade;
        share_ = std::clamp(share_ + (leads && !pulled_away_ ? change : -change), 0.0, 1.0);
        held_ = std::clamp(held_ + (settles && !pulled_away_ ? -change : change), 0.0, 1.0);
        // The rest of the motion after the end of the pull is equally slow.
        is_slow_ = share_ > 0.0 || held_ < 1.0 || (is_slow_ && !balanced);
        slip_ = is_slow_ ? parameters.lead_speed * elapsed : std::numeric_limits<double>::infinity();
    }

    /// Fraction of the pull, 0 to 1.
    double share() const noexcept { return share_; }
    /// Fraction of the springs' strength, 0 to 1; smooth at both ends, because a kink is perceived as a knock.
    double springs() const noexcept { return held_ * held_ * (3.0 - 2.0 * held_); }
    /// m, `slip` of QuasiStaticSettings.
    double slip() const noexcept { return slip_; }

private:
    double share_ = 0.0, held_ = 1.0, slip_ = std::numeric_limits<double>::infinity();
    bool settles_ = false;  // since the springs had full strength; a short failure of the pull does not reset it
    bool pulled_away_ = false, is_slow_ = false;
    Vec3 hand_{0.0}, settled_at_{0.0};
};

}  // namespace tactus::nodes
