// SPDX-License-Identifier: Apache-2.0
// The features of file formats, each with a file that has it and the expected answer of the command. The tables of
// docs/reference/formats.md are written from this list, and compared with it by a test.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::conformance {

namespace fs = std::filesystem;
using Json = nlohmann::json;

enum class Result { read, note, refused };

/// Returns the error of an answer, or "" if it is right.
using Check = std::function<std::string(const Json&)>;

struct Case {
    std::string feature;
    /// Path of the file that the command is given, in a folder of its own.
    std::string file;
    std::function<void(const fs::path&)> write;
    Result result = Result::read;
    std::string words{};  ///< that the note or the refusal contains
    std::vector<std::string> options{};
    Check check{};  ///< in place of that of the format
};

struct Format {
    std::string name;
    std::vector<std::string> verb;  ///< behind `tactus`; "FILE" is the file of the case
    /// Of an answer, whose member `said` is the text before it on standard error.
    std::function<std::vector<std::string>(const Json&)> notes;
    Check check;
    std::vector<Case> cases;
};

/// A table of the page.
struct Table {
    std::string name;
    std::vector<Format> formats;
};

Table scan_table();
Table mesh_table();
Table mark_table();
Table sound_table();
Table log_table();
Table recording_table();

/// A case whose file has these bytes.
std::function<void(const fs::path&)> bytes(std::string content);

/// Runs the command in the folder of `path`; throws std::runtime_error if it fails.
void by_command(const fs::path& path, std::vector<std::string> words);

/// The strings of an array; none if it is absent.
std::vector<std::string> strings_of(const Json& array);

/// "" if two numbers agree to `relative`, otherwise a sentence with both.
std::string differs(const std::string& what, double found, double expected, double relative = 1e-4);

}  // namespace tactus::conformance
