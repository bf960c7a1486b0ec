// SPDX-License-Identifier: Apache-2.0
#include "tools/window/hand/pulled_hands.hpp"

#include "tools/window/document/hand_of_patch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace tactus::window {

void PulledHands::follow(const std::shared_ptr<observe::Observer>& observer, const render::SceneOutline& outline,
                         const compile::Schedule& plan) {
    forget();
    observer_ = observer;
    for (const compile::ScheduleNode& node : plan.nodes) {
        if (node.type->role != NodeRole::hand_source) continue;
        Source source{device_of(plan, node), {}, 0.0};
        source.limit_N = largest_force(plan, source.device);
        const auto place = std::ranges::find_if(outline.places, [&](const render::SceneOutline::Place& one) {
            return one.device.starts_with(node.name + ".");
        });
        if (place != outline.places.end()) source.place = *place;
        // Between the node and the mapping there may be others, as a filter.
        else if (sources_.empty() && !outline.places.empty()) source.place = outline.places.front();
        sources_.push_back(std::move(source));
    }
}

void PulledHands::forget() {
    hands_.clear();
    sources_.clear();
    observer_.reset();
}

void PulledHands::keep_those_of(const RunStatus& status) {
    const auto is_of = [](const Hand& hand, const DevicePull& pull) {
        return hand.link == pull.link && hand.device == pull.device;
    };
    std::erase_if(hands_, [&](const std::unique_ptr<Hand>& hand) {
        return std::ranges::none_of(status.pulls, [&](const DevicePull& pull) { return is_of(*hand, pull); });
    });
    for (const DevicePull& pull : status.pulls) {
        const auto source = std::ranges::find(sources_, pull.device, &Source::device);
        const bool is_known = std::ranges::any_of(hands_, [&](const auto& hand) { return is_of(*hand, pull); });
        if (is_known || source == sources_.end() || !observer_) continue;
        auto hand = std::make_unique<Hand>();
        hand->device = pull.device;
        hand->link = pull.link;
        hand->limit_N = source->limit_N;
        if (!source->place.frame.empty()) hand->place.follow(observer_, source->place);
        hands_.push_back(std::move(hand));
    }
}

void PulledHands::look(const RunStatus& status, std::int64_t now_ns) {
    constexpr std::int64_t forgotten_ns = 2'000'000'000;  // a device that is not read any more
    keep_those_of(status);
    for (const auto& hand : hands_) {
        std::uint64_t number = 0;
        if (!hand->link->read(hand->told, number)) continue;
        // The device of a run that stands still is not read.
        const bool stands = status.state == RunStatus::State::stands && hand->is_there;
        // The time is that of another process, which may be broken.
        const bool is_time = hand->told.at_ns > 0 && hand->told.at_ns < now_ns + forgotten_ns;
        hand->is_there = number != 0 && is_time && (now_ns - hand->told.at_ns < forgotten_ns || stands);
    }
}

std::vector<HandSight> PulledHands::sights() const {
    std::vector<HandSight> all;
    for (const auto& hand : hands_) {
        if (!hand->is_there) continue;
        const HandPlace place = hand->place.of(hand->told.pose);
        all.push_back({place.handle, in_scene(hand->told.wanted.position, hand->told.pose.position, place),
                       glm::length(hand->told.force.force), hand->limit_N, hand->device});
    }
    return all;
}

}  // namespace tactus::window
