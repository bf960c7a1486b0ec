// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/watched_hand.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>

namespace tactus::test {

std::int64_t steady_now() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

std::vector<WatchedHand::Given> WatchedHand::given() const {
    const std::lock_guard lock(lock_);
    return given_;
}

double WatchedHand::force() const {
    const std::lock_guard lock(lock_);
    return given_.empty() ? 0.0 : given_.back().force_N;
}

double WatchedHand::force_at(std::int64_t ns) const {
    const std::lock_guard lock(lock_);
    const auto after = std::ranges::upper_bound(given_, ns, {}, &Given::ns);
    return after == given_.begin() ? 0.0 : std::prev(after)->force_N;
}

double WatchedHand::ms_to_zero(std::int64_t ns) const {
    double last = 0.0;
    for (const Given& g : given())
        if (g.force_N > 0.0) last = 1e9;
        else if (last == 1e9) last = static_cast<double>(std::max<std::int64_t>(g.ns - ns, 0)) * 1e-6;
    return last;
}

double WatchedHand::largest_after(std::int64_t ns) const {
    double largest = 0.0;
    for (const Given& g : given())
        if (g.ns >= ns) largest = std::max(largest, g.force_N);
    return largest;
}

void WatchedHand::block() {
    blocked_ns = steady_now();
    is_blocked = true;
    while (blocks != Blocks::never) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    is_blocked = false;
}

DeviceSample WatchedHand::acquire(double elapsed_s) {
    // The first sample is read when the device is opened.
    if (count_ > 0) tick_ = std::this_thread::get_id();
    if (blocks == Blocks::in_acquire) block();
    logical_s = logical_s + elapsed_s;
    DeviceSample sample;
    sample.pose.position.z = logical_s < rest ? 0.0 : -depth;
    ++count_;
    if (!is_stale) counter_ = count_;
    sample.counter = counter_;
    sample.valid = true;
    return sample;
}

void WatchedHand::commit(const Wrench& wrench) {
    const bool is_tick = std::this_thread::get_id() == tick_;
    if (blocks == Blocks::in_commit || (blocks == Blocks::in_commit_of_the_guard && !is_tick)) block();
    const std::lock_guard lock(lock_);
    given_.push_back({steady_now(), glm::length(wrench.force), std::this_thread::get_id()});
}

WatchedHand& watched_hand(const std::string& name) {
    auto* hand = new WatchedHand;
    static auto& all = *new std::vector<WatchedHand*>;  // never destroyed, so the leak checker finds them
    all.push_back(hand);
    hand->performance.acquire = [hand](std::int64_t, double elapsed, const Wrench&) { return hand->acquire(elapsed); };
    hand->performance.commit = [hand](const Wrench& wrench) { hand->commit(wrench); };
    play_as(name, hand->performance);
    return *hand;
}

void add_hand(PatchText& patch, const std::string& name, const std::string& stiffness, const std::string& spring,
              const std::string& rate) {
    const std::string hand = name + "_hand", rest = name + "_rest", pull = name + "_" + spring, out = name + "_out";
    patch.nodes.push_back({hand, "device_input", rate, {{"device", name}}});
    patch.nodes.push_back({rest, "still", rate, {}});
    patch.nodes.push_back({pull, "spring", rate, {{"stiffness", stiffness}}});
    patch.nodes.push_back({out, "device_output", rate, {{"device", name}, {"max_force", "20 N"}}});
    patch.wires.insert(patch.wires.end(), {hand + ".pose -> " + pull + ".device", rest + ".pose -> " + pull + ".object",
                                           pull + ".wrench -> " + out + ".wrench"});
    patch.extra += "[devices." + name + "]\ndriver = \"" + name + "\"\n";
}

}  // namespace tactus::test
