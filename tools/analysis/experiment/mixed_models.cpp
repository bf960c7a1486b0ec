// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/experiment/mixed_models.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/run/child_process.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

namespace tactus::analysis {

namespace fs = std::filesystem;
using experiment::Protocol;

namespace {

/// Column of a factor: a name that R accepts, and that no other column has.
std::string column_of(const Protocol& protocol, const std::string& factor) {
    std::string plain;
    for (const char c : factor) plain += std::isalnum(static_cast<unsigned char>(c)) != 0 && (c & 0x80) == 0 ? c : '.';
    int number = 0, equal = 0, index = 0;
    for (const auto& [other, level] : protocol.conditions.front().factors) {
        ++index;
        std::string text;
        for (const char c : other)
            text += std::isalnum(static_cast<unsigned char>(c)) != 0 && (c & 0x80) == 0 ? c : '.';
        if (text == plain) ++equal;
        if (other == factor) number = index;
    }
    return equal > 1 ? fmt::format("factor.{}.{}", plain, number) : "factor." + plain;
}

/// A string of R.
std::string r_string(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c == '\n' || c == '\t' ? ' ' : c;
    }
    return out + "\"";
}

std::string table_cell(const std::string& text) {
    std::string out = text;
    std::ranges::replace_if(out, [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
    return out.empty() ? "NA" : out;
}

/// A row for each value: of a trial of a task, or a threshold.
class Table {
public:
    explicit Table(const ExperimentAnalysis& analysis) : analysis_(analysis), protocol_(analysis.protocol) {}

    std::string text() {
        text_ = "subject\ttask\tmeasure\tcondition\tperiod\ttrial\tvalue";
        for (const auto& [factor, level] : protocol_.conditions.front().factors)
            text_ += fmt::format("\t{0}\tbefore.{0}", column_of(protocol_, factor));
        text_ += "\n";
        for (const AnalysedSubject& subject : analysis_.subjects) {
            if (!subject.excluded.empty()) continue;
            order_ = experiment::condition_order(protocol_, subject.entry.row);
            if (protocol_.is_psychophysics()) add_thresholds(subject);
            else add_trials(subject);
        }
        return text_;
    }

private:
    void add_thresholds(const AnalysedSubject& subject) {
        for (std::size_t i = 0; i < protocol_.conditions.size(); ++i)
            if (const auto value = value_of(protocol_, subject, "", "threshold", protocol_.conditions[i].name))
                add(subject, "", "threshold", i, period_of(i), 0, *value);
    }

    void add_trials(const AnalysedSubject& subject) {
        for (const experiment::TrialRecord& trial : subject.records) {
            if (trial.phase != experiment::Phase::main) continue;
            const auto condition =
                std::ranges::find(protocol_.conditions, trial.condition, &experiment::Condition::name);
            const auto task = std::ranges::find(protocol_.tasks, trial.task, &experiment::Task::name);
            if (condition == protocol_.conditions.end() || task == protocol_.tasks.end()) continue;
            for (const experiment::Measure& measure : task->measures) {
                const auto found = trial.measures.find(measure.name);
                if (found == trial.measures.end() || (measure.is_log && !(found->second > 0.0))) continue;
                // Blocks are periods times tasks.
                add(subject, trial.task, measure.name,
                    static_cast<std::size_t>(condition - protocol_.conditions.begin()),
                    static_cast<std::size_t>(trial.block) / protocol_.tasks.size(), trial.number,
                    measure.is_log ? std::log(found->second) : found->second);
            }
        }
    }

    std::size_t period_of(std::size_t condition) const {
        return static_cast<std::size_t>(std::ranges::find(order_, condition) - order_.begin());
    }

    void add(const AnalysedSubject& subject, const std::string& task, const std::string& measure, std::size_t condition,
             std::size_t period, int trial, double value) {
        text_ += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{:.17g}", subject.entry.pseudonym, table_cell(task), measure,
                             protocol_.conditions[condition].name, period + 1, trial, value);
        for (const auto& [factor, level] : protocol_.conditions[condition].factors)
            text_ += fmt::format("\t{}\t{}", table_cell(level),
                                 period == 0 || period > order_.size()
                                     ? "none"
                                     : table_cell(protocol_.conditions[order_[period - 1]].factors.at(factor)));
        text_ += "\n";
    }

    const ExperimentAnalysis& analysis_;
    const Protocol& protocol_;
    std::vector<std::size_t> order_;  // of the subject
    std::string text_;
};

/// Factors besides that of the comparison which still vary within it.
std::vector<std::string> other_factors(const Protocol& protocol, const experiment::Comparison& comparison) {
    std::map<std::string, std::vector<std::string>> levels;
    for (const experiment::Condition& condition : protocol.conditions) {
        if (!comparison.within_factor.empty() && condition.factors.at(comparison.within_factor) != comparison.within)
            continue;
        const std::string& own = condition.factors.at(comparison.factor);
        if (own != comparison.a && own != comparison.b) continue;
        for (const auto& [factor, level] : condition.factors)
            if (std::ranges::find(levels[factor], level) == levels[factor].end()) levels[factor].push_back(level);
    }
    std::vector<std::string> others;
    for (const auto& [factor, all] : levels)
        if (factor != comparison.factor && all.size() > 1) others.push_back(column_of(protocol, factor));
    return others;
}

constexpr const char* script_head =
    R"R(# value: the measure, as its natural logarithm where the protocol states so; effect: -0.5 for level a and 0.5 for b, so that its
# coefficient is b - a; before: the same of the period before, 0 in the first. Other factors have sum contrasts: the effect is
# the mean over their levels. Subjects differ in level, and in the effect where they have several values for each level.
suppressPackageStartupMessages(library(lmerTest))
options(contrasts = c("contr.sum", "contr.poly"))
# Levels are text, also those that look like numbers.
data <- read.delim("data.tsv", colClasses = "character", na.strings = "NA", check.names = FALSE, quote = "", comment.char = "")
data$value <- as.numeric(data$value)
data$subject <- factor(data$subject)
data$period <- factor(data$period)
number <- function(x) if (length(x) == 1 && is.finite(x)) format(x, digits = 17) else "NA"
cat("values\testimate\tlow\thigh\tp\tdf\tsubject\tslope\tresidual\tformula\tnote\n", file = "models.tsv")
fit <- function(rows, a, b, level, before, fixed) {
  rows <- rows[rows[[level]] %in% c(a, b), ]
  rows$effect <- ifelse(rows[[level]] == b, 0.5, -0.5)
  rows$before <- ifelse(rows[[before]] == b, 0.5, ifelse(rows[[before]] == a, -0.5, 0))
  rows <- droplevels(rows)
  notes <- character()
  if (nlevels(rows$period) < 2) fixed <- sub(" + period", "", fixed, fixed = TRUE)
  # One value for each level cannot separate the subject's own effect from the residual.
  several <- all(table(rows$subject, rows$effect) > 1)
  random <- if (several) "(1 | subject) + (0 + effect | subject)" else "(1 | subject)"
  formula <- paste("value ~", fixed, "+", random)
  result <- rep("NA", 8)
  tryCatch(withCallingHandlers({
    # lme4 leaves out columns that others determine, and says so only in a message.
    columns <- model.matrix(as.formula(paste("~", fixed)), rows)
    others <- lm.fit(columns[, colnames(columns) != "effect", drop = FALSE], columns[, "effect"])
    if (all(abs(others$residuals) < 1e-9)) {
      same <- names(which(abs(others$coefficients) > 1e-9))
      stop("the orders do not separate the effect from ", paste(setdiff(same, "(Intercept)"), collapse = ", "))
    }
    model <- suppressMessages(lmer(as.formula(formula), rows, REML = TRUE))
    dropped <- setdiff(colnames(columns), names(fixef(model)))
    if (length(dropped) > 0)
      notes <- c(notes, paste("left out, since the orders do not separate it:", paste(dropped, collapse = ", ")))
    # Numbers of a fit that did not converge mean nothing. A singular fit did.
    failed <- grep("converge", unlist(model@optinfo$conv$lme4$messages), value = TRUE)
    code <- model@optinfo$conv$opt
    if (length(failed) == 0 && length(code) == 1 && code != 0) failed <- paste("the optimiser did not converge, code", code)
    if (length(failed) > 0) stop("no numbers of this fit: ", paste(failed, collapse = "; "))
    one <- summary(model)$coefficients["effect", ]
    reach <- qt(0.975, one["df"]) * one["Std. Error"]
    spread <- as.data.frame(VarCorr(model))
    of <- function(group, name) spread$sdcor[spread$grp %in% group & spread$var1 %in% name]
    groups <- grep("^subject", spread$grp, value = TRUE)
    result <- c(number(one["Estimate"]), number(one["Estimate"] - reach), number(one["Estimate"] + reach),
                number(one["Pr(>|t|)"]), number(one["df"]), number(of(groups, "(Intercept)")),
                number(of(groups, "effect")), number(of("Residual", NA)))
    if (isSingular(model)) notes <- c(notes, "singular: a random effect has no variance")
  }, warning = function(w) {
    notes <<- c(notes, conditionMessage(w))
    invokeRestart("muffleWarning")
  }), error = function(e) notes <<- c(notes, conditionMessage(e)))
  note <- gsub("[\t\r\n]+", " ", paste(notes, collapse = "; "))
  cat(nrow(rows), result, formula, note, sep = "\t", file = "models.tsv", append = TRUE)
  cat("\n", file = "models.tsv", append = TRUE)
}

)R";

/// Comparisons without a test, as those of a rehearsal, have no model either.
std::string script_of(const ExperimentAnalysis& analysis, bool has_carry_over) {
    const Protocol& protocol = analysis.protocol;
    std::string text = fmt::format(
                           "# Mixed models of the experiment '{}', written by 'tactus experiment analyse'.\n"
                           "# Rscript model.R reads data.tsv and writes models.tsv, a row for each comparison.\n",
                           protocol.name) +
                       script_head;
    for (const AnalysedComparison& one : analysis.comparisons) {
        if (!one.test) continue;
        const experiment::Comparison& comparison = one.of;
        const std::string level = column_of(protocol, comparison.factor);
        std::string rows = fmt::format("data$measure == {}", r_string(comparison.measure));
        if (!comparison.task.empty()) rows += fmt::format(" & data$task == {}", r_string(comparison.task));
        if (!comparison.within_factor.empty())
            rows += fmt::format(" & data[[{}]] == {}", r_string(column_of(protocol, comparison.within_factor)),
                                r_string(comparison.within));
        std::string fixed = "effect";
        for (const std::string& other : other_factors(protocol, comparison)) fixed += " * " + other;
        fixed += " + period";
        if (has_carry_over) fixed += " + before";
        text += fmt::format("fit(data[{}, ], {}, {}, {}, {}, {})\n", rows, r_string(comparison.a),
                            r_string(comparison.b), r_string(level), r_string("before." + level), r_string(fixed));
    }
    return text;
}

std::optional<double> number_in(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end != text.c_str() && *end == '\0' && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

void read_models(const fs::path& file, const ExperimentAnalysis& analysis, std::vector<MixedModel>& models) {
    std::istringstream lines(file::read_whole_file(file));
    std::string line;
    std::getline(lines, line);
    for (const AnalysedComparison& comparison : analysis.comparisons) {
        if (!comparison.test) continue;
        std::vector<std::string> cells;
        if (std::getline(lines, line)) {
            std::istringstream row(line + "\t");
            for (std::string cell_; std::getline(row, cell_, '\t');) cells.push_back(cell_);
        }
        if (cells.size() < 10)
            throw Error(fmt::format("{}: has no row for the comparison '{}'", file.string(), comparison.label));
        MixedModel model;
        model.label = comparison.label;
        model.is_log = comparison.is_log;
        model.values = static_cast<std::size_t>(number_in(cells[0]).value_or(0.0));
        model.effect = number_in(cells[1]);
        model.low = number_in(cells[2]);
        model.high = number_in(cells[3]);
        model.p = number_in(cells[4]);
        model.freedom = number_in(cells[5]);
        model.subject_deviation = number_in(cells[6]);
        model.effect_deviation = number_in(cells[7]);
        model.residual_deviation = number_in(cells[8]);
        model.formula = cells[9];
        if (cells.size() > 10) model.note = cells[10];
        models.push_back(std::move(model));
    }
}

}  // namespace

MixedModels fit_mixed_models(const ExperimentAnalysis& analysis, const fs::path& folder, bool has_carry_over,
                             const std::atomic<bool>& stop) {
    MixedModels result;
    result.folder = folder / "mixed";
    std::error_code failure;
    fs::remove_all(result.folder, failure);
    fs::create_directories(result.folder, failure);
    if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", result.folder.string(), failure.message()));
    if (analysis.protocol.comparisons.empty()) {
        result.problem = "the protocol states no comparison";
        return result;
    }
    file::write_whole_file(result.folder / "data.tsv", Table(analysis).text());
    file::write_whole_file(result.folder / "model.R", script_of(analysis, has_carry_over));
    const run::Capture out("tactus-r-out"), err("tactus-r-err");
    const run::Finished finished = run::run_process({"Rscript", "--vanilla", "model.R"}, result.folder, out, err,
                                                    {.seconds = 600.0, .stop = &stop});
    const std::string said = err.text();
    if (finished.code == 127 || said.find("there is no package called") != std::string::npos) {
        result.problem = fmt::format(
            "R with lmerTest is not installed (apt install r-base-core r-cran-lmertest); the data and the script are "
            "in {}",
            result.folder.string());
        return result;
    }
    if (finished.code != 0 || finished.signal != 0 || finished.is_late)
        throw Error(fmt::format("{}: the script failed: {}", (result.folder / "model.R").string(),
                                finished.is_late ? "it took longer than 10 min" : said));
    read_models(result.folder / "models.tsv", analysis, result.models);
    return result;
}

}  // namespace tactus::analysis
