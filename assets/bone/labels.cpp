// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/labels.hpp"

#include "assets/bone/air_around.hpp"
#include "assets/bone/assumed_density.hpp"
#include "assets/bone/from_hu.hpp"
#include "assets/bone/thin_sheets.hpp"
#include "assets/mesh/mesh.hpp"
#include "dsp/core/error.hpp"
#include "dsp/geometry/surface_net.hpp"
#include "dsp/volume/cubic_interpolant.hpp"
#include "dsp/volume/resample.hpp"
#include "dsp/volume/surface_distance.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::bone {

namespace {

constexpr int relax_passes = 40;

// Colours that people with red-green colour blindness can distinguish (Okabe and Ito 2008), after the colour of bone.
const std::array<Vec3, 8> colours{Vec3(0.90, 0.86, 0.76), Vec3(0.34, 0.71, 0.91), Vec3(0.90, 0.62, 0.00),
                                  Vec3(0.00, 0.62, 0.45), Vec3(0.80, 0.47, 0.65), Vec3(0.94, 0.89, 0.26),
                                  Vec3(0.00, 0.45, 0.70), Vec3(0.84, 0.37, 0.00)};

struct Box {
    std::array<int, 3> first, last;
};

// 1 at labelled samples, else 0, on the samples around the label; outside the map is not labelled.
volume::Grid mask_of(const volume::Grid& labels, int label, std::size_t& count) {
    Box box{labels.size, {-1, -1, -1}};
    const auto wanted = static_cast<float>(label);
    count = 0;
    for (int k = 0; k < labels.size[2]; ++k)
        for (int j = 0; j < labels.size[1]; ++j)
            for (int i = 0; i < labels.size[0]; ++i) {
                if (labels.at(i, j, k) != wanted) continue;
                const std::array<int, 3> at{i, j, k};
                for (std::size_t a = 0; a < 3; ++a)
                    box.first[a] = std::min(box.first[a], at[a]), box.last[a] = std::max(box.last[a], at[a]);
                ++count;
            }
    if (count == 0) throw Error(fmt::format("no voxel has label {}", label));
    volume::Grid mask{{}, {}, labels.spacing, {}};
    for (std::size_t a = 0; a < 3; ++a) {
        const int reach = 6 + static_cast<int>(std::ceil(air_around / labels.spacing[static_cast<int>(a)]));
        box.first[a] -= reach;
        mask.size[a] = box.last[a] + reach - box.first[a] + 1;
    }
    mask.origin = labels.position(box.first[0], box.first[1], box.first[2]);
    mask.values.assign(mask.count(), 0.0f);
    for (int k = 0; k < mask.size[2]; ++k)
        for (int j = 0; j < mask.size[1]; ++j)
            for (int i = 0; i < mask.size[0]; ++i) {
                const int x = i + box.first[0], y = j + box.first[1], z = k + box.first[2];
                if (x < 0 || y < 0 || z < 0 || x >= labels.size[0] || y >= labels.size[1] || z >= labels.size[2])
                    continue;
                mask.at(i, j, k) = labels.at(x, y, z) == wanted ? 1.0f : 0.0f;
            }
    return mask;
}

// Faces of the label's voxels beside voxels of other labels.
contact::ScannedBorder border_of(const volume::Grid& labels, int label) {
    contact::ScannedBorder border{{}, labels.spacing};
    const auto wanted = static_cast<float>(label);
    for (int k = 0; k < labels.size[2]; ++k)
        for (int j = 0; j < labels.size[1]; ++j)
            for (int i = 0; i < labels.size[0]; ++i)
                for (int axis = 0; axis < 3; ++axis) {
                    std::array<int, 3> next{i, j, k};
                    const auto a = static_cast<std::size_t>(axis);
                    if (++next[a] >= labels.size[a]) continue;
                    const float here = labels.at(i, j, k), there = labels.at(next[0], next[1], next[2]);
                    if (here == there || here == 0.0f || there == 0.0f || (here != wanted && there != wanted)) continue;
                    Vec3 middle = labels.position(i, j, k);
                    middle[axis] += 0.5 * labels.spacing[axis];
                    border.faces.push_back(middle);
                }
    return border;
}

// Grey values on both sides of the edge of a label.
struct Grey {
    const volume::Grid& labels;
    const volume::Grid& mask;
    const volume::Grid& hu;
    volume::CubicInterpolant f{hu};

    Vec3 place(const Vec3& at) const { return (at - hu.origin) / hu.spacing; }

    bool is_inside(const Vec3& u) const {
        for (int a = 0; a < 3; ++a)
            if (u[a] < 0.0 || u[a] > hu.size[static_cast<std::size_t>(a)] - 1) return false;
        return true;
    }

    // True when the sample has no label at all.
    bool is_background(const Vec3& at) const {
        const Vec3 u = glm::floor((at - labels.origin) / labels.spacing + 0.5);
        for (int a = 0; a < 3; ++a)
            if (u[a] < 0.0 || u[a] >= labels.size[static_cast<std::size_t>(a)]) return true;
        return labels.at(static_cast<int>(u.x), static_cast<int>(u.y), static_cast<int>(u.z)) == 0.0f;
    }

