// SPDX-License-Identifier: Apache-2.0
// tactus cache: shows and clears what is kept of earlier computations.
#include "assets/file/cache.hpp"
#include "assets/file/json.hpp"
#include "tools/command/options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

struct CacheChoice {
    bool clear = false, json = false;
};

std::string megabytes(std::uintmax_t bytes) { return fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6); }

int show_cache(const CacheChoice& choice) {
    const std::filesystem::path folder = file::root_of_cache();
    const std::uintmax_t limit = file::cache_limit();
    const file::CacheContent content = choice.clear ? file::clear_cache() : file::cache_content();
    if (choice.json) {
        fmt::print("{}\n", file::Json{{"folder", folder.string()},
                                      {choice.clear ? "removed_files" : "files", content.files},
                                      {choice.clear ? "removed_bytes" : "bytes", content.bytes},
                                      {"limit_bytes", limit}}
                               .dump(2));
        return done;
    }
    if (choice.clear)
        fmt::print("{}: {} removed, {}\n", folder.string(), counted(content.files, "file"), megabytes(content.bytes));
    else
        fmt::print("{}: {}, {} of {}\n", folder.string(), counted(content.files, "file"), megabytes(content.bytes),
                   limit > 0 ? megabytes(limit) : "0 MB: the cache is off");
    return done;
}

}  // namespace

Verb cache_verb() {
    return {"cache", "show or clear what is kept of earlier computations", [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<CacheChoice>();
                verb.flag("--clear", choice->clear, "remove all of it; it is made again when it is needed");
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return show_cache(*choice); };
            }};
}

}  // namespace tactus::command
