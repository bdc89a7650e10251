// What people read at the start and the end of a run.
#pragma once

#include <string>

#include "app/options.h"
#include "takt/engine/engine.h"
#include "takt/engine/scheduler.h"
#include "takt/lcm/service.h"

namespace takt::app {

// One line: machine, axes and other components, cycle, pace.
std::string Greeting(const engine::Machine& machine, engine::Pace pace);

// One paragraph: how it ended, cycles, overruns, times, losses.
std::string Summary(const engine::Engine& engine, const engine::RunResult& result, engine::Pace pace,
                    const lcm::Losses& losses);

}  // namespace takt::app
