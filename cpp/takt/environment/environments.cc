#include "takt/environment/environments.h"

#include <utility>

#include "takt/core/describe.h"
#include "takt/core/hash.h"
#include "takt/core/in_range.h"

namespace takt::environment {

namespace {

constexpr double kPerStator = 1000;

std::uint32_t BordersOf(const planar::Environment& surface) {
  std::size_t count = 0;
  for (const planar::Outline& outline : surface.outlines) count += outline.corners.size();
  return static_cast<std::uint32_t>(count);
}

void Add(const planar::Place& stator, std::size_t environment, Environments& e) {
  State& s = e.states[environment];
  e.stators[environment].push_back(stator);
  ++s.stator_count;
  s.stator_hash = HashOf(stator, s.stator_hash);
}

// One command to one environment.
struct Applier {
  const Context& c;
  std::uint32_t environment;
  Ticket ticket;
  State& s;

  void Report(FeedbackState state, ErrorId error = ErrorId::kNone, double value = 0,
              const ObjectInfo& object = {}) const {
    c.feedback.Report({ticket, c.cycle.count, state, false, error, value, object});
  }
  void Refuse(ErrorId error) const { Report(FeedbackState::kError, error); }
  void DoneAtOnce() const {
    Report(FeedbackState::kActive);
    Report(FeedbackState::kDone);
  }
  void Answer(const planar::Verdict& verdict) const {
    if (verdict.error == ErrorId::kNone) return DoneAtOnce();
    Report(FeedbackState::kError, verdict.error, 0, verdict.object);
  }
  // Returns true if no enabled group uses it and no request reads its stators.
  bool MayChange() const {
    return s.asked == 0 && c.grounds.Watching(c.grounds.group_of_environment[environment]) == 0;
  }

  void operator()(const AddStator& a) const {
    if (!MayChange()) return Refuse(ErrorId::kEnvironmentUsed);
    if (s.stator_count == planar::kMostStators) {
      return Report(FeedbackState::kError, ErrorId::kStators, ToValue(planar::StatorProblem::kTooMany, 0));
    }
    Add({a.lower_x, a.lower_y}, environment, c.environments);
    DoneAtOnce();
  }
  void operator()(const CreateBoundary&) const {
    if (!MayChange()) return Refuse(ErrorId::kEnvironmentUsed);
    s.asked = ++c.environments.questions;
    s.ticket = ticket;
    c.environments.desk.questions.TryPush({s.asked, environment, &c.environments.stators[environment]});
    Report(FeedbackState::kActive);
  }
  void operator()(const Clear&) const {
    if (!MayChange()) return Refuse(ErrorId::kEnvironmentUsed);
    Use(nullptr);
    c.environments.stators[environment].clear();
    s = {};
    DoneAtOnce();
  }
  void operator()(const AddToGroup& a) const {
    const std::uint32_t group = c.grounds.Find(a.group.view());
    if (group == 0) return Refuse(ErrorId::kParameter);
    Answer(planar::AddEnvironment(environment, group, c.grounds));
  }
  void operator()(const RemoveFromGroup&) const { Answer(planar::RemoveEnvironment(environment, c.grounds)); }
  void operator()(const BoundaryMade& made) const {
    if (made.number == 0 || made.number != s.asked) return Refuse(ErrorId::kState);
    const bool good = made.problem == planar::StatorProblem::kNone;
    ErrorId error = good ? ErrorId::kNone : ErrorId::kStators;
    if (good) {
      const planar::Environment* surface = Fetch(made.number);
      if (!surface) return Refuse(ErrorId::kState);
      // Its group may have been enabled with the old boundary meanwhile.
      if (c.grounds.Watching(c.grounds.group_of_environment[environment]) != 0) {
        c.environments.desk.retired.TryPush(surface);
        error = ErrorId::kEnvironmentUsed;
      } else {
        Use(surface);
      }
    }
    c.feedback.Report({s.ticket, c.cycle.count, error == ErrorId::kNone ? FeedbackState::kDone : FeedbackState::kError,
                       false, error, good ? 0 : ToValue(made.problem, made.stator)});
    s.asked = 0;
    s.ticket = 0;
    DoneAtOnce();
  }

  void Use(const planar::Environment* surface) const {
    const planar::Environment* old = std::exchange(c.environments.surfaces[environment], surface);
    if (old) c.environments.desk.retired.TryPush(old);
    c.grounds.surfaces[environment] = surface;
    s.border_count = surface ? BordersOf(*surface) : 0;
  }
  // Returns the surface for this request, and retires the others before it; null if it is not there.
  const planar::Environment* Fetch(std::uint64_t number) const {
    Delivery delivery;
    while (c.environments.desk.deliveries.TryPop(delivery)) {
      if (delivery.number == number) return delivery.surface;
      c.environments.desk.retired.TryPush(delivery.surface);
    }
    return nullptr;
  }
};

}  // namespace

Environments::Environments(const std::vector<EnvironmentParams>& params)
    : states(params.size()),
      stators(params.size()),
      outputs(params.size()),
      surfaces(params.size()),
      desk(params.size()) {
  for (std::size_t i = 0; i < params.size(); ++i) {
    stators[i].reserve(planar::kMostStators);
    for (const planar::Place& stator : params[i].stators) Add(stator, i, *this);
    if (stators[i].empty()) continue;
    auto* surface = new planar::Environment();
    planar::MakeEnvironment(stators[i], *surface);
    surfaces[i] = surface;
    states[i].border_count = BordersOf(*surface);
  }
}

Environments::~Environments() {
  for (const planar::Environment* surface : surfaces) delete surface;
}

void Apply(const Context& c, std::size_t environment, Ticket ticket, const Command& command) noexcept {
  const Applier applier{c, static_cast<std::uint32_t>(environment), ticket, c.environments.states[environment]};
  std::visit([&](const auto& body) { takt::InRange(body) ? applier(body) : applier.Refuse(ErrorId::kParameter); },
             command);
}

void Publish(const Context& c) noexcept {
  Environments& e = c.environments;
  for (std::size_t i = 0; i < e.states.size(); ++i) {
    e.outputs[i] = {e.states[i].stator_count, e.states[i].border_count, c.grounds.group_of_environment[i]};
  }
}

double ToValue(planar::StatorProblem problem, std::uint32_t stator) noexcept {
  return static_cast<double>(problem) + kPerStator * stator;
}

planar::StatorProblem ProblemOf(double value) noexcept {
  return static_cast<planar::StatorProblem>(static_cast<std::uint64_t>(value) % static_cast<std::uint64_t>(kPerStator));
}

std::uint32_t StatorOf(double value) noexcept {
  return static_cast<std::uint32_t>(value / kPerStator);
}

void describe(Description<State>& d) {
  using S = State;
  d.named("EnvironmentState");
  d.about("State of an environment.");
  d.internal<&S::stator_count>("Number of its stators.");
  d.internal<&S::stator_hash>("Hash of the stators.");
  d.internal<&S::border_count>("Number of straight sides of its boundary.");
  d.internal<&S::asked>("Number of the request whose answer is awaited; 0: none.");
  d.internal<&S::ticket>("Ticket of the command that made the request.");
}

}  // namespace takt::environment
