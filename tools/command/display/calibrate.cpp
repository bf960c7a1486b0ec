// SPDX-License-Identifier: Apache-2.0
// tactus calibrate: touched positions in, a display file out.
#include "assets/display/touch_file.hpp"
#include "assets/file/json.hpp"
#include "assets/table/csv_file.hpp"
#include "devices/haptic/catalogue.hpp"
#include "devices/hosted/hosted_device.hpp"
#include "dsp/core/units.hpp"
#include "tools/analysis/display/calibration.hpp"
#include "tools/analysis/display/touch_session.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/render/mark_window.hpp"

#include <fmt/format.h>

#include <poll.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <utility>

namespace tactus::command {

namespace {

struct CalibrateChoice {
    analysis::CalibrationSettings settings;
    std::filesystem::path out, touches, keep, base;
    std::string device;
    std::vector<std::string> device_options, tracker_options;  // driver options, NAME=VALUE
    bool json = false;
    int show = 0;  // monitor for the marks, from 1
};

std::unique_ptr<HapticDevice> open(const std::string& driver, const std::vector<std::string>& given) {
    std::vector<OptionText> options;
    for (const std::string& one : given) {
        const std::size_t equals = one.find('=');
        if (equals == std::string::npos || equals == 0)
            throw Error(fmt::format("a device option must be NAME=VALUE, not '{}'", one));
        options.push_back({one.substr(0, equals), one.substr(equals + 1), {}});
    }
    return hosted::open_placed({driver, fmt::format("device '{}'", driver), std::move(options), {}},
                               [](const std::string& name) { return std::filesystem::path(name); });
}

/// Touches from the device, or from a file.
std::vector<display::Touch> touches_of(const CalibrateChoice& choice, const display::DisplayFile& base,
                                       const display::DisplayFitOptions& options) {
    if (!choice.touches.empty()) return display::load_touches(choice.touches);
    std::vector<display::Touch> steps = analysis::calibration_steps(choice.settings);
    analysis::check_screens(choice.settings, base);
    analysis::TouchLead lead(std::move(steps), !choice.settings.tracker.empty(),
                             [&](std::span<const display::Touch> done) { display::fit_display(done, options); });
    analysis::TipReader tip(
        open(choice.device, choice.device_options), haptic::is_real_driver(choice.device),
        display::parse_vector(choice.settings.tip, "mm"),
        choice.settings.tracker.empty() ? nullptr : open(choice.settings.tracker, choice.tracker_options));
    std::optional<render::MarkWindow> window;
    if (choice.show > 0) window.emplace(choice.show);
    const bool can_ask = ::isatty(STDIN_FILENO) != 0;
    analysis::TouchSession session;
    session.show = [&](const display::Touch& step, std::size_t number, std::size_t of) {
        if (!choice.json)
            fmt::print(stderr, "{:2} of {}: {}; press {}\n", number + 1, of, analysis::prompt_of(step),
                       can_ask ? "the button, or Enter" : "the button");
        if (window) window->show(step, fmt::format("{} of {}: {}", number + 1, of, analysis::prompt_of(step)));
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
    session.run(tip, lead);
    return lead.steps();
}

int calibrate(const CalibrateChoice& choice) {
    const display::DisplayFile base =
        choice.base.empty() ? display::DisplayFile{} : display::load_display_file(choice.base);
    const display::DisplayFitOptions options = analysis::fit_options(choice.settings, base);
    const std::vector<display::Touch> touches = touches_of(choice, base, options);
    // Touches are kept even if the fit fails.
    if (!choice.keep.empty()) table::save_csv(choice.keep, display::touches_text(touches));
    const display::DisplayFit fit = display::fit_display(touches, options);
    const analysis::TouchesOff all = analysis::touches_off(fit);
    file::Json parts = file::Json::array();
    std::string text;
    for (const display::TouchedPart& part : fit.parts) {
        file::Json off = file::Json::array();
        text += analysis::part_text(part) + "\n";
        for (std::size_t i = 0; i < part.touches.size(); ++i) {
            const display::Touch& touch = touches[part.touches[i]];
            text += fmt::format("  touch {:2}  {:6.2f} mm  {}\n", part.touches[i] + 1, part.off[i] * 1e3, touch.name());
            off.push_back({{"touch", part.touches[i] + 1}, {"off_mm", part.off[i] * 1e3}, {"of", touch.name()}});
        }
        parts.push_back({{"part", part.what},
                         {"rms_mm", part.residual.rms * 1e3},
                         {"worst_mm", part.residual.worst * 1e3},
                         {"touches", off}});
    }
    analysis::write_calibrated(choice.out, analysis::calibrated_display(base, fit), fit);
    if (choice.json)
        fmt::print("{}\n", file::Json{{"display", choice.out.string()},
                                      {"rig", choice.out.string()},  // the key before
                                      {"rms_mm", all.rms * 1e3},
                                      {"worst_mm", all.worst * 1e3},
                                      {"parts", parts}}
                               .dump(2));
    else
        fmt::print(
            "{}all {} touches: {:.2f} mm rms, {:.2f} mm worst\n{} is written; use it with 'run --view --display {}'\n",
            text, all.count, all.rms * 1e3, all.worst * 1e3, choice.out.string(), choice.out.string());
    return done;
}

Action declare_calibrate(VerbOptions& verb) {
    const auto choice = std::make_shared<CalibrateChoice>();
    verb.output("-o,--out", choice->out, {{".toml"}}, "TOML file for the display").required();
    const Option device = verb.add("--device", choice->device, "driver of the touching device; 'devices' lists them");
    verb.add("--touches", choice->touches, "a CSV of touches instead of a device").excludes(device);
    verb.add("--option", choice->device_options, "option of the device's driver: NAME=VALUE").one_each();
    verb.add("--tip", choice->settings.tip, "position of the tip in the frame of the handle").shows_default();
    verb.add("--screen", choice->settings.screens, "a screen whose marks are touched; may be repeated").one_each();
    verb.add("--image", choice->settings.images, "a screen whose marks are touched at their mirror image").one_each();
    verb.flag("--mirror", choice->settings.mirror, "touch the mirror as well");
    verb.add("--places", choice->settings.places, "CSV (x_mm, y_mm, z_mm) of positions known in the viewer's world");
    verb.add("--tracker", choice->settings.tracker,
             "instead: driver of a tracker that measures the tip in the viewer's world");
    verb.add("--tracker-option", choice->tracker_options, "option of the tracker's driver: NAME=VALUE").one_each();
    verb.add("--grid", choice->settings.grid, "marks along each side of a screen").shows_default().range(2, 9);
    verb.add("--points", choice->settings.points, "touches of the mirror, and of the workspace with a tracker")
        .shows_default()
        .range(4, 100);
    verb.add("--show", choice->show, "show the marks on this monitor, from 1").range(1, 64);
    verb.flag("--affine", choice->settings.affine, "also estimate scale and skew of the device");
    verb.add("--tolerance", choice->settings.tolerance, "greatest residual of a touch").shows_default();
    verb.add("--base", choice->base, "display file with the values of untouched parts");
    verb.output("--keep", choice->keep, {{".csv"}}, "write the touches as CSV, for --touches");
    verb.flag("--json", choice->json, "as JSON");
    return [choice] {
        if (choice->device.empty() == choice->touches.empty())
            throw Error("choose the source of touches: --device DRIVER or --touches FILE");
        return calibrate(*choice);
    };
}

}  // namespace

Verb calibrate_verb() {
    return {"calibrate",
            "calibrate a display: find screens, mirror and device by touching them; writes a file for --display",
            declare_calibrate};
}

}  // namespace tactus::command
