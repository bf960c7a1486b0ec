// SPDX-License-Identifier: Apache-2.0
#include "tools/run/rendered_run.hpp"

#include "tools/run/load_plan.hpp"
#include "tools/run/output_folder.hpp"
#include "tools/run/results.hpp"
#include "tools/run/summary.hpp"

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>

namespace tactus::run {

namespace {

RenderedRun render(const RunChoice& choice, compile::AssetCache& assets, observe::Observer* observer,
                   const std::function<void(run::Engine&)>& drive) {
    run::EngineOptions options;
    options.observer = observer;
    options.seconds = choice.seconds.value();
    compile::Schedule plan = load_plan(choice, assets);
    OutputFolder folder({choice.out, choice.overwrite});
    options.folder = folder.path();
    options.tap = choice.tap;
    std::unique_ptr<take::TakeWriter> take;
    if (!choice.record.empty()) {
        take = make_take(choice, choice.record, options.seconds, false);
        options.take = take.get();
        if (!choice.record_values) take->limit_values(take::max_first_bytes);
    }
    run::Engine engine(std::move(plan), options);
    drive(engine);
    RenderedRun run;
    run.seconds = std::min(options.seconds, engine.progress_seconds());
    engine.complete();
    const Report report = engine.report();
    WrittenFiles written = write_results(report, folder.path());
    run.losses = engine.losses();
    run.losses.insert(run.losses.end(), written.losses.begin(), written.losses.end());
    written.names.emplace_back("summary.json");
    run.summary = summary_json(engine, report, run.seconds, false, written.names, run.losses);
    try {
        folder.write_summary(run.summary);
    } catch (const Error& error) {
        run.losses.emplace_back(error.what());
    }
    run.faults = unrecovered(engine);
    return run;
}

}  // namespace

RenderedRun render_run(const RunChoice& choice, compile::AssetCache& assets, const std::atomic<bool>& stop,
                       const std::function<void(double done)>& progress) {
    return render(choice, assets, nullptr, [&](run::Engine& engine) {
        engine.render(static_cast<int>(std::max(1u, std::thread::hardware_concurrency())), [&](double done) {
            if (stop) engine.stop();
            progress(done);
        });
    });
}

RenderedRun render_in_steps(const RunChoice& choice, compile::AssetCache& assets, observe::Observer* observer,
                            const std::function<void(run::Engine&)>& drive) {
    return render(choice, assets, observer, [&](run::Engine& engine) {
        drive(engine);
        engine.end_advance();
    });
}

}  // namespace tactus::run
