// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/track.hpp"

#include <algorithm>

namespace tactus::vessel {

std::string_view reason_of(End end) {
    switch (end) {
        case End::contrast: return "the contrast is lost";
        case End::noise: return "the vessel is not told from noise";
        case End::border: return "the scan ends";
        case End::excluded: return "it meets bone or a stent";
        case End::larger_vessel: return "it joins a larger vessel";
        case End::meets_track: return "it meets a vessel that is tracked";
        case End::forks: return "it forks";
        case End::length: return "the limit of length is reached";
    }
    return "";
}

std::vector<LostStretch> Branch::lost() const {
    std::vector<LostStretch> found;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (!nodes[n].is_lost) continue;
        if (n > 0 && nodes[n - 1].is_lost) found.back().to = nodes[n].along;
        else found.push_back({nodes[n].along, nodes[n].along});
    }
    std::erase_if(found, [](const LostStretch& stretch) { return stretch.to <= stretch.from; });
    return found;
}

double Track::length() const {
    double sum = 0.0;
    for (const Branch& branch : branches) sum += branch.length();
    return sum;
}

namespace {

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Shorter narrowings read too wide, in reference radii: on phantoms narrowed over two radii, by a half and more.
constexpr double least_width = 1.5;

/// How far from a node, one way, the radius passes `limit`, m; up to the end of the branch.
double passes(const std::vector<Node>& nodes, std::size_t from, int step, double limit) {
    auto n = static_cast<std::ptrdiff_t>(from);
    for (; n + step >= 0 && n + step < std::ssize(nodes); n += step) {
        const Node &here = nodes[static_cast<std::size_t>(n)], &next = nodes[static_cast<std::size_t>(n + step)];
        if (next.radius < limit) continue;
        const double part = (limit - here.radius) / std::max(1e-12, next.radius - here.radius);
        return std::abs(here.along + part * (next.along - here.along) - nodes[from].along);
    }
    return std::abs(nodes[static_cast<std::size_t>(n)].along - nodes[from].along);
}

/// Length in which a narrowing has more than half its depth, m.
double width_of(const std::vector<Node>& nodes, const Stenosis& stenosis) {
    const double half = 0.5 * (stenosis.radius + stenosis.reference_radius);
    return passes(nodes, stenosis.node, -1, half) + passes(nodes, stenosis.node, 1, half);
}

}  // namespace

std::optional<Stenosis> stenosis_of(const Branch& branch) {
    std::vector<double> radii;
    for (const Node& node : branch.nodes)
        if (!node.is_lost && node.along >= branch.free_from) radii.push_back(node.radius);
    if (radii.size() < 5) return std::nullopt;
    const double typical = median(radii), begin = branch.free_from;
    if (branch.length() - begin < 6.0 * typical) return std::nullopt;
    Stenosis found;
    bool is_any = false;
    for (std::size_t n = 0; n < branch.nodes.size(); ++n) {
        const Node& node = branch.nodes[n];
        // The ends are worn by the end of the contrast.
        if (node.is_lost || node.along < begin + typical || node.along > branch.length() - typical) continue;
        double near = 3.0 * typical, far = 10.0 * typical;
        std::vector<double> before, after;
        for (const Node& other : branch.nodes) {
            const double away = other.along - node.along;
            if (other.is_lost || other.along < begin || std::abs(away) < near || std::abs(away) > far) continue;
            (away < 0.0 ? before : after).push_back(other.radius);
        }
        double reference = 0.0;
        if (before.size() >= 3 && after.size() >= 3) reference = 0.5 * (median(before) + median(after));
        else if (before.size() >= 3) reference = median(before);
        else if (after.size() >= 3) reference = median(after);
        else continue;
        const double percent = 100.0 * (1.0 - node.radius / reference);
        if (is_any && percent <= found.percent) continue;
        is_any = true;
        found = {n, node.radius, reference, std::max(0.0, percent), node.is_radius_uncertain};
    }
    if (!is_any) return std::nullopt;
    // The window of a measurement is about as long: it sees the wider vessel before and after, too.
    if (width_of(branch.nodes, found) < least_width * found.reference_radius) found.is_uncertain = true;
    return found;
}

}  // namespace tactus::vessel
