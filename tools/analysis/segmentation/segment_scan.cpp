// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/segmentation/segment_scan.hpp"

#include "assets/bone/labels.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/processor_time.hpp"
#include "dsp/segmentation/gap_statistics.hpp"
#include "dsp/segmentation/random_walk.hpp"
#include "dsp/segmentation/strokes.hpp"
#include "dsp/segmentation/uncertain.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <ctime>
#include <limits>

namespace tactus::analysis {

namespace {

/// Throws Error when painting would take minutes: many wide strokes.
void check_work(const ScanGraph& scan, std::span<const segmentation::SeedLabel> labels, const std::string& file) {
    constexpr double max_voxels = 5e9;
    const Vec3& h = scan.box.spacing;
    double voxels = 0.0;
    for (const segmentation::SeedLabel& label : labels)
        for (const segmentation::Stroke& stroke : label.strokes)
            for (std::size_t n = 0; n < stroke.points.size(); ++n) {
                const Vec3 reach =
                    glm::abs(stroke.points[std::min(n + 1, stroke.points.size() - 1)] - stroke.points[n]) +
                    2.0 * stroke.radius;
                double box = 1.0;
                for (int axis = 0; axis < 3; ++axis)
                    box *= std::min(reach[axis] / h[axis] + 1.0,
                                    static_cast<double>(scan.box.size[static_cast<std::size_t>(axis)]));
                voxels += box;
            }
    if (voxels > max_voxels)
        throw Error(
            fmt::format("{}: the strokes cover {:.0f} million voxels, counted each time; use fewer points, or "
                        "narrower strokes",
                        file, voxels * 1e-6));
}

/// What to do about a stroke that touches no bone: often it is not where the scan is, as in another unit.
std::string way_out_of_air(const ScanGraph& scan, const segmentation::Stroke& stroke) {
    const Vec3 low = scan.scan.origin * 1e3,
               high = scan.scan.position(scan.scan.size[0] - 1, scan.scan.size[1] - 1, scan.scan.size[2] - 1) * 1e3;
    for (const Vec3& place : stroke.points) {
        const Vec3 at = place * 1e3;
        if (glm::any(glm::lessThan(at, low)) || glm::any(glm::greaterThan(at, high)))
            return fmt::format(
                "{:g}, {:g}, {:g} mm lies outside of the scan, which reaches from {:.1f}, {:.1f}, {:.1f} to {:.1f}, "
                "{:.1f}, {:.1f} mm (LPS); seeds are in mm",
                at.x, at.y, at.z, low.x, low.y, low.z, high.x, high.y, high.z);
    }
    return "move it, or make it wider";
}

std::vector<std::uint8_t> seeds_in(const ScanGraph& scan, std::span<const segmentation::SeedLabel> labels,
                                   const std::string& file) {
    check_work(scan, labels, file);
    std::vector<std::uint8_t> seed(scan.graph.nodes(), 0);
    for (std::size_t l = 0; l < labels.size(); ++l)
        for (std::size_t s = 0; s < labels[l].strokes.size(); ++s)
            if (segmentation::paint(scan.box, scan.node_of_voxel, labels[l].strokes[s],
                                    static_cast<std::uint8_t>(l + 1), seed) == 0)
                throw Error(fmt::format(
                    "{}: label '{}', stroke {}: it touches no voxel of bone (values from {:g} on); {}", file,
                    labels[l].name, s + 1, scan.threshold, way_out_of_air(scan, labels[l].strokes[s])));
    for (std::size_t l = 0; l < labels.size(); ++l)
        if (std::find(seed.begin(), seed.end(), static_cast<std::uint8_t>(l + 1)) == seed.end())
            throw Error(
                fmt::format("{}: later labels are painted over all strokes of label '{}'", file, labels[l].name));
    return seed;
}

double share_below(std::vector<float> values, double share) {
    if (values.empty()) return 0.0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return static_cast<double>(*at);
}

/// Voxels beside the bone that take the label of the nearest bone: marrow, and in a masked scan all that are not 0. A
/// masked scan says itself where the bone ends, so that only single voxels within it are missing.
std::vector<std::uint8_t> open_voxels(const ScanGraph& scan, const segmentation::LabelMap& map, double marrow) {
    std::vector<std::uint8_t> open(map.label.size(), 0);
    const bool is_masked = scan.hu == volume::HuKind::masked;
    const Vec3& h = scan.scan.spacing;
    const double radius = is_masked ? std::min(marrow, 0.5 * std::min({h.x, h.y, h.z})) : marrow;
    if (radius > 0.0) open = segmentation::marrow_of(map, h, radius);
    if (is_masked)
        for (std::size_t v = 0; v < open.size(); ++v) open[v] |= scan.scan.values[v] != 0.0f;
    return open;
}

}  // namespace

std::vector<UnseededIsland> islands_of(const ScanGraph& scan, std::span<const std::uint8_t> label) {
    const segmentation::GraphParts parts = segmentation::parts_of(scan.graph);
    std::vector<UnseededIsland> of_part(parts.nodes.size());
    const auto position = [&](std::size_t n) {
        const auto at = scan.graph.place(n);
        return scan.box.position(at[0], at[1], at[2]);
    };
    for (std::size_t n = 0; n < label.size(); ++n) {
        if (label[n] != 0) continue;
        UnseededIsland& island = of_part[static_cast<std::size_t>(parts.part[n])];
        ++island.voxels;
        island.centre += position(n);
    }
    for (UnseededIsland& island : of_part)
        if (island.voxels > 0) island.centre /= static_cast<double>(island.voxels);
    std::vector<double> least(of_part.size(), std::numeric_limits<double>::infinity());
    for (std::size_t n = 0; n < label.size(); ++n) {
        if (label[n] != 0) continue;
        const auto part = static_cast<std::size_t>(parts.part[n]);
        const Vec3 away = position(n) - of_part[part].centre;
        if (const double square = glm::dot(away, away); square < least[part]) {
            least[part] = square;
            of_part[part].inside = position(n);
        }
    }
    std::erase_if(of_part, [](const UnseededIsland& island) { return island.voxels == 0; });
    std::stable_sort(of_part.begin(), of_part.end(),
                     [](const UnseededIsland& a, const UnseededIsland& b) { return a.voxels > b.voxels; });
    return of_part;
}

std::unique_ptr<segmentation::VoxelGraph> graph_for_seeds(const ScanGraph& scan, std::span<const std::uint8_t> seed,
                                                          segmentation::GapLaw& law) {
    law = segmentation::law_of_seeds(scan.law, scan.graph, scan.box, seed);
    if (!(law.bright < scan.law.bright)) return nullptr;
    std::vector<std::uint8_t> inside(scan.node_of_voxel.size());
    for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = scan.node_of_voxel[v] >= 0;
    return std::make_unique<segmentation::VoxelGraph>(segmentation::make_voxel_graph(scan.box, inside, law));
}

SegmentedScan segment_scan(const ScanGraph& scan, std::span<const segmentation::SeedLabel> seeds,
                           const SegmentSettings& settings, const std::string& seeds_file) {
    const std::vector<std::uint8_t> seed = seeds_in(scan, seeds, seeds_file);
    const double begin = process_seconds();
    SegmentedScan out;
    const std::unique_ptr<segmentation::VoxelGraph> own = graph_for_seeds(scan, seed, out.law);
    const segmentation::Walks walks = segmentation::random_walks(
        own ? *own : scan.graph, seed, static_cast<int>(seeds.size()), {}, nullptr, settings.run);
    out.seconds = process_seconds() - begin;
    out.residual = walks.residual;
    out.iterations = walks.iterations;
    const std::vector<std::uint8_t> label = segmentation::labels_of(walks);
    const std::vector<float> certainty = segmentation::certainty_of(walks);

    out.map = {scan.scan.size, std::vector<std::uint8_t>(scan.scan.count(), 0)};
    out.certainty = {scan.scan.size, scan.scan.origin, scan.scan.spacing, std::vector<float>(scan.scan.count(), 0.0f)};
    std::vector<float> labelled;
    // A voxel without a label counts as certain: islands are reported by themselves.
    std::vector<float> of_labelled(certainty.size(), 1.0f);
    for (std::size_t n = 0; n < label.size(); ++n) {
        const auto at = scan.graph.place(n);
        const std::size_t v = scan.scan.index(at[0] + scan.box_at[0], at[1] + scan.box_at[1], at[2] + scan.box_at[2]);
        out.map.label[v] = label[n];
        out.certainty.values[v] = certainty[n];
        if (label[n] == 0) continue;
        labelled.push_back(certainty[n]);
        of_labelled[n] = certainty[n];
    }
    out.certainty_p05 = share_below(std::move(labelled), 0.05);
    out.islands = islands_of(scan, label);
    for (const segmentation::UncertainRegion& region : segmentation::uncertain_regions(scan.graph, of_labelled))
        out.uncertain.push_back(
            {region.nodes, scan.box.position(region.deepest[0], region.deepest[1], region.deepest[2])});
    const std::vector<std::uint8_t> open = open_voxels(scan, out.map, settings.marrow);
    for (const segmentation::TouchingLabels& t : segmentation::touching_labels(out.map, scan.scan.spacing))
        out.touching.push_back({seeds[t.a - 1u].name, seeds[t.b - 1u].name, t.area});
    std::stable_sort(out.touching.begin(), out.touching.end(),
                     [](const TouchingFace& a, const TouchingFace& b) { return a.area > b.area; });
    out.marrow_voxels = segmentation::spread(out.map, open);

    const Vec3& h = scan.scan.spacing;
    for (std::size_t l = 0; l < seeds.size(); ++l)
        out.labels.push_back(
            {seeds[l].name, seeds[l].colour.value_or(bone::label_colour(static_cast<int>(l) + 1)), 0, 0.0});
    for (const std::uint8_t l : out.map.label)
        if (l != 0) ++out.labels[l - 1u].voxels;
    for (SegmentedLabel& l : out.labels) l.volume = static_cast<double>(l.voxels) * h.x * h.y * h.z;
    return out;
}

}  // namespace tactus::analysis
