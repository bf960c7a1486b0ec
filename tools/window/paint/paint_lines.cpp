// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/paint_lines.hpp"

#include "dsp/display/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tactus::window {

namespace {

/// Words behind the command: texts first, then numbers.
struct Command {
    const char* name;
    std::size_t texts, numbers;
    bool is_list = false;  ///< the numbers once or several times
};

constexpr std::array commands{
    Command{"label", 1, 0},  Command{"brush", 0, 1},      Command{"stroke", 0, 3, true}, Command{"erase", 0, 3, true},
    Command{"remove", 1, 0}, Command{"rename", 2, 0},     Command{"undo", 0, 0},         Command{"redo", 0, 0},
    Command{"cursor", 0, 3}, Command{"grey", 0, 2},       Command{"zoom", 0, 1},         Command{"from", 1, 0},
    Command{"look", 0, 0},   Command{"vessel", 0, 3},     Command{"plan", 0, 0},         Command{"until", 1, 0},
    Command{"press", 1, 0},  Command{"drag", 0, 4},       Command{"wheel", 0, 3},        Command{"size", 0, 2},
    Command{"wait", 0, 1},   Command{"screenshot", 1, 0}, Command{"frames", 0, 1},       Command{"close", 0, 0},
    Command{"tool", 1, 0},   Command{"click_bone", 0, 3}, Command{"merge", 2, 0},        Command{"island", 0, 0},
    Command{"spots", 1, 0},  Command{"shut", 0, 0},
};

void check(const ScriptLine& line) {
    const auto fail = [&](const std::string& why) { throw Error(line.where, why); };
    const std::string& what = line.words.front();
    const Command& command = *std::ranges::find(commands, what, &Command::name);
    const std::size_t given = line.words.size() - 1;
    if (what == "until") {
        const std::string& which = line.word(1);
        if (which == "there") line.word(2);
        else if (which != "solved") fail(fmt::format("'until' waits until 'solved' or 'there FILE', not '{}'", which));
        if (given > (which == "there" ? 2u : 1u)) fail(fmt::format("'until {}' has too many words", which));
        return;
    }
    const std::size_t wanted = command.texts + command.numbers;
    for (std::size_t n = 1; n <= wanted; ++n)
        if (n <= command.texts) line.word(n);
        else line.number(n);
    for (std::size_t n = wanted + 1; n <= given; ++n) {
        if (!command.is_list) fail(fmt::format("'{}' takes {} words, not {}", what, wanted, given));
        line.number(n);
    }
    if (command.is_list && given % 3 != 0) fail(fmt::format("'{}' needs positions of three numbers", what));
    if (what == "from" && !display::view_of_name(line.word(1))) fail(fmt::format("no view '{}'", line.word(1)));
    if (what == "grey" && !(line.number(1) < line.number(2))) fail("'grey' needs a lower and a higher value");
    if (what == "tool" && line.word(1) != "paint" && line.word(1) != "erase" && line.word(1) != "vessel")
        fail(fmt::format("the tools are paint, erase and vessel, not '{}'", line.word(1)));
    if (what == "size")
        for (const std::size_t n : {1u, 2u})
            if (!(line.number(n) >= 100.0 && line.number(n) <= 10'000.0)) fail("'size' is 100 to 10000 pixels");
    for (const char* const positive : {"brush", "zoom"})
        if (what == positive && !(line.number(1) > 0.0)) fail(fmt::format("'{}' needs a number above 0", what));
}

}  // namespace

std::vector<ScriptLine> paint_lines(const std::string& text, const std::string& file) {
    std::vector<std::string> names;
    for (const Command& command : commands) names.emplace_back(command.name);
    std::vector<ScriptLine> lines = script_lines(text, file, names);
    for (const ScriptLine& line : lines) check(line);
    return lines;
}

}  // namespace tactus::window
