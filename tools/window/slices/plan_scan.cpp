// SPDX-License-Identifier: Apache-2.0
#include "tools/window/slices/plan_scan.hpp"

#include "assets/plan/plan_file.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "tools/analysis/leaving.hpp"
#include "tools/render/section_grey.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

namespace tactus::window {

PlanScanData read_plan_scan(const std::filesystem::path& scan) {
    volume::ScanVolume read = volume::read_volume(scan);
    if (const std::string question = volume::unit_question(read); !question.empty())
        throw Error(fmt::format("{}: {}", scan.string(), question));
    if (read.kind == volume::VolumeKind::labels)
        throw Error(fmt::format("{}: this is a label map; slices show a CT", scan.string()));
    PlanScanData data;
    data.name = scan.filename().empty() ? scan.parent_path().filename().string() : scan.filename().string();
    data.unit = read.hu == volume::HuKind::scanner ? "" : "HU";
    data.grid = volume::lps_grid(std::move(read));
    data.window = suggested_window(data.grid);
    return data;
}

volume::Grid joined_grids(const std::vector<volume::Grid>& grids, std::size_t max_samples) {
    Vec3 low(infinity), high(-infinity), spacing(infinity);
    for (const volume::Grid& grid : grids) {
        if (grid.values.empty()) continue;
        low = glm::min(low, grid.origin);
        high = glm::max(high, grid.position(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1));
        spacing = glm::min(spacing, grid.spacing);
    }
    if (!(low.x <= high.x)) return {};
    volume::Grid joined{{}, low, spacing, {}};
    double samples = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double along = std::round((high[axis] - low[axis]) / spacing[axis]) + 1.0;
        samples *= along;
        if (samples > static_cast<double>(max_samples)) return {};
        joined.size[static_cast<std::size_t>(axis)] = static_cast<int>(along);
    }
    joined.values.assign(joined.count(), 0.0f);
    for (const volume::Grid& grid : grids) {
        if (grid.values.empty()) continue;
        // The samples of the joined grid that lie within this one, by their nearest sample in it.
        std::array<int, 3> first{}, last{};
        std::array<std::vector<int>, 3> nearest;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int a = static_cast<int>(axis);
            const double offset = (grid.origin[a] - low[a]) / spacing[a], step = spacing[a] / grid.spacing[a];
            first[axis] = std::max(0, static_cast<int>(std::ceil(offset - 0.5 / step)));
            last[axis] =
                std::min(joined.size[axis] - 1, static_cast<int>(std::floor(offset + (grid.size[axis] - 0.5) / step)));
            for (int n = first[axis]; n <= last[axis]; ++n)
                nearest[axis].push_back(
                    std::clamp(static_cast<int>(std::lround((n - offset) * step)), 0, grid.size[axis] - 1));
        }
        for (int k = first[2]; k <= last[2]; ++k) {
            leave_if_stopped();
            for (int j = first[1]; j <= last[1]; ++j)
                for (int i = first[0]; i <= last[0]; ++i) {
                    const auto of = [&](std::size_t axis, int n) {
                        return nearest[axis][static_cast<std::size_t>(n - first[axis])];
                    };
                    float& value = joined.at(i, j, k);
                    value = std::max(value, grid.at(of(0, i), of(1, j), of(2, k)));
                }
        }
    }
    return joined;
}

PlanScanData scan_of_fragments(const std::filesystem::path& plan, std::size_t max_samples) {
    PlanScanData data;
    data.grid = joined_grids(render::read_densities(plan), max_samples);
    data.window = {render::section_grey.black, render::section_grey.white};
    data.name = "the fragments, where they were scanned";
    data.unit = "mg/cm³";
    return data;
}

bool are_of_one_case(const std::filesystem::path& plan, const std::filesystem::path& other) {
    try {
        const plan::CasePlan a = plan::load_case_plan(plan), b = plan::load_case_plan(other);
        return std::ranges::any_of(a.fragments, [&](const plan::PlanFragment& one) {
            return std::ranges::find(b.fragments, one.hash, &plan::PlanFragment::hash) != b.fragments.end();
        });
    } catch (const Error&) {
        return false;
    }
}

void PlanScan::read(const std::filesystem::path& scan) {
    reading_.begin(analysis::Lane::studies, analysis::leaving([scan] { return read_plan_scan(scan); }));
}

void PlanScan::read_fragments(const std::filesystem::path& plan) {
    reading_.begin(analysis::Lane::studies, analysis::leaving([plan] { return scan_of_fragments(plan); }));
}

bool PlanScan::tend() {
    if (!reading_.is_ready()) return false;
    auto read = std::make_unique<PlanScanData>(reading_.take());
    if (read->grid.values.empty()) return false;
    now_ = std::move(read);
    return true;
}

}  // namespace tactus::window
