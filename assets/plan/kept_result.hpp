// SPDX-License-Identifier: Apache-2.0
// Cache of the results of long computations on files, in the user's cache folder (assets/file/cache.hpp).
//
// A result is a list of numbers. Its key is a text with everything that determines it: hashes of the files, options,
// and the version of the algorithm. A cached result is used only if its key is equal and its checksum is correct.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tactus::plan {

class ResultKey {
public:
    /// `what`: name of the computation; `version`: incremented when a change of the algorithm changes its result.
    ResultKey(const std::string& what, int version);

    /// Adds a file by the hash of its bytes ("FILE.vdb#NAME": also by the name). A file that refers to other files has
    /// no key, so that results with it are not cached. Throws Error for a file that cannot be read.
    ResultKey& add_file(const std::filesystem::path& path);
    ResultKey& add(const std::string& name, double number);
    ResultKey& add_text(const std::string& name, const std::string& value);

    /// Empty if results are not cached.
    std::string text() const { return is_complete_ ? text_ : std::string(); }

private:
    std::string text_;
    bool is_complete_ = true;
};

/// Returns the cached result of a key. `note` receives a sentence if the file exists but is not a result of this key.
std::optional<std::vector<double>> kept_result(const ResultKey& key, std::string& note);

/// Caches a result. The file is complete or does not exist; without disk space or permission, nothing is written.
void keep_result(const ResultKey& key, const std::vector<double>& numbers) noexcept;

/// The same for a result that is a text.
std::optional<std::string> kept_text(const ResultKey& key, std::string& note);
void keep_text(const ResultKey& key, const std::string& text) noexcept;

/// Returns the cache file of a result; empty without a folder or a key.
std::filesystem::path file_of_result(const ResultKey& key);

/// Returns `count` cached numbers (any number if empty), or those that `make` returns, which are then cached.
std::vector<double> result_of(const ResultKey& key, std::optional<std::size_t> count, std::string& note,
                              const std::function<std::vector<double>()>& make);

}  // namespace tactus::plan
