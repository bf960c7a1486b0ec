// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "devices/audio/portaudio.hpp"
#include "devices/haptic/catalogue.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

int devices(bool json) {
    file::Json list{{"haptic", file::Json::array()}, {"audio", file::Json::array()}};
    for (const haptic::HapticDriver& driver : haptic::haptic_drivers())
        list["haptic"].push_back({{"driver", driver.name}, {"about", driver.summary}});
    std::string no_sound = "none";
    try {
        for (const audio::AudioOutput& output : audio::list_audio_outputs())
            list["audio"].push_back({{"name", output.name},
                                     {"channels", output.channels},
                                     {"rate_hz", output.rate},
                                     {"latency_ms", 1e3 * output.latency},
                                     {"default", output.is_default}});
    } catch (const Error& error) {
        no_sound = error.what();
    }
    if (json) {
        fmt::print("{}\n", list.dump(2));
        return done;
    }
    fmt::print("haptic drivers\n");
    for (const auto& driver : list["haptic"])
        fmt::print("  {:<12} {}\n", driver["driver"].get<std::string>(), driver["about"].get<std::string>());
    fmt::print("sound outputs{}\n", list["audio"].empty() ? ": " + no_sound : "");
    for (const auto& output : list["audio"])
        fmt::print("  {} ({}, {:.0f} Hz, {:.1f} ms{})\n", output["name"].get<std::string>(),
                   counted(output["channels"].get<int>(), "channel"), output["rate_hz"].get<double>(),
                   output["latency_ms"].get<double>(), output["default"].get<bool>() ? ", default" : "");
    return done;
}

Action add(VerbOptions& verb) {
    const auto json = std::make_shared<bool>(false);
    verb.flag("--json", *json, "as JSON");
    return [json] { return devices(*json); };
}

}  // namespace

Verb devices_verb() { return {"devices", "list haptic drivers and sound outputs of this machine", add}; }

}  // namespace tactus::command
