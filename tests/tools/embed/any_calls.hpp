// SPDX-License-Identifier: Apache-2.0
// Calls of the C functions of libtactus in any order and with any arguments, as a source of choices has it: random numbers in a
// test, bytes in a fuzzer.
#pragma once

#include "tools/embed/tactus.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

namespace tactus::test {

/// With the names of touch-sphere, and prepared a hundred times faster.
inline constexpr const char* light_patch = R"(
wires = ["hand.pose -> coupling.pose", "coupling.wrench -> out.wrench"]
[devices.simulated]
driver = "scripted"
targets = "0 s: 0 0 60 mm; 0.1 s: 0 0 50 mm"
[nodes]
hand = { type = "device_input", rate = "1 kHz" }
coupling = { type = "sphere_contact", rate = "1 kHz" }
out = { type = "device_output", rate = "1 kHz" }
)";

/// `pick(n)`: from 0 to n − 1. `count` calls on one patch and one run of it; both are freed at the end. Aborts when a function
/// fails and states no reason.
inline void make_any_calls(const std::function<int(int)>& pick, int count) {
    constexpr std::array<const char*, 15> words{nullptr,
                                                "",
                                                "simulated",
                                                "coupling.stiffness",
                                                "coupling.wrench",
                                                "scene.scene",
                                                "1 N/mm",
                                                "-1",
                                                "nan",
                                                "coupling.stiffness=2 N/mm",
                                                "place.pose",
                                                "\xff\xfe",
                                                "a.b.c",
                                                "trajectory=/nowhere",
                                                "[nodes.a]\ntype = \"sine\"\nrate = \"48 kHz\"\n"};
    constexpr std::array<double, 6> numbers{0.0, 0.001, -1.0, 1e300, std::numeric_limits<double>::quiet_NaN(), 0.01};
    const auto word = [&] { return words[static_cast<std::size_t>(pick(words.size()))]; };
    const auto number = [&] { return numbers[static_cast<std::size_t>(pick(numbers.size()))]; };
    tactus_error error{};
    tactus_patch* patch = nullptr;
    switch (pick(40)) {
        case 0: break;
        case 1: patch = tactus_parse(word(), word(), &error); break;
        case 2: patch = tactus_load("touch-sphere", &error); break;
        default: patch = tactus_parse(light_patch, nullptr, &error);
    }
    tactus_run* run = nullptr;
    tactus_motion motion{};
    std::array<double, 64> values{};
    std::vector<double> samples(3000);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<double>(i % 17);
    for (int call = 0; call < count; ++call) {
        tactus_error* const wanted_error = pick(4) ? &error : nullptr;
        tactus_options options{};
        options.size = pick(9) ? sizeof(options) : static_cast<std::size_t>(pick(100));
        options.seconds = number();
        if (options.seconds > 1.0) options.seconds = 0.01;
        options.threads = pick(3);
        std::memset(&error, 0, sizeof(error));
        bool has_failed = false;
        double* const room = pick(5) ? values.data() : nullptr;
        switch (pick(21)) {
            case 0: has_failed = tactus_configure(patch, word(), wanted_error) < 0; break;
            case 1: has_failed = tactus_use_asset(patch, word(), wanted_error) < 0; break;
            case 2: has_failed = tactus_attach_hand(patch, word(), nullptr, wanted_error) < 0; break;
            case 3:
                if (run) break;
                run = tactus_start(patch, pick(2) ? &options : nullptr, wanted_error);
                has_failed = !run;
                break;
            case 4: has_failed = tactus_advance(run, std::min(number(), 0.002), wanted_error) < 0; break;
            case 5: has_failed = tactus_render(run, wanted_error) < 0; break;
            case 6: has_failed = tactus_set(run, word(), word(), wanted_error) < 0; break;
            case 7: has_failed = tactus_find_hand(run, word(), wanted_error) < 0; break;
            case 8:
                motion.position[pick(3)] = number();
                tactus_move_hand(run, pick(3) - 1, pick(5) ? &motion : nullptr);
                break;
            case 9: tactus_hand_force(run, pick(3) - 1, room); break;
            case 10: {
                tactus_output_info info{};
                has_failed = tactus_output(run, word(), pick(2), pick(2) ? &info : nullptr, wanted_error) < 0;
                break;
            }
            case 11: tactus_newest(run, pick(4) - 1, room); break;
            case 12: tactus_fetch(run, pick(4) - 1, nullptr, room, 4); break;
            case 13: has_failed = tactus_finish(run, wanted_error) < 0; break;
            case 14:
                tactus_hash(run), tactus_summary(run), tactus_time(run), tactus_output_name(run, pick(50) - 1);
                tactus_available(run, pick(4) - 1);
                break;
            case 15:
                has_failed = tactus_spectrum(pick(5) ? samples.data() : nullptr, static_cast<std::size_t>(pick(3000)),
                                             1e3 * number(), static_cast<std::size_t>(pick(300)), room, room,
                                             static_cast<std::size_t>(pick(64)), wanted_error) == 0;
                break;
            case 16: {
                tactus_comparison comparison{};
                has_failed =
                    tactus_compare(samples.data(), static_cast<std::size_t>(pick(3000)), 2e3 * number(),
                                   samples.data() + 7, 2000, 1e3, pick(5) ? &comparison : nullptr, wanted_error) < 0;
                break;
            }
            case 17: {
                const std::array<const double*, 3> axes{samples.data(), samples.data(),
                                                        pick(4) ? samples.data() : nullptr};
                tactus_exposure exposure{};
                has_failed = tactus_hand_arm_exposure(axes.data(), static_cast<std::size_t>(pick(3000)), 1e3 * number(),
                                                      number(), pick(5) ? &exposure : nullptr, wanted_error) < 0;
                break;
            }
            case 18: {
                const tactus_port port{word(), pick(2) ? "signal" : word(), word(), word(), pick(2)};
                const tactus_parameter parameter{word(), word(), word(), word(), word()};
                tactus_node_type type{};
                type.size = pick(9) ? sizeof(type) : static_cast<std::size_t>(pick(100));
                type.name = pick(2) ? "any" : word();
                type.inputs = pick(5) ? &port : nullptr;
                type.input_count = pick(3) - 1;
                type.outputs = &port;
                type.output_count = pick(2);
                type.parameters = &parameter;
                type.parameter_count = pick(2);
                if (pick(5)) type.process = [](void*, const tactus_block*, tactus_error*) { return 0; };
                has_failed = tactus_declare_node(pick(5) ? &type : nullptr, wanted_error) < 0;
                break;
            }
            case 19: {
                // Small enough to be searched in a moment.
                constexpr std::array<std::int32_t, 12> triangles{0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
                constexpr std::array<double, 12> corners{0.0, 0.0, 0.0, 0.03, 0.0, 0.0, 0.0, 0.02, 0.0, 0.0, 0.0, 0.01};
                const auto some = [&] {
                    return tactus_mesh{pick(7) ? corners.data() : nullptr, static_cast<std::size_t>(pick(5)),
                                       pick(7) ? triangles.data() : nullptr, static_cast<std::size_t>(pick(5))};
                };
                const tactus_mesh moving = some(), fixed = some();
                tactus_registration registration{};
                tactus_contact_settings settings{sizeof(settings), number(), 0.0, 0.002};
                if (pick(3) == 0) {
                    tactus_contact* const contact =
                        tactus_make_contact(&moving, &fixed, pick(5) ? &settings : nullptr, wanted_error);
                    has_failed = !contact;
                    if (contact) {
                        tactus_contact_sum sum{};
                        has_failed = tactus_contact_at(contact, room, 1, pick(5) ? &sum : nullptr, wanted_error) < 0;
                    }
                    tactus_free_contact(contact);
                    break;
                }
                has_failed = tactus_register(pick(9) ? &moving : nullptr, &fixed, pick(2),
                                             pick(9) ? &registration : nullptr, wanted_error) < 0;
                break;
            }
            default:
                if (pick(3) == 0) {
                    tactus_free_run(run);
                    run = nullptr;
                }
        }
        if (wanted_error && has_failed != (error.text[0] != '\0')) std::abort();
    }
    // In either order.
    if (pick(2)) tactus_free_patch(std::exchange(patch, nullptr));
    tactus_free_run(run);
    tactus_free_patch(patch);
}

}  // namespace tactus::test
