// SPDX-License-Identifier: Apache-2.0
// The C functions: arguments are checked, exceptions become texts, and one object has one user at a time.
#include "tools/embed/tactus.h"

#include "dsp/core/error.hpp"
#include "tools/embed/c_errors.hpp"
#include "tools/embed/c_use.hpp"
#include "tools/embed/embedded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;

struct tactus_patch {
    embed::Patch patch;
    std::atomic<bool> is_used{false};
};

struct tactus_run {
    embed::Run run;
    std::atomic<bool> is_used{false};
    std::vector<std::vector<const char*>> names = {};  // of the columns of each output
    std::string listed = {};  // by tactus_output_name
};

namespace {

using embed::guarded;
using embed::Use;

Use<tactus_patch> use(tactus_patch* patch) { return Use<tactus_patch>(patch, "patch"); }
Use<tactus_run> use(tactus_run* run) { return Use<tactus_run>(run, "run"); }

std::string text_of(const char* given, const char* what) {
    if (!given) throw Error(fmt::format("no {} is given: NULL", what));
    return given;
}

tactus_patch* make_patch(run::PatchChoice choice) { return new tactus_patch{embed::Patch(std::move(choice))}; }

embed::RunOptions options_of(const tactus_options* given) {
    embed::RunOptions options;
    if (!given) return options;
    tactus_options all{};
    if (given->size < offsetof(tactus_options, seed) || given->size > sizeof(all))
        throw Error(
            "tactus_options.size must be sizeof(tactus_options) of the header that the program was compiled with");
    std::memcpy(&all, given, given->size);
    options.seconds = all.seconds;
    options.seed = all.seed;
    if (all.folder) options.folder = all.folder;
    if (all.audio) options.audio = all.audio;
    options.live = all.live != 0;
    options.threads = all.threads;
    return options;
}

bool is_negative(double value) { return !(value >= 0.0); }

}  // namespace

