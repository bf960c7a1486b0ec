// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/vessel.hpp"
#include "assets/file/outputs.hpp"
#include "assets/vessel/track_file.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/processor_time.hpp"
#include "dsp/vessel/track_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

namespace tactus::analysis {

namespace {

constexpr double air = -200.0, bone = 900.0;  // HU; vessels in a CT angiography reach about 700

/// Mean of the 27 samples around the seed.
void check_seed(const volume::Grid& grid, const Vec3& seed) {
    const vessel::Scan scan(grid);
    if (!is_finite(seed) || !scan.contains(seed)) return;  // the tracker says it
    double sum = 0.0;
    for (int n = 0; n < 27; ++n)
        sum += scan.any_value(seed + Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1) * grid.spacing) / 27.0;
    if (sum < air) throw Error(fmt::format("the seed lies in air ({:.0f} HU); put it into the vessel", sum));
    if (sum > bone)
        throw Error(fmt::format("the seed lies on bone or a stent ({:.0f} HU); put it into the vessel", sum));
}

}  // namespace

FoundVessel follow_vessel(const VesselSettings& settings) {
    for (const std::filesystem::path& path : settings.out)
        if (!vessel::is_track_file(path))
            throw Error(path.string() + ": a vessel is written as .csv, .vtp, .mrk.json, .stl or .ply");
    std::vector<std::filesystem::path> outputs = settings.out;
    outputs.push_back(settings.straightened);
    const std::filesystem::path sources[] = {settings.scan};
    file::check_outputs(sources, outputs);
    FoundVessel result;
    volume::ReadOptions options;
    options.series = settings.series;
    options.unit = settings.unit;
    volume::ScanVolume scan = volume::read_volume(settings.scan, options);
    if (scan.kind == volume::VolumeKind::labels)
        throw Error(settings.scan.string() + ": a label map has no brightness to follow; give the scan");
    if (const std::string question = volume::unit_question(scan); !question.empty())
        throw Error(settings.scan.string() + ": " + question);
    result.notes = scan.notes;
    const bool is_hu = scan.hu == volume::HuKind::calibrated;
    const volume::Grid grid = volume::lps_grid(std::move(scan));
    if (is_hu) check_seed(grid, settings.seed);

    const double before = thread_seconds();
    vessel::TrackSettings track_settings = settings.track;
    if (is_hu) track_settings.clip_below = min_hu_of_vessels;
    result.found = vessel::follow(grid, settings.seed, track_settings);
    result.seconds = thread_seconds() - before;
    const vessel::Track& track = result.found.track;
    if (settings.leg) result.run_off = vessel::run_off(track, *settings.leg);
    if (result.run_off) result.warnings = result.run_off->warnings;
    if (track.branches.empty()) return result;
    for (const std::filesystem::path& path : settings.out) vessel::write_track(track, path, result.warnings);
    for (const vessel::TrackWarning& warning : vessel::warnings_of(track)) result.warnings.push_back(warning.text);
    if (!settings.straightened.empty()) {
        const vessel::Branch& main = track.branches.front();
        double widest = 0.0;
        for (const vessel::Node& node : main.nodes) widest = std::max(widest, node.radius);
        result.straightened = vessel::straightened(grid, main, 2.5 * widest);
    }
    return result;
}

}  // namespace tactus::analysis
