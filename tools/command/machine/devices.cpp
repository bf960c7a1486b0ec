// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "devices/audio/portaudio.hpp"
#include "devices/haptic/catalogue.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/machine/look_at_device.hpp"
#include "tools/command/options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace tactus::command {

namespace {

int devices(bool json) {
    file::Json list{{"haptic", file::Json::array()}, {"audio", file::Json::array()}};
    for (const haptic::HapticDriver& driver : haptic::haptic_drivers())
        list["haptic"].push_back({{"driver", driver.name},
                                  {"about", driver.summary},
                                  {"real", driver.is_real},
                                  {"untested_on_hardware", driver.is_untested}});
    std::string no_sound = "none";
    try {
        for (const audio::AudioCard& card : audio::list_audio_cards())
            list["audio"].push_back({{"name", card.name},
                                     {"channels", card.outputs},
                                     {"inputs", card.inputs},
                                     {"rate_hz", card.rate},
                                     {"latency_ms", 1e3 * card.latency},
                                     {"default", card.is_default}});
    } catch (const Error& error) {
        no_sound = error.what();
    }
    if (json) {
        fmt::print("{}\n", list.dump(2));
        return done;
    }
    fmt::print("haptic drivers\n");
    for (const auto& driver : list["haptic"])
        fmt::print("  {:<16} {}{}\n", driver["driver"].get<std::string>(), driver["about"].get<std::string>(),
                   driver["untested_on_hardware"].get<bool>() ? " (untested on hardware)" : "");
    fmt::print("sound cards{}\n", list["audio"].empty() ? ": " + no_sound : "");
    for (const auto& card : list["audio"])
        fmt::print("  {} ({}, {}, {:.0f} Hz, {:.1f} ms{})\n", card["name"].get<std::string>(),
                   counted(card["channels"].get<int>(), "output"), counted(card["inputs"].get<int>(), "input"),
                   card["rate_hz"].get<double>(), card["latency_ms"].get<double>(),
                   card["default"].get<bool>() ? ", default" : "");
    return done;
}

Action declare_devices(VerbOptions& verb) {
    struct Choice {
        std::string probe, verify;
        DeviceLook look;
    };
    const auto choice = std::make_shared<Choice>();
    Option probe = verb.add("--probe", choice->probe,
                            "read one real device and give no force: versions, pose, rate, or the step that failed");
    probe.value_name("DRIVER");
    Option verify = verb.add("--verify", choice->verify,
                             "let one real device push gently and say which way: lifts the cap of 0.5 N");
    verify.value_name("DRIVER").excludes(probe);
    verb.add("--option", choice->look.options, "of the device, as in a patch; may be given several times")
        .value_name("NAME=VALUE")
        .one_each();
    verb.flag("--json", choice->look.json, "as JSON");
    return [choice] {
        if (choice->probe.empty() && choice->verify.empty()) {
            if (!choice->look.options.empty()) throw Error("--option needs --probe or --verify");
            return devices(choice->look.json);
        }
        choice->look.driver = choice->probe.empty() ? choice->verify : choice->probe;
        return choice->probe.empty() ? verify_device(choice->look) : probe_device(choice->look);
    };
}

}  // namespace

Verb devices_verb() { return {"devices", "list haptic drivers and sound cards of this machine", declare_devices}; }

}  // namespace tactus::command
