// SPDX-License-Identifier: Apache-2.0
#include "tools/window/widgets/spots.hpp"

#include "tools/window/widgets/painter.hpp"
#include "tools/window/widgets/spot_list.hpp"

#include <fmt/format.h>

#include <map>
#include <unordered_map>
#include <utility>

namespace tactus::window {

namespace {

using Spots = std::unordered_map<std::string, Box>;

/// Of this frame, and of the previous one.
std::pair<Spots, Spots>& spots() {
    static std::pair<Spots, Spots> both;
    return both;
}

}  // namespace

void mark_spot(const std::string& name) {
    if (!ImGui::IsItemVisible()) return;
    const Point low = point(ImGui::GetItemRectMin()), high = point(ImGui::GetItemRectMax());
    const Box whole{low.x, low.y, high.x, high.y};
    // Of what is scrolled half out of its panel, only a part can be pressed.
    const ImDrawList& drawn = *ImGui::GetWindowDrawList();
    const Point first = point(drawn.GetClipRectMin()), last = point(drawn.GetClipRectMax());
    if (!Box{first.x, first.y, last.x, last.y}.contains(whole.middle())) return;
    spots().first[name] = whole;
}

void set_spot(const std::string& name, const Box& box) { spots().first[name] = box; }

std::optional<Box> spot(const std::string& name) {
    const Spots& drawn = spots().second;
    const auto found = drawn.find(name);
    if (found == drawn.end()) return std::nullopt;
    return found->second;
}

void forget_spots() {
    std::swap(spots().first, spots().second);
    spots().first.clear();
}

std::string spot_list() {
    std::string text;
    for (const auto& [name, box] : std::map(spots().second.begin(), spots().second.end()))
        text += fmt::format("{}\t{:.0f}\t{:.0f}\t{:.0f}\t{:.0f}\n", name, box.left, box.top, box.right, box.bottom);
    return text;
}

}  // namespace tactus::window