    // Calls visit(HU inside, HU outside) for the edges of a cell that lead from the label to background.
    template <typename Visit>
    int for_each_edge(const std::array<int, 3>& cell, Visit visit) const {
        int crossings = 0;
        for (int from = 0; from < 8; ++from)
            for (int axis = 0; axis < 3; ++axis) {
                const int to = from | 1 << axis;
                if (to == from) continue;
                const auto corner = [&](int c) {
                    return std::array<int, 3>{cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)};
                };
                const auto a = corner(from), b = corner(to);
                const bool a_in = mask.at(a[0], a[1], a[2]) > 0.5f, b_in = mask.at(b[0], b[1], b[2]) > 0.5f;
                if (a_in == b_in) continue;
                ++crossings;
                const auto &in = a_in ? a : b, &out = a_in ? b : a;
                const Vec3 inside = mask.position(in[0], in[1], in[2]), outside = mask.position(out[0], out[1], out[2]);
                if (!is_background(outside) || !is_inside(place(inside)) || !is_inside(place(outside))) continue;
                visit(f(place(inside)).value, f(place(outside)).value);
            }
        return crossings;
    }

    // The level with equal error: as many inside values lie below it as outside values above it.
    std::optional<double> level(const geometry::SurfaceNet& net) const {
        std::vector<double> inside, outside;
        for (const auto& cell : net.cell)
            for_each_edge(cell, [&](double in, double out) { inside.push_back(in), outside.push_back(out); });
        if (inside.size() < 100) return {};
        std::sort(inside.begin(), inside.end());
        std::sort(outside.begin(), outside.end(), std::greater<>());
        std::size_t n = 0;
        while (n < inside.size() && inside[n] < outside[n]) ++n;
        if (n == inside.size()) return {};
        const double low = n > 0 ? std::max(inside[n - 1], outside[n]) : outside[n];
        return 0.5 * (low + (n > 0 ? std::min(inside[n], outside[n - 1]) : inside[n]));
    }
};

// Share of a cell's edges where the grey values cross the level, smoothed so that the surface stays continuous.
std::vector<double> trust_in(const Grey& grey, const geometry::SurfaceNet& net, double level) {
    std::vector<double> trust;
    for (const auto& cell : net.cell) {
        int good = 0;
        const int all = grey.for_each_edge(cell, [&](double in, double out) { good += in >= level && out < level; });
        trust.push_back(all > 0 ? double(good) / all : 0.0);
    }
    for (int pass = 0; pass < 2; ++pass) {
        std::vector<double> sum = trust, count(trust.size(), 1.0);
        for (const auto& t : net.triangles)
            for (std::size_t c = 0; c < 3; ++c) {
                sum[static_cast<std::size_t>(t[c])] += trust[static_cast<std::size_t>(t[(c + 1) % 3])];
                count[static_cast<std::size_t>(t[c])] += 1.0;
            }
        for (std::size_t n = 0; n < trust.size(); ++n)
            trust[n] = std::min(trust[n], 1.0) * 0.5 + 0.5 * sum[n] / count[n];
    }
    return trust;
}

void move_to_level(const Grey& grey, geometry::SurfaceNet& net, double level) {
    const std::vector<double> trust = trust_in(grey, net, level);
    const double cell = std::min({grey.mask.spacing.x, grey.mask.spacing.y, grey.mask.spacing.z});
    for (std::size_t n = 0; n < net.vertices.size(); ++n) {
        if (trust[n] <= 0.0) continue;
        Vec3 at = net.vertices[n];
        for (int step = 0; step < 3; ++step) {
            const auto here = grey.f(grey.place(at));
            const double steep = glm::dot(here.gradient, here.gradient);
            if (!(steep > 0.0)) break;
            Vec3 move = here.gradient * ((level - here.value) / steep);
            if (const double length = glm::length(move); length > 0.5 * cell) move *= 0.5 * cell / length;
            at += move;
        }
        Vec3 move = at - net.vertices[n];
        // A crossing that far away belongs to another structure.
        if (glm::length(move) < 1.2 * cell) net.vertices[n] += move * trust[n];
    }
}

