// SPDX-License-Identifier: Apache-2.0
// How a body in the hand is led to a place: how the pull comes and goes, how the springs to the hand give way while the
// body settles, and how fast it may go.
#pragma once

#include "dsp/core/types.hpp"
#include "graph/node/node.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace tactus::nodes {

struct LeadParameters {
    Param fade{"100 ms", "1 ms", "10 s", "in which the pull and the springs come and go"};
    Param lead_speed{"50 mm/s", "0.1 mm/s", "10 m/s",
                     "what is led, or settles, goes no faster than this beyond the hand's own motion: where it slips "
                     "over an edge, the force changes by the spring's stiffness times this"};
    Param loose{"8 mm", "0.1 mm", "100 mm", "a hand that goes farther than this while the body settles has it back"};
    TACTUS_GROUP(fade, lead_speed, loose)
};

class Lead {
public:
    /// The hand takes a body: it has all of the springs, and nothing pulls yet.
    void take() noexcept { *this = {}; }

    /// `leads`: there is a pull that is wanted; `gives_way`: the hand wants the springs gone, which they are while
    /// something leads; `balanced`: by the last tick the body stood where its forces balance; `elapsed` s. What was
    /// pulled away stays with the hand until `gives_way` ends, whatever the pull does meanwhile.
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
        // What is still on its way when nothing leads any more goes on as slowly.
        is_slow_ = share_ > 0.0 || held_ < 1.0 || (is_slow_ && !balanced);
        slip_ = is_slow_ ? parameters.lead_speed * elapsed : std::numeric_limits<double>::infinity();
    }

    /// Of the pull, 0 to 1.
    double share() const noexcept { return share_; }
    /// Of the springs' strength, 0 to 1: without a kink at either end, which the hand would feel as a knock.
    double springs() const noexcept { return held_ * held_ * (3.0 - 2.0 * held_); }
    /// m, for QuasiStaticSettings.
    double slip() const noexcept { return slip_; }

private:
    double share_ = 0.0, held_ = 1.0, slip_ = std::numeric_limits<double>::infinity();
    bool settles_ = false;  // since the springs were whole: a pull that fails for a moment does not begin anew
    bool pulled_away_ = false, is_slow_ = false;
    Vec3 hand_{0.0}, settled_at_{0.0};
};

}  // namespace tactus::nodes
