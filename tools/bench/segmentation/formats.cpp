// SPDX-License-Identifier: Apache-2.0
// One scan as files of several types: `segment` must give them the same labels.
#include "tools/bench/segmentation/formats.hpp"
#include "tools/analysis/segmentation/segment_scan.hpp"
#include "tools/analysis/workers.hpp"
#include "tools/bench/segmentation/seeded_case.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>

namespace tactus::bench {

using file::Json;

namespace {

/// Writes a grid as an NRRD file of that type; values are rounded unless they are float.
template <class Value>
void write_nrrd(const volume::Grid& grid, const char* type, const std::function<double(double)>& of,
                const std::filesystem::path& path) {
    const Vec3 o = grid.origin * 1e3, h = grid.spacing * 1e3;
    std::ofstream out(path, std::ios::binary);
    out << fmt::format(
        "NRRD0005\ntype: {}\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\n"
        "space directions: ({},0,0) (0,{},0) (0,0,{})\nspace origin: ({},{},{})\nendian: little\nencoding: raw\n\n",
        type, grid.size[0], grid.size[1], grid.size[2], h.x, h.y, h.z, o.x, o.y, o.z);
    for (const float v : grid.values) {
        const double value = of(double(v));
        const Value written =
            std::is_integral_v<Value> ? static_cast<Value>(std::lround(value)) : static_cast<Value>(value);
        out.write(reinterpret_cast<const char*>(&written), sizeof written);
    }
}

constexpr float clearly_bone = 700.0f;  // HU; above the threshold of every file

/// A dab at each place that the scripted user would paint.
std::vector<segmentation::SeedLabel> strokes_of(const SeededCase& real, int dabs) {
    const double radius = 3.0 * std::min({real.grid.spacing.x, real.grid.spacing.y, real.grid.spacing.z});
    const Random random{1};
    std::uint64_t draw = 0;
    std::vector<segmentation::SeedLabel> labels;
    for (int label = 1; label <= real.labels; ++label) {
        segmentation::SeedLabel one{fmt::format("fragment {}", label), {}, {}};
        while (static_cast<int>(one.strokes.size()) < dabs) {
            const std::size_t node = real.surface[random.bits(draw++) % real.surface.size()];
            const auto at = real.graph.place(node);
            if (real.truth[node] != label || real.grid.at(at[0], at[1], at[2]) < clearly_bone) continue;
            one.strokes.push_back({radius, {real.grid.position(at[0], at[1], at[2])}});
        }
        labels.push_back(std::move(one));
    }
    return labels;
}

}  // namespace

Json format_row(const SeededCase& real, int dabs) {
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("tactus_formats_{}", ::getpid());
    std::filesystem::create_directories(folder);
    const std::vector<segmentation::SeedLabel> strokes = strokes_of(real, dabs);
    double threshold = 0.0;  // of the last one
    const auto labels_of = [&](const char* name, std::optional<double> given = {}) {
        analysis::SegmentSettings settings;
        settings.threshold = given;
        settings.scan = folder / name;
        settings.run = analysis::on_threads();
        const analysis::ScanGraph scan = analysis::scan_graph(settings);
        threshold = scan.threshold;
        return analysis::segment_scan(scan, strokes, settings, "seeds").map.label;
    };
    // These scans are masked with zeros, which a window moves: air instead, as a scanner has it.
    const auto hounsfield = [](double v) { return v == 0.0 ? -1000.0 : v; };
    // As unsigned numbers hold them, too.
    const auto whole = [](double v) { return std::clamp(std::round(v), 0.0, 32767.0); };
    write_nrrd<std::int16_t>(real.grid, "int16", whole, folder / "int16.nrrd");
    write_nrrd<std::uint16_t>(real.grid, "uint16", whole, folder / "uint16.nrrd");
    write_nrrd<float>(real.grid, "float", whole, folder / "float.nrrd");
    write_nrrd<float>(real.grid, "float", hounsfield, folder / "hu.nrrd");
    write_nrrd<float>(real.grid, "float", [&](double v) { return hounsfield(v) / 1000.0; }, folder / "thousandth.nrrd");
    constexpr double low = -200.0, high = 1800.0;
    write_nrrd<std::uint8_t>(
        real.grid, "uint8",
        [&](double v) { return 255.0 * std::clamp((hounsfield(v) - low) / (high - low), 0.0, 1.0); },
        folder / "byte.nrrd");
    const auto difference = [](const auto& a, const auto& b) {
        std::size_t bone = 0, other = 0;
        for (std::size_t n = 0; n < a.size(); ++n) {
            bone += a[n] != 0 || b[n] != 0;
            other += a[n] != b[n];
        }
        return bone ? double(other) / double(bone) : 1.0;
    };
    const auto int16 = labels_of("int16.nrrd"), hu = labels_of("hu.nrrd");
    Json row{{"case", real.name}, {"threshold", threshold}};
    row["uint16"] = difference(int16, labels_of("uint16.nrrd"));
    row["float"] = difference(int16, labels_of("float.nrrd"));
    row["hu_over_1000"] = difference(hu, labels_of("thousandth.nrrd"));
    // A threshold on the edge between two of the 256 steps: both have the same bone then.
    const double step = (high - low) / 255.0, steps = std::round((row["threshold"].get<double>() - low) / step);
    row["eight_bits"] =
        difference(labels_of("hu.nrrd", low + (steps - 0.5) * step), labels_of("byte.nrrd", steps - 0.5));
    std::filesystem::remove_all(folder);
    return row;
}

}  // namespace tactus::bench
