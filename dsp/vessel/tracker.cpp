// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/tracker.hpp"
#include "dsp/core/error.hpp"
#include "dsp/vessel/refine.hpp"
#include "dsp/vessel/stenosis.hpp"
#include "dsp/vessel/track_doubts.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::vessel {

namespace {

constexpr int max_branches = 64;

std::string in_mm(const Vec3& p) { return fmt::format("{:.1f}, {:.1f}, {:.1f} mm", p.x * 1e3, p.y * 1e3, p.z * 1e3); }

/// Brightness above which something is bone or stent rather than this vessel.
double exclusion(const Tube& start, const Noise& noise) {
    return start.background + start.contrast + std::max(0.6 * start.contrast, 4.0 * noise.sigma);
}

class Follower {
public:
    Follower(const volume::Grid& grid, const TrackSettings& settings)
        : settings_(settings),
          scan_(grid),
          search_{scan_, settings_, tracking_window(settings.axial_window, settings.across_window),
                  Sampling{scan_.voxel_volume()}} {}

    Followed run(const Vec3& seed) {
        if (settings_.clip_below) scan_.clip_below(*settings_.clip_below);
        if (settings_.exclude_above) {
            scan_.exclude_above(*settings_.exclude_above);
            if (scan_.is_excluded(seed))
                throw Error(fmt::format("the seed {} lies on bone or a stent (value {:.0f}); put it into the vessel",
                                        in_mm(seed), scan_.any_value(seed)));
        }
        Tube start = best_start(search_, seed);
        if (!(start.score > 0.0)) return nothing(seed, start);
        know_noise(start, seed);
        if (!settings_.exclude_above) scan_.exclude_above(exclusion(start, found_.track.noise));
        start = best_start(search_, seed);
        found_.track.contrast = start.contrast;
        found_.track.background = start.background;
        found_.track.excluded_above = scan_.excluded_above();
        if (start.score < search_.min_start) return nothing(seed, start);
        if (!follow_seed(start, seed)) return nothing(seed, start);
        if (settings_.branches)
            for (std::size_t n = 0; n < found_.track.branches.size(); ++n) find_branches(n);
        cut_forked_ends();
        for (Branch& branch : found_.track.branches)
            branch.stenosis = measured_stenosis(search_, found_.track.noise, branch);
        narrow_roots();
        doubt_ends();
        found_.track.doubts = doubts_of(scan_, found_.track, settings_.max_radius);
        found_.track.seed_node = std::min(found_.track.seed_node, found_.track.branches[0].nodes.size() - 1);
        return std::move(found_);
    }

private:
    Followed nothing(const Vec3& seed, const Tube& start) {
        found_.track.branches.clear();
        found_.why =
            fmt::format("no vessel at {}: the best tube there has a t-statistic of {:.1f}, noise reaches {:.1f}",
                        in_mm(seed), start.score, search_.min_start);
        if (start.score >= search_.min_start)
            found_.why = fmt::format("no vessel at {}: what is bright there cannot be followed", in_mm(seed));
        return std::move(found_);
    }

    void know_noise(const Tube& start, const Vec3& seed) {
        found_.track.noise = measured_noise(scan_, seed, start.background - 1.0 * start.contrast,
                                            start.background + 1.5 * start.contrast);
        search_.sampling = found_.track.noise.sampling(scan_);
    }

    /// Why a branch ends at its refined end: what was followed beyond it, and was cut, showed no vessel.
    static End end_at(const Node& node, const Vec3& followed_to, End end) {
        const bool is_cut = glm::length(node.position - followed_to) > 2.0 * node.radius;
        const bool is_beyond = end == End::border || end == End::length || end == End::meets_track;
        return is_cut && is_beyond ? End::contrast : end;
    }