// Shifts the whole surface until it encloses the volume of the labelled voxels. Every labelled voxel stays inside; where
// bone is thin, by so much that the sheet between neighbouring samples does not break up.
void keep_volume(volume::Grid& distance, const volume::Grid& mask, const std::vector<char>& thin, double voxels) {
    const double wanted = voxels * mask.spacing.x * mask.spacing.y * mask.spacing.z;
    const double cell = std::min({mask.spacing.x, mask.spacing.y, mask.spacing.z});
    const bool has_samples = distance.size == mask.size && distance.spacing == mask.spacing;
    const auto keep_inside = [&](bool only_thin) {
        for (std::size_t n = 0; has_samples && n < distance.values.size(); ++n)
            if (mask.values[n] > 0.5f && (thin[n] != 0 || !only_thin))
                distance.values[n] =
                    std::min(distance.values[n], static_cast<float>((thin[n] != 0 ? -0.25 : -0.02) * cell));
    };
    // What thin sheets keep is taken from the rest, a part in each round.
    const int rounds = std::ranges::find(thin, 1) != thin.end() ? 4 : 2;
    for (int round = 0; round < rounds; ++round) {
        keep_inside(false);
        const geometry::TriangleSurface surface = geometry::iso_surface(distance, 0.0f, false);
        if (surface.triangles.empty()) return;
        const double outwards =
            std::clamp((wanted - mesh::volume_of(surface)) / mesh::area_of(surface), -0.5 * cell, 0.5 * cell);
        for (float& d : distance.values) d -= static_cast<float>(outwards);
    }
    keep_inside(true);
}

}  // namespace

Vec3 label_colour(int label) { return colours[static_cast<std::size_t>(std::max(label - 1, 0)) % colours.size()]; }

std::vector<int> labels_in(const volume::Grid& labels) {
    std::vector<char> seen(65536, 0);
    float last = 0.0f;
    for (const float value : labels.values) {
        if (value == last) continue;
        if (!(value >= 0.0f && value <= 65535.0f) || value != std::floor(value))
            throw Error(fmt::format("a value of {:g} is not a label: labels are whole numbers from 0 to 65535", value));
        seen[static_cast<std::size_t>(value)] = 1;
        last = value;
    }
    std::vector<int> found;
    for (int n = 1; n < 65536; ++n)
        if (seen[static_cast<std::size_t>(n)]) found.push_back(n);
    if (found.size() > 1000)
        throw Error(
            fmt::format("{} different values: this is an image, not a label map; leave out --label", found.size()));
    return found;
}

Bone bone_of_label(const volume::Grid& labels, const volume::Segment& segment, const LabelBone& how, const RunJobs& run,
                   std::size_t* voxels) {
    std::size_t count = 0;
    volume::Grid mask = mask_of(labels, segment.label, count);
    const auto is_background = [&](int i, int j, int k) {
        const Vec3 u = glm::floor((mask.position(i, j, k) - labels.origin) / labels.spacing + 0.5);
        for (int a = 0; a < 3; ++a)
            if (u[a] < 0.0 || u[a] >= labels.size[static_cast<std::size_t>(a)]) return true;
        return labels.at(static_cast<int>(u.x), static_cast<int>(u.y), static_cast<int>(u.z)) == 0.0f;
    };
    const std::vector<char> thin = close_thin_sheets(mask, is_background);
    if (voxels) *voxels = count;
    geometry::SurfaceNet net = geometry::surface_net(mask, 0.5f, true);
    geometry::relax(net, mask, relax_passes, run);
    bool from_grey = false;
    std::string surface = "label edges, staircase taken off, volume kept";
    // A masked CT has no background values, so it shows no edge.
    if (how.hu && !how.hu_is_masked) {
        const Grey grey{labels, mask, *how.hu};
        if (const auto level = grey.level(net)) {
            move_to_level(grey, net, *level);
            from_grey = true;
            surface = fmt::format("grey values at {:.0f} HU, label edges where they do not cross it", *level);
        }
    }
    Bone bone;
    volume::Grid layout{mask.size, mask.origin, mask.spacing, {}};
    if (how.spacing) {
        const Vec3 extent = Vec3(mask.size[0] - 1, mask.size[1] - 1, mask.size[2] - 1) * mask.spacing;
        layout.spacing = Vec3(*how.spacing);
        for (int a = 0; a < 3; ++a) {
            const double steps = std::floor(extent[a] / *how.spacing) + 1.0;
            if (steps > 10000.0)
                throw Error("the spacing gives more than 10000 voxels along an axis; use a larger one");
            layout.size[static_cast<std::size_t>(a)] = static_cast<int>(steps);
        }
    }
    bone.distance = volume::signed_distance(layout, net, run);
    if (!from_grey) keep_volume(bone.distance, mask, thin, static_cast<double>(count));
    if (how.hu) {
        bone.density = volume::resampled(*how.hu, layout);
        for (float& value : bone.density.values) value = density_of_hu(value);
        bone.provenance["calibration"] = density_calibration();
    } else {
        bone.density = assumed_density(bone.distance);
        bone.provenance["calibration"] = assumed_density_law();
    }
    bone.name = segment.name.empty() ? fmt::format("label_{}", segment.label) : segment.name;
    bone.colour = segment.colour.value_or(label_colour(segment.label));
    bone.provenance["frame"] = "LPS";
    bone.provenance["label"] = std::to_string(segment.label);
    bone.provenance["surface"] = surface;
    if (how.keeps_border) bone.border = border_of(labels, segment.label);
    return bone;
}

}  // namespace tactus::bone
