// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/sweep/results.hpp"

#include "assets/file/utc_text.hpp"
#include "assets/table/csv_field.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "tools/analysis/sweep/provenance.hpp"

#include <fmt/format.h>

#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <map>
#include <variant>

namespace tactus::analysis {

namespace fs = std::filesystem;
using file::Json;
using sweep::Row;

namespace {

/// A value of the table: none, number or text.
using Cell = std::variant<std::monostate, double, std::int64_t, std::string>;

Cell cell_of(const Json& value) {
    if (value.is_boolean()) return static_cast<std::int64_t>(value.get<bool>() ? 1 : 0);
    if (value.is_number_integer()) {
        try {
            return value.get<std::int64_t>();
        } catch (const Error&) {
            return value.get<double>();
        }
    }
    if (value.is_number()) return value.get<double>();
    if (value.is_string()) return value.as_text();
    return {};
}

struct Column {
    std::string name, unit;
    bool is_text = false;
};

/// One row after another, in the same columns for all writers.
class Table {
public:
    explicit Table(const Results& results) : results_(results), sweep_(results.folder().sweep()) {
        columns.push_back({"index", "", false});
        columns.push_back({"point", "", true});
        for (const sweep::Axis& axis : sweep_.axes) {
            columns.push_back(
                {axis.name, axis.has_numbers ? axis.unit : "", !axis.has_numbers && axis.columns.empty()});
            for (const std::string& name : axis.columns) columns.push_back({axis.name + "." + name, "", true});
        }
        columns.push_back({"seed", "", false});
        columns.push_back({"state", "", true});
        for (const std::string& name : sweep_.value_names()) columns.push_back({name, "", false});
        columns.push_back({"output", "", true});
        columns.push_back({"reason", "", true});
        columns.push_back({"seconds", "s", false});
        columns.push_back({"peak_mb", "MB", false});
        columns.push_back({"attempt", "", false});
        columns.push_back({"finished", "", true});
    }

    void read(std::size_t index, std::vector<Cell>& cells) const {
        const Row row = results_.row(index);
        const sweep::Point point = results_.folder().tasks().point(index);
        cells.clear();
        cells.emplace_back(static_cast<std::int64_t>(index + 1));
        cells.emplace_back(sweep::text_of_id(row.point));
        for (std::size_t a = 0; a < sweep_.axes.size(); ++a) {
            const sweep::Axis& axis = sweep_.axes[a];
            const std::size_t l = point.levels[a];
            if (std::isnan(axis.levels[l].number) || (!axis.has_numbers && axis.columns.empty()))
                cells.emplace_back(axis.levels[l].text);
            else cells.emplace_back(axis.levels[l].number);
            if (!axis.rows.empty())
                for (const std::string& field : axis.rows[l]) cells.emplace_back(field);
        }
        cells.emplace_back(static_cast<std::int64_t>(point.seed));
        cells.emplace_back(std::string(row.is_ok ? "done" : "failed"));
        for (const sweep::Step& step : sweep_.steps)
            for (const sweep::KeptValue& kept : step.values) {
                const Json* value = row.values.find(kept.name);
                cells.push_back(value ? cell_of(*value) : Cell());
            }
        cells.push_back(row.is_ok ? Cell(sweep::text_of_id(row.output)) : Cell());
        cells.push_back(row.is_ok ? Cell() : Cell(row.reason));
        cells.emplace_back(row.seconds);
        cells.emplace_back(std::round(row.peak * 1e-4) / 100.0);
        cells.emplace_back(static_cast<std::int64_t>(row.attempt));
        cells.emplace_back(time_text(row.finished));
    }

    std::vector<Column> columns;

private:
    static std::string time_text(double seconds) {
        const std::chrono::seconds since_1970(static_cast<std::int64_t>(std::clamp(seconds, 0.0, 4e9)));
        return file::utc_text(std::chrono::system_clock::time_point(since_1970));
    }

    const Results& results_;
    const sweep::Sweep& sweep_;
};

constexpr const char* worker_keys[] = {"version", "build", "libc", "vector", "features", "cpu", "machine", "runner"};

std::string csv_text(const Cell& cell) {
    if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{}", *number + 0.0);  // 0, not "-0"
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) return fmt::format("{}", *whole);
    if (const auto* text = std::get_if<std::string>(&cell)) return table::csv_field(*text);
    return {};
}

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

/// A file under a name of its own, renamed into place at the end.
class PartFile {
public:
    explicit PartFile(const fs::path& path) : path_(path), part_(path) { part_ += "." + process_name() + ".part"; }
    ~PartFile() {
        if (!part_.empty()) ::unlink(part_.c_str());
    }
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;

