// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/response_file.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/table/csv_file.hpp"
#include "assets/table/decimal_sign.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>

namespace tactus::sound {

namespace {

constexpr int max_lines = 1'000'000;

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t' || text.front() == '"')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r' || text.back() == '"'))
        text.remove_suffix(1);
    return text;
}

/// '\0': blanks, of which several separate once.
constexpr char blanks = '\0';

bool is_remark(std::string_view line) { return line.front() == '#' || line.front() == '*' || line.front() == ';'; }

/// Of the whole file, because with semicolons or tabs a comma is decimal.
char separator_of(std::string_view text) {
    bool has_comma = false, has_tab = false, is_decimal = false;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string_view line = trimmed(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (line.empty() || is_remark(line)) continue;
        if (line.find(';') != std::string_view::npos) return ';';
        // Names may be separated otherwise than numbers.
        if (std::string_view("+-.0123456789").find(line.front()) == std::string_view::npos) continue;
        for (std::size_t at = line.find(','); at != std::string_view::npos; at = line.find(',', at + 1)) {
            has_comma = true;
            const auto is_digit = [&](std::size_t i) { return i < line.size() && line[i] >= '0' && line[i] <= '9'; };
            is_decimal = is_decimal || (at > 0 && is_digit(at - 1) && is_digit(at + 1));
        }
        has_tab = has_tab || line.find('\t') != std::string_view::npos;
    }
    return has_comma && has_tab && is_decimal ? '\t' : has_comma ? ',' : blanks;
}

/// Splits a line, keeping empty cells but those at the end.
std::vector<std::string_view> cells_of(std::string_view line, char separator) {
    std::vector<std::string_view> cells;
    while (true) {
        const std::size_t end = separator == blanks ? line.find_first_of(" \t") : line.find(separator);
        const std::string_view cell = trimmed(line.substr(0, end));
        if (separator != blanks || !cell.empty()) cells.push_back(cell);
        if (end == std::string_view::npos) break;
        line.remove_prefix(end + 1);
    }
    while (cells.size() > 1 && cells.back().empty()) cells.pop_back();
    return cells;
}

std::optional<double> number_in(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

class Reader {
public:
    explicit Reader(const std::filesystem::path& path) : path_(path) {}

    ResponseFile read() {
        const std::string text = file::read_whole_file(path_);
        std::string_view rest = text;
        const char separator = separator_of(text);
        sign_ = table::DecimalSign(separator);
        while (!rest.empty()) {
            const std::size_t end = rest.find('\n');
            const std::string_view line = trimmed(rest.substr(0, end));
            rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
            if (++line_ > max_lines) fail(fmt::format("longer than {} lines", max_lines));
            if (line.empty()) continue;
            if (is_remark(line)) remark(line.substr(1));
            else {
                const bool has_names_apart = separator == blanks && line.find(',') != std::string_view::npos;
                row(cells_of(line, has_names_apart ? ',' : separator), separator);
            }
        }
        if (const auto doubt = sign_.doubt())
            throw Error({path_.string(), doubt->line, doubt->line > 0 ? 1 : 0}, doubt->why);
        vibration::FrequencyResponse& response = file_.identified.response;
        if (response.hz.size() < 3) throw Error({path_.string(), 0, 0}, "a response needs at least 3 frequencies");
        if (!has_phase_) assume_minimum_phase(response);
        return std::move(file_);
    }

private:
    [[noreturn]] void fail(const std::string& message) const { throw Error({path_.string(), line_, 1}, message); }

    /// The number of a cell, which may have a decimal comma.
    std::optional<double> number_of_cell(std::string_view cell) {
        if (const auto refused = sign_.note(cell, line_)) fail(*refused);
        const std::optional<double> number = cell.empty() ? std::nullopt : sign_.parse(cell);
        return number && std::isfinite(*number) ? number : std::nullopt;
    }

    void remark(std::string_view text) {
        const std::size_t equals = text.find('=');
        if (equals == std::string_view::npos) return;
        const std::string_view key = trimmed(text.substr(0, equals)), value = trimmed(text.substr(equals + 1));
        if (key == "title") file_.title = value;
        if (key == "unit") file_.unit = value;
        if (key == "latency_s") {
            const auto latency = number_in(value);
            if (!latency) fail("latency_s must be a number of seconds");
            file_.identified.response.latency = *latency;
        }
    }

    void names(const std::vector<std::string_view>& cells) {
        hz_ = level_ = phase_ = coherence_ = none;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const std::string name = lower(cells[i]);
            if (name.starts_with("freq") || name == "hz") hz_ = i;
            else if (name.starts_with("level") || name.starts_with("mag") || name.starts_with("spl") || name == "db")
                level_ = i;
            else if (name.starts_with("phase") || name.starts_with("deg")) phase_ = i;
            else if (name.starts_with("coherence")) coherence_ = i;
            else if (name.starts_with("order_")) {
                const auto order = number_in(std::string_view(name).substr(6));
                if (!order || *order < 2.0 || *order > 100.0) fail(fmt::format("'{}' is not an order", name));
                orders_.push_back(i);
                file_.identified.distortions.push_back({static_cast<int>(*order), {}});
            }
        }
        if (hz_ == none || level_ == none)
            fail("no columns of numbers: frequency in Hz, level in dB and phase in degrees are expected");
        has_phase_ = phase_ != none;
        named_ = true;
        columns_ = cells.size();
    }

    void row(const std::vector<std::string_view>& cells, char separator) {
        vibration::FrequencyResponse& response = file_.identified.response;
        if (!number_of_cell(cells.front())) {
            if (named_ || !response.hz.empty()) fail(fmt::format("'{}' is not a number", cells.front()));
            return names(cells);
        }
        if (!named_ && response.hz.empty()) has_phase_ = cells.size() > 2;
        // Half of a number with a decimal comma would be taken for a column.
        if (cells.size() > columns_ && separator == ',')
            fail(
                named_
                    ? fmt::format("the row has {} cells and there are {} names; are commas decimal here? Then separate "
                                  "the cells by semicolons or tabs",
                                  cells.size(), columns_)
                    : fmt::format("the row has {} cells; without names there are at most {}: frequency in Hz, level in "
                                  "dB and phase in degrees",
                                  cells.size(), columns_));
        const auto value = [&](std::size_t column) {
            const auto read = column < cells.size() ? number_of_cell(cells[column]) : std::nullopt;
            if (!read) fail(fmt::format("column {} is not a number", column + 1));
            return *read;
        };
        const double hz = value(hz_), level = value(level_);
        if (!(hz >= 0.0)) fail("a frequency must not be negative");
        if (hz == 0.0) return;  // tables of transforms begin there
        if (!response.hz.empty() && hz <= response.hz.back()) fail("frequencies must increase from line to line");
        if (std::abs(level) > 400.0) fail("a level must lie between -400 and 400 dB");
        const double phase = has_phase_ ? value(phase_) * std::numbers::pi / 180.0 : 0.0;
        response.hz.push_back(hz);
        response.gain.push_back(std::polar(std::pow(10.0, level / 20.0), phase));
        if (coherence_ != none) response.coherence.push_back(std::clamp(value(coherence_), 0.0, 1.0));
        for (std::size_t i = 0; i < orders_.size(); ++i) {
            const auto ratio = orders_[i] < cells.size() ? number_of_cell(cells[orders_[i]]) : std::nullopt;
            file_.identified.distortions[i].ratio.push_back(ratio.value_or(std::numeric_limits<double>::quiet_NaN()));
        }
    }

    static void assume_minimum_phase(vibration::FrequencyResponse& response) {
        std::vector<double> magnitude;
        for (const auto& gain : response.gain) magnitude.push_back(std::abs(gain));
        const std::vector<double> phase = vibration::minimum_phase(response.hz, magnitude);
        for (std::size_t i = 0; i < phase.size(); ++i) response.gain[i] = std::polar(magnitude[i], phase[i]);
    }

    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    std::filesystem::path path_;
    ResponseFile file_;
    int line_ = 0;
    bool named_ = false, has_phase_ = false;
    std::size_t hz_ = 0, level_ = 1, phase_ = 2, coherence_ = none;
    std::size_t columns_ = 3;  // without names
    std::vector<std::size_t> orders_;
    table::DecimalSign sign_{','};
};

}  // namespace

