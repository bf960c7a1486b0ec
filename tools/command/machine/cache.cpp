// SPDX-License-Identifier: Apache-2.0
// tactus cache: shows and clears what is kept of earlier computations.
#include "assets/file/cache.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/machine/machine_result.hpp"
#include "tools/report/result/printers.hpp"

#include <memory>

namespace tactus::command {

namespace {

struct CacheChoice {
    bool clear = false;
    ResultChoice result;
};

int show_cache(const CacheChoice& choice) {
    check_result_files(choice.result, {});
    const report::ShownCache shown{file::root_of_cache().string(),
                                   choice.clear ? file::clear_cache() : file::cache_content(), file::cache_limit()};
    write_result((choice.clear ? report::cleared_cache_fields() : report::cache_fields()).of(shown), choice.result);
    return done;
}

}  // namespace

Verb cache_verb() {
    return {.name = "cache",
            .about = "show or clear what is kept of earlier computations",
            .add = [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<CacheChoice>();
                verb.flag("--clear", choice->clear, "remove all of it; it is made again when it is needed");
                add_result_options(verb, choice->result, ResultFigure::none);
                return [choice] { return show_cache(*choice); };
            },
            .schema =
                [] {
                    return report::schema_of_output(
                        {report::cache_fields().schema(), report::cleared_cache_fields().schema()});
                }};
}

}  // namespace tactus::command
