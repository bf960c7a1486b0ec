// SPDX-License-Identifier: Apache-2.0
// A folder with records, and the command run in it.
#pragma once

#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>
#include <sndfile.h>
#include <sys/wait.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace tactus::test {

struct RecordOutcome : Outcome {
    nlohmann::json answer() const { return nlohmann::json::parse(out); }
    /// Of the only file.
    nlohmann::json only(const char* list) const {
        const nlohmann::json rows = answer()[list];
        REQUIRE(rows.size() == 1);
        return rows[0];
    }
};

struct RecordFolder : Folder {
    fs::path sound(const char* name, const std::vector<double>& samples, int channels = 1, int rate = 48000,
                   int format = SF_FORMAT_WAV | SF_FORMAT_DOUBLE) const {
        SF_INFO info{};
        info.format = format;
        info.channels = channels;
        info.samplerate = rate;
        SNDFILE* file = sf_open((path / name).c_str(), SFM_WRITE, &info);
        REQUIRE(file);
        sf_writef_double(file, samples.data(), static_cast<sf_count_t>(samples.size()) / channels);
        sf_close(file);
        return path / name;
    }
    fs::path text(const char* name, const std::string& content) const { return write(name, content); }
    /// The command, run in the folder.
    RecordOutcome tactus(const std::string& arguments) const {
        const std::string command =
            fmt::format("cd {} && {} {} >stdout 2>stderr", path.string(), tactus::test::command(), arguments);
        const int status = std::system(command.c_str());
        return {{WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(path / "stdout"), slurp(path / "stderr")}};
    }
};

inline std::vector<double> tones(std::initializer_list<std::pair<double, double>> list, double seconds,
                                 double rate = 48000.0) {
    std::vector<double> x(static_cast<std::size_t>(seconds * rate));
    for (const auto& [hz, amplitude] : list)
        for (std::size_t i = 0; i < x.size(); ++i)
            x[i] += amplitude * std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(i) / rate);
    return x;
}

/// Noise that every machine makes alike.
inline void add_noise(std::vector<double>& x, double amplitude) {
    unsigned state = 1;
    for (double& v : x) {
        state = state * 1664525u + 1013904223u;
        v += amplitude * (static_cast<double>(state >> 8) / 8388608.0 - 1.0);
    }
}

}  // namespace tactus::test