void save_response(const ResponseFile& file, const std::filesystem::path& path) {
    const vibration::FrequencyResponse& response = file.identified.response;
    std::string out = fmt::format("# title = \"{}\"\n# unit = \"{}\"\n# latency_s = {:.9g}\n", file.title, file.unit,
                                  response.latency);
    out += "frequency_hz,level_db,phase_deg,coherence";
    for (const vibration::Distortion& d : file.identified.distortions) out += fmt::format(",order_{}", d.order);
    const std::vector<double> phase = vibration::unwrapped_phase(response.gain);
    for (std::size_t i = 0; i < response.hz.size(); ++i) {
        out +=
            fmt::format("\n{:.7g},{:.6f},{:.5f},{:.7f}", response.hz[i],
                        20.0 * std::log10(std::max(std::abs(response.gain[i]), 1e-18)),
                        phase[i] * 180.0 / std::numbers::pi, response.coherence.empty() ? 1.0 : response.coherence[i]);
        for (const vibration::Distortion& d : file.identified.distortions)
            out += std::isfinite(d.ratio[i]) ? fmt::format(",{:.3e}", d.ratio[i]) : ",";
    }
    table::save_csv(path, out + "\n");
}

ResponseFile load_response(const std::filesystem::path& path) { return Reader(path).read(); }

}  // namespace tactus::sound
