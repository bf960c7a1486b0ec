// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/arrangement/assemblies.hpp"

#include <algorithm>

namespace tactus::fit {

namespace {

template <class IsMeant>
std::vector<std::vector<int>> parts_of(const Arrangement& a, const IsMeant& is_meant) {
    const auto count = static_cast<int>(a.size());
    std::vector<char> seen(a.size(), 0);
    std::vector<std::vector<int>> parts;
    for (int first = 0; first < count; ++first) {
        if (seen[static_cast<std::size_t>(first)] || !is_meant(first)) continue;
        std::vector<int> part{first};
        seen[static_cast<std::size_t>(first)] = 1;
        for (std::size_t n = 0; n < part.size(); ++n)
            for (int other = 0; other < count; ++other) {
                if (seen[static_cast<std::size_t>(other)] || !is_meant(other)) continue;
                if (a.fitted_to(other) != part[n] && a.fitted_to(part[n]) != other) continue;
                seen[static_cast<std::size_t>(other)] = 1;
                part.push_back(other);
            }
        std::ranges::sort(part);
        parts.push_back(std::move(part));
    }
    std::ranges::stable_sort(parts, std::ranges::greater{}, &std::vector<int>::size);
    return parts;
}

}  // namespace

std::vector<std::vector<int>> assemblies(const Arrangement& arrangement) {
    return parts_of(arrangement, [&](int n) { return !arrangement.is_hidden(n); });
}

std::vector<char> standing(const Arrangement& arrangement, int moving) {
    const auto parts = parts_of(
        arrangement, [&](int n) { return !arrangement.is_hidden(n) && !arrangement.move_together(moving, n); });
    std::vector<char> stands(arrangement.size(), 0);
    const auto take = [&](const std::vector<int>& part) {
        for (const int n : part) stands[static_cast<std::size_t>(n)] = 1;
    };
    bool is_any_locked = false;
    for (const auto& part : parts) {
        if (std::ranges::none_of(part, [&](int n) { return arrangement.is_locked(n); })) continue;
        take(part);
        is_any_locked = true;
    }
    if (!is_any_locked && !parts.empty() && parts.front().size() > 1) take(parts.front());
    return stands;
}

}  // namespace tactus::fit
