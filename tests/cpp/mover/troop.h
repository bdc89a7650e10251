// Several movers with their own cycles, stepped as in the engine.
#pragma once

#include <gtest/gtest.h>

#include <complex>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "../core/allocations.h"
#include "rig.h"
#include "takt/mover/formation.h"

namespace takt::mover {

class Troop {
 public:
  explicit Troop(std::vector<MoverParams> p, double period_s = 0.001) : params(std::move(p)) {
    cycle.period_s = period_s;
    for (std::size_t i = 0; i < std::variant_size_v<Command>; ++i) TypeOfCommand(i);  // the first use allocates
    for (std::size_t i = 0; i < params.size(); ++i) {
      params[i].name = "m" + std::to_string(i);
      states.push_back(MakeState(params[i]));
      bodies.emplace_back(params[i], params.size());
      inputs.push_back(Simulate(states[i]));
      streets.movers.push_back({.name = params[i].name});
    }
    outs.resize(params.size());
    for (std::uint32_t i = 0; i < params.size(); ++i) Arrive(At(i), states[i]);
  }

  Context At(std::uint32_t i) {
    const Fleet fleet{params, states, bodies};
    return {ParamsIn(fleet, cycle, i), cycle, planner, feedback, streets, grounds, i, fleet};
  }
  Ticket Give(std::uint32_t mover, const Command& command) {
    const long before = AllocationsOfThisThread();
    Apply(At(mover), ++ticket, command, states[mover]);
    allocated += AllocationsOfThisThread() - before;
    Hear();
    return ticket;
  }
  void Break(std::uint32_t mover, ErrorId error = ErrorId::kMoverDeviation) { Fail(At(mover), error, states[mover]); }
  void Step() {
    const long before = AllocationsOfThisThread();
    for (const bool planets : {false, true}) {
      for (std::uint32_t i = 0; i < params.size(); ++i) {
        if (IsPlanet(states[i]) == planets) mover::Step(At(i), inputs[i], states[i]);
      }
    }
    allocated += AllocationsOfThisThread() - before;
    for (std::uint32_t i = 0; i < params.size(); ++i) {
      Publish(At(i), inputs[i], states[i], outs[i]);
      inputs[i] = Simulate(states[i]);
    }
    Hear();
    ++cycle.count;
  }
  void Run(int cycles) {
    for (int i = 0; i < cycles; ++i) Step();
  }
  const FeedbackEvent& Of(Ticket of) { return answers[of]; }
  FeedbackState Become(Ticket of, int most = 100'000) {
    for (int i = 0; !IsFinal(Of(of).state) && i < most; ++i) Step();
    return Of(of).state;
  }
  // The first mover is the star of all others.
  void Form() {
    for (std::uint32_t i = 0; i < params.size(); ++i) Give(i, Enable{});
    Run(3);
    for (std::uint32_t i = 1; i < params.size(); ++i) joins.push_back(Give(i, JoinFormation{Name::Of("m0")}));
    Step();
  }

  std::vector<MoverParams> params;
  std::vector<State> states;
  std::vector<Body> bodies;
  std::vector<Inputs> inputs;
  std::vector<Outputs> outs;
  std::vector<Ticket> joins;
  TrackNetworkState streets{params.size(), {}};
  planar::GroupRegistry grounds{params.size(), 0, 1, {"cell"}};
  Cycle cycle;
  trajectory::Planner planner;
  std::vector<FeedbackEvent> storage = std::vector<FeedbackEvent>(4096);
  FeedbackSink feedback{storage};
  Ticket ticket = 0;
  long allocated = 0;                       // by commands and steps
  std::map<Ticket, FeedbackEvent> answers;  // the last one of each

 private:
  void Hear() {
    for (const FeedbackEvent& event : feedback.events()) {
      const auto before = answers.find(event.ticket);
      ASSERT_FALSE(before != answers.end() && IsFinal(before->second.state)) << "final once, ticket " << event.ticket;
      answers[event.ticket] = event;
    }
    EXPECT_EQ(feedback.lost(), 0u);
    feedback.Clear();
  }
};

using Complex = std::complex<double>;
inline Complex PlaceOf(const SetPoint& s) {
  return {s[kX].position, s[kY].position};
}
inline Complex VelocityOf(const SetPoint& s) {
  return {s[kX].velocity, s[kY].velocity};
}
inline Complex AccelerationOf(const SetPoint& s) {
  return {s[kX].acceleration, s[kY].acceleration};
}

// A mover that can turn all the way.
inline MoverParams Turning(double x, double y, double c = 0) {
  MoverParams p;
  p.initial = {.x = x, .y = y, .c = c};
  p.c.lower = -180;
  p.c.upper = 180;
  return p;
}

}  // namespace takt::mover
