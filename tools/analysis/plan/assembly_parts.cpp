// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/assembly_parts.hpp"

#include "dsp/fit/arrangement/assemblies.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace tactus::analysis {

using fit::Arrangement;

AssemblyParts::AssemblyParts(const Arrangement& arrangement, const std::function<double(int)>& size_of)
    : body_(arrangement.size(), -1), locked_(arrangement.size(), 0), first_(arrangement.size(), 0) {
    const auto count = static_cast<int>(arrangement.size());
    for (int n = 0; n < count; ++n) {
        const auto at = static_cast<std::size_t>(n);
        poses_.push_back(arrangement.pose(n));
        size_.push_back(size_of(n));
        locked_[at] = !arrangement.can_move(n);
        if (arrangement.is_hidden(n)) continue;
        body_[at] = n;
        for (int other = 0; other < n; ++other)
            if (body_[static_cast<std::size_t>(other)] >= 0 && arrangement.move_together(n, other)) {
                body_[at] = body_[static_cast<std::size_t>(other)];
                break;
            }
        const int partner = arrangement.fitted_to(n);
        if (partner == Arrangement::none || arrangement.is_hidden(partner)) continue;
        AssemblyLink link{n, partner, {}, true};
        link.match.moving = n;
        link.match.partner = partner;
        links_.push_back(link);
    }
    const auto connected = fit::assemblies(arrangement);
    if (!connected.empty() && connected.front().size() > 1)
        for (const int n : connected.front()) first_[static_cast<std::size_t>(n)] = 1;
    number();
}

/// Parts by union over bodies and links.
void AssemblyParts::number() {
    part_ = body_;
    for (bool changed = true; changed;) {
        changed = false;
        const auto unite = [&](int a, int b) {
            int &p = part_[static_cast<std::size_t>(a)], &q = part_[static_cast<std::size_t>(b)];
            if (p == q) return;
            const int from = std::max(p, q), to = std::min(p, q);
            std::ranges::replace(part_, from, to);
            changed = true;
        };
        for (const AssemblyLink& link : links_) unite(link.a, link.b);
    }
}

std::vector<int> AssemblyParts::members(int part) const {
    std::vector<int> list;
    for (std::size_t n = 0; n < part_.size(); ++n)
        if (part_[n] == part) list.push_back(static_cast<int>(n));
    return list;
}

std::vector<char> AssemblyParts::mask(int part) const {
    std::vector<char> in;
    for (const int p : part_) in.push_back(p == part);
    return in;
}

std::vector<char> AssemblyParts::and_locked(std::vector<char> stands, int moving) const {
    for (std::size_t n = 0; n < part_.size(); ++n)
        if (part_[n] >= 0 && part_[n] != moving && !can_move(part_[n])) stands[n] = 1;
    return stands;
}

bool AssemblyParts::can_move(int part) const {
    for (std::size_t n = 0; n < part_.size(); ++n)
        if (part_[n] == part && locked_[n]) return false;
    return true;
}

bool AssemblyParts::goes_to(int first, int second) const {
    if (can_move(first) != can_move(second)) return can_move(first);
    const auto weight = [&](int part) {
        double area = 0.0;
        for (const int n : members(part)) area += size_[static_cast<std::size_t>(n)];
        return area;
    };
    return weight(first) <= weight(second);
}

void AssemblyParts::connect(AssemblyLink link, const Pose& pose) {
    const Pose motion = pose * this->pose(link.a).inverse();
    for (const int n : members(part_of(link.a))) {
        Pose& moved = poses_[static_cast<std::size_t>(n)];
        moved = motion * moved;
        moved.orientation = glm::normalize(moved.orientation);
    }
    links_.push_back(std::move(link));
    number();
}

void AssemblyParts::cut(std::size_t link) {
    links_.erase(links_.begin() + static_cast<std::ptrdiff_t>(link));
    number();
}

