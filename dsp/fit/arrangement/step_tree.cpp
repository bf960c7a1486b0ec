// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/arrangement/step_tree.hpp"

#include <cstring>

namespace tactus::fit {

namespace {

bool same(const Arrangement::Place& a, const Arrangement::Place& b) noexcept {
    // Bitwise: undo restores exactly the same values.
    return std::memcmp(&a.pose, &b.pose, sizeof(Pose)) == 0 && a.group == b.group && a.fitted_to == b.fitted_to &&
           std::memcmp(&a.beside, &b.beside, sizeof(Pose)) == 0 && a.locked == b.locked && a.hidden == b.hidden;
}
bool same(const Arrangement::Group& a, const Arrangement::Group& b) noexcept {
    return a.parent == b.parent && a.exists == b.exists;
}

}  // namespace

StepTree::StepTree(std::size_t fragments, std::size_t known, std::size_t most) : fragments_(fragments), most_(most) {
    before_.reserve(known + most);
    way_.reserve(known + most);
    steps_.reserve(known + most);
    before_.resize(known, -1);
    steps_.resize(known);
    stand({});
}

StepTree::Step StepTree::changes(const Arrangement& from, const Arrangement& to) noexcept {
    Step step{0, places_.size(), groups_.size(), 0, 0};
    for (int n = 0; n < static_cast<int>(fragments_); ++n)
        if (!same(from.fragment(n), to.fragment(n))) places_.push_back({n, from.fragment(n), to.fragment(n)});
    for (int n = 0; n < static_cast<int>(from.max_groups()); ++n)
        if (!same(from.group(n), to.group(n))) groups_.push_back({n, from.group(n), to.group(n)});
    step.place_count = places_.size() - step.places;
    step.group_count = groups_.size() - step.groups;
    return step;
}

void StepTree::put(int step, int before, const Arrangement& from, const Arrangement& to) {
    const auto n = static_cast<std::size_t>(step);
    steps_[n] = changes(from, to);
    steps_[n].depth = before < 0 ? 1 : steps_[static_cast<std::size_t>(before)].depth + 1;
    before_[n] = before;
}

void StepTree::stand(HistoryPlace place) {
    place_ = place;
    // One step may move all fragments; most steps move few.
    places_.reserve(places_.size() + 2 * most_ + fragments_);
    groups_.reserve(groups_.size() + most_ + fragments_ + 1);
}

void StepTree::forget() noexcept {
    forgotten_ = done();
    root_ = head();
    first_ += static_cast<int>(steps_.size());
    before_.clear();
    steps_.clear();
    places_.clear();
    groups_.clear();
    place_ = {};
}

void StepTree::add(const Arrangement& from, const Arrangement& to) noexcept {
    if (steps_.size() == steps_.capacity() || places_.size() + fragments_ > places_.capacity() ||
        groups_.size() + fragments_ + 1 > groups_.capacity())
        forget();
    const int depth = done() - forgotten_ + 1;
    before_.push_back(place_.head);
    steps_.push_back(changes(from, to));
    steps_.back().depth = depth;
    place_ = after_step(static_cast<int>(steps_.size()) - 1);
}

template <class Side>
void StepTree::restore(const Step& step, Arrangement& now, Side side) const noexcept {
    for (std::size_t n = 0; n < step.place_count; ++n)
        now.restore(places_[step.places + n].number, side(places_[step.places + n]));
    for (std::size_t n = 0; n < step.group_count; ++n)
        now.restore(groups_[step.groups + n].number, side(groups_[step.groups + n]));
}

bool StepTree::undo(Arrangement& now) noexcept {
    const HistoryPlace to = undone(before_, place_);
    if (to.head == place_.head) return false;
    restore(steps_[static_cast<std::size_t>(place_.head)], now, [](const auto& change) { return change.from; });
    place_ = to;
    return true;
}

bool StepTree::redo(Arrangement& now) noexcept {
    const HistoryPlace to = redone(before_, place_);
    if (to.head == place_.head) return false;
    restore(steps_[static_cast<std::size_t>(to.head)], now, [](const auto& change) { return change.to; });
    place_ = to;
    return true;
}

HistoryPlace StepTree::place() const noexcept { return {head(), place_.tip < 0 ? root_ : place_.tip + first_}; }

bool StepTree::go(HistoryPlace to, Arrangement& now) noexcept {
    const auto index_of = [this](int number, int& index) {
        index = number == root_ ? -1 : number - first_;
        return number == root_ || (index >= 0 && index < static_cast<int>(steps_.size()));
    };
    HistoryPlace at;
    if (!index_of(to.head, at.head) || !index_of(to.tip, at.tip) || !is_on_way(before_, at.head, at.tip)) return false;
    way_.clear();
    int here = place_.head, there = at.head;
    // A step comes after its predecessor: the later of the two is not in common.
    while (here != there) {
        if (there > here) {
            way_.push_back(there);
            there = before_[static_cast<std::size_t>(there)];
            continue;
        }
        restore(steps_[static_cast<std::size_t>(here)], now, [](const auto& change) { return change.from; });
        here = before_[static_cast<std::size_t>(here)];
    }
    while (!way_.empty()) {
        restore(steps_[static_cast<std::size_t>(way_.back())], now, [](const auto& change) { return change.to; });
        way_.pop_back();
    }
    place_ = at;
    return true;
}

int StepTree::done() const noexcept {
    return forgotten_ + (place_.head < 0 ? 0 : steps_[static_cast<std::size_t>(place_.head)].depth);
}

}  // namespace tactus::fit
