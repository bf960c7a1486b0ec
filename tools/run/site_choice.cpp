// SPDX-License-Identifier: Apache-2.0
#include "tools/run/site_choice.hpp"

#include "dsp/core/units.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace tactus::run {

namespace {

/// Three lengths with commas, in mm where no unit stands; in mm.
Vec3 three_lengths(const char* option, std::string_view text) {
    Vec3 v(0.0);
    std::size_t begin = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = axis < 2 ? text.find(',', begin) : text.size();
        std::string_view part = text.substr(begin, comma == std::string_view::npos ? comma : comma - begin);
        while (part.starts_with(' ')) part.remove_prefix(1);
        while (part.ends_with(' ')) part.remove_suffix(1);
        const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), v[axis]);
        try {
            if (error != std::errc() || stop != part.data() + part.size()) v[axis] = parse_as(part, "mm") * 1e3;
            if (comma == std::string_view::npos || !std::isfinite(v[axis])) throw Error("no length");
        } catch (const Error&) {
            throw Error(
                fmt::format("{} {}: give three numbers with commas, as in 12.5,-3,40 (mm) or "
                            "\"12.5 mm, -3 mm, 40 mm\"",
                            option, text));
        }
        begin = comma + 1;
    }
    return v;
}

/// 0 for an empty text.
Vec3 direction(const char* option, const std::string& text) {
    if (text.empty()) return Vec3(0.0);
    const Vec3 found = three_lengths(option, text);
    if (!(glm::length(found) > 1e-9)) throw Error(fmt::format("{} 0,0,0 is no direction", option));
    return found;
}

}  // namespace

std::vector<SiteSetting> site_settings(const patch::Patch& patch, const Vec3& site_mm, const Vec3& approach,
                                       const Vec3& along) {
    std::vector<SiteSetting> settings;
    for (const patch::PatchNode& node : patch.nodes) {
        const bool has_bone = std::ranges::any_of(
            node.settings, [](const auto& setting) { return setting.name == "bone" || setting.name == "source"; });
        if (!has_bone || (node.type != "workspace" && node.type != "carve")) continue;
        settings.push_back({node.name, "find_site", "false"});
        settings.push_back({node.name, "site", fmt::format("{} mm, {} mm, {} mm", site_mm.x, site_mm.y, site_mm.z)});
        settings.push_back({node.name, "approach", fmt::format("{}, {}, {}", approach.x, approach.y, approach.z)});
        settings.push_back({node.name, "along", fmt::format("{}, {}, {}", along.x, along.y, along.z)});
    }
    return settings;
}

void choose_site(PatchChoice& choice, const SiteText& text) {
    if (text.site.empty() && text.approach.empty() && text.along.empty()) return;
    if (text.site.empty())
        throw Error(fmt::format("{} needs --site: the point that the saw is to meet",
                                text.approach.empty() ? "--along" : "--approach"));
    const Vec3 site = three_lengths("--site", text.site);
    const Vec3 approach = direction("--approach", text.approach), along = direction("--along", text.along);
    patch::Problems problems;
    const patch::Patch patch = patch::load_patch(find_patch(choice.patch), problems);
    const std::vector<SiteSetting> settings = site_settings(patch, site, approach, along);
    for (const SiteSetting& s : settings)
        choice.overrides.settings.push_back(fmt::format("{}.{}={}", s.node, s.param, s.value));
    const bool any = !settings.empty();
    if (!any && problems.empty())
        throw Error(fmt::format("{}: --site needs a workspace with a bone, which this patch has not", choice.patch));
}

}  // namespace tactus::run
