// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/error.hpp"
#include "tools/command/machine/look_at_device.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/machine/machine_result.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/terminal.hpp"

#include <memory>
#include <string>

namespace tactus::command {

namespace {

int devices(bool json) {
    report::FoundDevices found;
    for (const haptic::HapticDriver& driver : haptic::haptic_drivers()) found.haptic.push_back(driver);
    found.no_sound = "none";
    try {
        for (const audio::AudioCard& card : audio::list_audio_cards()) found.audio.push_back(card);
    } catch (const Error& error) {
        found.no_sound = error.what();
    }
    const report::Result result = report::devices_fields().of(found);
    say(stdout, json ? report::output_json(result).dump(2) + "\n" : report::text_of(result));
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

Verb devices_verb() {
    return {.name = "devices",
            .about = "list haptic drivers and sound cards of this machine",
            .add = declare_devices,
            .schema = [] { return report::schema_of_output({report::devices_fields().schema()}); }};
}

}  // namespace tactus::command
