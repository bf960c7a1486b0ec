// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/pointshell_contact.hpp"

#include "dsp/contact/pointshell_kernel.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tactus::contact {

namespace {

/// The samples around this many chunks exceed the caches next to a core.
constexpr std::size_t many_chunks = 256;

bool is_usable(const ContactPair& pair) noexcept {
    return pair.shell && pair.map && !pair.shell->empty() && !pair.map->grid.values.empty() &&
           is_valid(pair.shell_pose) && is_valid(pair.map_pose);
}

Pose normalised(const Pose& pose) noexcept { return {pose.position, glm::normalize(pose.orientation)}; }

/// One pair in double precision: the transform from the shell's frame to the map's, and the reference point in the map.
struct Relation {
    const Pointshell* shell = nullptr;
    const Voxmap* map = nullptr;
    Mat3 rotation{1.0}, to_world{1.0};  // shell to map, map to world
    Vec3 shift{0.0};  // of the shell's origin, map frame
    Vec3 about{0.0};  // map frame
    double sign = 1.0;

    Relation() noexcept = default;
    Relation(const ContactPair& pair, const Vec3& world_about) noexcept
        : shell(pair.shell), map(pair.map), sign(pair.shell_moves ? 1.0 : -1.0) {
        const Pose map_pose = normalised(pair.map_pose);
        const Pose into_map = map_pose.inverse() * normalised(pair.shell_pose);
        rotation = glm::mat3_cast(into_map.orientation);
        shift = into_map.position;
        to_world = glm::mat3_cast(map_pose.orientation);
        about = map_pose.inverse().apply(world_about);
    }

    /// Lower bound of the distance at the node's points.
    double clearance(const ShellNode& node) const noexcept {
        return map->min_within(shift + rotation * node.centre, node.radius);
    }

    kernel::PairFrame frame(const ContactLaw& law, ContactParts parts) const noexcept {
        kernel::PairFrame frame(law);
        const volume::Grid& grid = map->grid;
        frame.values = grid.values.data();
        frame.row = grid.size[0];
        frame.plane = static_cast<std::ptrdiff_t>(grid.size[0]) * grid.size[1];
        for (int axis = 0; axis < 3; ++axis) {
            frame.size[axis] = grid.size[static_cast<std::size_t>(axis)];
            frame.spacing[axis] = static_cast<float>(grid.spacing[axis]);
            frame.per_spacing[axis] = static_cast<float>(1.0 / grid.spacing[axis]);
            for (int c = 0; c < 3; ++c) {
                frame.rotation[3 * axis + c] = static_cast<float>(rotation[c][axis]);
                frame.cells[3 * axis + c] = static_cast<float>(rotation[c][axis] / grid.spacing[axis]);
            }
        }
        frame.stiffness = static_cast<float>(law.stiffness);
        // Both interpolants are weighted means of samples around the point.
        frame.near = static_cast<float>(law.blend + map->steepness * glm::length(grid.spacing));
        frame.by_area = law.by_area;
        frame.by_normal = law.direction == ForceDirection::shell_normal;
        frame.quadratic = law.interpolation == Interpolation::quadratic;
        frame.saturates = law.saturation < 1e3;
        frame.energy_only = parts == ContactParts::energy;
        return frame;
    }

    kernel::ChunkFrame chunk(std::size_t n) const noexcept {
        const ShellNode& node = shell->nodes[n];
        const volume::Grid& grid = map->grid;
        const Vec3 centre = shift + rotation * node.centre, at = (centre - grid.origin) / grid.spacing;
        kernel::ChunkFrame frame;
        frame.chunk = &shell->chunks[n];
        frame.rows = (node.held + kernel::lanes - 1) / kernel::lanes;
        for (int axis = 0; axis < 3; ++axis) {
            const int last = grid.size[static_cast<std::size_t>(axis)] - 1;
            const double cell = std::floor(std::clamp(at[axis], 0.0, static_cast<double>(last)));
            const double reach = node.radius / grid.spacing[axis] + 2.0;
            frame.cell[axis] = static_cast<int>(cell);
            frame.fraction[axis] = static_cast<float>(at[axis] - cell);
            frame.lever[axis] = static_cast<float>(grid.origin[axis] + cell * grid.spacing[axis] - about[axis]);
            frame.border = frame.border || at[axis] - reach < 0.0 || at[axis] + reach > last;
        }
        frame.base = static_cast<std::ptrdiff_t>(grid.index(frame.cell[0], frame.cell[1], frame.cell[2]));
        return frame;
    }
};

/// Sums of the lanes of one pair, in double precision.
struct Totals {
    double value[kernel::sums][kernel::lanes] = {};

