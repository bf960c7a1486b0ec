// SPDX-License-Identifier: Apache-2.0
// The folder of an experiment's data: subjects, rows of the order, and the protocol as the first subject met it.
#pragma once

#include "assets/experiment/protocol.hpp"
#include "assets/experiment/records.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::analysis {

class ExperimentFolder {
public:
    /// Opens or makes the folder and locks it until destroyed. Throws Error when another program uses it, or when the protocol or a
    /// file that it names has changed since the first subject: the message has the file, the line, and both texts.
    ExperimentFolder(const std::filesystem::path& folder, const experiment::Protocol& protocol);
    /// Opens an existing folder for `withdraw`.
    explicit ExperimentFolder(const std::filesystem::path& folder);
    ~ExperimentFolder();
    ExperimentFolder(const ExperimentFolder&) = delete;
    ExperimentFolder& operator=(const ExperimentFolder&) = delete;

    const std::filesystem::path& path() const { return folder_; }
    const experiment::ExperimentFile& file() const { return file_; }
    /// Row of the order that the subject has, or that `enrol` would give it.
    std::size_t row_of(const std::string& pseudonym) const;
    /// The subject's entry; a new one gets the lowest row that a withdrawn subject freed, or the next row. Throws Error for a
    /// pseudonym that cannot be part of a file name, and when a subject was simulated and is now real, or the reverse.
    experiment::SubjectEntry enrol(const std::string& pseudonym, bool is_simulated);
    void update(const experiment::SubjectEntry& entry);
    /// Deletes everything of the subject and frees the row. Throws Error when there is no such subject.
    void withdraw(const std::string& pseudonym);

    std::filesystem::path subject_folder(const std::string& pseudonym) const { return folder_ / ("sub-" + pseudonym); }
    /// Hash of the frozen files, 16 hexadecimal digits.
    std::string protocol_hash() const;

private:
    void lock();
    void freeze(const experiment::Protocol& protocol);
    void check_frozen(const experiment::Protocol& protocol) const;
    void save() const;

    std::filesystem::path folder_;
    experiment::ExperimentFile file_;
    int lock_ = -1;
};

/// The protocol that an experiment's folder keeps: analyses read that one, wherever the original is. Throws Error when the folder is
/// none.
experiment::Protocol frozen_protocol(const std::filesystem::path& folder);

/// Beginnings of the names of results in the folder of an experiment: report.html, results.json. Every other name may be
/// that of data.
inline constexpr std::array<std::string_view, 2> result_stems{"report", "results"};
/// Whether a file with this name in the folder of an experiment is a result of an analysis: it may be replaced by the
/// next one, and a withdrawal deletes it, since it may name the subject.
bool is_experiment_result(std::string_view name);

/// Throws Error unless `name` is 1 to 40 letters and digits, as BIDS demands of a subject's label.
void check_subject_name(const std::string& name);

}  // namespace tactus::analysis