    const fs::path& part() const { return part_; }
    [[noreturn]] void fail(const std::string& why) const {
        throw Error(fmt::format("{}: cannot be written: {}", path_.string(), why));
    }
    void publish() {
        if (std::rename(part_.c_str(), path_.c_str()) != 0) fail(std::strerror(errno));
        part_.clear();
    }

private:
    fs::path path_, part_;
};

class Database {
public:
    explicit Database(const PartFile& file) : file_(file) {
        if (::sqlite3_open(file.part().c_str(), &base_) != SQLITE_OK) fail();
        // Nobody sees it before it is whole.
        run("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; BEGIN");
    }
    ~Database() {
        ::sqlite3_finalize(insert_);
        ::sqlite3_close(base_);
    }
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    void run(const std::string& text) {
        if (::sqlite3_exec(base_, text.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
    }
    void prepare(const std::string& table, std::size_t columns) {
        ::sqlite3_finalize(insert_);
        insert_ = nullptr;
        std::string marks = "?";
        for (std::size_t i = 1; i < columns; ++i) marks += ",?";
        const std::string text = fmt::format("INSERT INTO {} VALUES ({})", table, marks);
        if (::sqlite3_prepare_v2(base_, text.c_str(), -1, &insert_, nullptr) != SQLITE_OK) fail();
    }
    void insert(const std::vector<Cell>& cells) {
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const int at = static_cast<int>(i + 1);
            if (const auto* number = std::get_if<double>(&cells[i])) ::sqlite3_bind_double(insert_, at, *number);
            else if (const auto* whole = std::get_if<std::int64_t>(&cells[i]))
                ::sqlite3_bind_int64(insert_, at, *whole);
            else if (const auto* text = std::get_if<std::string>(&cells[i]))
                ::sqlite3_bind_text(insert_, at, text->data(), static_cast<int>(text->size()), SQLITE_STATIC);
            else ::sqlite3_bind_null(insert_, at);
        }
        if (::sqlite3_step(insert_) != SQLITE_DONE) fail();
        ::sqlite3_reset(insert_);
    }
    void close() {
        ::sqlite3_finalize(insert_);
        insert_ = nullptr;
        run("COMMIT");
        if (::sqlite3_close(base_) != SQLITE_OK) fail();
        base_ = nullptr;
    }

private:
    [[noreturn]] void fail() const { file_.fail(::sqlite3_errmsg(base_)); }

    const PartFile& file_;
    sqlite3* base_ = nullptr;
    sqlite3_stmt* insert_ = nullptr;
};

std::string conflict_text(const SweepFolder& folder, std::size_t index, const sweep::LogReader& a, const Json& worker_a,
                          const sweep::LogReader& b, const Json& worker_b) {
    const bool is_same = bits_of(worker_a) == bits_of(worker_b);
    return fmt::format("point {} ({}) has two results, in {} and {}, {}", index + 1,
                       sweep::text_of_id(folder.tasks().id(index)), a.path().filename().string(),
                       b.path().filename().string(),
                       is_same ? "from the same build on equal processors: the point depends on more than its inputs"
                               : "from different builds or processors");
}

}  // namespace

std::vector<bool> finished_points(const SweepFolder& folder) {
    std::vector<bool> finished(folder.tasks().size(), false);
    for (const fs::path& path : sweep::log_files(folder.path()))
        sweep::LogReader(path).scan([&](const sweep::RowHead& head, std::uint64_t, std::uint32_t) {
            if (!head.is_ok) return;
            if (const auto index = folder.tasks().find(head.point)) finished[*index] = true;
        });
    return finished;
}

Results::Results(const SweepFolder& folder) : folder_(folder), places_(folder.tasks().size()) {
    for (const fs::path& path : sweep::log_files(folder.path())) {
        logs_.push_back(std::make_unique<sweep::LogReader>(path));
        const Json worker = logs_.back()->worker();
        workers_.push_back(worker.is_object() ? worker : Json::object());
    }
    for (std::uint32_t log = 0; log < logs_.size(); ++log)
        damaged_ += logs_[log]->scan([&](const sweep::RowHead& head, std::uint64_t at, std::uint32_t length) {
            const auto index = folder.tasks().find(head.point);
            if (!index) {
                ++foreign_;
                return;
            }
            Place& place = places_[*index];
            if (place.state == State::done && head.is_ok) {
                ++repeated_;
                if (place.output != head.output && conflicts_.size() < 20)
                    conflicts_.push_back(conflict_text(folder, *index, *logs_[place.log], workers_[place.log],
                                                       *logs_[log], workers_[log]));
                return;
            }
            // A later failure counts only if nothing succeeded.
            if (place.state == State::done) return;
            place = {at, head.output, length, log, head.is_ok ? State::done : State::failed};
        });
    for (const Place& place : places_) {
        done_ += place.state == State::done ? 1 : 0;
        failed_ += place.state == State::failed ? 1 : 0;
    }
}

void Results::require_agreement() const {
    if (conflicts_.empty()) return;
    throw Error(fmt::format("{}; {} in all. Move one of the logs out of {}, or compare with 'tactus sweep verify {}'",
                            conflicts_.front(),
                            conflicts_.size() < 20 ? fmt::format("{}", conflicts_.size()) : "20 or more",
                            (folder_.path() / "log").string(), folder_.path().string()));
}

Row Results::row(std::size_t index) const {
    const Place& place = places_[index];
    return sweep::read_row(logs_[place.log]->line(place.at, place.length));
}

std::uint64_t Results::hash() const {
    Hash hash;
    for (std::size_t i = 0; i < places_.size(); ++i)
        if (places_[i].state == State::done) {
            hash.add_word(folder_.tasks().id(i));
            hash.add_word(places_[i].output);
        }
    return hash.value();
}

std::vector<Results::Failure> Results::failures() const {
    std::map<std::string, Failure> by_reason;
    constexpr std::size_t max_read = 20'000;
    std::size_t read = 0;
    for (std::size_t i = 0; i < places_.size() && read < max_read; ++i)
        if (places_[i].state == State::failed) {
            ++read;
            const Row failed = row(i);
            Failure& failure = by_reason[failed.reason];
            if (failure.count++ > 0) continue;
            failure.example = i;
            failure.step = failed.step;
        }
    std::vector<Failure> all;
    for (auto& [reason, failure] : by_reason) {
        failure.reason = reason;
        all.push_back(failure);
    }
    std::ranges::stable_sort(all, std::greater(), &Failure::count);
    if (read < failed_) all.push_back({"(not read: only the first 20000 failures are)", failed_ - read, 0, 0});
    return all;
}

std::optional<double> Results::mean_seconds() const {
    constexpr std::size_t max_read = 400;
    if (done_ == 0) return {};
    const std::size_t step = std::max<std::size_t>(done_ / max_read, 1);
    double sum = 0.0;
    std::size_t seen = 0, read = 0;
    for (std::size_t i = 0; i < places_.size(); ++i)
        if (places_[i].state == State::done && seen++ % step == 0) {
            sum += row(i).seconds;
            ++read;
        }
    return sum / static_cast<double>(read);
}

std::size_t Results::active_workers() const {
    const double recent = std::max(120.0, 3.0 * mean_seconds().value_or(0.0));
    const auto now = static_cast<double>(std::time(nullptr));
    std::size_t active = 0;
    for (std::size_t log = 0; log < logs_.size(); ++log) {
        struct stat status{};
        if (::stat(logs_[log]->path().c_str(), &status) != 0) continue;
        if (now - static_cast<double>(status.st_mtime) > recent) continue;
        active += static_cast<std::size_t>(std::max(1, workers_[log].value("jobs", 1)));
    }
    return active;
}

void Results::write_csv(const fs::path& path) const {
    require_agreement();
    PartFile file(path);
    const std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(file.part().c_str(), "wbxe"));
    if (!stream) file.fail(std::strerror(errno));
    const Table table(*this);
    std::string line;
    for (const Column& column : table.columns)
        line += (line.empty() ? "" : ",") + table::csv_field(column.unit.empty() || column.name == "peak_mb"
                                                                 ? column.name
                                                                 : fmt::format("{} [{}]", column.name, column.unit));
    for (const char* key : worker_keys) line += fmt::format(",{}", key);
    line += '\n';
    std::fputs(line.c_str(), stream.get());
    std::vector<std::string> ends;
    for (const Json& worker : workers_) {
        ends.emplace_back();
        for (const char* key : worker_keys) ends.back() += "," + table::csv_field(worker.value(key, std::string()));
        ends.back() += '\n';
    }
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < size(); ++i) {
        if (places_[i].state == State::unfinished) continue;
        table.read(i, cells);
        line.clear();
        for (const Cell& cell : cells) line += (&cell == cells.data() ? "" : ",") + csv_text(cell);
        line += ends[places_[i].log];
        if (std::fputs(line.c_str(), stream.get()) < 0) file.fail(std::strerror(errno));
    }
    if (std::fflush(stream.get()) != 0) file.fail(std::strerror(errno));
    file.publish();
}

