// SPDX-License-Identifier: Apache-2.0
// From touched places to the file of a display rig.
#include "assets/display/rig_file.hpp"
#include "assets/display/touch_file.hpp"
#include "assets/file/whole_file.hpp"
#include "devices/haptic/catalogue.hpp"
#include "dsp/core/units.hpp"
#include "tools/mark_window.hpp"
#include "tools/touch_session.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <optional>

namespace tactus {

namespace {

std::unique_ptr<HapticDevice> open(const std::string& driver, const std::vector<std::string>& given) {
    std::vector<OptionText> options;
    for (const std::string& one : given) {
        const std::size_t equals = one.find('=');
        if (equals == std::string::npos || equals == 0)
            throw Error(fmt::format("an option of a device is NAME=VALUE, not '{}'", one));
        options.push_back({one.substr(0, equals), one.substr(equals + 1), {}});
    }
    Options all(fmt::format("device '{}'", driver), std::move(options));
    auto device =
        open_haptic_device(driver, {}, all, [](const std::string& name) { return std::filesystem::path(name); });
    all.finish();
    return device;
}

/// What is to be touched, in order: the device's place first, since the rest counts from it.
std::vector<RigTouch> steps_of(const CalibrateChoice& choice) {
    std::vector<RigTouch> steps;
    using Of = RigTouch::Of;
    if (!choice.places.empty())
        for (const Vec3& place : load_places(choice.places)) steps.push_back({Of::workspace, {}, {}, {}, place});
    else if (!choice.tracker.empty())
        for (int n = 0; n < choice.points; ++n) steps.push_back({Of::workspace, {}, {}, {}, {}});
    if (choice.mirror)
        for (int n = 0; n < choice.points; ++n) steps.push_back({Of::mirror, {}, {}, {}, {}});
    const auto marks = [&](Of of, const std::string& screen) {
        for (int row = 0; row < choice.grid; ++row)
            for (int column = 0; column < choice.grid; ++column) {
                const auto at = [&](int n) { return 0.1 + 0.8 * n / (choice.grid - 1.0); };
                steps.push_back({of, screen, {at(column), at(row)}, {}, {}});
            }
    };
    for (const std::string& screen : choice.screens) marks(Of::screen, screen);
    for (const std::string& screen : choice.images) marks(Of::image, screen);
    if (steps.empty())
        throw Error(
            "there is nothing to touch: --screen NAME, --image NAME, --mirror, --places FILE or --tracker DRIVER");
    return steps;
}

std::string prompt(const RigTouch& step) {
    const int u = static_cast<int>(step.shown.x * 100.0 + 0.5), v = static_cast<int>(step.shown.y * 100.0 + 0.5);
    switch (step.of) {
        case RigTouch::Of::workspace:
            if (step.place == Vec3(0.0)) return "hold the tracked marker to the tip, somewhere new in the workspace";
            return "touch the " + step.name();
        case RigTouch::Of::mirror: return "touch the mirror with the tip, somewhere new, far from the touches before";
        case RigTouch::Of::image:
            return fmt::format(
                "bring the tip to where the mirror shows the mark of screen '{}' at {} % of its width and "
                "{} % of its height",
                step.screen, u, v);
        case RigTouch::Of::screen: break;
    }
    return fmt::format("touch screen '{}' at {} % of its width from the left and {} % of its height from below",
                       step.screen, u, v);
}

/// The touches of a device, or those of a file.
std::vector<RigTouch> touches_of(const CalibrateChoice& choice, const RigFitOptions& options) {
    if (!choice.touches.empty()) return load_touches(choice.touches);
    std::vector<RigTouch> steps = steps_of(choice);
    TipReader tip(open(choice.device, choice.device_options), is_real_driver(choice.device),
                  parse_vector(choice.tip, "mm"),
                  choice.tracker.empty() ? nullptr : open(choice.tracker, choice.tracker_options));
    std::optional<MarkWindow> window;
    if (choice.show > 0) window.emplace(choice.show);
    const bool can_ask = ::isatty(STDIN_FILENO) != 0;
    TouchSession session;
    session.show = [&](const RigTouch& step, std::size_t number, std::size_t of) {
        if (!choice.json)
            fmt::print(stderr, "{:2} of {}: {}; press {}\n", number + 1, of, prompt(step),
                       can_ask ? "the button, or Enter" : "the button");
        if (window) window->show(step, fmt::format("{} of {}: {}", number + 1, of, prompt(step)));
    };
    session.say = [](const std::string& said) { fmt::print(stderr, "        {}\n", said); };
    session.is_asked = [&] {
        pollfd input{STDIN_FILENO, POLLIN, 0};
        char line[256];
        return can_ask && ::poll(&input, 1, 0) == 1 && ::read(STDIN_FILENO, line, sizeof line) > 0;
    };
    session.tend = [&] {
        if (window && !window->draw()) throw Error("the window with the marks was closed; nothing is written");
    };
    session.check = [&](std::span<const RigTouch> done) { fit_rig(done, options); };
    session.run(tip, steps, !choice.tracker.empty());
    return steps;
}

RigFile joined(RigFile file, const RigFit& fit) {
    file.rig.haptic_world = fit.device;
    file.rig.haptic_stretch = fit.stretch;
    file.rig.mirror = fit.mirror;
    for (const auto& [name, screen] : fit.screens) {
        const auto known = std::ranges::find(file.screens, name, &RigScreen::name);
        if (known != file.screens.end()) {
            file.rig.screens[static_cast<std::size_t>(known - file.screens.begin())] = screen;
            continue;
        }
        file.rig.screens.push_back(screen);
        file.screens.push_back({name, ScreenEyes::both, {}, {}, 0, {}});
    }
    if (file.screens.empty()) throw Error("no screen was touched, and --base names none: a rig needs one");
    return file;
}

}  // namespace

int calibrate_verb(const CalibrateChoice& choice) {
    RigFile file;
    if (!choice.base.empty()) file = load_rig_file(choice.base);
    RigFitOptions options;
    options.is_affine = choice.affine;
    options.tolerance = parse_as(choice.tolerance, "mm");
    if (!(options.tolerance > 0.0)) throw Error("--tolerance must be above 0 mm");
    options.mirror = file.rig.mirror;
    options.device = file.rig.haptic_world;
    options.stretch = file.rig.haptic_stretch;
    const std::vector<RigTouch> touches = touches_of(choice, options);
    // Touches are worth keeping also when nothing comes of them.
    if (!choice.keep.empty()) write_whole_file(choice.keep, touches_text(touches));
    const RigFit fit = fit_rig(touches, options);
    file = joined(std::move(file), fit);

    double sum = 0.0, worst = 0.0;
    std::size_t count = 0;
    nlohmann::ordered_json parts = nlohmann::ordered_json::array();
    std::vector<std::string> about{
        "Made by 'tactus calibrate': how far the touches are off, root mean square and worst"};
    std::string text;
    for (const TouchedPart& part : fit.parts) {
        nlohmann::ordered_json off = nlohmann::ordered_json::array();
        text += fmt::format("{}: {:.2f} mm rms, {:.2f} mm worst\n", part.what, part.residual.rms * 1e3,
                            part.residual.worst * 1e3);
        about.push_back(fmt::format("  {}: {:.2f} mm, {:.2f} mm of {} touches", part.what, part.residual.rms * 1e3,
                                    part.residual.worst * 1e3, part.touches.size()));
        for (std::size_t i = 0; i < part.touches.size(); ++i) {
            const RigTouch& touch = touches[part.touches[i]];
            text += fmt::format("  touch {:2}  {:6.2f} mm  {}\n", part.touches[i] + 1, part.off[i] * 1e3, touch.name());
            off.push_back({{"touch", part.touches[i] + 1}, {"off_mm", part.off[i] * 1e3}, {"of", touch.name()}});
            sum += part.off[i] * part.off[i];
            worst = std::max(worst, part.off[i]);
            ++count;
        }
        parts.push_back({{"part", part.what},
                         {"rms_mm", part.residual.rms * 1e3},
                         {"worst_mm", part.residual.worst * 1e3},
                         {"touches", off}});
    }
    const double rms = std::sqrt(sum / static_cast<double>(count));
    write_whole_file(choice.out, rig_text(file, about));
    // What is written can be read.
    load_rig_file(choice.out);
    if (choice.json)
        fmt::print("{}\n",
                   nlohmann::ordered_json{
                       {"rig", choice.out.string()}, {"rms_mm", rms * 1e3}, {"worst_mm", worst * 1e3}, {"parts", parts}}
                       .dump(2));
    else
        fmt::print(
            "{}all {} touches: {:.2f} mm rms, {:.2f} mm worst\n{} is written; use it with 'run --view --rig {}'\n",
            text, count, rms * 1e3, worst * 1e3, choice.out.string(), choice.out.string());
    return done;
}

}  // namespace tactus
