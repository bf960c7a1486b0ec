// SPDX-License-Identifier: Apache-2.0
// Writes universal files and MATLAB 5 files, from their definitions.
#pragma once

#include <zlib.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace tactus::test {

template <class T>
std::string bytes_of(T value, bool big = false) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (big) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

struct UniversalFunction {
    int type = 2;  // 2: single, 4: double
    bool is_even = true, is_binary = false, big = false;
    int abscissa = 17;  // time
    int node = 12, direction = 3;
    std::string unit = "m/s^2", time_unit = "s";
    double start = 0.0, step = 5e-4;
    std::vector<double> times, values;
};

inline std::string universal_function(const UniversalFunction& f) {
    std::string data;
    for (std::size_t n = 0; n < f.values.size(); ++n) {
        const bool is_double = f.type == 4;
        if (f.is_binary) {
            if (!f.is_even) data += bytes_of(static_cast<float>(f.times[n]), f.big);
            data += is_double ? bytes_of(f.values[n], f.big) : bytes_of(static_cast<float>(f.values[n]), f.big);
        } else {
            if (!f.is_even) data += fmt::format("{:13.5E}", f.times[n]);
            data += is_double ? fmt::format("{:20.12E}", f.values[n]) : fmt::format("{:13.5E}", f.values[n]);
            const std::size_t in_line = f.is_even ? (is_double ? 4 : 6) : (is_double ? 2 : 3);
            if (n % in_line == in_line - 1) data += '\n';
        }
    }
    std::string text = "    -1\n";
    text += f.is_binary ? fmt::format("{:6}b{:6}{:6}{:12}{:12}{:6}{:6}{:12}{:12}\n", 58, f.big ? 2 : 1, 2, 11,
                                      data.size(), 0, 0, 0, 0)
                        : "    58\n";
    text += "a title\nNONE\nNONE\nNONE\nNONE\n";
    text += fmt::format("{:5}{:10}{:5}{:10} {:<10}{:10}{:4} {:<10}{:10}{:4}\n", 1, 1, 0, 0, "NONE", f.node, f.direction,
                        "NONE", 0, 0);
    text += fmt::format("{:10}{:10}{:10}{:13.5E}{:13.5E}{:13.5E}\n", f.type, f.values.size(), f.is_even ? 1 : 0,
                        f.start, f.step, 0.0);
    const auto axis = [](int kind, const std::string& name, const std::string& unit) {
        return fmt::format("{:10}{:5}{:5}{:5} {:<20} {:<20}\n", kind, 0, 0, 0, name, unit);
    };
    text += axis(f.abscissa, "Time", f.time_unit) + axis(12, "Acceleration", f.unit) + axis(0, "NONE", "NONE") +
            axis(0, "NONE", "NONE");
    return text + data + "\n    -1\n";
}

/// An element of a MATLAB 5 file: its tag, its data, and padding.
inline std::string matlab_element(std::uint32_t type, const std::string& data, bool big = false) {
    return bytes_of(type, big) + bytes_of(static_cast<std::uint32_t>(data.size()), big) + data +
           std::string((8 - data.size() % 8) % 8, '\0');
}

/// The inner elements of an array: flags, dimensions, name.
inline std::string matlab_array(std::uint32_t kind, const std::string& name, int rows, int columns, bool big = false) {
    return matlab_element(6, bytes_of(kind, big) + bytes_of(std::uint32_t{0}, big), big) +
           matlab_element(5, bytes_of(std::int32_t{rows}, big) + bytes_of(std::int32_t{columns}, big), big) +
           matlab_element(1, name, big);
}

/// A double array; `type`: that in which its numbers are stored, 9: double, 3: int16, 7: single.
inline std::string matlab_numbers(const std::string& name, int rows, int columns, const std::vector<double>& values,
                                  bool big = false, std::uint32_t type = 9) {
    std::string data;
    for (const double value : values)
        data += type == 3   ? bytes_of(static_cast<std::int16_t>(value), big)
                : type == 7 ? bytes_of(static_cast<float>(value), big)
                            : bytes_of(value, big);
    return matlab_element(14, matlab_array(6, name, rows, columns, big) + matlab_element(type, data, big), big);
}

inline std::string matlab_packed(const std::string& element) {
    uLongf size = compressBound(static_cast<uLong>(element.size()));
    std::string out(size, '\0');
    compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(element.data()),
             static_cast<uLong>(element.size()));
    out.resize(size);
    return bytes_of(std::uint32_t{15}) + bytes_of(static_cast<std::uint32_t>(size)) + out;
}

inline std::string matlab_file(const std::string& elements, bool big = false) {
    std::string header = "MATLAB 5.0 MAT-file, written by a test";
    header.resize(124, ' ');
    return header + (big ? std::string("\1\0MI", 4) : std::string("\0\1IM", 4)) + elements;
}

}  // namespace tactus::test
