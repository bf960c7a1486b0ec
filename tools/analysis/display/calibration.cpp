// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/display/calibration.hpp"

#include "assets/display/touch_file.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::analysis {

namespace {

constexpr auto no_screen =
    "a display needs a screen: touch one (--screen, --image), or name a display file that has one (--base)";

}  // namespace

std::vector<display::Touch> calibration_steps(const CalibrationSettings& settings) {
    std::vector<display::Touch> steps;
    using Of = display::Touch::Of;
    if (!settings.places.empty())
        for (const Vec3& place : display::load_places(settings.places))
            steps.push_back({Of::workspace, {}, {}, {}, place});
    else if (!settings.tracker.empty())
        for (int n = 0; n < settings.points; ++n) steps.push_back({Of::workspace, {}, {}, {}, {}});
    if (settings.mirror)
        for (int n = 0; n < settings.points; ++n) steps.push_back({Of::mirror, {}, {}, {}, {}});
    const auto marks = [&](Of of, const std::string& screen) {
        for (int row = 0; row < settings.grid; ++row)
            for (int column = 0; column < settings.grid; ++column) {
                const auto at = [&](int n) { return 0.1 + 0.8 * n / (settings.grid - 1.0); };
                steps.push_back({of, screen, {at(column), at(row)}, {}, {}});
            }
    };
    for (const std::string& screen : settings.screens) marks(Of::screen, screen);
    for (const std::string& screen : settings.images) marks(Of::image, screen);
    if (steps.empty())
        throw Error("there is nothing to touch; name a screen, an image of one, the mirror, known places or a tracker");
    return steps;
}

void check_screens(const CalibrationSettings& settings, const display::DisplayFile& base) {
    if (settings.screens.empty() && settings.images.empty() && base.screens.empty()) throw Error(no_screen);
}

std::string prompt_of(const display::Touch& step) {
    const int u = static_cast<int>(step.shown.x * 100.0 + 0.5), v = static_cast<int>(step.shown.y * 100.0 + 0.5);
    switch (step.of) {
        case display::Touch::Of::workspace:
            if (step.place == Vec3(0.0)) return "hold the tracked marker to the tip, somewhere new in the workspace";
            return "touch the " + step.name();
        case display::Touch::Of::mirror:
            return "touch the mirror with the tip, somewhere new, far from the touches before";
        case display::Touch::Of::image:
            return fmt::format(
                "bring the tip to where the mirror shows the mark of screen '{}' at {} % of its width and "
                "{} % of its height",
                step.screen, u, v);
        case display::Touch::Of::screen: break;
    }
    return fmt::format("touch screen '{}' at {} % of its width from the left and {} % of its height from below",
                       step.screen, u, v);
}

display::DisplayFitOptions fit_options(const CalibrationSettings& settings, const display::DisplayFile& base) {
    display::DisplayFitOptions options;
    options.is_affine = settings.affine;
    options.tolerance = parse_as(settings.tolerance, "mm");
    if (!(options.tolerance > 0.0)) throw Error("the tolerance must be above 0 mm");
    options.mirror = base.geometry.mirror;
    options.device = base.geometry.haptic_world;
    options.stretch = base.geometry.haptic_stretch;
    return options;
}

TouchesOff touches_off(const display::DisplayFit& fit) {
    TouchesOff all;
    double sum = 0.0;
    for (const display::TouchedPart& part : fit.parts)
        for (std::size_t i = 0; i < part.off.size(); ++i) {
            sum += part.off[i] * part.off[i];
            ++all.count;
            if (part.off[i] < all.worst) continue;
            all.worst = part.off[i];
            all.worst_touch = part.touches[i];
        }
    if (all.count > 0) all.rms = std::sqrt(sum / static_cast<double>(all.count));
    return all;
}

std::string part_text(const display::TouchedPart& part) {
    return fmt::format("{}: {:.2f} mm rms, {:.2f} mm worst", part.what, part.residual.rms * 1e3,
                       part.residual.worst * 1e3);
}

display::DisplayFile calibrated_display(display::DisplayFile file, const display::DisplayFit& fit) {
    file.geometry.haptic_world = fit.device;
    file.geometry.haptic_stretch = fit.stretch;
    file.geometry.mirror = fit.mirror;
    for (const auto& [name, screen] : fit.screens) {
        const auto known = std::ranges::find(file.screens, name, &display::ScreenSettings::name);
        if (known != file.screens.end()) {
            file.geometry.screens[static_cast<std::size_t>(known - file.screens.begin())] = screen;
            continue;
        }
        file.geometry.screens.push_back(screen);
        file.screens.push_back({name, display::ScreenEyes::both, {}, {}, 0, {}});
    }
    if (file.screens.empty()) throw Error(no_screen);
    return file;
}

void write_calibrated(const std::filesystem::path& file, const display::DisplayFile& display,
                      const display::DisplayFit& fit) {
    std::vector<std::string> about{"Calibrated. Residuals of the touches, root mean square and greatest:"};
    for (const display::TouchedPart& part : fit.parts)
        about.push_back(fmt::format("  {}: {:.2f} mm, {:.2f} mm of {} touches", part.what, part.residual.rms * 1e3,
                                    part.residual.worst * 1e3, part.touches.size()));
    file::write_whole_file(file, display::display_text(display, about));
    // Checks that the file can be read.
    display::load_display_file(file);
}

}  // namespace tactus::analysis
