// SPDX-License-Identifier: Apache-2.0
// Recordings of analysers: universal files and MATLAB files.
#include "tests/conformance/cases.hpp"
#include "tests/support/written_recordings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace tactus::conformance {

namespace {

using Bytes = std::string;
using test::matlab_file;
using test::matlab_numbers;

constexpr double turn = 6.283185307179586, rate = 1600.0, tone = 120.0, level = 5.0;
constexpr int sample_count = 800;

std::vector<double> values(double scale = 1.0) {
    std::vector<double> all;
    for (int n = 0; n < sample_count; ++n) all.push_back(scale * level * std::sin(turn * tone * n / rate));
    return all;
}
std::vector<double> times(double per_second = 1.0) {
    std::vector<double> all;
    for (int n = 0; n < sample_count; ++n) all.push_back(per_second * n / rate);
    return all;
}

std::string is_tone(const Json& found) {
    const Json& row = found["rows"][0];
    if (auto fault = differs("the rate", row["sample_rate_hz"], rate); !fault.empty()) return fault;
    return differs("the rms", row["channels"][0]["rms"], level / std::sqrt(2.0), 2e-3);
}

/// What was left out, and a rate that a variable states; not what is stated of each file.
std::vector<Bytes> notes_of(const Json& found) {
    std::vector<Bytes> notes;
    const Json& form = found["rows"][0]["log"]["form"];
    for (const auto& [key, sign] : {std::pair{"format", "left out"}, std::pair{"time", "as variable"}})
        if (form.contains(key) && form[key].is_string())
            if (Bytes text = form[key].get<Bytes>(); text.find(sign) != Bytes::npos) notes.push_back(std::move(text));
    return notes;
}

Bytes function_of(const std::function<void(test::UniversalFunction&)>& change = {}) {
    test::UniversalFunction f;
    f.step = 1.0 / rate, f.values = values(), f.times = times();
    if (change) change(f);
    return test::universal_function(f);
}

Format universal() {
    const Bytes si = "    -1\n   164\n         1SI                  2\n    -1\n";
    const auto unlabelled = [](test::UniversalFunction& f) { f.unit = "NONE"; };
    const auto slow = [](test::UniversalFunction& f) { f.step = 0.01, f.node = 7, f.values.resize(20); };
    const auto spectrum = [](test::UniversalFunction& f) { f.abscissa = 18; };
    const auto half = [](const Bytes& whole) { return whole.substr(0, whole.size() / 2); };
    Bytes vax = function_of([](test::UniversalFunction& f) { f.is_binary = true; });
    vax.replace(vax.find("b     1     2"), 13, "b     1     1");
    return {"universal file",
            {"spectrum", "FILE", "--json"},
            notes_of,
            is_tone,
            {
                {"dataset 58, single precision", "a.uff", bytes(function_of())},
                {"double precision", "a.unv", bytes(function_of([](auto& f) { f.type = 4; }))},
                {"uneven abscissa", "a.uff", bytes(function_of([](auto& f) { f.is_even = false, f.type = 4; }))},
                {"dataset 58b, little endian", "a.bunv", bytes(function_of([](auto& f) { f.is_binary = true; }))},
                {"dataset 58b, big endian", "a.uff", bytes(function_of([](auto& f) { f.is_binary = f.big = true; }))},
                {"dataset 58b in a form of VAX", "a.uff", bytes(vax), Result::refused, "save"},
                {"no unit, and SI by dataset 164",
                 "a.uff",
                 bytes(si + function_of(unlabelled)),
                 Result::read,
                 "",
                 {},
                 [](const Json& found) {
                     return found["rows"][0]["channels"][0]["unit"] == "m/s^2" ? is_tone(found) : Bytes("no unit");
                 }},
                {"functions of frequency and datasets of other kinds beside it", "a.uff",
                 bytes("    -1\n   151\nthe model\n    -1\n" + function_of() + function_of(spectrum)), Result::note,
                 "left out"},
                {"functions of several rates", "a.uff", bytes(function_of() + function_of(slow)), Result::refused,
                 "7Z+ (100 Hz, 20 samples)"},
                {"the same", "a.uff", bytes(function_of() + function_of(slow)), Result::read, "", {"--column", "12Z+"}},
                {"cut short", "a.uff", bytes(half(function_of())), Result::refused, "a.uff"},
            }};
}

Format matlab() {
    const auto variables = [](const Bytes& all, bool big = false) { return bytes(matlab_file(all, big)); };
    const Bytes t = matlab_numbers("t_s", sample_count, 1, times()),
                ax = matlab_numbers("ax", sample_count, 1, values()), fs = matlab_numbers("fs", 1, 1, {rate});
    std::vector<double> two = values();
    for (const double x : values(0.5)) two.push_back(x);
    const Bytes names("time_s\0\0acc\0\0\0\0\0", 16);
    const Bytes structure = test::matlab_element(
        14, test::matlab_array(2, "data", 1, 1) + test::bytes_of(std::uint32_t{0x40005}) +
                test::bytes_of(std::int32_t{8}) + test::matlab_element(1, names) +
                matlab_numbers("", sample_count, 1, times()) + matlab_numbers("", sample_count, 1, values()));
    const Bytes text = test::matlab_element(
        14, test::matlab_array(4, "note", 1, 4) + test::matlab_element(4, Bytes("a\0b\0c\0d\0", 8)));
    const Bytes whole = matlab_file(t + ax);
    return {"MATLAB 5",
            {"spectrum", "FILE", "--json"},
            notes_of,
            is_tone,
            {
                {"vectors, one of them a time", "a.mat", variables(t + ax)},
                {"big endian", "a.mat",
                 variables(matlab_numbers("t_s", sample_count, 1, times(), true) +
                               matlab_numbers("ax", sample_count, 1, values(), true),
                           true)},
                {"packed", "a.mat", variables(test::matlab_packed(t) + test::matlab_packed(ax))},
                {"numbers stored in single precision", "a.mat",
                 variables(t + matlab_numbers("ax", sample_count, 1, values(), false, 7))},
                {"a scalar `fs`", "a.mat", variables(ax + fs), Result::note, "variable 'fs'"},
                {"a matrix of two channels",
                 "a.mat",
                 variables(matlab_numbers("data", sample_count, 2, two) + fs),
                 Result::note,
                 "as variable 'fs' states",
                 {"--column", "data_1"}},
                {"fields of a structure", "a.mat", variables(structure)},
                {"characters beside them", "a.mat", variables(t + ax + text), Result::note, "left out"},
                {"vectors of several lengths", "a.mat",
                 variables(ax + matlab_numbers("ay", 50, 1, std::vector<double>(50, 1.0)) + fs), Result::refused,
                 "ay (50 samples)"},
                {"no rate and no time", "a.mat", variables(ax), Result::refused, "--sample-rate"},
                {"MATLAB 7.3", "a.mat", bytes("MATLAB 7.3 MAT-file" + Bytes(200, ' ')), Result::refused, "'-v7'"},
                {"cut short", "a.mat", bytes(whole.substr(0, whole.size() / 2)), Result::refused, "a.mat"},
            }};
}

}  // namespace

Table recording_table() { return {"recordings", {universal(), matlab()}}; }

}  // namespace tactus::conformance
