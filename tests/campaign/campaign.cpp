// SPDX-License-Identifier: Apache-2.0
// campaign COUNT [FORMAT ...]: COUNT damaged files of each format, or of those named, given to the built command. Each
// must end by itself: exit code 0 to 3, at most 20 s of processor time and 2 GB of memory. What does not is kept in
// campaign-findings/, by its number; the same number makes the same file. Exit code 1 when there is one.
#include "assets/file/whole_file.hpp"
#include "tests/campaign/formats.hpp"
#include "tests/campaign/limited_run.hpp"
#include "tests/campaign/mutate.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

namespace fs = std::filesystem;
using namespace tactus::campaign;

namespace {

/// Damages one file of `seed`, put in `folder`, by `number`. Returns where it is and what was done.
std::pair<fs::path, std::string> make_mutant(const Format& format, const fs::path& seed, std::uint64_t number,
                                             const fs::path& folder) {
    const fs::path mutant = folder / seed.filename();
    fs::copy(seed, mutant, fs::copy_options::recursive);
    // Formats differ in what the same number does to them.
    Dice dice(number * 1000003 + format.name[0] * 257u + format.name[1]);
    fs::path file = mutant;
    if (fs::is_directory(mutant)) {
        std::vector<fs::path> files;
        for (const auto& entry : fs::recursive_directory_iterator(mutant))
            if (entry.is_regular_file()) files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        file = files[dice.below(files.size())];
    }
    std::string bytes = format.open(tactus::file::read_whole_file(file));
    const std::string done = mutate(bytes, dice);
    tactus::file::write_whole_file(file, format.close(std::move(bytes), number));
    return {mutant, file.filename().string() + ": " + done};
}

std::vector<std::string> words_of(const std::vector<std::string>& verb, const fs::path& file) {
    std::vector<std::string> words{tried_command()};
    for (std::string word : verb) {
        if (const std::size_t at = word.find("FILE"); at != std::string::npos) word.replace(at, 4, file.string());
        words.push_back(std::move(word));
    }
    return words;
}

struct Tally {
    int findings = 0, refused = 0;
};

/// Undamaged files must be read, or the damaged ones show nothing. Each verb has a seed that it takes.
void try_seeds(const Format& format, const fs::path& scratch) {
    for (const std::vector<std::string>& verb : format.verbs) {
        bool is_taken = false;
        for (const fs::path& seed : format.seeds)
            is_taken = is_taken || (run_limited(words_of(verb, seed), scratch).code & ~1) == 0;
        if (!is_taken)
            throw std::runtime_error(fmt::format("no seed of {} is taken by '{}'", format.name, verb.front()));
    }
}

Tally try_mutant(const Format& format, std::uint64_t number, const fs::path& scratch) {
    Tally tally;
    const fs::path folder = scratch / "mutant";
    fs::create_directories(folder);
    const auto [mutant, done] = make_mutant(format, format.seeds[number % format.seeds.size()], number, folder);
    for (const std::vector<std::string>& verb : format.verbs) {
        const RunEnd end = run_limited(words_of(verb, mutant), folder);
        tally.refused += end.code >= 2;
        if (end.fault.empty()) continue;
        ++tally.findings;
        const fs::path kept =
            fs::path("campaign-findings") / fmt::format("{}-{}", format.name, number) / mutant.filename();
        fs::create_directories(kept.parent_path());
        fs::copy(mutant, kept, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
        fmt::print("{} {} '{}': {}\n  {}\n  kept as {}\n", format.name, number, verb.front(), end.fault, done,
                   kept.string());
    }
    fs::remove_all(folder);
    return tally;
}

}  // namespace

int main(int count, char** words) {
    if (count < 2 || std::atoi(words[1]) < 1) {
        fmt::print(stderr, "usage: campaign COUNT [FORMAT ...]\n");
        return 2;
    }
    const std::vector<std::string> wanted(words + 2, words + count);
    const fs::path scratch = fs::temp_directory_path() / fmt::format("tactus-campaign-{}", getpid());
    int found = 0, tried = 0;
    try {
        fs::create_directories(scratch);
        for (const Format& format : make_formats(scratch)) {
            if (!wanted.empty() && std::ranges::find(wanted, format.name) == wanted.end()) continue;
            try_seeds(format, scratch);
            Tally all;
            for (int n = 0; n < std::atoi(words[1]); ++n) {
                const Tally one = try_mutant(format, static_cast<std::uint64_t>(n), scratch);
                all.findings += one.findings, all.refused += one.refused;
            }
            fmt::print("{}: {} damaged files, {} verbs each, {} times refused, {} findings\n", format.name, words[1],
                       format.verbs.size(), all.refused, all.findings);
            std::fflush(stdout);
            found += all.findings;
            ++tried;
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "campaign: {}\n", error.what());
        found = 1;
    }
    std::error_code ignored;
    fs::remove_all(scratch, ignored);
    return found > 0 || tried == 0 ? 1 : 0;
}