    bool follow_seed(const Tube& start, const Vec3& seed) {
        Tube back = start;
        back.direction = -back.direction;
        const OneWay ahead = follow_one_way(search_, start, {}, settings_.max_length);
        std::vector<Taken> taken;
        for (std::size_t n = 0; n < ahead.tubes.size(); ++n)
            if (glm::length(ahead.tubes[n].centre - start.centre) > 4.0 * start.radius)
                taken.push_back({ahead.tubes[n].centre, ahead.tubes[n].radius, 0});
        const OneWay behind = follow_one_way(search_, back, taken, settings_.max_length);
        std::vector<Tube> tubes(behind.tubes.rbegin(), behind.tubes.rend());
        for (Tube& tube : tubes) tube.direction = -tube.direction;
        tubes.push_back(start);
        tubes.insert(tubes.end(), ahead.tubes.begin(), ahead.tubes.end());
        Branch branch;
        Refined refined = refined_nodes(search_, tubes, start.contrast, start.centre, true, true);
        branch.nodes = std::move(refined.nodes);
        if (!is_vessel(branch)) return false;
        branch.start = refined.start.value_or(end_at(branch.nodes.front(), tubes.front().centre, behind.end));
        branch.end = refined.end.value_or(end_at(branch.nodes.back(), tubes.back().centre, ahead.end));
        for (std::size_t n = 0; n < branch.nodes.size(); ++n)
            if (glm::length(branch.nodes[n].position - seed) <
                glm::length(branch.nodes[found_.track.seed_node].position - seed))
                found_.track.seed_node = n;
        add(std::move(branch));
        return true;
    }

    /// Long enough, and clearer than noise all along.
    bool is_vessel(const Branch& branch) const {
        if (branch.nodes.size() < 4) return false;
        std::vector<double> radii;
        double score = 0.0, seen = 0.0;
        for (const Node& node : branch.nodes) {
            radii.push_back(node.radius);
            score += node.score;
            seen += !node.is_lost;
        }
        std::ranges::sort(radii);
        const double typical = radii[radii.size() / 2], count = double(branch.nodes.size());
        return branch.length() > std::max(4.0 * typical, 8.0 * scan_.voxel()) && seen > 0.6 * count &&
               score / count > search_.min_branch;
    }

    void add(Branch branch) {
        const int index = static_cast<int>(found_.track.branches.size());
        for (const Node& node : branch.nodes) taken_.push_back({node.position, node.radius, index});
        found_.track.branches.push_back(std::move(branch));
    }

    void find_branches(std::size_t index) {
        const std::vector<SideBranch> sides = side_branches(search_, found_.track.branches[index], taken_);
        for (const SideBranch& side : sides) {
            if (static_cast<int>(found_.track.branches.size()) >= max_branches) return;
            follow_side(side, index);
        }
    }

    void follow_side(const SideBranch& side, std::size_t index) {
        const Node leaves = found_.track.branches[index].nodes[static_cast<std::size_t>(side.node)];
        const auto is_taken = [&](const Vec3& place) {
            return std::ranges::any_of(taken_, [&](const Taken& other) {
                return glm::length(place - other.position) < other.radius + 0.3 * side.tube.radius;
            });
        };
        if (is_taken(side.tube.centre)) return;
        FitLimits limits{0.7 * side.tube.radius, std::min(1.4 * side.tube.radius, 1.1 * leaves.radius)};
        limits.max_radius = std::max(limits.max_radius, limits.min_radius);
        limits.shift = 0.8;
        Tube start = fitted(scan_, tracking_window(1.3, 2.0), search_.sampling, side.tube, limits);
        start.radius = std::min(start.radius, 1.3 * edge_distance(scan_, start));
        if (start.score < search_.min_mean || is_taken(start.centre)) return;
        if (glm::dot(start.direction, side.tube.direction) < 0.0) start.direction = -start.direction;
        const OneWay ahead = follow_one_way(search_, start, taken_, settings_.max_length);
        // Back to the parent, which the search for side branches keeps clear of.
        Tube back = start;
        back.direction = -back.direction;
        const OneWay behind = follow_one_way(search_, back, taken_, 6.0 * leaves.radius);
        std::vector<Tube> tubes(behind.tubes.rbegin(), behind.tubes.rend());
        for (Tube& tube : tubes) tube.direction = -tube.direction;
        const bool is_joined = behind.end == End::meets_track || behind.end == End::larger_vessel;
        if (!is_joined) tubes.clear();
        tubes.push_back(start);
        tubes.insert(tubes.end(), ahead.tubes.begin(), ahead.tubes.end());
        Branch branch;
        Refined refined = refined_nodes(search_, tubes, start.contrast, start.centre, false, true);
        branch.nodes = std::move(refined.nodes);
        if (!is_vessel(branch) || branch.length() < 5e-3) return;
        branch.end = refined.end.value_or(end_at(branch.nodes.back(), tubes.back().centre, ahead.end));
        branch.meets = branch.end == End::meets_track ? ahead.meets : -1;
        branch.parent = static_cast<int>(index);
        attach(branch, found_.track.branches[index], leaves);
        add(std::move(branch));
    }