/// The fragment that stays: a locked one, one of the plan's largest connected part, or the largest.
int AssemblyParts::base_of(const std::vector<int>& members) const {
    const auto rank = [&](int n) {
        const auto at = static_cast<std::size_t>(n);
        return std::tuple(locked_[at] != 0, first_[at] != 0, size_[at]);
    };
    return *std::ranges::max_element(members, {}, rank);
}

std::vector<char> AssemblyParts::fixed_bodies() const {
    std::vector<char> fixed(poses_.size(), 1);
    for (std::size_t n = 0; n < body_.size(); ++n)
        if (body_[n] >= 0) fixed[static_cast<std::size_t>(body_[n])] = 0;
    for (std::size_t n = 0; n < body_.size(); ++n)
        if (body_[n] >= 0 && locked_[n]) fixed[static_cast<std::size_t>(body_[n])] = 1;
    for (const auto& list : lists())
        fixed[static_cast<std::size_t>(body_[static_cast<std::size_t>(base_of(list))])] = 1;
    return fixed;
}

void AssemblyParts::return_to(const Arrangement& arrangement) {
    for (const auto& list : lists()) {
        const int base = base_of(list);
        const Pose motion = arrangement.pose(base) * pose(base).inverse();
        for (const int n : list) {
            Pose& moved = poses_[static_cast<std::size_t>(n)];
            moved = motion * moved;
            moved.orientation = glm::normalize(moved.orientation);
        }
        // Exactly, for the bodies that stay.
        for (const int n : list)
            if (locked_[static_cast<std::size_t>(n)] ||
                body_[static_cast<std::size_t>(n)] == body_[static_cast<std::size_t>(base)])
                poses_[static_cast<std::size_t>(n)] = arrangement.pose(n);
    }
}

std::vector<AssemblyLink> AssemblyParts::in_order() const {
    std::vector<AssemblyLink> order;
    for (const auto& list : lists()) {
        std::vector<char> there(poses_.size(), 0);
        const auto arrive = [&](int fragment) {
            for (const int n : list)
                if (body_[static_cast<std::size_t>(n)] == body_[static_cast<std::size_t>(fragment)])
                    there[static_cast<std::size_t>(n)] = 1;
        };
        arrive(base_of(list));
        for (;;) {
            const AssemblyLink* best = nullptr;
            const auto worth = [](const AssemblyLink& l) {
                return l.was_before ? 1.0 : l.match.quality.score * std::sqrt(l.match.quality.overlap);
            };
            for (const AssemblyLink& link : links_) {
                if (there[static_cast<std::size_t>(link.a)] == there[static_cast<std::size_t>(link.b)]) continue;
                if (!best || worth(link) > worth(*best)) best = &link;
            }
            if (!best) break;
            AssemblyLink next = *best;
            if (there[static_cast<std::size_t>(next.a)]) std::swap(next.a, next.b);
            arrive(next.a);
            order.push_back(next);
        }
    }
    return order;
}

std::vector<std::vector<int>> AssemblyParts::lists() const {
    std::map<int, std::vector<int>> by_part;
    for (std::size_t n = 0; n < part_.size(); ++n)
        if (part_[n] >= 0) by_part[part_[n]].push_back(static_cast<int>(n));
    std::vector<std::vector<int>> all;
    for (auto& [part, list] : by_part) all.push_back(std::move(list));
    const auto rank = [&](const std::vector<int>& list) {
        double area = 0.0;
        for (const int n : list) area += size_[static_cast<std::size_t>(n)];
        const auto at = static_cast<std::size_t>(base_of(list));
        return std::tuple(locked_[at] != 0, first_[at] != 0, list.size(), area);
    };
    std::ranges::stable_sort(all, std::ranges::greater{}, rank);
    return all;
}

Arrangement AssemblyParts::arrangement_moving(const Arrangement& arrangement, int part) const {
    Arrangement now(arrangement.size());
    for (int n = 0; n < static_cast<int>(arrangement.size()); ++n) {
        now.place(n, pose(n));
        now.hide(n, arrangement.is_hidden(n));
    }
    now.join(members(part));
    return now;
}

}  // namespace tactus::analysis
