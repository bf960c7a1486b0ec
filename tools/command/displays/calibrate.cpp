// SPDX-License-Identifier: Apache-2.0
// From touched places to the file of a display rig.
#include "assets/display/touch_file.hpp"
#include "assets/file/whole_file.hpp"
#include "devices/haptic/catalogue.hpp"
#include "dsp/core/units.hpp"
#include "tools/study/displays/calibration.hpp"
#include "tools/picture/scene/mark_window.hpp"
#include "tools/study/displays/touch_session.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <poll.h>
#include <unistd.h>

#include <optional>
#include <utility>

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

/// The touches of a device, or those of a file.
std::vector<RigTouch> touches_of(const CalibrateChoice& choice, const RigFile& base, const RigFitOptions& options) {
    if (!choice.touches.empty()) return load_touches(choice.touches);
    std::vector<RigTouch> steps = calibration_steps(choice);
    check_screens(choice, base);
    TouchLead lead(std::move(steps), !choice.tracker.empty(),
                   [&](std::span<const RigTouch> done) { fit_rig(done, options); });
    TipReader tip(open(choice.device, choice.device_options), is_real_driver(choice.device),
                  parse_vector(choice.tip, "mm"),
                  choice.tracker.empty() ? nullptr : open(choice.tracker, choice.tracker_options));
    std::optional<MarkWindow> window;
    if (choice.show > 0) window.emplace(choice.show);
    const bool can_ask = ::isatty(STDIN_FILENO) != 0;
    TouchSession session;
    session.show = [&](const RigTouch& step, std::size_t number, std::size_t of) {
        if (!choice.json)
            fmt::print(stderr, "{:2} of {}: {}; press {}\n", number + 1, of, prompt_of(step),
                       can_ask ? "the button, or Enter" : "the button");
        if (window) window->show(step, fmt::format("{} of {}: {}", number + 1, of, prompt_of(step)));
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

}  // namespace

int calibrate_verb(const CalibrateChoice& choice) {
    const RigFile base = choice.base.empty() ? RigFile{} : load_rig_file(choice.base);
    const RigFitOptions options = fit_options(choice, base);
    const std::vector<RigTouch> touches = touches_of(choice, base, options);
    // Touches are worth keeping also when nothing comes of them.
    if (!choice.keep.empty()) write_whole_file(choice.keep, touches_text(touches));
    const RigFit fit = fit_rig(touches, options);
    const TouchesOff all = touches_off(fit);
    nlohmann::ordered_json parts = nlohmann::ordered_json::array();
    std::string text;
    for (const TouchedPart& part : fit.parts) {
        nlohmann::ordered_json off = nlohmann::ordered_json::array();
        text += part_text(part) + "\n";
        for (std::size_t i = 0; i < part.touches.size(); ++i) {
            const RigTouch& touch = touches[part.touches[i]];
            text += fmt::format("  touch {:2}  {:6.2f} mm  {}\n", part.touches[i] + 1, part.off[i] * 1e3, touch.name());
            off.push_back({{"touch", part.touches[i] + 1}, {"off_mm", part.off[i] * 1e3}, {"of", touch.name()}});
        }
        parts.push_back({{"part", part.what},
                         {"rms_mm", part.residual.rms * 1e3},
                         {"worst_mm", part.residual.worst * 1e3},
                         {"touches", off}});
    }
    write_calibrated(choice.out, calibrated_rig(base, fit), fit);
    if (choice.json)
        fmt::print("{}\n", nlohmann::ordered_json{{"rig", choice.out.string()},
                                                  {"rms_mm", all.rms * 1e3},
                                                  {"worst_mm", all.worst * 1e3},
                                                  {"parts", parts}}
                               .dump(2));
    else
        fmt::print(
            "{}all {} touches: {:.2f} mm rms, {:.2f} mm worst\n{} is written; use it with 'run --view --rig {}'\n",
            text, all.count, all.rms * 1e3, all.worst * 1e3, choice.out.string(), choice.out.string());
    return done;
}

}  // namespace tactus