    void take(kernel::LaneSums& sums) noexcept {
        for (std::size_t n = 0; n < kernel::sums; ++n)
            for (std::size_t lane = 0; lane < kernel::lanes; ++lane) {
                value[n][lane] += static_cast<double>(sums.value[n][lane]);
                sums.value[n][lane] = 0.0f;
            }
    }
    double sum(std::size_t n) const noexcept {
        double total = 0.0;
        for (const double lane : value[n]) total += lane;
        return total;
    }
};

Mat3 symmetric(const Totals& totals, std::size_t n) noexcept {
    const double xx = totals.sum(n), xy = totals.sum(n + 1), xz = totals.sum(n + 2);
    const double yy = totals.sum(n + 3), yz = totals.sum(n + 4), zz = totals.sum(n + 5);
    return {Vec3(xx, xy, xz), Vec3(xy, yy, yz), Vec3(xz, yz, zz)};
}

void put(ContactSum& sum, std::size_t row, std::size_t column, const Mat3& block) noexcept {
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            sum.stiffness[6 * (row + i) + column + j] += block[static_cast<int>(j)][static_cast<int>(i)];
}

/// Rotates a pair's sums to world axes and adds them.
void add(ContactSum& sum, const Totals& totals, const Relation& relation) noexcept {
    sum.energy += totals.sum(0);
    sum.total_force += totals.sum(1);
    const Mat3 &r = relation.to_world, back = glm::transpose(r);
    const Vec3 force = r * Vec3(totals.sum(2), totals.sum(3), totals.sum(4));
    const Vec3 moment = r * Vec3(totals.sum(5), totals.sum(6), totals.sum(7));
    for (int i = 0; i < 3; ++i) {
        sum.gradient[static_cast<std::size_t>(i)] -= relation.sign * force[i];
        sum.gradient[static_cast<std::size_t>(i) + 3] -= relation.sign * moment[i];
    }
    Mat3 cross;  // rows n, columns r × n
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) cross[j][i] = totals.sum(static_cast<std::size_t>(14 + 3 * i + j));
    cross = r * cross * back;
    put(sum, 0, 0, r * symmetric(totals, 8) * back);
    put(sum, 0, 3, cross);
    put(sum, 3, 0, glm::transpose(cross));
    put(sum, 3, 3, r * symmetric(totals, 23) * back);
}

}  // namespace

PointshellContact::PointshellContact(std::size_t max_nodes) {
    frontier_.reserve(max_nodes);
    next_.reserve(max_nodes);
    chosen_.reserve(max_nodes);
    // Detects the processor now, not in the first tick.
    kernel::variant_in_use();
    kernel::LaneSums none;
    kernel::evaluate(kernel::PairFrame{ContactLaw{}}, {}, none);
}

std::size_t PointshellContact::choose(std::span<const ContactPair> pairs, double blend, std::size_t budget) noexcept {
    frontier_.clear();
    chosen_.clear();
    std::size_t left_out = 0, used = 0;
    Relation relation;
    std::uint32_t related = std::numeric_limits<std::uint32_t>::max();  // the pair that `relation` belongs to
    const auto relate = [&](std::uint32_t pair) {
        if (pair != related) relation = Relation(pairs[pair], Vec3(0.0));
        related = pair;
    };
    const auto visit = [&](std::vector<Entry>& list, std::uint32_t node) {
        const double clearance = relation.clearance(relation.shell->nodes[node]);
        if (clearance >= blend) return;
        list.push_back({related, node, clearance});
        used += relation.shell->nodes[node].held;
    };
    for (std::uint32_t p = 0; p < pairs.size(); ++p) {
        if (!is_usable(pairs[p]) || frontier_.size() == frontier_.capacity()) continue;
        relate(p);
        visit(frontier_, 0);
    }
    while (!frontier_.empty()) {
        // Upper bound of the size of the next level; each node stores how many more points its children have.
        std::size_t more = 0, children = 0;
        for (const Entry& entry : frontier_) {
            const ShellNode& node = pairs[entry.pair].shell->nodes[entry.node];
            more += node.below;
            children += node.children;
        }
        const std::size_t room = chosen_.capacity();
        // When not all can be refined, the nearest come first; ties in the order of pairs and nodes.
        if (used + more > budget || chosen_.size() + frontier_.size() + children > room)
            std::ranges::sort(frontier_, {}, [](const Entry& e) { return std::tuple(e.clearance, e.pair, e.node); });
        next_.clear();
        std::size_t waiting = frontier_.size();
        for (const Entry& entry : frontier_) {
            relate(entry.pair);
            const ShellNode& node = relation.shell->nodes[entry.node];
            --waiting;
            const bool fits = used - node.held + node.below <= budget &&
                              chosen_.size() + next_.size() + waiting + node.children <= room;
            if (node.children == 0 || !fits) {
                chosen_.push_back(entry);
                left_out += node.children != 0;
                continue;
            }
            used -= node.held;
            for (std::uint32_t c = 0; c < node.children; ++c) visit(next_, node.first_child + c);
        }
        frontier_.swap(next_);
    }
    return left_out;
}

ContactSum PointshellContact::operator()(std::span<const ContactPair> pairs, const Vec3& about, const ContactLaw& law,
                                         std::size_t budget, ContactParts parts) noexcept {
    ContactSum sum;
    if (!is_finite(about)) return sum;
    sum.reduced = choose(pairs, std::max(law.blend, 1e-9), budget) > 0;
    for (std::size_t first = 0; first < chosen_.size();) {
        const std::uint32_t pair = chosen_[first].pair;
        std::size_t end = first;
        while (end < chosen_.size() && chosen_[end].pair == pair) ++end;
        const Relation relation(pairs[pair], about);
        kernel::PairFrame frame = relation.frame(law, parts);
        frame.prefetches = end - first > many_chunks;
        kernel::LaneSums lanes;
        Totals totals;
        kernel::ChunkFrame chunks[kernel::max_chunks];
        while (first < end) {
            std::size_t count = 0;
            for (; count < kernel::max_chunks && first < end; ++first) {
                chunks[count++] = relation.chunk(chosen_[first].node);
                sum.evaluated += relation.shell->nodes[chosen_[first].node].held;
            }
            kernel::evaluate(frame, std::span(chunks).first(count), lanes);
            totals.take(lanes);
        }
        sum.in_contact += lanes.in_contact;
        for (const float deep : lanes.deepest) sum.penetration = std::max(sum.penetration, static_cast<double>(deep));
        add(sum, totals, relation);
    }
    sum.contact_gradient = sum.gradient;
    return sum;
}

}  // namespace tactus::contact
