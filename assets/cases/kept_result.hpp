// SPDX-License-Identifier: Apache-2.0
// Results of long computations on files, kept in the user's cache folder (assets/file/cache.hpp).
//
// A result is a list of numbers. Its key is a text with all it depends on: hashes of the files, options, and the
// version of the algorithm. It is read only when the key is the same text and its checksum is right.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tactus::cases {

class ResultKey {
public:
    /// `what` is computed; `version` counts changes of the algorithm that change its result.
    ResultKey(const std::string& what, int version);

    /// A file by the hash of its bytes ("FILE.vdb#NAME": also by the name). A file that refers to other files has no
    /// key: results with it are not kept. Throws Error for a file that cannot be read.
    ResultKey& add_file(const std::filesystem::path& path);
    ResultKey& add(const std::string& name, double number);
    ResultKey& add_text(const std::string& name, const std::string& value);

    /// Empty when results are not kept.
    std::string text() const { return is_complete_ ? text_ : std::string(); }

private:
    std::string text_;
    bool is_complete_ = true;
};

/// The kept result of a key. `note` gets a sentence when there is a file and it is not a result of this key.
std::optional<std::vector<double>> kept_result(const ResultKey& key, std::string& note);

/// Keeps a result. The file is complete or does not exist; without room or right to write, nothing is kept.
void keep_result(const ResultKey& key, const std::vector<double>& numbers) noexcept;

/// The same for a result that is a text.
std::optional<std::string> kept_text(const ResultKey& key, std::string& note);
void keep_text(const ResultKey& key, const std::string& text) noexcept;

/// The file that keeps a result; empty without a folder or a key.
std::filesystem::path file_of_result(const ResultKey& key);

/// Kept numbers of `count` (any number when none), or those that `make` returns, which are then kept.
std::vector<double> result_of(const ResultKey& key, std::optional<std::size_t> count, std::string& note,
                              const std::function<std::vector<double>()>& make);

}  // namespace tactus::cases