extern "C" {

const char* tactus_version(void) { return TACTUS_VERSION; }

tactus_patch* tactus_load(const char* name_or_path, tactus_error* error) {
    return guarded<tactus_patch*>(error, nullptr, [&] {
        run::PatchChoice choice;
        choice.patch = text_of(name_or_path, "name of a patch");
        return make_patch(std::move(choice));
    });
}

tactus_patch* tactus_parse(const char* toml, const char* folder, tactus_error* error) {
    return guarded<tactus_patch*>(error, nullptr, [&] {
        run::PatchChoice choice;
        choice.text = text_of(toml, "text of a patch");
        choice.patch = (std::filesystem::path(folder ? folder : ".") / "patch").string();
        return make_patch(std::move(choice));
    });
}

int tactus_configure(tactus_patch* patch, const char* setting, tactus_error* error) {
    return guarded(error, -1, [&] {
        use(patch)->patch.configure(text_of(setting, "setting"));
        return 0;
    });
}

int tactus_use_asset(tactus_patch* patch, const char* asset, tactus_error* error) {
    return guarded(error, -1, [&] {
        use(patch)->patch.use_asset(text_of(asset, "asset"));
        return 0;
    });
}

int tactus_attach_hand(tactus_patch* patch, const char* name, const tactus_device* device, tactus_error* error) {
    return guarded(error, -1, [&] {
        DeviceInfo info;
        info.name = text_of(name, "name of a device");
        info.actuates_torque = info.senses_rotation = true;
        if (device) {
            if (is_negative(device->max_force) || is_negative(device->max_torque) || is_negative(device->damping) ||
                is_negative(device->delay))
                throw Error("a device's largest force and torque, damping and delay are numbers from 0 on");
            info.max_force = device->max_force;
            info.max_torque = device->max_torque;
            info.damping = device->damping;
            info.delay = device->delay;
            info.actuates_torque = device->max_torque > 0.0;
        }
        const std::string known = info.name;
        use(patch)->patch.attach_hand(known, info);
        return 0;
    });
}

void tactus_free_patch(tactus_patch* patch) { delete patch; }

tactus_run* tactus_start(tactus_patch* patch, const tactus_options* options, tactus_error* error) {
    return guarded<tactus_run*>(error, nullptr, [&] {
        const auto held = use(patch);
        return new tactus_run{embed::Run(held->patch, options_of(options))};
    });
}

int tactus_advance(tactus_run* run, double seconds, tactus_error* error) {
    return guarded(error, -1, [&] {
        use(run)->run.advance(seconds);
        return 0;
    });
}

int tactus_render(tactus_run* run, tactus_error* error) {
    return guarded(error, -1, [&] {
        use(run)->run.render();
        return 0;
    });
}

double tactus_time(tactus_run* run) {
    return guarded(nullptr, 0.0, [&] { return use(run)->run.time(); });
}

int tactus_set(tactus_run* run, const char* node_and_parameter, const char* value, tactus_error* error) {
    return guarded(error, -1, [&] {
        use(run)->run.set(text_of(node_and_parameter, "parameter"), text_of(value, "value"));
        return 0;
    });
}

int tactus_find_hand(tactus_run* run, const char* name, tactus_error* error) {
    return guarded(error, -1, [&] { return use(run)->run.find_hand(text_of(name, "name of a hand")); });
}

void tactus_move_hand(tactus_run* run, int hand, const tactus_motion* motion) {
    embed::HostHand* const moved = run && motion ? run->run.hand(hand) : nullptr;
    if (!moved) return;
    const tactus_motion& m = *motion;
    embed::HostMotion to;
    to.pose.position = {m.position[0], m.position[1], m.position[2]};
    const bool is_turned =
        std::any_of(std::begin(m.orientation), std::end(m.orientation), [](double v) { return v != 0.0; });
    if (is_turned) to.pose.orientation = Quat(m.orientation[0], m.orientation[1], m.orientation[2], m.orientation[3]);
    to.twist.linear = {m.velocity[0], m.velocity[1], m.velocity[2]};
    to.twist.angular = {m.turning[0], m.turning[1], m.turning[2]};
    to.buttons = m.buttons;
    to.is_invalid = m.invalid != 0 ? 1 : 0;
    moved->move(to);
}

void tactus_hand_force(tactus_run* run, int hand, double wrench[6]) {
    if (!wrench) return;
    const embed::HostHand* const felt = run ? run->run.hand(hand) : nullptr;
    const Wrench w = felt ? felt->force() : Wrench{};
    const double all[6] = {w.force.x, w.force.y, w.force.z, w.torque.x, w.torque.y, w.torque.z};
    std::copy(std::begin(all), std::end(all), wrench);
}

int tactus_output(tactus_run* run, const char* node_and_port, int every, tactus_output_info* info,
                  tactus_error* error) {
    return guarded(error, -1, [&] {
        const auto held = use(run);
        const int number = held->run.output(text_of(node_and_port, "output"), every != 0);
        const auto at = static_cast<std::size_t>(number);
        const embed::Run::Output& output = *held->run.find_output(number);
        if (held->names.size() <= at) {
            held->names.resize(at + 1);
            for (const std::string& name : output.names) held->names[at].push_back(name.c_str());
        }
        if (info)
            *info = {output.type->name.data(), held->names[at].data(), static_cast<int>(output.names.size()),
                     output.rate};
        return number;
    });
}

const char* tactus_output_name(tactus_run* run, int index) {
    return guarded<const char*>(nullptr, nullptr, [&]() -> const char* {
        const auto held = use(run);
        held->listed = held->run.output_name(index);
        return held->listed.empty() ? nullptr : held->listed.c_str();
    });
}

void tactus_newest(tactus_run* run, int output, double* values) {
    if (!run || !values) return;
    guarded(nullptr, 0, [&] {
        if (const auto* found = run->run.find_output(output)) run->run.newest(*found, values);
        return 0;
    });
}

size_t tactus_fetch(tactus_run* run, int output, double* times, double* values, size_t most) {
    return guarded<size_t>(nullptr, 0, [&]() -> size_t {
        const auto held = use(run);
        auto* const found = held->run.find_output(output);
        return found && values ? held->run.fetch(*found, times, values, most) : 0;
    });
}

size_t tactus_available(tactus_run* run, int output) {
    return guarded<size_t>(nullptr, 0, [&]() -> size_t {
        const auto held = use(run);
        auto* const found = held->run.find_output(output);
        return found ? held->run.available(*found) : 0;
    });
}

int tactus_finish(tactus_run* run, tactus_error* error) {
    return guarded(error, -1, [&] {
        use(run)->run.finish();
        return 0;
    });
}

const char* tactus_summary(tactus_run* run) { return run && run->run.is_finished() ? run->run.summary().c_str() : ""; }

uint64_t tactus_hash(tactus_run* run) {
    return guarded<uint64_t>(nullptr, 0, [&]() -> uint64_t {
        const auto held = use(run);
        return held->run.is_finished() ? held->run.hash() : 0;
    });
}

void tactus_free_run(tactus_run* run) { delete run; }

}  // extern "C"
