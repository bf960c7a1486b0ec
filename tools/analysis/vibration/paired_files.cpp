// SPDX-License-Identifier: Apache-2.0
// Pairs files for comparison.
#include "tools/analysis/vibration/comparison.hpp"
#include "tools/analysis/vibration/record.hpp"

#include <algorithm>

namespace tactus::analysis {

namespace fs = std::filesystem;

std::vector<PairedFiles> paired_files(const fs::path& reference, const fs::path& output) {
    const bool references = fs::is_directory(reference), outputs = fs::is_directory(output);
    std::vector<PairedFiles> pairs;
    if (!references || !outputs) {
        for (const fs::path& file : expand_folders({references ? reference : output}))
            pairs.push_back(references ? PairedFiles{file, output} : PairedFiles{reference, file});
        return pairs;
    }
    const std::vector<fs::path> wanted = expand_folders({reference});
    for (const fs::path& file : expand_folders({output})) {
        const auto found =
            std::ranges::find_if(wanted, [&](const fs::path& name) { return name.stem() == file.stem(); });
        pairs.push_back({found == wanted.end() ? fs::path() : *found, file});
    }
    for (const fs::path& file : wanted)
        if (std::ranges::none_of(pairs, [&](const PairedFiles& pair) { return pair.reference == file; }))
            pairs.push_back({file, {}});
    return pairs;
}

std::string pair_name(const ComparedPair& pair, std::span<const ComparedPair> all) {
    const bool one_output = all.size() > 1 && std::ranges::all_of(all, [&](const ComparedPair& p) {
                                return p.output == all.front().output;
                            });
    return (one_output || pair.output.empty() ? pair.reference : pair.output).filename().string();
}

}  // namespace tactus::analysis
