// SPDX-License-Identifier: Apache-2.0
#include "tools/command/machine/node_project.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "nodes/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <system_error>
#include <utility>

namespace tactus::command {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view build_file = R"(# SPDX-License-Identifier: CC0-1.0
cmake_minimum_required(VERSION 3.16)
project(@name@ CXX)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
find_package(Tactus 0.1 REQUIRED)  # package libtactus-dev, or -DCMAKE_PREFIX_PATH=FOLDER

# @name@.so, which Tactus loads: tactus render PATCH --nodes build/@name@.so
add_library(@name@ MODULE @name@.cpp)
set_target_properties(@name@ PROPERTIES PREFIX "")
target_link_libraries(@name@ PRIVATE Tactus::node)

include(CTest)
if(BUILD_TESTING)
  # Real time, blocks of any length, bad values, cost of a call.
  add_test(NAME check COMMAND $<TARGET_FILE:Tactus::check-node> $<TARGET_FILE:@name@>)
  set_tests_properties(check PROPERTIES ENVIRONMENT LD_LIBRARY_PATH=$<TARGET_FILE_DIR:Tactus::tactus>)
  # What it computes.
  add_executable(test_@name@ test.cpp)
  target_link_libraries(test_@name@ PRIVATE Tactus::tactus)
  add_test(NAME values COMMAND test_@name@)
  set_tests_properties(values PROPERTIES ENVIRONMENT TACTUS_NODES=$<TARGET_FILE:@name@>)
endif()
)";

constexpr std::string_view source = R"(// SPDX-License-Identifier: CC0-1.0
#include <tactus/graph/node/plugin.hpp>

using namespace tactus;

/// In a patch: type = "@name@". Its ports and parameters are the members below.
struct @Struct@ {
    static constexpr auto about = "Multiplies a signal by a factor.";

    In<Signal> in{"the signal"};
    Out<Signal> out{"factor × in"};
    Param factor{"2", "-100", "100", "gain"};  // default, least, largest; with units as in "0.8 N/mm"

    /// Before the run. May allocate, read files and throw Error; sets the first value of outputs that are no signals.
    void prepare(const Setup&) {}

    /// In each tick: real time. No allocation, lock, wait, exception or system call. A signal comes in blocks of tick.frames samples.
    void process(const Tick& tick) noexcept {
        const auto f = static_cast<float>(factor);
        for (int i = 0; i < tick.frames; ++i) out[i] = f * in[i];
    }
};
TACTUS_NODE(@Struct@, in, out, factor)

// Name and version of the whole, and all of its node types.
TACTUS_PLUGIN("@name@", "0.1", @Struct@)
)";

constexpr std::string_view test = R"(// SPDX-License-Identifier: CC0-1.0
// The node in a patch that a program runs, by the C functions of libtactus. ctest sets TACTUS_NODES.
#include <tactus.h>

#include <cmath>
#include <cstdio>

int main() {
    const char* patch_text = R"toml(wires = ["level.value -> source.in", "source.out -> node.in"]
[nodes.level]
type = "constant"
rate = "48 kHz"
number = "0.25"
[nodes.source]
type = "to_signal"
rate = "48 kHz"
[nodes.node]
type = "@name@"
rate = "48 kHz"
factor = "3"
)toml";
    tactus_error error;
    tactus_patch* patch = tactus_parse(patch_text, nullptr, &error);
    tactus_run* run = patch ? tactus_start(patch, nullptr, &error) : nullptr;
    double value = NAN;
    const int output = run ? tactus_output(run, "node.out", 0, nullptr, &error) : -1;
    if (output < 0 || tactus_advance(run, 0.01, &error) != 0) {
        std::fprintf(stderr, "%s\n", error.text);
        return 2;
    }
    tactus_newest(run, output, &value);
    tactus_free_run(run);
    tactus_free_patch(patch);
    std::printf("3 x 0.25 = %g\n", value);
    return value == 0.75 ? 0 : 1;
}
)";

constexpr std::string_view ignored = "build/\n";

/// "soft_clip" → "SoftClip".
std::string struct_name_of(const std::string& name) {
    std::string made;
    bool begins = true;
    for (const char c : name) {
        if (c != '_') made += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        begins = c == '_';
    }
    return made;
}

std::string filled(std::string_view text, const std::string& name) {
    std::string out(text);
    const std::array<std::pair<std::string_view, std::string>, 2> words{
        {{"@name@", name}, {"@Struct@", struct_name_of(name)}}};
    for (const auto& [word, value] : words)
        for (std::size_t at = out.find(word); at != std::string::npos; at = out.find(word, at + value.size()))
            out.replace(at, word.size(), value);
    return out;
}

void check_name(const std::string& name) {
    const bool has_letters =
        std::ranges::all_of(name, [](unsigned char c) { return std::islower(c) || std::isdigit(c) || c == '_'; });
    if (name.empty() || !std::islower(static_cast<unsigned char>(name.front())) || !has_letters ||
        type_name_of(struct_name_of(name)) != name)
        throw Error(fmt::format(
            "'{}' is no name of a node type; it has lower-case letters, digits, and '_' before a letter, as "
            "in soft_clip",
            name));
    for (const char* const target : {"all", "clean", "help", "install", "package", "test"})
        if (name == target)
            throw Error(
                fmt::format("'{0}' is a target of every CMake project; choose another name, such as my_{0}", name));
    for (const NodeType* type : nodes::catalogue())
        if (type->name == name)
            throw Error(fmt::format("there is a node type '{0}' already; choose another name, such as my_{0}", name));
}

}  // namespace

fs::path write_node_project(const std::string& name) {
    check_name(name);
    const fs::path folder = name;
    std::error_code failure;
    if (!fs::create_directory(folder, failure))
        throw Error(failure ? fmt::format("{}: cannot make the folder: {}", name, failure.message())
                            : fmt::format("{}: there is a file or folder of this name already", name));
    try {
        file::write_whole_file(folder / "CMakeLists.txt", filled(build_file, name));
        file::write_whole_file(folder / (name + ".cpp"), filled(source, name));
        file::write_whole_file(folder / "test.cpp", filled(test, name));
        file::write_whole_file(folder / ".gitignore", std::string(ignored));
    } catch (...) {
        fs::remove_all(folder, failure);
        throw;
    }
    return folder;
}

}  // namespace tactus::command