    /// Joins the branch to its parent where the line of its first piece, drawn backwards, comes closest to the parent's.
    void attach(Branch& branch, const Branch& parent, const Node& leaves) {
        // Where the branch is free of its parent; closer, the parent draws the track to itself.
        std::size_t clear = 0;
        const auto is_clear = [&](const Vec3& place, double radius) {
            return std::ranges::none_of(parent.nodes, [&](const Node& node) {
                return glm::length(place - node.position) < node.radius + 0.5 * radius;
            });
        };
        while (clear + 4 < branch.nodes.size() && !is_clear(branch.nodes[clear].position, branch.nodes[clear].radius))
            ++clear;
        const double reach = std::max({2.5 * branch.nodes[clear].radius, 2.5 * leaves.radius, 6.0 * scan_.voxel()});
        std::size_t ahead = clear + 1;
        while (ahead + 1 < branch.nodes.size() && branch.nodes[ahead].along - branch.nodes[clear].along < reach)
            ++ahead;
        ahead = std::min(ahead, branch.nodes.size() - 1);
        clear = std::min(clear, ahead - 1);
        // Its line there: through the means of two halves.
        const auto mean = [&](std::size_t from, std::size_t to) {
            Vec3 sum(0.0);
            for (std::size_t n = from; n < to; ++n) sum += branch.nodes[n].position / double(to - from);
            return sum;
        };
        const std::size_t half = (clear + ahead + 1) / 2;
        Vec3 first = mean(clear, half);
        const Vec3 back = glm::normalize(first - mean(half, ahead + 1));
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t n = 0; n < parent.nodes.size(); ++n) {
            const Vec3 to = parent.nodes[n].position - first;
            if (glm::length(parent.nodes[n].position - leaves.position) > 6.0 * leaves.radius) continue;
            const double along = std::clamp(glm::dot(to, back), 0.0, 6.0 * leaves.radius);
            const double off = glm::length(to - along * back);
            if (off < least) least = off, branch.parent_node = static_cast<int>(n);
        }
        std::size_t behind = 0;  // nodes on the other side of the root
        while (behind < clear && glm::dot(branch.nodes[behind].position -
                                              parent.nodes[static_cast<std::size_t>(branch.parent_node)].position,
                                          back) > 0.0)
            ++behind;
        branch.nodes.erase(branch.nodes.begin(), branch.nodes.begin() + static_cast<std::ptrdiff_t>(behind));
        first = branch.nodes.front().position;
        const double dropped = branch.nodes.front().along;
        for (Node& node : branch.nodes) node.along -= dropped;
        // A straight piece from the parent's axis.
        const Node& root = parent.nodes[static_cast<std::size_t>(branch.parent_node)];
        const double gap = glm::length(first - root.position);
        const int parts = std::max(1, static_cast<int>(gap / scan_.voxel()));
        std::vector<Node> joining;
        for (int n = 0; n < parts; ++n) {
            Node node = branch.nodes.front();
            node.position = root.position + (first - root.position) * (double(n) / parts);
            node.direction = gap > 0.0 ? (first - root.position) / gap : -back;
            node.along = gap * n / parts;
            node.is_lost = false;
            joining.push_back(node);
        }
        for (Node& node : branch.nodes) node.along += gap;
        branch.nodes.insert(branch.nodes.begin(), joining.begin(), joining.end());
        joining_.push_back(joining.size());
        // The parent, and its blur, are part of what is measured up to here.
        for (const Node& node : branch.nodes) {
            branch.free_from = node.along;
            if (std::ranges::none_of(parent.nodes, [&](const Node& other) {
                    return glm::length(node.position - other.position) <
                           other.radius + node.radius + 1.5 * scan_.voxel();
                }))
                break;
        }
        // The start of a branch is a place on the axis that it left.
        if (branch.parent_node == 0 && parent.parent >= 0) {
            branch.parent = parent.parent;
            branch.parent_node = parent.parent_node;
        }
    }

