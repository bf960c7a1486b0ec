// SPDX-License-Identifier: Apache-2.0
// Files of a patch that other programs write anew between its runs.
#include "graph/compile/load_assets.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/run/load_plan.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

using namespace tactus;
using tactus::test::Folder;

namespace {

/// A WAV of so many samples of silence: 16 bits, one channel.
std::string silence(std::uint32_t count) {
    const auto number = [](std::uint32_t value, int bytes) {
        std::string text;
        for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xff);
        return text;
    };
    const std::string data(2 * count, '\0');
    return "RIFF" + number(36 + 2 * count, 4) + "WAVEfmt " + number(16, 4) + number(1, 2) + number(1, 2) +
           number(48000, 4) + number(96000, 4) + number(2, 2) + number(16, 2) + "data" + number(2 * count, 4) + data;
}

}  // namespace

TEST_CASE("what was loaded is shared until its file is written anew and the next run looks") {
    const Folder folder;
    const auto sound = folder.write("a.wav", silence(480));
    run::PatchChoice choice;
    choice.patch = folder
                       .write("p.toml",
                              "wires = [\"go.out -> drum.trigger\"]\n[assets]\na = \"a.wav\"\n[nodes.go]\ntype = "
                              "\"clock\"\nrate = \"48 kHz\"\n[nodes.drum]\ntype = \"player\"\nrate = \"48 kHz\"\n"
                              "sound = \"a\"\n")
                       .string();
    compile::AssetCache assets;
    const auto loaded = [&] {
        const compile::Schedule plan = run::load_plan(choice, assets);
        std::shared_ptr<const void> found;
        for (const compile::ScheduleNode& node : plan.nodes)
            for (const AssetParam* asset : node.assets) found = asset->loaded;
        REQUIRE(found != nullptr);
        return found;
    };
    const auto first = loaded();
    assets.forget_changed();
    CHECK(loaded() == first);
    folder.write("a.wav", silence(960));
    // Edits of a run that goes on keep what it has.
    CHECK(loaded() == first);
    assets.forget_changed();
    const auto second = loaded();
    CHECK(second != first);
    // As long as before, but newer.
    folder.write("a.wav", silence(960));
    std::filesystem::last_write_time(sound, std::filesystem::last_write_time(sound) + std::chrono::seconds(2));
    assets.forget_changed();
    CHECK(loaded() != second);
}