void Results::write_sqlite(const fs::path& path) const {
    require_agreement();
    PartFile file(path);
    Database base(file);
    const Table table(*this);
    std::string columns;
    for (const Column& column : table.columns)
        columns += fmt::format("{}\"{}\"{}", columns.empty() ? "" : ", ", column.name, column.is_text ? " TEXT" : "");
    base.run(fmt::format("CREATE TABLE results ({}, worker INTEGER)", columns));
    base.run(
        "CREATE TABLE workers (id INTEGER PRIMARY KEY, log TEXT, version TEXT, build TEXT, libc TEXT, vector TEXT, "
        "features TEXT, cpu TEXT, machine TEXT, runner TEXT)");
    base.run("CREATE TABLE axes (name TEXT, unit TEXT)");
    base.prepare("workers", 2 + std::size(worker_keys));
    for (std::size_t log = 0; log < logs_.size(); ++log) {
        std::vector<Cell> cells{static_cast<std::int64_t>(log), logs_[log]->path().filename().string()};
        for (const char* key : worker_keys) cells.emplace_back(workers_[log].value(key, std::string()));
        base.insert(cells);
    }
    base.prepare("axes", 2);
    for (const sweep::Axis& axis : folder_.sweep().axes) base.insert({axis.name, axis.unit});
    base.prepare("results", table.columns.size() + 1);
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < size(); ++i) {
        if (places_[i].state == State::unfinished) continue;
        table.read(i, cells);
        cells.emplace_back(static_cast<std::int64_t>(places_[i].log));
        base.insert(cells);
    }
    base.close();
    file.publish();
}

}  // namespace tactus::analysis