    /// Within the fork the lumen narrows from the parent's radius to that of the branch.
    void narrow_roots() {
        std::vector<Branch>& branches = found_.track.branches;
        for (std::size_t b = 1; b < branches.size(); ++b) {
            Branch& branch = branches[b];
            const std::size_t count = std::min(joining_[b - 1], branch.nodes.size() - 1);
            const Node& root =
                branches[static_cast<std::size_t>(branch.parent)].nodes[static_cast<std::size_t>(branch.parent_node)];
            for (std::size_t n = 0; n < count; ++n)
                branch.nodes[n].radius = std::lerp(root.radius, branch.nodes[count].radius, double(n) / double(count));
        }
    }

    /// Where a vessel forks evenly, the track of the trunk runs on between its branches: it ends at their root.
    void cut_forked_ends() {
        std::vector<Branch>& branches = found_.track.branches;
        for (std::size_t b = 0; b < branches.size(); ++b) {
            Branch& branch = branches[b];
            for (const bool at_end : {true, false}) {
                if (!at_end && b > 0) continue;
                const End end = at_end ? branch.end : branch.start;
                if (end == End::meets_track || end == End::larger_vessel) continue;
                const double tip = at_end ? branch.length() : 0.0;
                int children = 0;
                double furthest = -1.0, smallest = 1e9;
                for (const Branch& child : branches) {
                    if (child.parent != static_cast<int>(b)) continue;
                    const Node& root = branch.nodes[static_cast<std::size_t>(child.parent_node)];
                    const double off = std::abs(tip - root.along);
                    if (off > 5.0 * root.radius) continue;
                    ++children;
                    furthest = std::max(furthest, static_cast<double>(child.parent_node));
                    smallest = std::min(smallest, static_cast<double>(child.parent_node));
                }
                if (children < 2) continue;
                if (at_end) branch.nodes.resize(static_cast<std::size_t>(furthest) + 1);
                else cut_start(b, static_cast<int>(smallest));
                (at_end ? branch.end : branch.start) = End::forks;
            }
        }
    }

    /// Where a vessel becomes indistinguishable from noise, confidence decreases over the eight radii before; it is at
    /// most 0.9 in the whole branch.
    void doubt_ends() {
        for (Branch& branch : found_.track.branches)
            for (const bool at_end : {true, false}) {
                if ((at_end ? branch.end : branch.start) != End::noise || (!at_end && branch.parent >= 0)) continue;
                for (Node& node : branch.nodes) {
                    const double away = at_end ? branch.length() - node.along : node.along;
                    node.confidence = std::min(node.confidence, std::min(0.9, away / (8.0 * node.radius)));
                }
            }
    }

    void cut_start(std::size_t index, int count) {
        std::vector<Branch>& branches = found_.track.branches;
        std::vector<Node>& nodes = branches[index].nodes;
        const double cut = nodes[static_cast<std::size_t>(count)].along;
        nodes.erase(nodes.begin(), nodes.begin() + count);
        for (Node& node : nodes) node.along -= cut;
        for (Branch& child : branches)
            if (child.parent == static_cast<int>(index)) child.parent_node -= count;
        found_.track.seed_node -= std::min(found_.track.seed_node, static_cast<std::size_t>(count));
    }

    const TrackSettings settings_;
    Scan scan_;
    Search search_;
    Followed found_;
    std::vector<Taken> taken_;
    std::vector<std::size_t>
        joining_;  ///< nodes of the straight piece from the parent's axis, of each branch but the first
};

}  // namespace

Followed follow(const volume::Grid& grid, const Vec3& seed, const TrackSettings& settings) {
    const Scan scan(grid);
    if (!is_finite(seed)) throw Error("the seed is not a position: it needs three numbers, in mm");
    if (!scan.contains(seed)) {
        const Vec3 high = grid.position(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1);
        throw Error(fmt::format("the seed {} lies outside of the scan, which reaches from {} to {} (LPS)", in_mm(seed),
                                in_mm(grid.origin), in_mm(high)));
    }
    return Follower(grid, settings).run(seed);
}

}  // namespace tactus::vessel
