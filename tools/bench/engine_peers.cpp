// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/engine_peers.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <vector>

extern char** environ;

namespace tactus::bench {

namespace {

void write_file(const std::filesystem::path& path, const std::string& bytes) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    const bool written = file && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (!file || std::fclose(file) != 0 || !written) throw Error(fmt::format("{}: cannot write", path.string()));
}

/// Runs a program without input and output; returns its processor time, s.
std::optional<double> time_of(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int failure = posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (failure != 0) return std::nullopt;
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// Big-endian primitives of OSC and synth definitions.
void put32(std::string& out, std::uint32_t v) {
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(v >> shift);
}
void put16(std::string& out, std::uint32_t v) {
    out += static_cast<char>(v >> 8);
    out += static_cast<char>(v);
}
void put_float(std::string& out, float v) { put32(out, std::bit_cast<std::uint32_t>(v)); }
void put_name(std::string& out, const std::string& name) {
    out += static_cast<char>(name.size());
    out += name;
}
void put_text(std::string& out, const std::string& text) {
    out += text;
    out.append(4 - text.size() % 4, '\0');
}

/// A unit generator at audio rate; inputs are {unit, output}, unit −1 meaning a constant.
void put_unit(std::string& out, const std::string& name, std::initializer_list<std::pair<int, int>> inputs, int outputs,
              int operation) {
    constexpr char audio_rate = 2;
    put_name(out, name);
    out += audio_rate;
    put32(out, static_cast<std::uint32_t>(inputs.size()));
    put32(out, static_cast<std::uint32_t>(outputs));
    put16(out, static_cast<std::uint32_t>(operation));
    for (const auto& [unit, output] : inputs) {
        put32(out, static_cast<std::uint32_t>(unit));
        put32(out, static_cast<std::uint32_t>(output));
    }
    out.append(static_cast<std::size_t>(outputs), audio_rate);
}

/// A synth definition file, version 2, with one definition called "chain".
std::string synth_definition(int nodes) {
    constexpr int multiply = 2;
    std::string out = "SCgf";
    put32(out, 2);
    put16(out, 1);
    put_name(out, "chain");
    put32(out, 3);
    for (const float constant : {440.0f, 0.999f, 0.0f}) put_float(out, constant);
    for (int i = 0; i < 2; ++i) put32(out, 0);  // no parameters, no names of them
    put32(out, static_cast<std::uint32_t>(nodes) + 2);
    put_unit(out, "SinOsc", {{-1, 0}, {-1, 2}}, 1, 0);
    for (int i = 0; i < nodes; ++i) put_unit(out, "BinaryOpUGen", {{i, 0}, {-1, 1}}, 1, multiply);
    put_unit(out, "Out", {{-1, 2}, {nodes, 0}}, 0, 0);
    put16(out, 0);  // no variants
    return out;
}

/// A message as a time-stamped bundle with its length before it, as in a score file.
void put_at(std::string& score, double time, const std::string& message) {
    std::string bundle;
    put_text(bundle, "#bundle");
    const double whole = static_cast<double>(static_cast<std::uint32_t>(time));
    put32(bundle, static_cast<std::uint32_t>(time));
    put32(bundle, static_cast<std::uint32_t>((time - whole) * 4294967296.0));
    put32(bundle, static_cast<std::uint32_t>(message.size()));
    bundle += message;
    put32(score, static_cast<std::uint32_t>(bundle.size()));
    score += bundle;
}

std::string score_of(const std::filesystem::path& definition, double seconds) {
    std::string load, start, end, score;
    put_text(load, "/d_load");
    put_text(load, ",s");
    put_text(load, definition.string());
    put_text(start, "/s_new");
    put_text(start, ",siii");
    put_text(start, "chain");
    for (const std::uint32_t v : {1000u, 0u, 0u}) put32(start, v);
    put_text(end, "/c_set");
    put_text(end, ",if");
    put32(end, 0);
    put_float(end, 0.0f);
    put_at(score, 0.0, load);
    put_at(score, 0.0, start);
    put_at(score, seconds, end);
    return score;
}

}  // namespace

std::optional<double> run_in_pure_data(const Chain& chain, const std::filesystem::path& folder) {
    std::string text = "#N canvas 0 0 400 400 10;\n#N canvas 0 0 400 400 chain 0;\n#X obj 10 10 osc~ 440;\n";
    for (int i = 0; i < chain.nodes; ++i) text += "#X obj 10 10 *~ 0.999;\n";
    text += fmt::format("#X obj 200 10 block~ {};\n", chain.block);
    for (int i = 0; i < chain.nodes; ++i) text += fmt::format("#X connect {} 0 {} 0;\n", i, i + 1);
    text += fmt::format(
        "#X restore 10 10 pd chain;\n#X obj 10 50 loadbang;\n#X msg 10 80 \\; pd dsp 1;\n#X obj 10 110 delay {};\n"
        "#X msg 10 140 \\; pd quit;\n#X connect 1 0 2 0;\n#X connect 1 0 3 0;\n#X connect 3 0 4 0;\n",
        chain.seconds * 1e3);
    const std::filesystem::path patch = folder / "chain.pd";
    write_file(patch, text);
    return time_of({"pd", "-batch", "-noaudio", "-nogui", "-noprefs", "-r", "48000", patch.string()});
}

std::optional<double> run_in_scsynth(const Chain& chain, const std::filesystem::path& folder) {
    const std::filesystem::path definition = folder / "chain.scsyndef", score = folder / "score.osc";
    write_file(definition, synth_definition(chain.nodes));
    write_file(score, score_of(definition, chain.seconds));
    return time_of({"scsynth", "-N", score.string(), "_", (folder / "chain.wav").string(), "48000", "WAV", "int16",
                    "-z", std::to_string(chain.block), "-o", "1", "-m", "262144", "-D", "0"});
}

}  // namespace tactus::bench
