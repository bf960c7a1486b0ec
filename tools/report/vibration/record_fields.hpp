// SPDX-License-Identifier: Apache-2.0
// What was understood of a record, as fields of results.
#pragma once

#include "assets/sound/record_reader.hpp"
#include "assets/sound/stretch.hpp"
#include "tools/report/result/fields.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::report {

/// A log with the rate at which it was read.
struct ReadLog {
    const sound::LogFacts* facts;
    double rate;  ///< Hz
};

/// A record that was read: the stretch of it, its calibration, and its form if it is a log.
struct ReadRecord {
    const sound::ReadStretch& stretch;
    const sound::Calibration& calibration;
    const std::optional<sound::LogFacts>& log;
    double rate;  ///< Hz
};

/// from_s, to_s, of_s
const Fields<sound::ReadStretch>& stretch_fields();

/// stretch, calibration, and last log.
const Fields<ReadRecord>& record_fields();

template <class T>
ReadRecord record_of(const T& t) {
    return {t.stretch, t.calibration, t.log, t.rate};
}

/// The result of a record, or why it could not be used.
template <class T>
struct Tried {
    std::string file;
    const T* result;
    std::string error;  ///< empty: there is a result
};

/// `results` and `errors` of the records, as run_batch gives them.
template <class T>
std::vector<Tried<T>> tried(const std::vector<std::filesystem::path>& files, const std::vector<T>& results,
                            const std::vector<std::string>& errors) {
    std::vector<Tried<T>> all;
    for (std::size_t i = 0; i < files.size(); ++i) all.push_back({files[i].string(), &results[i], errors[i]});
    return all;
}

template <class T>
const Fields<Tried<T>>& tried_fields(const Fields<T>& of_result) {
    static const Fields<Tried<T>> failed = Fields<Tried<T>>("record that could not be used")
                                               .titled([](const Tried<T>& t) { return t.file; })
                                               .text("file", "", &Tried<T>::file)
                                               .text("error", "error", &Tried<T>::error)
                                               .judged([](const Tried<T>&) { return Severity::fail; });
    static const Fields<Tried<T>> all = Fields<Tried<T>>("result of a record")
                                            .part(of_result, [](const Tried<T>& t) -> const T& { return *t.result; })
                                            .otherwise([](const Tried<T>& t) { return !t.error.empty(); }, failed);
    return all;
}

}  // namespace tactus::report
